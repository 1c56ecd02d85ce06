"""Roads that pay otherwise, and the agents of the lesson on the second trap that ship."""

import numpy as np
import pytest

from bootcourse.course.lessons.the_second_trap import ppo_kinds, second_trap
from bootcourse.episodes.evaluate import drive_episodes, held_out_seeds
from bootcourse.road.vector_env import TrapVectorEnv

RANDOM = np.random.default_rng(0).integers(0, 9, (60, 8))  # (decisions, roads)


def both(pay, actions):
    """The same roads with two rewards, and the potential before each decision: (decisions, roads) each."""
    plain, repaid = TrapVectorEnv(8), second_trap.Repaid(8, pay)
    for env in (plain, repaid):
        env.reset(seed=0)
    each = []
    for t in range(len(actions)):
        before = second_trap.left_of(repaid.cars)
        (_, rewards, *_), (_, others, terminated, truncated, _) = plain.step(actions[t]), repaid.step(actions[t])
        each.append([rewards, others, before, terminated, truncated])
    return map(np.array, zip(*each, strict=True))


def test_a_shaping_reward_adds_up_to_its_two_ends_over_an_accident_and_a_new_episode():
    pay = second_trap.shaped_pay(second_trap.left_of, gamma=1.0)
    rewards, others, phi, terminated, truncated = both(pay, RANDOM)
    assert terminated.sum() > 8 and not truncated.any()
    ends = np.flatnonzero(terminated[:, 0])
    for start, end in zip([0, *(ends[:-1] + 1)], ends, strict=True):  # each episode: 0 - Φ(s_0)
        extra = (others - rewards)[start : end + 1, 0]
        assert extra.sum() == pytest.approx(-phi[start, 0], abs=1e-9)


def test_the_agents_that_ship_drive_as_their_results_say():
    ships = ppo_kinds.reference()["alone"]
    driven = drive_episodes(ppo_kinds.agent_of("alone", 1).as_policy(), ppo_kinds.ROADS[:60])
    assert abs(driven.returns.mean() - ships["returns"][1]) < 5
    assert abs(driven.success.mean() - ships["success"][1]) < 0.05


def test_a_training_of_a_kind_keeps_what_the_lesson_reads(monkeypatch):
    monkeypatch.setattr(ppo_kinds, "KINDS", {"shaped": ppo_kinds.KINDS["shaped"]._replace(decisions=600)})
    monkeypatch.setattr(ppo_kinds, "QUICK", {"hidden": (4, 4), "envs_per_agent": 4, "horizon": 8, "batch": 32})
    monkeypatch.setattr(ppo_kinds, "EVERY", 200)
    monkeypatch.setattr(ppo_kinds, "ROADS", held_out_seeds(14, 3))
    trained, ships = ppo_kinds.train_kind("shaped", seeds=2), ppo_kinds.shipped_kinds.__wrapped__()["shaped"]
    for part in ("notes", "measured", "weights", "tested", "curves"):
        assert getattr(trained, part).keys() == getattr(ships, part).keys()
    assert trained.notes["at"].shape == (2, 3) and trained.weights["actor.0"].shape == (2, 26, 4)
