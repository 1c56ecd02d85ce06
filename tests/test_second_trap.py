"""Roads that pay otherwise, and the agents of the last lesson that ship."""

import numpy as np
import pytest

from bootcourse.course.lessons.the_second_trap import second_trap
from bootcourse.episodes.evaluate import drive_episodes, held_out_seeds
from bootcourse.errors import BootcourseError
from bootcourse.files import read_arrays, write_arrays
from bootcourse.research import ppo_reference
from bootcourse.road.formulas import speed_reward
from bootcourse.road.vector_env import TrapVectorEnv


def both(pay, decisions, actions):
    """The same roads with two rewards, and the potential before each decision: (decisions, roads) each."""
    plain, repaid = TrapVectorEnv(8), second_trap.Repaid(8, pay)
    for env in (plain, repaid):
        env.reset(seed=0)
    found = []
    for t in range(decisions):
        before = second_trap.left_of(repaid.cars)
        (_, rewards, *_), (_, others, terminated, truncated, _) = plain.step(actions[t]), repaid.step(actions[t])
        found.append([rewards, others, before, terminated, truncated])
    return map(np.array, zip(*found, strict=True))


def test_a_shaping_reward_adds_up_to_its_two_ends_over_an_accident_and_a_new_episode():
    actions = np.random.default_rng(0).integers(0, 9, (60, 8))
    rewards, others, phi, terminated, truncated = both(
        second_trap.shaped_pay(second_trap.left_of, gamma=1.0), 60, actions
    )
    assert terminated.sum() > 8 and not truncated.any()
    ends = np.flatnonzero(terminated[:, 0])
    for start, end in zip([0, *(ends[:-1] + 1)], ends, strict=True):  # each episode: 0 - Φ(s_0)
        extra = (others - rewards)[start : end + 1, 0]
        assert extra.sum() == pytest.approx(-phi[start, 0], abs=1e-9)


def test_the_concave_reward_has_the_ends_of_the_road_s_own_and_pays_more_between_them():
    v = np.array([4.0, 5.0, 7.5, 10.0, 12.5, 15.0, 16.0])
    pays, own = second_trap.concave_speed_reward(v), np.array([speed_reward(each) for each in v])
    assert pays == pytest.approx([0, 0, 0.5, 0.5**0.5, 0.75**0.5, 1, np.exp(-1)])
    assert np.allclose((pays - own)[[0, 1, 5, 6]], 0) and (pays > own)[2:5].all()


def test_the_concave_reward_replaces_that_of_the_speed_alone_and_leaves_accidents_as_they_are():
    straight = np.full((20, 8), 4)
    rewards, others, _, terminated, _ = both(second_trap.concave_pay, 20, straight)
    assert not terminated.any()
    assert np.allclose(others - rewards, 1.5 / 1.6 * (0.5**0.5 - 2 / 15), atol=1e-3)  # 10 m/s, of w_v + w_y + w_θ = 1.6
    actions = np.random.default_rng(0).integers(0, 9, (60, 8))
    rewards, others, _, terminated, _ = both(second_trap.concave_pay, 60, actions)
    assert terminated.sum() > 8 and np.array_equal(rewards[terminated], others[terminated])


def test_an_episode_whose_time_is_over_keeps_its_last_potential():
    actions = np.full((150, 8), 4)
    pay = second_trap.shaped_pay(lambda cars: np.full(len(cars), 3.0), gamma=0.5)
    rewards, others, _, terminated, truncated = both(pay, 150, actions)
    assert truncated[-1].all() and not terminated.any()
    assert np.allclose(others - rewards, 0.5 * 3 - 3)


def test_a_reference_that_was_stopped_goes_on_and_keeps_the_networks(tmp_path, monkeypatch):
    monkeypatch.setattr(ppo_reference, "KINDS", {"alone": ppo_reference.Kind("ppo", 600)})
    monkeypatch.setattr(ppo_reference, "QUICK", {"hidden": (4, 4), "envs_per_agent": 4, "horizon": 8, "batch": 32})
    monkeypatch.setattr(ppo_reference, "EVERY", 200)
    monkeypatch.setattr(ppo_reference, "ROADS", held_out_seeds(14, 3))
    out, kept = tmp_path / "ppo.npz", {"returns": np.array(5.0), "curve": np.zeros(3)}
    write_arrays(tmp_path / "ppo.unfinished/alone-0.npz", kept)
    trained = []
    made = ppo_reference.made
    monkeypatch.setattr(ppo_reference, "made", lambda kind, seed: trained.append(seed) or made(kind, seed))
    assert ppo_reference.main(["--out", str(out), "--seeds", "2"]) == 0
    assert trained == [1] and not (tmp_path / "ppo.unfinished").exists()
    assert read_arrays(out)["alone/returns"][0] == 5 and read_arrays(out)["alone/curve"].shape == (2, 3)


def test_the_agents_that_ship_drive_as_the_file_says():
    kept = ppo_reference.reference()["alone"]
    driven = drive_episodes(ppo_reference.agent_of("alone", 1).as_policy(), ppo_reference.ROADS[:60])
    assert (
        abs(driven.returns.mean() - kept["returns"][1]) < 5 and abs(driven.success.mean() - kept["success"][1]) < 0.05
    )


def test_a_file_without_all_kinds_is_refused_with_the_command(tmp_path):
    write_arrays(tmp_path / "ppo.npz", {"alone/returns": np.zeros(2)})
    with pytest.raises(BootcourseError, match="ppo_reference --out assets/ppo.npz"):
        ppo_reference.reference(tmp_path / "ppo.npz")
