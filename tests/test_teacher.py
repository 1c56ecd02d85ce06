"""A teacher of your own: it drives, demonstrates and labels in place of the course's rule."""

import copy
import math
import re
from dataclasses import replace

import numpy as np
import pytest
import torch

from bootcourse.course.lessons.your_teacher import crashes, free_lane
from bootcourse.course.lessons.your_teacher.example_teachers import examine
from bootcourse.course.lessons.your_teacher.exercises import without_the_accident
from bootcourse.course.lessons.your_teacher.taught_agents import demonstrated
from bootcourse.episodes.record import record
from bootcourse.errors import BootcourseError, RuleFailed
from bootcourse.learn.settings import settings_for, with_seeds
from bootcourse.learn.teachers import (
    ahead,
    all_roads,
    course_rule,
    marked,
    slow,
    teacher_name,
    teacher_of,
    teacher_policy,
    toward,
    with_name,
)
from bootcourse.learn.training import Training
from bootcourse.road.state import EGO, LANE, TRAP_1, X
from bootcourse.road.vector_env import TrapVectorEnv
from bootcourse.rule import rule
from bootcourse.scenario import CALIBRATED, DEFAULT
from bootcourse.storage.checkpoint import load_checkpoint, save_checkpoint
from bootcourse.storage.runs import load_run, save_runs

SMALL = {"hidden": (8,), "buffer_size": 2000, "demonstration_episodes": 20}
TWO = with_seeds(settings_for("bootstrapped", **SMALL), 2)


def one_road(cars, scenario):
    """The course's rule, one road at a time."""
    return int(rule(cars[None], scenario).actions[0])


def follows(cars, scenario):
    return 4


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


PLACE = r"with the ego at x = 0.0 m, y = 8.0 m, 10.0 m/s"
NO_ACTIONS = [
    *[(lambda cars, scenario, answer=answer: answer, f"{PLACE}: it returned .* an action is a whole number from 0 to 8")
      for answer in (9, -1, 4.0, True, None, "keep straight", np.float64(4))],
    (all_roads(lambda cars, scenario: [4, 9]), f"failed {PLACE}: it returned 9, but an action is a whole number from"),
    (all_roads(lambda cars, scenario: [4.0, 4.0]),
     r"failed in a call for all roads: it returned actions of shape \(2,\) and type float64"),
    (all_roads(lambda cars, scenario: [4]),
     r"it returned actions of shape \(1,\) and type int64, but 2 roads need a whole number each"),
    (all_roads(lambda cars, scenario: {}["lane"]), "failed in a call for all roads: it raised KeyError: 'lane'."),
    (lambda cars, scenario: {}["lane"], f"failed {PLACE}: it raised KeyError: 'lane'."),
]  # fmt: skip


@pytest.mark.parametrize(("rule", "sentence"), NO_ACTIONS)
def test_a_rule_that_fails_is_named_with_the_state_in_which_it_did(rule, sentence):
    cars = roads(2).cars
    with pytest.raises(RuleFailed, match=sentence) as failed:
        teacher_of(rule)(cars)
    assert any(np.array_equal(failed.value.state, state) for state in (cars, *cars))
    assert str(copy.copy(failed.value)) == str(failed.value)  # rebuilt from what another process would send


def test_a_rule_that_fails_when_a_training_is_resumed_does_not_call_the_checkpoint_damaged(tmp_path):
    broken = []

    def rule_that_breaks(cars, scenario):
        return {}["lane"] if broken else 4

    save_checkpoint(Training([settings_for("soft", **SMALL)], 12, teacher=rule_that_breaks), tmp_path / "c.npz")
    broken.append(True)
    with pytest.raises(RuleFailed, match="raised KeyError: 'lane'"):
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


def test_a_mark_makes_another_rule_and_leaves_the_function_as_it_was():
    def follows(cars, scenario):
        return 4

    of_all = all_roads(follows)
    assert marked(of_all).answers_all_roads and not marked(follows).answers_all_roads
    assert teacher_of(follows)(roads(3).cars).tolist() == [4, 4, 4]
    with pytest.raises(BootcourseError, match="but 3 roads need a whole number each"):
        teacher_of(of_all)(roads(3).cars)
    both = slow(with_name(of_all, "follows the trap"))
    assert (both.answers_all_roads, both.is_slow, both(None, None)) == (True, True, 4)
    assert teacher_name(both).startswith("follows the trap ") and teacher_name(of_all) == teacher_name(follows)


def test_a_teacher_on_a_road_of_one_s_own_is_told_the_scenario_of_that_road():
    training = Training([settings_for("sac")], 1, make_env=lambda n: TrapVectorEnv(n, CALIBRATED))
    assert training.scenario == CALIBRATED and training.place.name == "Trap-v0"


def test_a_crashing_drive_is_cut_at_the_first_decision_that_finds_the_car_in_the_free_lane():
    kept = []
    for drive in crashes.crashed():
        n = crashes.before_free_lane(drive)
        lanes = [drive.cars[decision, EGO, LANE] for decision in range(len(drive.actions))]
        assert 0 not in lanes[:n] and (n == len(lanes) or lanes[n] == 0)
        kept.append(n)
    assert 0 < sum(kept) < sum(len(drive.actions) for drive in crashes.crashed())
    whole, cut = crashes.rows_of_crashes("all"), crashes.rows_of_crashes("cut")
    assert len(cut) == sum(kept)
    first = crashes.crashed()[0]
    assert torch.equal(cut[: kept[0]], whole[: kept[0]])
    assert torch.equal(cut[kept[0]], whole[len(first.actions)])  # the second drive begins there


def test_the_control_takes_away_as_many_decisions_as_the_cut_and_none_in_the_free_lane():
    cut, control = crashes.is_kept("cut"), crashes.is_kept("as-many")
    assert cut.sum() == control.sum() == len(crashes.rows_of_crashes("as-many")) and (cut | control).all()


def test_the_free_lane_and_its_accidents_are_parted_and_together_they_are_all():
    whole, cut = crashes.is_kept("all"), crashes.is_kept("cut")
    lane, accident = map(crashes.marked, (without_the_accident, crashes.without_the_lane))
    in_lane_0 = [drive for drive in crashes.crashed() if crashes.before_free_lane(drive) < len(drive.actions)]
    assert (lane | accident | cut).all() and whole.sum() - lane.sum() == accident.sum() - cut.sum() == len(in_lane_0)


def test_what_is_shown_of_a_teacher_is_counted_in_the_drives_that_teach():
    drives = demonstrated("random-50")
    lanes = [drive.cars[: len(drive.actions), EGO, LANE] for drive in drives]
    reach, crashed = free_lane.shown("random-50")
    assert reach == np.mean([(each == 0).any() for each in lanes])
    assert crashed == np.mean([drive.accident > 0 for drive in drives])


def test_agents_learn_from_drives_that_crash_without_their_part_in_the_free_lane():
    assert set(crashes.cells(1, 3, 2)) == set(crashes.KINDS)
    result = crashes.from_crashes(**crashes.cells(1, 3, 2)["cut"])
    assert result.scores("returns").shape == (1,) and result.curves["success"].shape == (1, 3)
