"""The students of the look-ahead: their labels, and the table of what they do."""

import numpy as np
import pytest

import bootcourse as bc
from bootcourse.episodes.lookahead import nine_drives
from bootcourse.research.computed import experiment
from bootcourse.research.experiments import distil
from bootcourse.research.experiments.distil import learned_rows
from bootcourse.research.experiments.lookahead import shipped_actors

TINY = {"DRIVES": 3, "ROUNDS": 2, "UPDATES": 2, "AGENTS": 1, "ROADS": 2}


@pytest.fixture(scope="module")
def base():
    return shipped_actors(distil.BASE)[0]


def test_the_labels_are_the_best_actions_and_the_shield_s_differ_only_before_an_accident(base):
    reckless = bc.record(bc.plan_policy([("accelerate straight", 30)]), bc.held_out_seeds(1, 4))  # into trap 1
    cars = np.concatenate([drive.cars for drive in reckless])
    states, best, below, differs = distil.labelled(cars, base, "actions")
    nine = nine_drives(cars, base.as_policy())
    own = base.probabilities(states).argmax(-1)
    assert np.array_equal(best, nine.values.argmax(1)) and np.array_equal(differs, best != own)
    assert below.max(axis=1).tolist() == [0.0] * len(cars) and below.min() == distil.WORST
    saved = distil.labelled(cars, base, "shield")[1]
    endangered = nine.accidents[np.arange(len(own)), own] > 0
    assert endangered.any() and np.array_equal(saved, np.where(endangered, best, own))


@pytest.mark.parametrize("name", distil.TRIES)
def test_a_student_learns_drives_alone_and_leaves_its_base_as_it_was(name, base, monkeypatch):
    for constant, value in TINY.items():
        monkeypatch.setattr(distil, constant, value)
    before = [layer.clone() for layer in base.actor]
    measured = distil.distilled(**distil.TRIES[name]).measured
    assert measured["roads"].tolist() == [2] and 0 <= measured["accidents"][0] <= 2
    assert all((one == other).all() for one, other in zip(before, base.actor, strict=True))


def test_the_table_sets_the_students_below_the_agents_that_they_were():
    tried, cells = experiment("distil"), experiment("look-ahead")
    headings, lines = learned_rows(tried, cells)
    assert len(lines) == 1 + len(tried) == 1 + len(distil.TRIES)
    assert lines[0][0].startswith("nothing") and {len(line) for line in lines} == {len(headings)}
    assert len(learned_rows(tried, {})[1]) == len(tried)
