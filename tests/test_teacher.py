"""A teacher of your own: it drives, demonstrates and labels in place of the course's rule."""

import copy
import math
import traceback
from dataclasses import replace

import numpy as np
import pytest
import torch

from bootcourse.course.lessons.your_teacher.example_teachers import examine
from bootcourse.episodes.evaluate import evaluate, held_out_seeds
from bootcourse.episodes.record import record
from bootcourse.errors import BootcourseError, RuleFailed
from bootcourse.learn import training as learn_training
from bootcourse.learn.demonstrations import FIRST_SEED, collect, demonstration_rows
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
from bootcourse.policies import idle_policy
from bootcourse.road.state import EGO, LANE, TRAP_1, X
from bootcourse.road.vector_env import TrapVectorEnv
from bootcourse.rule import rule
from bootcourse.scenario import DEFAULT, IDLE
from bootcourse.storage.checkpoint import load_checkpoint, save_checkpoint
from bootcourse.storage.runs import load_run, save_runs

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


def after(calls: int, then):
    """A rule that keeps straight for so many calls, and then does something else."""
    left = iter(range(calls))

    def follows_first(cars, scenario):
        return then() if next(left, None) is None else 4

    return follows_first


def no_lane():
    return {}["lane"]


RAISED = "it raised KeyError: 'lane'."


def test_a_rule_that_fails_while_it_drives_names_the_road_and_the_decision():
    first = held_out_seeds(1, 4)[0]
    with pytest.raises(RuleFailed) as failed:
        evaluate(teacher_policy(after(4 * 12 + 2, no_lane)), 4)  # it is asked about four roads at a time
    where = f"on the road with seed {first + 2}, at decision 12"
    assert str(failed.value) == f"Your rule 'follows_first' failed {where}: {RAISED}"
    with pytest.raises(RuleFailed, match="with seed 7, at decision 3: it returned 9, but an action is a whole number"):
        record(teacher_policy(after(3, lambda: 9)), [7])


def test_the_rule_s_own_exception_and_its_line_stay_behind_the_sentence():
    with pytest.raises(RuleFailed) as failed:
        record(teacher_policy(after(0, no_lane)), [7])
    cause = failed.value.__cause__
    assert type(cause) is KeyError
    assert "follows_first" in [frame.name for frame in traceback.extract_tb(cause.__traceback__)]


def test_a_rule_that_fails_while_it_demonstrates_names_the_road_and_the_decision():
    with pytest.raises(RuleFailed, match=f"with seed {FIRST_SEED + 1}, at decision 5: it raised"):
        collect(2, teacher=after(2 * (1 + 5) + 1, no_lane))  # it is asked about decision 0 twice
    with pytest.raises(RuleFailed, match=f"with seed {FIRST_SEED + 1}, at decision 0: it raised"):
        collect(2, policy=idle_policy, teacher=after(1, no_lane))
    with pytest.raises(RuleFailed, match="with seed 7, at decision 9: it raised"):
        demonstration_rows(record(idle_policy, [7]), after(9, no_lane))


@pytest.mark.parametrize(
    ("calls", "where"),
    [
        (0, "on road 0 of agent 0 in training, at decision 0"),
        (8 * 12 + 6, "on road 2 of agent 1 in training, at decision 12"),
        (8 * 150 + 5, "on road 1 of agent 1 in training, at decision 0"),  # of its second episode
        (8 * 151 + 5, "on road 1 of agent 1 in training, at an episode's end"),
    ],
)
def test_a_rule_that_fails_while_it_teaches_names_the_agent_and_its_road(calls, where, monkeypatch):
    two = with_seeds(settings_for("soft", hidden=(8,), buffer_size=2000), 2)
    monkeypatch.setattr(Training, "update", lambda training: None)
    monkeypatch.setattr(learn_training, "sample_actions", lambda policy, uniforms: np.full(uniforms.shape, IDLE))
    with pytest.raises(RuleFailed, match=f"failed {where}: {RAISED}"):
        Training(two, 20, teacher=after(calls, no_lane)).run(progress=False)


def test_a_rule_for_all_roads_that_raises_names_no_road():
    with pytest.raises(RuleFailed, match="failed in a call for all roads: it raised KeyError"):
        collect(2, teacher=all_roads(lambda cars, scenario: no_lane()))


@pytest.mark.parametrize(
    ("actions", "sentence"),
    [
        ([4, 9], "failed on road 1: it returned 9, but an action is a whole number from 0 to 8"),
        ([4.0, 4.0], r"failed in a call for all roads: it returned actions of shape \(2,\) and type float64"),
        ([4], r"it returned actions of shape \(1,\) and type int64, but 2 roads need a whole number each"),
        (["left", "left"], "but 2 roads need a whole number each"),
    ],
)
def test_a_rule_for_all_roads_is_held_to_the_actions(actions, sentence):
    with pytest.raises(RuleFailed, match=sentence):
        teacher_of(all_roads(lambda cars, scenario: actions))(np.zeros((2, 9, 10)))


def test_a_rule_that_fails_when_a_training_is_resumed_does_not_call_the_checkpoint_damaged(tmp_path):
    broken = []

    def rule_that_breaks(cars, scenario):
        return 4 if not broken else no_lane()

    training = Training([settings_for("soft", hidden=(8,), buffer_size=2000)], 12, teacher=rule_that_breaks)
    training.step()
    save_checkpoint(training, tmp_path / "checkpoint.npz")
    broken.append(True)
    with pytest.raises(RuleFailed, match=f"on road 0 of agent 0 in training, at decision 0: {RAISED}"):
        load_checkpoint(tmp_path / "checkpoint.npz", teacher=rule_that_breaks)


def test_an_interrupt_and_an_exception_of_the_library_s_own_rules_pass():
    def interrupted(cars, scenario):
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        record(teacher_policy(interrupted), [7])
    with pytest.raises(IndexError):
        teacher_of(course_rule)(np.zeros((2, 0, 10)))


def test_what_a_rule_failed_of_survives_the_way_from_another_process():
    with pytest.raises(RuleFailed) as failed:
        record(teacher_policy(after(0, lambda: 9)), [7])
    assert str(copy.copy(failed.value)) == str(failed.value)  # rebuilt from what a process would send


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
