"""The named teachers of a study, and the jobs that train with them."""

import numpy as np
import pytest

from bootcourse.cli.training import teacher_from
from bootcourse.episodes.evaluate import drive_episodes
from bootcourse.errors import BootcourseError
from bootcourse.learn.settings import settings_for
from bootcourse.learn.teachers import course_rule, slow, teacher_name, teacher_policy
from bootcourse.learn.training import Training
from bootcourse.research.cells import train_and_test, trained
from bootcourse.research.jobs import Job, finished, run_job
from bootcourse.research.results import load_job
from bootcourse.research.teachers import (
    LATE,
    PLANNER,
    TEACHERS,
    as_it_was,
    chance,
    late,
    mirrored,
    teacher_named,
)
from bootcourse.road.state import ACCELERATION, EGO, HEADING, LANE, SPEED, TRAP_1, X, Y
from bootcourse.road.vector_env import TrapVectorEnv
from bootcourse.scenario import DEFAULT

TINY = {"learning_starts": 16, "hidden": (8,), "buffer_size": 2000, "demonstration_episodes": 2}
NAME = "teachers/mirrored-soft"
QUICK = [name for name in TEACHERS if name != PLANNER]


def job(teacher: str) -> Job:
    return Job(NAME, train_and_test, trained(2, 4, 3, ("soft",), teacher=teacher, **TINY))


def some_roads(n: int = 60) -> np.ndarray:
    """Roads on which the rule has driven for ten seconds."""
    env = TrapVectorEnv(n)
    env.reset(seed=5)
    for _ in range(10):
        env.step(course_rule(env.cars, DEFAULT))
    return env.cars


@pytest.mark.parametrize("name", QUICK)
def test_a_teacher_answers_for_each_road_as_if_it_were_the_only_one_and_changes_none(name):
    cars, teacher = some_roads(), teacher_named(name)
    before = cars.copy()
    actions = teacher(cars, DEFAULT)
    assert actions.tolist() == [int(teacher(cars[i : i + 1], DEFAULT)[0]) for i in range(len(cars))]
    assert np.array_equal(cars, before) and set(actions) <= set(range(9))


def test_each_teacher_earns_more_than_the_one_before_it():
    returns = [drive_episodes(teacher_policy(TEACHERS[name].rule), range(100)).returns.mean() for name in QUICK]
    assert returns == sorted(returns)


@pytest.mark.parametrize("share", [0.25, 0.5])
def test_a_share_of_the_decisions_is_drawn_evenly_and_does_not_depend_on_the_last_digits(share):
    cars = np.concatenate([some_roads(2000) + np.eye(10)[X] * moved for moved in (0.0, 7.0)])
    taken, right = TEACHERS[f"random-{100 * share:g}"].rule(cars, DEFAULT), course_rule(cars, DEFAULT)
    drawn = chance(cars, 1) < share
    assert drawn.mean() == pytest.approx(share, abs=0.03) and np.array_equal(taken[~drawn], right[~drawn])
    np.testing.assert_allclose(np.bincount(taken[drawn], minlength=9) / drawn.sum(), 1 / 9, atol=0.04)
    noise = 1 + 1e-13 * np.random.default_rng(0).standard_normal(cars.shape)
    assert np.array_equal(chance(cars, 1), chance(cars * noise, 1))


def test_a_late_teacher_sees_where_everybody_was_and_how_fast():
    cars = np.zeros((1, 2, 10))
    cars[0, EGO, [X, Y, SPEED, ACCELERATION, LANE]] = [100.0, 4.0, 11.0, 1.0, 1]
    cars[0, TRAP_1, [X, Y, SPEED, HEADING, LANE]] = [120.0, 6.5, 10.0, 0.3, 2]
    (ego, trap), driven = as_it_was(cars, 2.0, DEFAULT)[0], 20.0
    assert (ego[X], ego[Y], ego[SPEED], ego[LANE]) == (80.0, 4.0, 9.0, 1)  # 2 s at (9 + 11) / 2
    assert trap[[X, Y]] == pytest.approx([120 - driven * np.cos(0.3), 6.5 - driven * np.sin(0.3)]) and trap[LANE] == 0
    now = some_roads()
    assert np.array_equal(late(now, DEFAULT), course_rule(as_it_was(now, LATE, DEFAULT), DEFAULT))


@pytest.mark.parametrize(("method", "asks"), [("rlpd", False), ("ppo_cloned", False), ("soft", True), ("dagger", True)])
def test_a_slow_teacher_labels_only_where_the_labels_are_used(method, asks):
    quick = {"envs_per_agent": 4, "batch": 8, "cloning_updates": 1} if method == "ppo_cloned" else {}

    @slow
    def follows(cars, scenario):
        return 4

    training = Training([settings_for(method, **TINY | quick)], 1, teacher=follows)
    training.step()
    assert (training.rule_actions == (4 if asks else 0)).all()


def test_a_job_trains_with_its_teacher_and_its_results_say_so(tmp_path):
    (tmp_path / "study.json").write_text("{}")
    assert run_job(job("mirrored"), tmp_path) == "" and finished(job("mirrored"), tmp_path)
    results = load_job(tmp_path / "jobs" / NAME)
    by_hand = Training(list(job("mirrored").arguments["settings"]), 4, teacher=mirrored).run(progress=False)
    np.testing.assert_array_equal(results.curves["return"], by_hand.curves["return"].astype(np.float32))
    assert [agent["teacher"] for agent in results.agents] == ["mirrored", "mirrored"]
    with pytest.raises(BootcourseError, match="computed with other teacher: choose another folder"):
        finished(job("rule"), tmp_path)


def test_the_command_line_takes_a_teacher_by_its_name_and_a_run_s_files_name_each():
    assert all(teacher_from(name) is teacher.rule for name, teacher in TEACHERS.items())
    names = [teacher_name(teacher.rule) for teacher in TEACHERS.values()]
    assert len(set(names)) == len(names) and "rule" in names
    for make in (job, teacher_from):
        with pytest.raises(BootcourseError, match="did you mean 'planner'"):
            make("planer")
