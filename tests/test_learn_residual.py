"""Residual PPO: the untrained agent is the stochastic rule, and its logits correct it."""

import math

import torch

from bootcourse.episodes.evaluate import evaluate
from bootcourse.learn.learner import learner_for
from bootcourse.learn.ppo import Minibatch
from bootcourse.learn.settings import settings_for, with_seeds
from bootcourse.learn.training import Training
from bootcourse.policies import rule_policy
from bootcourse.scenario import DEFAULT
from tests.test_learn_ppo import SMALL

ACTIONS = torch.arange(9)


def test_the_untrained_policy_is_the_stochastic_rule():
    learner = learner_for(with_seeds(settings_for("ppo_residual", rule_p=0.8, hidden=(8,)), 2), 3)
    rule_actions = ACTIONS.expand(2, 9)
    pi = learner.driving_policy(torch.randn(2, 9, 3), rule_actions)
    expected = torch.where(ACTIONS == rule_actions[..., None], 0.8, 0.2 / 8)
    torch.testing.assert_close(pi, expected, rtol=1e-6, atol=0.0)


def test_a_logit_multiplies_the_rule_s_probability():
    """f = ln 2 for action 3 only: π = (0.9, 0.0125, 0.0125, 2 x 0.0125, ...) / 1.0125 if the rule takes action 0."""
    learner = learner_for([settings_for("ppo_residual", rule_p=0.9, hidden=(8,))], 3)
    with torch.no_grad():
        learner.actor[-1][..., 3] = math.log(2)
    pi = learner.driving_policy(torch.randn(1, 1, 3), torch.zeros(1, 1, dtype=torch.int64))[0, 0]
    expected = torch.where(ACTIONS == 3, 0.025, 0.0125)
    expected[0] = 0.9
    torch.testing.assert_close(pi, expected / 1.0125)


def test_the_old_probabilities_of_its_decisions_are_those_it_drove_with():
    training = Training([settings_for("ppo_residual", **SMALL)], episodes=10)
    for _ in range(7):
        training.step()
    training.update = lambda: None
    training.step()
    columns = training.replay.columns
    drove_as_the_rule = columns.actions == columns.rule_actions
    expected = torch.where(drove_as_the_rule, math.log(0.9), math.log(0.1 / 8))
    assert 0 < drove_as_the_rule.float().mean() < 1
    torch.testing.assert_close(columns.log_pi, expected)


def test_the_untrained_agent_drives_as_the_rule_does():
    agent = Training([settings_for("ppo_residual", **SMALL)], episodes=10).agent(0)
    assert evaluate(agent.as_policy(), 5) == evaluate(rule_policy(DEFAULT), 5)


def test_the_rule_s_action_becomes_rarer_where_it_does_badly():
    learner = learner_for([settings_for("ppo_residual", hidden=(8,), actor_lr=0.01)], 3)
    states, rule_actions, actions = torch.ones(1, 18, 3), torch.zeros(1, 18, dtype=torch.int64), ACTIONS.repeat(1, 2)
    old = learner.log_pi(states, rule_actions).detach().gather(-1, actions[..., None])[..., 0]
    advantages = torch.where(actions == 0, -1.0, 1.0)
    for _ in range(50):
        learner.update(Minibatch(states, actions, old, advantages, advantages, rule_actions))
    assert learner.driving_policy(states, rule_actions)[0, 0, 0] < 0.8  # of 0.9
