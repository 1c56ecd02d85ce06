"""What the lesson on the baselines measures."""

import numpy as np
import pytest
import torch

from bootcourse.course.lessons.recorded_drives import choosing
from bootcourse.course.lessons.recorded_drives.reachable_entropy import REACHABLE, by_entropy
from bootcourse.course.shipped import shipped_experiment
from bootcourse.learn.replay_buffer import Batch
from bootcourse.policies import PolicyOutput


def plan(action: int):
    """A driver that always does the same."""
    return lambda observations, cars: PolicyOutput(np.full(len(observations), action))


def test_what_a_policy_is_worth_is_read_from_recorded_decisions_where_it_acts_as_they_did():
    """A leads to B and pays 1; B ends and pays 2; γ = 0.5, so A is worth 1 + 0.5 · 2."""
    states, after = torch.eye(2), torch.tensor([[0.0, 1.0], [0.0, 1.0]])
    none = torch.zeros(2, dtype=torch.int64)
    data = Batch(states, after, none + 4, torch.tensor([1.0, 2.0]), torch.tensor([0.0, 1.0]), none, none, none.float())
    assert choosing.overlap(plan(4), data) == 1 and choosing.overlap(plan(7), data) == 0
    for start in (states[:1], states[1:]):
        assert choosing.estimates([plan(4), plan(4)], data, start, gamma=0.5) == pytest.approx([2, 2], abs=0.02)


def test_agents_with_a_reachable_target_entropy_ship_beside_agents_that_differ_from_them_in_it_alone():
    varied = shipped_experiment("reachable-entropy")
    assert set(varied) == {"gail", "cql_sac"}
    for method, both in varied.items():
        unreachable, reachable = by_entropy(both).values()
        assert {agent["target_entropy"] for agent in unreachable.agents} == {-1.0}
        assert {agent["target_entropy"] for agent in reachable.agents} == {REACHABLE}
        pairs = zip(unreachable.agents, reachable.agents, strict=True)
        assert all(first | {"target_entropy": REACHABLE} == second for first, second in pairs)
        assert len(reachable.of(method)) == 5 and 0 < REACHABLE < np.log(9)
