"""PPO with a fading KL: its weight and its loss against numbers worked by hand, and what the KL does alone."""

import math

import numpy as np
import pytest
import torch

from bootcourse.learn.kickstart import KickstartLearner, kl_weight_at
from bootcourse.learn.learner import learner_for
from bootcourse.learn.ppo import Minibatch
from bootcourse.learn.settings import settings_for
from bootcourse.learn.training import Training
from tests.test_learn_ppo import SMALL


def a_minibatch(decisions: int = 16) -> Minibatch:
    """Decisions of a policy that takes every action with probability 1/9; the rule's actions depend on the state."""
    generator = torch.Generator().manual_seed(0)
    states = torch.randn(1, decisions, 3, generator=generator)
    actions = torch.arange(decisions)[None] % 9
    advantages = torch.randn(1, decisions, generator=generator)
    log_pi, rule_actions = torch.full((1, decisions), -math.log(9)), 4 * (states[..., 0] > 0).long()
    return Minibatch(states, actions, log_pi, advantages, advantages, rule_actions)


def test_lambda_falls_as_the_success_grows_and_is_whole_before_the_first_episode():
    found = kl_weight_at(np.array([0.0, 0.4, 1.0, np.nan]), start=2.0)
    assert found == pytest.approx([2.0, 1.2, 0.0, 2.0])


def test_a_training_s_lambda_follows_the_success_of_each_agent():
    training = Training([settings_for("ppo_kl", seed=seed, kl_weight=2.0, **SMALL) for seed in (0, 1)], episodes=10)
    training.curves.finished[:] = 5
    training.curves.values["success"][:, :5] = [[1, 0, 0, 1, 0], [1, 1, 1, 1, 1]]
    training.step()
    assert training.learner.xi[:, 0].tolist() == pytest.approx([1.2, 0.0])


def test_lambda_can_fall_with_the_episodes_instead():
    training = Training([settings_for("ppo_kl", kl_weight=2.0, kl_episodes=20, **SMALL)], episodes=30)
    for finished, weight in ((0, 2.0), (5, 1.5), (20, 0.0), (25, 0.0)):
        training.curves.finished[:] = finished
        training.learner.note_temperature()
        assert training.learner.xi.item() == pytest.approx(weight)


def test_the_actor_loss_is_ppo_s_plus_lambda_times_the_kl():
    """Where all nine actions are equally likely, the KL from π̃ with p = 0.9 is ln 9 + 0.9 ln 0.9 + 0.1 ln 0.0125."""
    kl = math.log(9) + 0.9 * math.log(0.9) + 0.1 * math.log(0.1 / 8)
    assert kl == pytest.approx(1.6642, abs=1e-4)
    plain, kickstarted = (learner_for([settings_for(method, hidden=(8,))], 3) for method in ("ppo", "ppo_kl"))
    for learner in (plain, kickstarted):
        with torch.no_grad():
            torch._foreach_zero_(learner.actor[-2:])  # the last layer: all logits are 0
    kickstarted.xi = torch.tensor([[0.5]])
    without, with_kl = (learner.losses(a_minibatch())["actor_loss"].item() for learner in (plain, kickstarted))
    assert with_kl - without == pytest.approx(0.5 * kl, rel=1e-5)


def test_the_kl_alone_leads_the_policy_to_the_stochastic_rule():
    changes = {"hidden": (8,), "actor_lr": 0.05, "entropy_weight": 0.0, "rule_p": 0.8}
    learner = learner_for([settings_for("ppo_kl", **changes)], 3)
    assert type(learner) is KickstartLearner
    batch = a_minibatch(64)
    batch = batch._replace(advantages=torch.zeros_like(batch.advantages))
    for _ in range(600):
        learner.update(batch)
    pi = learner.probabilities(batch.states).gather(-1, batch.rule_actions[..., None])[..., 0]
    clear = batch.states[..., 0].abs() > 0.2  # the rule's action changes at 0, where a small network has to be smooth
    assert clear.sum() > 40 and torch.allclose(pi[clear], torch.tensor(0.8), atol=0.05)
