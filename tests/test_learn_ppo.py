"""PPO: advantages and the clipped objective against numbers worked by hand, its minibatches, its files."""

import numpy as np
import pytest
import torch

from bootcourse.learn.ppo import Minibatch, RolloutBuffer, advantages, clipped_loss
from bootcourse.learn.settings import settings_for, with_seeds
from bootcourse.learn.training import Training

SMALL = {"hidden": (8,), "envs_per_agent": 4, "horizon": 8, "batch": 16, "epochs": 2, "buffer_size": 16}
GAMMA = torch.tensor(0.5)


def steps(*numbers):
    return torch.tensor(numbers)


def test_an_advantage_is_the_discounted_sum_of_the_surprises():
    zeros = torch.zeros(3)
    gained = advantages(steps(1.0, 2.0, 4.0), zeros, zeros, zeros, zeros, GAMMA, lam=0.5)
    assert gained.tolist() == [1 + (2 + 4 / 4) / 4, 2 + 4 / 4, 4]


def test_nothing_follows_an_accident_and_a_time_limit_is_worth_its_last_state():
    values, next_values = steps(1.0, 1.0), steps(10.0, 10.0)
    accident = advantages(steps(0.0, 0.0), values, next_values, steps(1.0, 0.0), steps(1.0, 0.0), GAMMA, lam=1.0)
    assert accident.tolist() == [0 + 0 - 1, 0.5 * 10 - 1]
    out_of_time = advantages(steps(0.0, 0.0), values, next_values, steps(0.0, 0.0), steps(1.0, 0.0), GAMMA, lam=1.0)
    assert out_of_time.tolist() == [0.5 * 10 - 1, 0.5 * 10 - 1]  # and no surprise of the next episode


@pytest.mark.parametrize(
    "ratio, advantage, loss, slope",
    [
        (1.1, 2.0, -2.2, True),  # within ε: the plain objective
        (1.5, 2.0, -2.4, False),  # a good action is not made likelier beyond 1 + ε,
        (0.5, 2.0, -1.0, True),  # but its way back is open
        (0.5, -2.0, 1.6, False),
        (1.5, -2.0, 3.0, True),
    ],
)
def test_the_objective_is_clipped_where_a_step_would_go_too_far(ratio, advantage, loss, slope):
    ratio = torch.tensor([ratio], requires_grad=True)
    clipped = clipped_loss(ratio, torch.tensor([advantage]), clip=0.2)
    clipped.backward()
    assert clipped.item() == pytest.approx(loss) and bool(ratio.grad.abs() > 0) is slope


@pytest.mark.parametrize("batch, minibatches", [(16, 2), (20, 2), (31, 2), (40, 1)])
def test_an_epoch_draws_every_decision_of_an_agent_once(batch, minibatches):
    buffer = RolloutBuffer(agents=2, roads=4, horizon=8, observation_size=1)
    numbers = torch.arange(64).view(2, 32)
    buffer.columns = Minibatch(*([numbers] * len(Minibatch._fields)))
    generators = [np.random.default_rng(seed) for seed in (0, 1)]
    for _ in range(2):
        drawn = torch.cat([buffer.sample(batch, np.zeros(2), generators).actions for _ in range(minibatches)], dim=1)
        assert torch.equal(drawn.sort(dim=1).values, numbers) and not torch.equal(drawn, numbers)


def test_a_training_updates_in_rounds_after_a_number_of_decisions():
    training = Training(with_seeds(settings_for("ppo", **SMALL), 2), episodes=10)
    for decision in range(1, 17):
        training.step()
        assert training.updates == (decision // 8) * 2 * 2  # epochs x minibatches
    assert set(training.losses) == {"actor_loss", "value_loss", "entropy"}


def test_both_learning_rates_fall_to_0_if_they_are_told_to():
    training = Training([settings_for("ppo", anneal_decisions=64, critic_lr=2e-3, actor_lr=1e-3, **SMALL)], episodes=50)
    seen = []
    for _ in range(3 * 8):  # a round is 8 decisions on 4 roads
        training.step()
        seen.append([group["lr"] for group in training.learner.optimiser.param_groups])
    assert seen[7::8] == [[1e-3, 2e-3], [5e-4, 1e-3], [0.0, 0.0]]


def test_a_clone_begins_with_the_teacher_s_actions():
    changes = SMALL | {"hidden": (32, 32), "demonstration_episodes": 10, "cloning_updates": 150}
    cloned, plain = (Training([settings_for(method, **changes)], 5) for method in ("ppo_cloned", "ppo"))
    agreement = []
    for training in (cloned, plain):
        pi = training.learner.probabilities(torch.from_numpy(training.states).float()[None])[0].numpy()
        agreement.append(pi[np.arange(len(pi)), training.taught()].mean())
    assert agreement[0] > 1.5 * agreement[1]
