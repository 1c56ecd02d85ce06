"""The named teachers of a study, and the jobs that train with them."""

import json
from dataclasses import replace

import numpy as np
import pytest

from bootcourse.cli.training import teacher_from
from bootcourse.episodes.evaluate import drive_episodes
from bootcourse.errors import BootcourseError
from bootcourse.files import read_arrays, sha256, write_arrays
from bootcourse.learn.settings import settings_for, with_seeds
from bootcourse.learn.teachers import course_rule, slow, teacher_name, teacher_policy
from bootcourse.learn.training import Training
from bootcourse.research import jobs as jobs_module
from bootcourse.research.fingerprint import behind
from bootcourse.research.jobs import Job, OtherQuestion, finished, read_job, run_job
from bootcourse.research.plan import Variation
from bootcourse.research.results import load_job, load_results, save_results
from bootcourse.research.teachers import LATE, PLANNER, TEACHERS, as_it_was, chance, late, mirrored, teacher_named
from bootcourse.road.state import ACCELERATION, EGO, HEADING, LANE, SPEED, TRAP_1, X, Y
from bootcourse.road.vector_env import TrapVectorEnv
from bootcourse.scenario import DEFAULT
from bootcourse.storage.checkpoint import save_checkpoint
from bootcourse.storage.sealed import write_sealed

TINY = {"learning_starts": 16, "hidden": (8,), "buffer_size": 2000, "demonstration_episodes": 2}
NAME = "teachers/mirrored-bootstrapped"


def job(teacher: str = "mirrored", method: str = "bootstrapped", **changes) -> Job:
    agents = tuple(with_seeds(settings_for(method, **TINY), 2))
    return replace(Job(NAME, agents, DEFAULT, 4, tests=3, runs=False, teacher=teacher), **changes)


def some_roads(n: int = 60) -> np.ndarray:
    """Roads on which the rule has driven for ten seconds."""
    env = TrapVectorEnv(n)
    env.reset(seed=5)
    for _ in range(10):
        env.step(course_rule(env.cars, DEFAULT))
    return env.cars


# The teachers --------------------------------------------------------------------------------------------


@pytest.mark.parametrize("name", [name for name in TEACHERS if name != PLANNER])
def test_a_teacher_answers_for_each_road_as_if_it_were_the_only_one_and_changes_none(name):
    cars, teacher = some_roads(), teacher_named(name)
    before = cars.copy()
    actions = teacher(cars, DEFAULT)
    assert actions.tolist() == [int(teacher(cars[i : i + 1], DEFAULT)[0]) for i in range(len(cars))]
    assert np.array_equal(cars, before) and set(actions) <= set(range(9))


def test_each_teacher_earns_more_than_the_one_before_it():
    returns = [
        drive_episodes(teacher_policy(its.rule), range(100)).returns.mean()
        for name, its in TEACHERS.items()
        if name != PLANNER
    ]
    assert returns == sorted(returns)


@pytest.mark.parametrize("share", [0.25, 0.5])
def test_a_share_of_the_decisions_is_drawn_evenly_from_all_nine(share):
    cars = np.concatenate([some_roads(2000) + np.eye(10)[X] * moved for moved in (0.0, 7.0)])
    taken, right = TEACHERS[f"random-{100 * share:g}"].rule(cars, DEFAULT), course_rule(cars, DEFAULT)
    drawn = chance(cars, 1) < share
    assert drawn.mean() == pytest.approx(share, abs=0.03) and np.array_equal(taken[~drawn], right[~drawn])
    np.testing.assert_allclose(np.bincount(taken[drawn], minlength=9) / drawn.sum(), 1 / 9, atol=0.04)


def test_what_is_drawn_depends_on_the_road_and_not_on_the_last_digits():
    cars = some_roads()
    noise = 1 + 1e-13 * np.random.default_rng(0).standard_normal(cars.shape)
    assert np.array_equal(chance(cars, 1), chance(cars * noise, 1))
    assert len(set(chance(cars, 1))) == len(cars) and not np.any(chance(cars, 1) == chance(cars, 2))


def test_the_mirrored_rule_does_on_a_mirrored_road_what_the_rule_does():
    env = TrapVectorEnv(50)
    env.reset(seed=2)
    cars = env.cars.copy()
    cars[:, EGO, [Y, HEADING, SPEED]] = [6.8, 0.02, 9.5]
    seen = cars.copy()
    seen[..., Y], seen[..., HEADING], seen[..., LANE] = 8 - cars[..., Y], -cars[..., HEADING], 2 - cars[..., LANE]
    right = course_rule(seen, DEFAULT)
    assert set(right % 3) - {1} and np.array_equal(mirrored(cars, DEFAULT), 3 * (right // 3) + (2 - right % 3))


def test_a_late_teacher_sees_where_everybody_was_and_how_fast():
    cars = np.zeros((1, 2, 10))
    cars[0, EGO, [X, Y, SPEED, ACCELERATION, LANE]] = [100.0, 4.0, 11.0, 1.0, 1]
    cars[0, TRAP_1, [X, Y, SPEED, HEADING, LANE]] = [120.0, 6.5, 10.0, 0.3, 2]
    (ego, trap), driven = as_it_was(cars, 2.0, DEFAULT)[0], 20.0
    assert (ego[X], ego[Y], ego[SPEED], ego[LANE]) == (80.0, 4.0, 9.0, 1)  # 2 s at (9 + 11) / 2
    assert trap[[X, Y]] == pytest.approx([120 - driven * np.cos(0.3), 6.5 - driven * np.sin(0.3)])
    assert trap[LANE] == 0  # 0.59 m
    now = some_roads()
    assert np.array_equal(late(now, DEFAULT), course_rule(as_it_was(now, LATE, DEFAULT), DEFAULT))


def test_every_teacher_has_a_name_of_its_own_in_a_run_s_files():
    names = [teacher_name(its.rule) for its in TEACHERS.values()]
    assert len(set(names)) == len(names) and teacher_name(teacher_named("rule")) == "rule"


def test_the_planner_does_not_plan_twice_for_the_same_road(monkeypatch):
    planned = []

    def plans(cars, scenario):
        planned.append(cars.copy())
        return 7

    monkeypatch.setattr("bootcourse.research.teachers.planner_rule", lambda: plans)
    from bootcourse.research.teachers import remembering_planner

    planner, cars = remembering_planner(), some_roads(2)
    assert [planner(cars[i], DEFAULT) for i in (0, 1, 0, 1)] == [7] * 4
    assert len(planned) == 2 and np.array_equal(planned[1], cars[1])


@pytest.mark.parametrize(("method", "asks"), [("rlpd", False), ("ppo_cloned", False), ("soft", True), ("dagger", True)])
def test_a_slow_teacher_labels_only_where_the_labels_are_used(method, asks):
    quick = {"envs_per_agent": 4, "batch": 8, "cloning_updates": 1} if method == "ppo_cloned" else {}
    settings = [settings_for(method, **TINY | quick)]

    @slow
    def follows(cars, scenario):
        return 4

    training = Training(settings, 1, teacher=follows)
    training.step()
    assert (training.rule_actions == (4 if asks else 0)).all()


# Jobs ----------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("make", [job, lambda name: Variation(teacher=name)])
def test_an_unknown_teacher_is_one_sentence(make):
    with pytest.raises(BootcourseError, match="Teacher 'planer' is unknown: did you mean 'planner'"):
        make("planer")


def test_a_job_trains_with_its_teacher_and_its_rows_say_so(tmp_path):
    (tmp_path / "study.json").write_text("{}")
    assert run_job(job(), tmp_path) == "" and finished(job(), tmp_path)
    found = load_job(tmp_path / "jobs" / NAME)
    by_hand = Training(list(job().settings), 4, teacher=mirrored).run(progress=False)
    np.testing.assert_array_equal(found.curves["return"], by_hand.curves["return"].astype(np.float32))
    assert [agent["teacher"] for agent in found.agents] == ["mirrored", "mirrored"]
    save_results(found, tmp_path / "kept.npz", {})
    assert load_results(tmp_path / "kept.npz").agents == found.agents
    with pytest.raises(OtherQuestion, match="computed with other teacher: choose another folder"):
        finished(job("rule"), tmp_path)


def test_a_job_of_a_version_without_teachers_and_memory_counts_as_the_rule_s_without_one(tmp_path):
    (tmp_path / "study.json").write_text("{}")
    folder = tmp_path / "jobs" / NAME
    assert run_job(job("rule", "sac"), tmp_path) == ""
    agents = load_job(folder).agents
    without_teachers(folder)
    assert finished(job("rule", "sac"), tmp_path)
    assert load_job(folder).agents == agents and agents[0]["teacher"] == "rule"
    with pytest.raises(OtherQuestion, match="other teacher"):
        finished(job("timid", "sac"), tmp_path)


def test_a_job_of_a_version_without_some_setting_had_its_default(tmp_path):
    (tmp_path / "study.json").write_text("{}")
    folder = tmp_path / "jobs" / NAME
    assert run_job(job("rule", "sac"), tmp_path) == ""
    made = read_job(folder)
    for settings in made["asked"]["settings"]:
        del settings["gamma"]
    write_sealed(folder / "job.json", made)
    assert finished(job("rule", "sac"), tmp_path)
    other = [replace(settings, gamma=0.9) for settings in job("rule", "sac").settings]
    with pytest.raises(OtherQuestion, match="other settings"):
        finished(replace(job("rule", "sac"), settings=tuple(other)), tmp_path)


def without_teachers(folder) -> None:
    """Write a job's files as earlier versions did, which knew no teacher and no memory."""
    arrays, made = read_arrays(folder / "results.npz"), read_job(folder)
    agents = json.loads(str(arrays["agents"]))
    for entry in (*agents, made["asked"]):
        del entry["teacher"]
    del made["asked"]["scenario"]["sight"]["memory"]
    write_arrays(folder / "results.npz", arrays | {"agents": np.array(json.dumps(agents))})
    made["sha256"]["results.npz"] = sha256(folder / "results.npz")
    write_sealed(folder / "job.json", made)


def test_a_job_that_was_interrupted_goes_on_with_its_teacher_and_no_other(tmp_path, monkeypatch):
    for name in ("whole", "stopped"):
        (tmp_path / name).mkdir()
        (tmp_path / name / "study.json").write_text("{}")
    random = job("random-25")
    assert run_job(random, tmp_path / "whole") == ""
    calls = iter([False] * 3 + [True] * 10**6)
    monkeypatch.setattr(jobs_module, "_orphaned", lambda: next(calls))
    assert "interrupted" in run_job(random, tmp_path / "stopped")
    monkeypatch.undo()
    assert "began with the teacher 'rule, 25 % at random" in run_job(job("rule"), tmp_path / "stopped")
    assert run_job(random, tmp_path / "stopped") == ""
    one, other = (load_job(tmp_path / name / "jobs" / NAME) for name in ("whole", "stopped"))
    np.testing.assert_array_equal(one.curves["return"], other.curves["return"])
    np.testing.assert_array_equal(one.tested["returns"], other.tested["returns"])


def test_a_result_depends_on_the_behaviour_of_its_teacher():
    agents = with_seeds(settings_for("soft"), 1)
    assert behind(agents, DEFAULT) == ("road", "rule", "soft")
    assert behind(agents, DEFAULT, "late") == ("road", "rule", "teachers", "soft")
    assert behind(agents, DEFAULT, "planner") == ("road", "rule", "planner", "soft")


@pytest.mark.parametrize("name", TEACHERS)
def test_the_command_line_takes_a_teacher_by_its_name(name):
    assert teacher_from(name) is TEACHERS[name].rule


def test_the_command_line_names_all_teachers_for_an_unknown_one():
    with pytest.raises(BootcourseError, match="did you mean 'planner'.*random-50.*late.*FILE.py:FUNCTION"):
        teacher_from("planer")


def test_a_training_goes_on_with_its_named_teacher_alone_and_so_do_its_agents(bootcourse, tmp_path):
    out, settings = tmp_path / "runs", settings_for("ibrl", **TINY)
    save_checkpoint(Training([settings], 1, teacher=teacher_from("late")), out / "unfinished" / "checkpoint.npz")
    go_on = ("train", "--method", "ibrl", "--out", out, "--quiet", "--resume", "--teacher")
    refused = bootcourse(*go_on, "mirrored")
    assert refused.status == 2 and "began with the teacher 'late " in refused.err and "not 'mirrored " in refused.err
    assert bootcourse(*go_on, "late").status == 0
    evaluate = ("evaluate", out, "--episodes", 2, "--teacher")
    refused = bootcourse(*evaluate, "random-25")
    assert refused.status == 2 and "drives with the teacher 'late " in refused.err
    assert bootcourse(*evaluate, "late").status == 0
