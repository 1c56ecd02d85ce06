"""A teacher of your own: it drives, demonstrates and labels in place of the course's rule."""

import copy
import math
import re
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
from bootcourse.learn.teachers import ahead, all_roads, course_rule, teacher_name, teacher_of, teacher_policy, toward
from bootcourse.learn.training import Training
from bootcourse.policies import idle_policy
from bootcourse.road.state import EGO, TRAP_1, X
from bootcourse.road.vector_env import TrapVectorEnv
from bootcourse.rule import rule
from bootcourse.scenario import DEFAULT, IDLE
from bootcourse.storage.checkpoint import load_checkpoint, save_checkpoint
from bootcourse.storage.runs import load_run, save_runs

SMALL = {"hidden": (8,), "buffer_size": 2000, "demonstration_episodes": 20}
TWO = with_seeds(settings_for("bootstrapped", **SMALL), 2)
RAISED = "it raised KeyError: 'lane'."


def one_road(cars, scenario):
    """The course's rule, one road at a time."""
    return int(rule(cars[None], scenario).actions[0])


def follows(cars, scenario):
    return 4


def after(calls: int, then):
    """A rule that keeps straight for so many calls, and then does something else."""
    left = iter(range(calls))
    return lambda cars, scenario: then() if next(left, None) is None else 4


def no_lane():
    return {}["lane"]


def roads(n: int, seed: int = 0) -> TrapVectorEnv:
    env = TrapVectorEnv(n)
    env.reset(seed=seed)
    return env


def test_a_rule_for_one_road_teaches_as_the_course_s_rule_does_for_all():
    plain, taught = (Training(TWO, 6, teacher=teacher).run(progress=False) for teacher in (course_rule, one_road))
    for name, values in plain.curves.items():
        assert np.array_equal(values, taught.curves[name], equal_nan=True), name
    assert all(torch.equal(a, b) for a, b in zip(plain.agents[1].actor, taught.agents[1].actor, strict=True))


def test_every_label_is_the_teacher_s_in_the_buffer_and_in_the_demonstrations_and_only_it_resumes_a_training(tmp_path):
    training = Training(TWO, 12, teacher=follows)
    training.step()
    save_checkpoint(training, tmp_path / "checkpoint.npz")
    with pytest.raises(BootcourseError, match="began with the teacher 'follows"):
        load_checkpoint(tmp_path / "checkpoint.npz")
    again = load_checkpoint(tmp_path / "checkpoint.npz", teacher=follows)
    for each in (training, again):
        each.run(progress=False)
    assert torch.equal(training.replay.table, again.replay.table)
    replay = training.replay
    labels = [replay.table[: replay.demonstrations, -2:]]
    labels += [replay.table[first : first + replay.size, -2:] for first in replay.first]
    assert replay.demonstrations == 20 * 150 and all((part == 4).all() for part in labels)
    other = lambda cars, scenario: 3  # noqa: E731
    other.__qualname__ = follows.__qualname__
    assert teacher_name(follows) != teacher_name(other) and teacher_name(course_rule) == "rule"
    (run, _) = save_runs(again.result(), tmp_path / "runs")
    assert load_run(run).provenance["teacher"] == teacher_name(follows)


def test_who_is_ahead_is_measured_from_bumper_to_bumper():
    cars = roads(1, 3).cars[0]
    gap, speed = ahead(cars, 2)
    assert gap == pytest.approx(cars[TRAP_1, X] - cars[EGO, X] - 5) and speed == 10.0
    assert ahead(cars[:1], 2) == (math.inf, math.inf)


def test_toward_is_the_rule_s_own_tracker_and_refuses_a_lane_that_is_not_there():
    env = roads(50, 5)
    for _ in range(20):
        decisions = rule(env.cars, DEFAULT)
        each = zip(env.cars, decisions.speeds, decisions.lanes, strict=True)
        assert [toward(cars, speed, lane) for cars, speed, lane in each] == decisions.actions.tolist()
        env.step(decisions.actions)
    with pytest.raises(BootcourseError, match=r"lanes 0\.\.2"):
        toward(np.zeros((9, 10)), 10.0, 3)


# A rule that fails -----------------------------------------------------------------------------------


NO_ACTIONS = [
    *[(lambda cars, scenario, answer=answer: answer, "an action is a whole number from 0 to 8")
      for answer in (9, -1, 4.0, True, None, "keep straight", np.float64(4))],
    (all_roads(lambda cars, scenario: [4, 9]), "failed on road 1: it returned 9, but an action is a whole number from"),
    (all_roads(lambda cars, scenario: [4.0, 4.0]),
     r"failed in a call for all roads: it returned actions of shape \(2,\) and type float64"),
    (all_roads(lambda cars, scenario: [4]),
     r"it returned actions of shape \(1,\) and type int64, but 2 roads need a whole number each"),
    (all_roads(lambda cars, scenario: ["left", "left"]), "but 2 roads need a whole number each"),
]  # fmt: skip


@pytest.mark.parametrize(("rule", "sentence"), NO_ACTIONS)
def test_what_is_no_action_is_named(rule, sentence):
    with pytest.raises(RuleFailed, match=sentence):
        teacher_of(rule)(roads(2).cars)


FIRST = held_out_seeds(1, 4)[0]
FAILURES = {
    "drives": (lambda: evaluate(teacher_policy(after(4 * 12 + 2, no_lane)), 4), f"seed {FIRST + 2}, at decision 12"),
    "is recorded": (lambda: record(teacher_policy(after(3, no_lane)), [7]), "seed 7, at decision 3"),
    "demonstrates": (lambda: collect(2, teacher=after(2 * 6 + 1, no_lane)), f"seed {FIRST_SEED + 1}, at decision 5"),
    "labels": (lambda: demonstration_rows(record(idle_policy, [7]), after(9, no_lane)), "seed 7, at decision 9"),
}


@pytest.mark.parametrize("case", FAILURES)
def test_a_rule_that_fails_names_the_road_and_the_decision_while_it(case):
    act, where = FAILURES[case]
    with pytest.raises(RuleFailed, match=f"on the road with {where}: {RAISED}") as failed:
        act()
    assert type(failed.value.__cause__) is KeyError  # the rule's own exception, with its line
    assert str(copy.copy(failed.value)) == str(failed.value)  # rebuilt from what another process would send


@pytest.mark.parametrize(
    ("calls", "where"),
    [
        (0, "on road 0 of agent 0 in training, at decision 0"),
        (8 * 12 + 6, "on road 2 of agent 1 in training, at decision 12"),
        (8 * 151 + 5, "on road 1 of agent 1 in training, at an episode's end"),
    ],
)
def test_a_rule_that_fails_while_it_teaches_names_the_agent_and_its_road(calls, where, monkeypatch):
    two = with_seeds(settings_for("soft", hidden=(8,), buffer_size=2000), 2)
    monkeypatch.setattr(Training, "update", lambda training: None)
    monkeypatch.setattr(learn_training, "sample_actions", lambda policy, uniforms: np.full(uniforms.shape, IDLE))
    with pytest.raises(RuleFailed, match=f"failed {where}: {RAISED}"):
        Training(two, 20, teacher=after(calls, no_lane)).run(progress=False)


def test_a_rule_that_fails_when_a_training_is_resumed_does_not_call_the_checkpoint_damaged(tmp_path):
    broken = []

    def rule_that_breaks(cars, scenario):
        return no_lane() if broken else 4

    save_checkpoint(Training([settings_for("soft", **SMALL)], 12, teacher=rule_that_breaks), tmp_path / "c.npz")
    broken.append(True)
    with pytest.raises(RuleFailed, match=f"on road 0 of agent 0 in training, at decision 0: {RAISED}"):
        load_checkpoint(tmp_path / "c.npz", teacher=rule_that_breaks)


def test_an_interrupt_and_the_library_s_own_exceptions_pass_and_a_rule_that_writes_changes_no_road():
    def interrupted(cars, scenario):
        raise KeyboardInterrupt

    def spoils(cars, scenario):
        cars[:] = 0
        return 4

    with pytest.raises(KeyboardInterrupt):
        record(teacher_policy(interrupted), [7])
    with pytest.raises(IndexError):
        teacher_of(course_rule)(np.zeros((2, 0, 10)))
    env = roads(2)
    before = env.cars.copy()
    teacher_of(spoils)(env.cars)
    assert np.array_equal(before, env.cars) and "writes into `cars`" in repr(examine(spoils, 5))


# What it is used for ---------------------------------------------------------------------------------


def test_demonstrations_by_chance_follow_the_teacher_with_p_and_need_the_same_p_for_all():
    settings = settings_for("demos", rule_p=0.5, stochastic_demonstrations=True, **SMALL)
    training = Training([settings], 2, teacher=follows)
    actions = training.replay.table[: training.replay.demonstrations, 2 * 26]
    assert 0.4 < float((actions == 4).float().mean()) < 0.6
    with pytest.raises(BootcourseError, match="need the same rule_p"):
        Training([settings, replace(settings, rule_p=0.9)], 2)


@pytest.mark.parametrize(
    ("teacher", "sentence"),
    [
        (course_rule, "gets out on 100%"),
        (follows, "gets out on 0%; .* return 23.4"),
        (lambda cars, scenario: 7, "100% collision"),
        (lambda cars, scenario: 12, "whole number"),
        (lambda cars, scenario: 1 // 0, "ZeroDivisionError"),
        (lambda cars, scenario: int(np.random.default_rng().integers(9)), "differently each time"),
    ],
)
def test_an_exam_counts_and_never_raises(teacher, sentence):
    assert re.search(sentence, repr(examine(teacher, 20)))
