"""What is remembered, and what is drawn from it."""

import numpy as np
import pytest
import torch

from bootcourse.errors import BootcourseError
from bootcourse.learn.demonstrations import collect
from bootcourse.learn.replay_buffer import ReplayBuffer, encode_transitions
from bootcourse.scenario import DEFAULT

INPUTS = DEFAULT.observation_size


def numbered(agents: int, roads: int, first: int) -> torch.Tensor:
    """Rows whose reward says which agent wrote them, and when: 1000 x agent + number."""
    numbers = np.arange(first, first + roads) + 1000.0 * np.arange(agents)[:, None]
    states, whole = np.zeros((agents, roads, INPUTS)), np.zeros((agents, roads))
    return encode_transitions(states, states, whole, numbers, whole, whole, whole)


def generators(*seeds: int) -> list[np.random.Generator]:
    return [np.random.default_rng(seed) for seed in seeds]


def test_what_goes_in_comes_out():
    rng = np.random.default_rng(0)
    states, next_states = rng.normal(size=(2, 6, INPUTS)).astype(np.float32)
    actions, rule_actions, next_rule_actions = rng.integers(9, size=(3, 6))
    rewards, terminated = rng.normal(size=6).astype(np.float32), np.array([0, 1, 0, 0, 1, 0])
    replay = ReplayBuffer(1, 6, INPUTS)
    replay.add(
        encode_transitions(states, next_states, actions, rewards, terminated, rule_actions, next_rule_actions)[None]
    )
    batch = replay.sample(200, np.zeros(1), generators(0))
    which = [int(np.flatnonzero(rewards == reward.item())[0]) for reward in batch.rewards[0]]
    assert set(which) == set(range(6))
    np.testing.assert_array_equal(batch.states[0], states[which])
    np.testing.assert_array_equal(batch.next_states[0], next_states[which])
    np.testing.assert_array_equal(batch.actions[0], actions[which])
    np.testing.assert_array_equal(batch.terminated[0], terminated[which])
    np.testing.assert_array_equal(batch.rule_actions[0], rule_actions[which])
    np.testing.assert_array_equal(batch.next_rule_actions[0], next_rule_actions[which])
    assert batch.actions.dtype == batch.rule_actions.dtype == torch.int64
    assert not batch.is_demonstration.any()


def test_the_oldest_is_overwritten_and_nothing_else():
    replay = ReplayBuffer(2, 10, INPUTS)
    for k in range(7):  # 28 transitions of each agent, 10 of which fit, across the end of the table
        replay.add(numbered(2, 4, 4 * k))
    batch = replay.sample(500, np.zeros(2), generators(0, 1))
    for agent in range(2):
        assert set(batch.rewards[agent].tolist()) == {1000.0 * agent + k for k in range(18, 28)}


@pytest.mark.parametrize(("beta", "demonstrations"), [(0.0, 0), (0.3, 19), (0.5, 32), (0.6, 38), (0.65, 42), (1.0, 64)])
def test_the_share_of_demonstrations_is_beta_of_the_batch(beta, demonstrations):
    replay = ReplayBuffer(2, 50, INPUTS, numbered(1, 20, 500)[0])
    replay.add(numbered(2, 50, 0))
    batch = replay.sample(64, np.array([beta, 0.5]), generators(0, 1))  # each agent has its own share
    assert batch.is_demonstration.sum(1).tolist() == [demonstrations, 32]
    from_demonstrations = (batch.rewards >= 500) & (batch.rewards < 1000)
    assert torch.equal(from_demonstrations, batch.is_demonstration.bool())


def test_beta_without_demonstrations_is_refused():
    replay = ReplayBuffer(1, 10, INPUTS)
    replay.add(numbered(1, 10, 0))
    with pytest.raises(BootcourseError, match="no demonstrations"):
        replay.sample(64, np.array([0.6]), generators(0))


def test_the_demonstrator_does_what_the_rule_says_and_goes_on_where_it_was_until_time_runs_out():
    n, episodes = INPUTS, 3
    rows = collect(episodes).view(DEFAULT.clock.decisions, episodes, -1)
    assert torch.equal(rows[..., 2 * n], rows[..., 2 * n + 3]) and not rows[..., 2 * n + 2].any()
    assert torch.equal(rows[1:, :, :n], rows[:-1, :, n : 2 * n])
    assert torch.equal(rows[1:, :, 2 * n + 3], rows[:-1, :, 2 * n + 4])
