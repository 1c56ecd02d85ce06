"""The update of all agents at once, against one that is written out for a single agent, and against itself."""

import numpy as np
import pytest
import torch

from bootcourse.learn import textbook
from bootcourse.learn.learner import SACLearner
from bootcourse.learn.networks import init_mlp
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
    settings_for("soft", xi_min=3.0),
    settings_for("margin_soft", paper_q_filter=False, gamma=0.95, target_entropy=0.3, rule_p=0.5),
]


def batches(settings, count=1, seed=0):
    """Batches as a training would draw them early on: 0.6 of each from the demonstrations, where there are any."""
    rng = np.random.default_rng(seed)
    replay = ReplayBuffer(len(settings), 500, INPUTS, random_rows(300, rng))
    replay.add(random_rows(len(settings) * 500, rng).view(len(settings), 500, -1))
    beta, generators = np.array([s.beta_start for s in settings]), [np.random.default_rng(s.seed) for s in settings]
    return [replay.sample(settings[0].batch, beta, generators) for _ in range(count)]


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
    gradients = []
    for net in (twin.actor, *twin.critics):
        for layer in net[::2]:
            gradients += [layer.weight.grad.T, layer.bias.grad[None]]
    return [*gradients, twin.log_alpha.grad]


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
