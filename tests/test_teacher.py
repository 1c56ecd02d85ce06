"""A teacher of your own: it drives, demonstrates and labels in place of the course's rule."""

import math
from dataclasses import replace

import numpy as np
import pytest
import torch

from bootcourse.errors import BootcourseError
from bootcourse.learn.demonstrations import collect
from bootcourse.learn.settings import settings_for, with_seeds
from bootcourse.learn.teachers import (
    ahead,
    all_roads,
    course_rule,
    teacher_name,
    teacher_of,
    teacher_policy,
    toward,
)
from bootcourse.learn.training import Training
from bootcourse.lessons.example_teachers import examine
from bootcourse.road.state import EGO, LANE, TRAP_1, X
from bootcourse.road.vector_env import TrapVectorEnv
from bootcourse.rule import rule
from bootcourse.scenario import DEFAULT
from bootcourse.storage.runs import load_checkpoint, load_run, save_checkpoint, save_runs

TWO = with_seeds(settings_for("bootstrapped", hidden=(8,), buffer_size=2000, demonstration_episodes=20), 2)


def one_road(cars, scenario):
    """The course's rule, one road at a time."""
    return int(rule(cars[None], scenario).actions[0])


def follows(cars, scenario):
    return 4


def test_taught_by_the_course_s_rule_every_number_is_that_of_a_plain_training():
    plain = Training(TWO, 12).run(progress=False)
    for teacher in (course_rule, one_road):
        taught = Training(TWO, 12, teacher=teacher).run(progress=False)
        for name, values in plain.curves.items():
            assert np.array_equal(values, taught.curves[name], equal_nan=True), name
        assert all(torch.equal(a, b) for a, b in zip(plain.agents[1].actor, taught.agents[1].actor, strict=True))


def test_the_demonstrations_of_the_course_s_rule_are_those_that_are_collected():
    assert torch.equal(collect(6, teacher=one_road), collect(6))


def test_every_label_is_the_teacher_s_in_the_memory_and_in_the_demonstrations():
    training = Training(TWO, 5, teacher=follows)
    training.run(progress=False)
    used = [slice(first, first + training.replay.size) for first in training.replay.first]
    labels = [training.replay.table[: training.replay.demonstrations, -2:]]
    labels += [training.replay.table[rows, -2:] for rows in used]
    assert training.replay.demonstrations == 20 * 150 and all((part == 4).all() for part in labels)


def test_a_method_without_demonstrations_is_only_labelled():
    training = Training([settings_for("soft", hidden=(8,), buffer_size=2000)], 2, teacher=follows)
    training.run(progress=False)
    assert training.replay.demonstrations == 0 and (training.replay.table[: training.replay.size, -2:] == 4).all()


def test_who_is_ahead_is_measured_from_bumper_to_bumper():
    env = TrapVectorEnv(1)
    env.reset(seed=3)
    cars = env.cars[0]
    gap, speed = ahead(cars, 2)
    assert gap == pytest.approx(cars[TRAP_1, X] - cars[EGO, X] - 5) and speed == 10.0
    assert ahead(cars[:1], 2) == (math.inf, math.inf)


def test_toward_is_the_rule_s_own_tracker():
    env = TrapVectorEnv(50)
    env.reset(seed=5)
    for _ in range(20):
        decisions = rule(env.cars, DEFAULT)
        found = [toward(cars, v, lane) for cars, v, lane in zip(env.cars, decisions.speeds, decisions.lanes)]  # noqa: B905
        assert found == decisions.actions.tolist()
        env.step(decisions.actions)


def test_toward_refuses_a_lane_that_is_not_there():
    with pytest.raises(BootcourseError, match=r"lanes 0\.\.2"):
        toward(np.zeros((9, 10)), 10.0, 3)


@pytest.mark.parametrize("answer", [9, -1, 4.0, True, None, "keep straight", np.float64(4)])
def test_what_is_no_action_is_named(answer):
    env = TrapVectorEnv(1)
    env.reset(seed=0)
    with pytest.raises(BootcourseError, match="an action is a whole number from 0 to 8"):
        teacher_of(lambda cars, scenario: answer)(env.cars)


def test_a_rule_that_writes_into_its_cars_changes_no_road():
    def spoils(cars, scenario):
        cars[:] = 0
        return 4

    env = TrapVectorEnv(2)
    env.reset(seed=0)
    before = env.cars.copy()
    teacher_of(spoils)(env.cars)
    assert np.array_equal(before, env.cars)
    assert "writes into `cars`" in repr(examine(spoils, 5))


def test_a_teacher_of_one_s_own_demonstrates_by_chance_too_where_that_is_asked_for():
    settings = [settings_for("demos", hidden=(8,), buffer_size=2000, demonstration_episodes=20, rule_p=0.5)]
    training = Training([replace(settings[0], stochastic_demonstrations=True)], 2, teacher=follows)
    actions = training.replay.table[: training.replay.demonstrations, 2 * 26]
    assert 0.4 < float((actions == 4).float().mean()) < 0.6


def test_agents_that_share_demonstrations_by_chance_need_the_same_p():
    pair = [settings_for("demos", stochastic_demonstrations=True, rule_p=p) for p in (0.5, 0.9)]
    with pytest.raises(BootcourseError, match="need the same rule_p"):
        Training(pair, 2)


def test_a_training_is_resumed_by_its_own_teacher_alone(tmp_path):
    training = Training(TWO, 12, teacher=follows)
    training.step()
    save_checkpoint(training, tmp_path / "checkpoint.npz")
    with pytest.raises(BootcourseError, match="began with the teacher 'follows"):
        load_checkpoint(tmp_path / "checkpoint.npz")
    again = load_checkpoint(tmp_path / "checkpoint.npz", teacher=follows)
    for each in (training, again):
        each.run(progress=False)
    assert torch.equal(training.replay.table, again.replay.table) and (again.rule_actions == 4).all()
    (run, _) = save_runs(again.result(), tmp_path / "runs")
    assert load_run(run).provenance["teacher"] == teacher_name(follows)


def test_two_rules_of_the_same_name_are_two_teachers():
    def other():
        def follows(cars, scenario):
            return 3

        return follows

    assert teacher_name(follows) != teacher_name(other()) and teacher_name(course_rule) == "rule"


def test_an_exam_counts_and_never_raises():
    assert "gets out on 100%" in repr(examine(course_rule, 20))
    assert "gets out on 0%" in repr(examine(follows, 20)) and "23.4" in repr(examine(follows, 20))
    assert "100% collision" in repr(examine(lambda cars, scenario: 7, 20))
    assert "whole number" in repr(examine(lambda cars, scenario: 12, 20))
    assert "ZeroDivisionError" in repr(examine(lambda cars, scenario: 1 // 0, 20))
    chance = np.random.default_rng(0)
    assert "differently each time" in repr(examine(lambda cars, scenario: int(chance.integers(9)), 20))


def test_all_roads_at_once_and_one_by_one_drive_alike():
    env = TrapVectorEnv(10)
    env.reset(seed=0)
    many = all_roads(lambda cars, scenario: np.where(cars[:, EGO, LANE] == 2, 1, 4))
    one = lambda cars, scenario: 1 if cars[EGO, LANE] == 2 else 4  # noqa: E731
    actions = [teacher_policy(each)(None, env.cars).actions for each in (many, one)]
    assert np.array_equal(*actions)
