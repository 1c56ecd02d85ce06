"""The problems of the experiment `elsewhere`, worked out by hand, and one cell of it."""

import gymnasium as gym
import numpy as np
import pytest

from bootcourse.episodes.evaluate import drive_episodes
from bootcourse.learn.teachers import teacher_policy
from bootcourse.research.experiments import elsewhere
from bootcourse.research.experiments.elsewhere import EXPERIMENT
from bootcourse.research.jobs import Workplace
from bootcourse.research.problems import (
    EAST,
    FORWARD,
    LEFT,
    NORTH,
    PICK_UP,
    PROBLEMS,
    RIGHT,
    SOUTH,
    TOGGLE,
    Chain,
    DoorKey,
    has_box2d,
    right_in,
    wrong_where,
)  # fmt: skip
from bootcourse.research.results import load_results


def in_chain(cells: list[int], actions: list[int]):
    env = Chain(len(cells))
    env.reset(seed=0)
    env.states = np.array(cells)[:, None]
    return env, env.step(np.array(actions))


def test_the_chain_pays_at_its_wall_and_at_its_end_and_nowhere_between():
    env, (seen, rewards, terminated, truncated, infos) = in_chain([0, 0, 7, 18], [0, 1, 0, 1])
    assert rewards.tolist() == [0.05, 0, 0, 10] and terminated.tolist() == [False, False, False, True]
    assert seen[:, :20].argmax(1).tolist() == [0, 1, 6, 0]  # the last has begun again
    assert infos["final_obs"][3][:20].argmax() == 19 and infos["final_info"]["is_success"].tolist() == [0, 0, 0, 1]
    np.testing.assert_allclose(seen[:, 20], [1 / 60, 1 / 60, 1 / 60, 0])
    for _ in range(59):
        *_, terminated, truncated, infos = env.step(np.array([0, 0, 0, 0]))
    assert truncated.tolist() == [True, True, True, False] and not terminated.any()


def test_the_way_through_the_door_step_by_step():
    env = DoorKey(1)
    env.reset(seed=0)
    env.states = np.array([[1, 1, EAST, 3, 2, 0]])  # key in row 3, door in row 2
    plan = [RIGHT, FORWARD, PICK_UP, LEFT, TOGGLE, FORWARD, FORWARD, RIGHT, FORWARD]
    seen, way, rewards = env.show(env.states, env.times), [], []
    for action in plan:
        assert PROBLEMS["doorkey"].rule(seen).tolist() == [action]
        seen, reward, terminated, _, infos = env.step(np.array([action]))
        way.append(tuple(env.states[0]))
        rewards.append(reward[0])
    assert way[:5] == [
        (1, 1, SOUTH, 3, 2, 0), (1, 2, SOUTH, 3, 2, 0), (1, 2, SOUTH, 0, 2, 0),
        (1, 2, EAST, 0, 2, 0), (1, 2, EAST, 0, 2, 1),
    ]  # fmt: skip
    assert terminated[0] and infos["is_success"][0] and rewards == pytest.approx([0] * 8 + [0.919])
    driven = drive_episodes(teacher_policy(PROBLEMS["doorkey"].rule, None, 5), range(300), None, make_env=DoorKey)
    assert driven.success.all() and driven.returns.min() > 0.8, "each start can be solved"


@pytest.mark.parametrize(
    ("state", "action"),
    [
        ((1, 2, SOUTH, 3, 2, 0), FORWARD),  # the key lies in the way
        ((1, 1, NORTH, 3, 2, 0), FORWARD),  # a wall
        ((1, 2, EAST, 3, 2, 0), TOGGLE),  # locked, and no key
        ((1, 2, EAST, 0, 2, 0), FORWARD),  # still locked
        ((1, 1, SOUTH, 3, 2, 0), PICK_UP),  # too far away
        ((1, 1, EAST, 0, 2, 1), FORWARD),  # beside the door
    ],
)
def test_what_cannot_be_done_changes_nothing(state, action):
    env = DoorKey(1)
    env.reset(seed=0)
    env.states = np.array([state])
    env.step(np.array([action]))
    assert tuple(env.states[0]) == state


@pytest.mark.parametrize("name", [name for name in PROBLEMS if name != "lander" or has_box2d()])
def test_a_worse_teacher_errs_where_it_is_meant_to(name):
    problem = PROBLEMS[name]
    env, rng = problem.make_env(40), np.random.default_rng(0)
    seen = [env.reset(seed=1)[0]]
    for _ in range(60):
        seen.append(env.step(rng.integers(problem.actions, size=40))[0])
    seen = np.unique(np.concatenate(seen), axis=0)
    right, random = problem.rule(seen), right_in(problem.right, problem.rule, problem.actions)(seen)
    assert (random == right).mean() == pytest.approx(problem.right, abs=0.06) and set(random) <= set(
        range(problem.actions)
    )
    systematic = wrong_where(problem.region, problem.rule, problem.actions)(seen)
    assert np.array_equal(systematic != right, problem.region(seen))
    assert max(*random, *systematic) < problem.actions and min(*random, *systematic) >= 0


def test_a_cell_is_trained_tested_and_shown(tmp_path):
    (job,) = EXPERIMENT.jobs("chain-random-soft", seeds=2, episodes=3, tests=4)
    assert job.name == "elsewhere/chain-random-soft" and job.arguments["seeds"] == 2
    job.run(Workplace(tmp_path, tmp_path), **job.arguments)
    results = load_results(tmp_path / "results.npz")
    assert results.sizes == (4, 3) and results.measured["teacher_success"].tolist() == [1, 1]
    assert results.scores("success").shape == (2,) and results.agents[0]["teacher"] == "random"


def test_the_lander_is_left_out_with_a_sentence_where_box2d_is_missing(monkeypatch, capsys):
    monkeypatch.setattr(elsewhere, "has_box2d", lambda: True)
    assert {job.arguments["seeds"] for job in EXPERIMENT.jobs("lander")} == {10}
    monkeypatch.setattr(elsewhere, "has_box2d", lambda: False)
    assert EXPERIMENT.jobs("lander") == []
    assert capsys.readouterr().out == (
        "Lunar lander is left out, since box2d is not installed: `pip install bootcourse[lander]`.\n"
    )


@pytest.mark.skipif(not has_box2d(), reason="box2d is not installed")
def test_the_lander_s_rule_is_gymnasium_s_heuristic():
    from gymnasium.envs.box2d.lunar_lander import heuristic

    env = gym.make("LunarLander-v3")
    seen, _ = env.reset(seed=0)
    for _ in range(300):
        action = heuristic(env.unwrapped, seen)
        assert PROBLEMS["lander"].rule(seen[None]) == action
        seen, _, terminated, truncated, _ = env.step(action)
        if terminated or truncated:
            seen, _ = env.reset()
