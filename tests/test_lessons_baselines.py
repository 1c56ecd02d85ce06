"""What the lesson on the baselines measures."""

from dataclasses import replace

import numpy as np
import pytest

from bootcourse.course.lessons.imitation.figures import (
    WINDOW,
    agents_of,
    as_the_rule_would,
    believed,
    half_success,
    still_going,
    success_around,
    updates_made,
)
from bootcourse.course.lessons.imitation.reachable_entropy import REACHABLE, by_entropy
from bootcourse.course.shipped import (
    shipped_agents,
    shipped_bound,
    shipped_drive,
    shipped_experiment,
    shipped_results,
)
from bootcourse.learn.learner import learner_for
from bootcourse.learn.settings import settings_for, with_seeds
from bootcourse.research.results import Results


def results(seconds: np.ndarray) -> Results:
    """GAIL agents whose test drives and training episodes last so long, (agents, episodes), at 10 m/s."""
    seconds = np.asarray(seconds, dtype=np.float32)
    agents = [{"method": "gail", "seed": i, "updates": 2, "envs_per_agent": 4} for i in range(len(seconds))]
    drives = {"speed": np.full_like(seconds, 10), "distance": 10 * seconds}
    return Results(agents, np.full(len(seconds), -1), drives, drives)


def test_the_agents_of_a_learner_drive_as_it_does_and_keep_what_they_know():
    learner = learner_for(with_seeds(settings_for("cql", hidden=(8,)), 2), 26)
    found, seen = agents_of(learner), np.ones((3, 26), dtype=np.float32)
    before = found[1].q_values(seen)
    for parameter in learner.critics:
        parameter.data += 1
    assert (found[1].q_values(seen) == before).all() and (agents_of(learner)[1].q_values(seen) != before).all()
    assert [agent.settings.seed for agent in found] == [0, 1]


def test_the_best_other_action_is_never_the_given_one():
    agent, seen = shipped_agents("cql")[0], np.random.default_rng(0).normal(size=(20, 26))
    q = agent.q_values(seen)
    given, other = believed([agent], seen, q.argmax(axis=1))
    assert given == pytest.approx(q.max(axis=1).mean()) and other == pytest.approx(np.sort(q)[:, -2].mean())


def test_the_rule_does_what_the_rule_would_and_a_driver_that_steers_otherwise_may_brake_with_it():
    drive = shipped_drive("rule")
    assert as_the_rule_would([drive]) == (1, 1, 1)
    turned = drive.actions // 3 * 3 + (drive.actions + 1) % 3
    assert as_the_rule_would([replace(drive, actions=turned)]) == (0, 1, 1)
    never = replace(drive, actions=np.full_like(drive.actions, 4))
    assert as_the_rule_would([never])[1:] == (0, 0) and as_the_rule_would([drive, never])[1:] == (0.5, 0.5)


def test_updates_are_counted_from_the_seconds_that_the_episodes_lasted():
    assert updates_made(results([[10, 150], [2, 4]])) == pytest.approx(np.array([[5, 80], [1, 3]]))


def test_half_of_the_last_drives_succeed_from_the_episode_that_makes_it_half():
    success = np.zeros((3, 4 * WINDOW))
    success[0, WINDOW:] = 1
    success[1, :WINDOW:2] = 1
    assert half_success(success).tolist() == [WINDOW, WINDOW // 2, 0]


def test_the_success_around_an_update_is_that_of_the_episodes_next_to_it():
    success, updates = np.repeat([[0.0, 1.0]], 100, axis=1), np.arange(1.0, 201)[None]
    assert success_around(success, updates, 50)[0] == 0 and success_around(success, updates, 150)[0] == 1
    assert success_around(success, updates, 101)[0] == pytest.approx(0.5)


def test_the_figure_says_which_share_of_the_drives_ended_early():
    figure = still_going(results([[150, 150.0001, 20, 149.5], [150, 150, 150, 150]]), methods=("gail",))
    assert "25.0 % of GAIL's" in figure.alt and "50, 100 at 150" in figure.alt


def test_the_bound_that_ships_is_of_the_roads_that_the_agents_were_tested_on():
    bound, returns = shipped_bound(), shipped_results().tested["returns"]
    assert bound.shape == returns.shape[1:]
    assert bound.mean() > returns.mean(axis=1).max()


def test_what_was_changed_one_number_at_a_time_ships_with_the_agents_of_the_ablation():
    varied = shipped_experiment("sensitivity")
    assert varied and all("bootstrapped" in results.methods for results in varied.values())


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
