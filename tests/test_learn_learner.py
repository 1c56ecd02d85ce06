"""The update of all agents at once, against one that is written out for a single agent, and against itself."""

import copy
from dataclasses import replace

import numpy as np
import pytest
import torch

from bootcourse.learn import textbook
from bootcourse.learn.learner import SACLearner
from bootcourse.learn.networks import init_mlp, mlp
from bootcourse.learn.replay_buffer import Batch, ReplayBuffer
from bootcourse.learn.settings import settings_for
from bootcourse.learn.textbook import TextbookSAC
from bootcourse.methods import ABLATION
from bootcourse.scenario import DEFAULT
from tests.bench_learn import random_rows

INPUTS = DEFAULT.observation_size
EVERY_METHOD = [settings_for(method, seed=seed) for seed, method in enumerate(ABLATION)]
VARIANTS = [
    settings_for("bootstrapped", kl_in_target=False),
    settings_for("bootstrapped", xi_fixed=0.3),
    settings_for("margin_soft", paper_q_filter=False, gamma=0.95, target_entropy=0.3, rule_p=0.5),
]


def batches(settings, count=1, seed=0):
    """Batches as a training would draw them early on: 0.6 of each from the demonstrations, where there are any."""
    rng = np.random.default_rng(seed)
    replay = ReplayBuffer(len(settings), 500, INPUTS, random_rows(300, rng))
    replay.add(random_rows(len(settings) * 500, rng).view(len(settings), 500, -1))
    beta, generators = np.array([s.beta_start for s in settings]), [np.random.default_rng(s.seed) for s in settings]
    return [replay.sample(settings[0].batch, beta, generators) for _ in range(count)]


def of_one(batch: Batch, i: int) -> Batch:
    return Batch(*(column[i : i + 1] for column in batch))


def weights(learner: SACLearner, i: int = 0) -> torch.Tensor:
    """Everything that an update changes in agent i, as one vector."""
    n = learner.agents
    parts = [p[i] for p in learner.actor]
    parts += [p[j] for p in (*learner.critics, *learner.target_critics) for j in (i, n + i)]
    return torch.cat([part.detach().reshape(-1) for part in (*parts, learner.log_alpha[i])])


def textbook_of(learner: SACLearner, i: int) -> TextbookSAC:
    """A textbook agent with the weights of agent i."""
    twin, n = TextbookSAC(learner.settings[i], INPUTS), learner.agents
    pairs = [(twin.actor, learner.actor, i)]
    for k in range(2):
        pairs += [(twin.critics[k], learner.critics, k * n + i), (twin.targets[k], learner.target_critics, k * n + i)]
    with torch.no_grad():
        for net, parameters, row in pairs:
            for layer, (weight, bias) in zip(
                net[::2], zip(parameters[::2], parameters[1::2], strict=True), strict=True
            ):
                layer.weight.copy_(weight[row].T)
                layer.bias.copy_(bias[row, 0])
    return twin


def gradients_of(learner: SACLearner, i: int) -> list[torch.Tensor]:
    n = learner.agents
    rows = [(learner.actor, i), (learner.critics, i), (learner.critics, n + i)]
    return [p.grad[row] for parameters, row in rows for p in parameters] + [learner.log_alpha.grad[i]]


def gradients_of_textbook(twin: TextbookSAC) -> list[torch.Tensor]:
    found = []
    for net in (twin.actor, *twin.critics):
        for layer in net[::2]:
            found += [layer.weight.grad.T, layer.bias.grad[None]]
    return [*found, twin.log_alpha.grad]


@pytest.mark.parametrize("settings", [EVERY_METHOD, VARIANTS], ids=["methods", "variants"])
def test_an_update_has_the_textbooks_gradients_and_ten_lead_where_the_textbook_leads(settings):
    learner = SACLearner(settings, INPUTS)
    twins = [textbook_of(learner, i) for i in range(learner.agents)]
    for number, batch in enumerate(batches(settings, 10)):
        learner.update(batch)
        for i, twin in enumerate(twins):
            twin.update(Batch(*(column[i] for column in batch)))
            for ours, theirs in zip(gradients_of(learner, i), gradients_of_textbook(twin), strict=True):
                if number == 0:
                    torch.testing.assert_close(ours, theirs, atol=1e-5, rtol=1e-4)
    states = torch.randn(50, INPUTS, generator=torch.Generator().manual_seed(0))
    policy = learner.probabilities(states.expand(learner.agents, -1, -1))
    values = learner.q_values(learner.critics, states.expand(learner.agents, -1, -1)).detach()
    for i, twin in enumerate(twins):
        with torch.no_grad():
            torch.testing.assert_close(policy[i], twin.actor(states).softmax(1), atol=1e-4, rtol=1e-3)
            torch.testing.assert_close(values[i], torch.min(*(c(states) for c in twin.critics)), atol=1e-3, rtol=1e-3)
        torch.testing.assert_close(learner.log_alpha[i], twin.log_alpha, atol=1e-5, rtol=0)


def test_agents_that_learn_together_learn_what_each_learns_alone():
    together = SACLearner(EVERY_METHOD, INPUTS)
    alone = [SACLearner([s], INPUTS) for s in EVERY_METHOD]
    for i, one in enumerate(alone):
        assert torch.equal(weights(together, i), weights(one)), "the first weights"
    for batch in batches(EVERY_METHOD, 5):
        told = together.update(batch)
        for i, one in enumerate(alone):
            told_alone = one.update(of_one(batch, i))
            for name, value in told.items():
                torch.testing.assert_close(value[i : i + 1], told_alone[name], atol=1e-4, rtol=1e-4)
    for i, one in enumerate(alone):
        torch.testing.assert_close(weights(together, i), weights(one), atol=1e-5, rtol=1e-5)


def test_the_two_critics_start_apart_and_learn_apart():
    settings = [settings_for("sac")]
    learner, (batch,) = SACLearner(settings, INPUTS), batches(settings)
    assert not torch.equal(learner.critics[0][0], learner.critics[0][1])
    other = SACLearner(settings, INPUTS)
    with torch.no_grad():
        other.critics[0][1] += 0.1  # the second critic's first layer; targets stay
    learner.update(batch)
    other.update(batch)
    for ours, theirs in zip(learner.critics, other.critics, strict=True):
        assert torch.equal(ours[0], theirs[0])
        assert not torch.equal(ours[1], theirs[1])


def test_targets_follow_by_tau_and_have_no_gradient():
    settings = [settings_for("bootstrapped", tau=0.25)]
    learner, (batch,) = SACLearner(settings, INPUTS), batches(settings)
    before = [p.clone() for p in learner.target_critics]
    learner.update(batch)
    for old, target, critic in zip(before, learner.target_critics, learner.critics, strict=True):
        assert not target.requires_grad and target.grad is None
        torch.testing.assert_close(target, 0.75 * old + 0.25 * critic.detach())


@pytest.mark.parametrize(
    ("rate", "moving"), [("actor_lr", "actor"), ("critic_lr", "critics"), ("alpha_lr", "log_alpha")]
)
def test_each_learning_rate_moves_its_own_part_and_no_other(rate, moving):
    still = dict.fromkeys(("actor_lr", "critic_lr", "alpha_lr"), 0.0)
    learner = SACLearner([settings_for("bootstrapped", **(still | {rate: 0.01}))], INPUTS)
    before = copy.deepcopy([learner.actor, learner.critics, [learner.log_alpha]])
    learner.update(batches(learner.settings)[0])
    for name, old, new in zip(
        ("actor", "critics", "log_alpha"), before, (learner.actor, learner.critics, [learner.log_alpha]), strict=True
    ):
        changed = any(not torch.equal(a, b) for a, b in zip(old, new, strict=True))
        assert changed == (name == moving), name


# For each method, its ingredients and the setting that switches each off; the last entry of each says
# what of the first update must then differ.
INGREDIENTS = [
    ("soft", {"xi_multiplier": 0.0}, ("actor", "critics")),
    ("bootstrapped", {"xi_multiplier": 0.0}, ("actor", "critics")),
    ("bootstrapped", {"kl_in_target": False}, ("critics",)),
    ("bootstrapped", {"rule_p": 0.5}, ("actor", "critics")),
    ("bootstrapped", {"bonus": 0.0}, ("critics",)),
    ("bootstrapped", {"beta_start": 0.0}, ("actor", "critics")),
    ("demos", {"bonus": 0.0}, ("critics",)),
    ("demos", {"beta_start": 0.0}, ("actor", "critics")),
    ("margin", {"margin": 0.0}, ("critics",)),
    ("margin", {"paper_q_filter": False}, ("critics",)),
    ("margin", {"beta_start": 0.0}, ("actor", "critics")),
    ("margin_soft", {"margin": 0.0}, ("critics",)),
    ("margin_soft", {"xi_multiplier": 0.0}, ("actor", "critics")),
    ("sac", {"gamma": 0.0}, ("critics",)),
]


@pytest.mark.parametrize(("method", "off", "differs"), INGREDIENTS)
def test_every_ingredient_is_at_work_in_the_very_first_update(method, off, differs):
    with_it = settings_for(method)
    learners = [SACLearner([settings], INPUTS) for settings in (with_it, replace(with_it, **off))]
    for learner in learners:
        learner.update(batches(learner.settings)[0])
    for part in ("actor", "critics"):
        gradients = [torch.cat([p.grad.reshape(-1) for p in getattr(learner, part)]) for learner in learners]
        assert (not torch.allclose(*gradients, atol=1e-6)) == (part in differs), part


def test_the_networks_compute_what_nn_linear_computes():
    parameters = init_mlp((4, 8, 8, 3), [torch.Generator().manual_seed(s) for s in (1, 2)])
    x = torch.randn(2, 5, 4)
    out = mlp(parameters, x)
    for i in range(2):
        h = x[i]
        for k in range(0, 6, 2):
            h = torch.nn.functional.linear(h, parameters[k][i].T, parameters[k + 1][i, 0])
            h = h.relu() if k < 4 else h
        torch.testing.assert_close(out[i], h)


def test_first_weights_fill_what_torch_fills_by_default():
    (weight, bias, *_) = init_mlp((100, 400, 9), [torch.Generator().manual_seed(0)])
    for drawn in (weight, bias):
        assert drawn.abs().max() <= 0.1 and drawn.abs().max() > 0.098 and drawn.mean().abs() < 0.005


def test_the_textbook_trains_and_drives_episodes_to_their_end():
    settings = settings_for("bootstrapped", hidden=(8, 8), learning_starts=16, demonstration_episodes=3)
    agent, escaped = textbook.train(settings, episodes=6)
    assert len(escaped) >= 6 and set(escaped) <= {True, False}
    first = textbook.TextbookSAC(settings)
    assert float(agent.log_alpha.detach()) != float(first.log_alpha.detach())  # it was updated
