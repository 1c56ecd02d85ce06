"""The leaderboard: its numbers by hand, what stands on it, and what a user enters."""

import numpy as np
import pytest

import bootcourse as bc
from bootcourse.course import board as module
from bootcourse.course.board import Board, Row, own_rows, row_of
from bootcourse.course.gap_rule import gap_rule
from bootcourse.episodes.evaluate import Episodes
from bootcourse.errors import BootcourseError
from bootcourse.learn.teachers import course_rule
from bootcourse.scenario import DEFAULT
from bootcourse.statistics import Estimate

IDLE_EARNS = 23.4375  # on every road


def drives(returns, success, accident) -> Episodes:
    nothing = np.zeros(len(returns))
    return Episodes(np.array(success), np.array(returns), nothing, nothing, np.array(accident))


def alone(cars, scenario):
    """A rule that does nothing."""
    return 4


@pytest.fixture
def few_roads(monkeypatch):
    """Every driver drives 5 roads, and the rows that ship are not driven at all."""
    ships = [Row(name, Estimate(value, value, value)) for name, value in (("the rule", 51.0), ("a wreck", -10.0))]
    monkeypatch.setattr(module, "ROADS", bc.held_out_seeds(1, 5))
    monkeypatch.setattr(module, "shipped_rows", lambda: tuple(ships))


@pytest.fixture(scope="module")
def training():
    return bc.Training(bc.with_seeds(bc.settings_for("sac"), 2), 2).run(progress=False)


def test_a_row_is_what_one_computes_by_hand():
    agents = [  # their mean returns are 10, 20, 30 and 40: without the ends 25
        drives([5.0, 15.0], [1, 1], [0, 0]),
        drives([20.0, 20.0], [1, 1], [0, 3]),
        drives([30.0, 30.0], [0, 1], [1, 2]),
        drives([50.0, 30.0], [0, 0], [0, 0]),
    ]
    row = row_of("plain SAC", agents)
    assert (row.returns.value, row.success.value, row.accidents.value) == (25, 5 / 8, 3 / 8)
    assert 10 <= row.returns.low < 25 < row.returns.high <= 40


def test_one_driver_has_the_intervals_of_its_roads():
    row = row_of("rule", [drives([1.0, 2.0, 3.0], [1, 1, 1], [0, 0, 0])])
    assert row.returns.high - 2 == pytest.approx(4.302653 / np.sqrt(3), abs=1e-5)  # Student's t with 2 degrees
    assert row.cells == ["rule", "2.0 [-0.5, 4.5]", "100 [29, 100]", "0 [0, 71]"]  # Clopper-Pearson


def test_the_highest_return_stands_first_and_one_s_own_rule_and_policy_are_marked(few_roads):
    table = bc.board(alone, mine=bc.plan_policy([("accelerate left", 60)]))
    assert [row.method for row in table.rows if row.method != "mine"] == ["the rule", "alone", "a wreck"]
    assert next(row for row in table.rows if row.method == "alone").returns.value == pytest.approx(IDLE_EARNS)
    marked = [line.split()[1] for line in repr(table).splitlines() if line.startswith("> ")]
    assert sorted(marked) == ["alone", "mine"]
    assert "<td><strong>alone</strong> (yours)</td>" in table._repr_html_()


def test_the_table_is_narrow_whatever_stands_in_it():
    all_of_them = Estimate(1.0, 1.0, 1.0)
    text = repr(Board((Row("m" * 99, Estimate(140.0, 139.0, 141.0), all_of_them, all_of_them),)))
    assert max(map(len, text.splitlines())) <= 100 and len(text.split("\n\n")[1].splitlines()) <= 3


def test_every_method_of_the_study_and_other_ways_has_its_row(monkeypatch):
    monkeypatch.setattr(module, "ROADS", bc.held_out_seeds(1, 5))
    rows = {row.method: row for row in module.shipped_rows.__wrapped__()}
    assert {"planner", "rule controller", "random driver", "bootstrapped SAC", "CQL", "IBRL"} <= rows.keys()
    assert rows["idle driver"].returns.value == pytest.approx(IDLE_EARNS) and rows["planner"].success is None


def test_on_the_roads_of_another_block_stand_one_s_own_drivers_and_those_that_are_not_trained(few_roads):
    rows = {row.method: row for row in bc.board(block=7, rule_again=bc.rule_policy(DEFAULT)).rows}
    names = {"rule controller", "idle driver", "random driver", "gap acceptance (rule)", "rule_again"}
    assert rows.keys() == names and rows["rule_again"].returns == rows["rule controller"].returns
    driven = bc.drive_episodes(bc.rule_policy(DEFAULT), bc.held_out_seeds(7, 5))
    assert rows["rule controller"].returns.value == driven.returns.mean()
    with pytest.raises(BootcourseError, match="block = -1"):
        bc.board(block=-1)


def test_agents_that_differ_in_their_seed_share_a_row_and_others_do_not(few_roads, training, tmp_path):
    (together,) = own_rows(training, course_rule, module.ROADS)
    bc.save_runs(training, tmp_path)
    (stored,) = own_rows(tmp_path, course_rule, module.ROADS)
    assert stored.returns == together.returns
    bc.save_runs(bc.Training([bc.settings_for("sac", gamma=0.9, seed=7)], 1).run(progress=False), tmp_path)
    assert [row.method for row in own_rows(str(tmp_path), course_rule, module.ROADS)] == [f"plain SAC, {tmp_path}"] * 2


def test_agents_that_drive_with_a_teacher_of_one_s_own_are_entered_with_it(few_roads, tmp_path):
    bc.save_runs(bc.Training([bc.settings_for("ibrl")], 1, teacher=alone).run(progress=False), tmp_path)
    with pytest.raises(BootcourseError, match="give the same teacher"):
        bc.board(tmp_path)
    assert [row.own for row in bc.board(tmp_path, teacher=alone).rows].count(True) == 1


@pytest.mark.parametrize("entry", [3, None, ["runs"], DEFAULT, {}])
def test_what_does_not_drive_is_refused_in_a_sentence(entry, few_roads):
    with pytest.raises(BootcourseError, match="cannot be entered: give a folder of runs"):
        bc.board(entry)


def test_the_rule_with_gap_acceptance_drives_without_an_accident_on_roads_that_nobody_chose_it_on():
    drive = bc.teacher_policy(gap_rule)
    each = bc.drive_episodes(drive, bc.held_out_seeds(22, 100), DEFAULT)
    assert each.success.all() and not each.accident.any() and each.returns.mean() > 120
