"""The leaderboard: its numbers by hand, what stands on it, and what a user enters."""

from dataclasses import replace

import numpy as np
import pytest

import bootcourse as bc
from bootcourse.course import board as module
from bootcourse.course.board import Row, driven, entered, ranked, read_rows, row_of, shipped_rows, study_rows
from bootcourse.errors import BootcourseError
from bootcourse.research.beyond import Within
from bootcourse.research.results import Results, StudyResults, in_assets
from bootcourse.scenario import DEFAULT, Sight
from bootcourse.statistics import Estimate
from bootcourse.storage.assets import FOLDER
from tests.hostile.payloads import PAYLOAD

IDLE_EARNS = 23.4375  # on every road


def results(method: str, returns, success, accident, seconds=None, **curves) -> Results:
    """Agents that were never trained: each score and curve (agents, episodes) is given."""
    agents = [{"method": method, "seed": seed} for seed in range(len(returns))]
    tested = {"returns": np.array(returns), "success": np.array(success), "accident": np.array(accident)}
    curves = {name: np.array(values) for name, values in curves.items()}
    return Results(agents, np.full(len(returns), -1), tested, curves, seconds)


def row(method: str, returns: float, **more) -> Row:
    return Row(method, more.pop("setting", "quick"), 1, Estimate(returns, returns, returns), **more)


def alone(cars, scenario):
    """A rule that does nothing."""
    return 4


@pytest.fixture
def few_roads(monkeypatch):
    """Every driver drives 5 roads, and the rows that ship are not driven at all."""
    monkeypatch.setattr(module, "ROADS", bc.held_out_seeds(1, 5))
    monkeypatch.setattr(module, "shipped_rows", lambda: (row("the rule", 51.0), row("a wreck", -10.0)))


def test_a_row_is_what_one_computes_by_hand():
    four = results(
        "sac",
        returns=[[5, 15], [20, 20], [30, 30], [50, 30]],  # means 10, 20, 30, 40: without the ends 25
        success=[[1, 1], [1, 1], [0, 1], [0, 0]],
        accident=[[0, 0], [0, 3], [1, 2], [0, 0]],
        seconds=np.array([10.0, 20, 30, 40]),
        decisions=[[150, 150], [100, 100], [150, 50], [50, np.nan]],
    )
    found = row_of(four, "sac", "quick", **module.costs(four))
    assert (found.method, found.agents, found.escapers) == ("plain SAC", 4, 2)
    assert (found.success, found.accidents) == (5 / 8, 3 / 8)
    assert found.returns.value == 25 and 10 <= found.returns.low < 25 < found.returns.high <= 40
    assert (found.decisions, found.seconds) == ((300 + 200 + 200 + 50) / 4, 25)
    cells = replace_interval(found).cells(best=100)
    assert cells == ["plain SAC", "quick", "2 of 4", "62.5", "25 [12, 38]", "25", "37.5", "188", "25", "–", "–"]


def replace_interval(found: Row) -> Row:
    return module.changed(found, returns=Estimate(25.0, 12.0, 38.0))


def test_a_single_driver_has_the_interval_of_its_roads_and_no_cost():
    found = row_of(results("rule", [[1.0, 2.0, 3.0]], [[1, 1, 1]], [[0, 0, 0]]), "rule", "not trained")
    assert found.returns.high - 2 == pytest.approx(4.302653 / np.sqrt(3), abs=1e-5)  # Student's t with 2 degrees
    assert found.cells(4)[2:] == ["1 of 1", "100.0", "2.0 [-0.5, 4.5]", "50", "0.0", "–", "–", "–", "–"]


def test_without_lengths_of_episodes_the_decisions_are_distance_over_speed():
    found = results("sac", [[1.0, 1.0]], [[0, 0]], [[0, 0]], distance=[[1500, 600]], speed=[[10, 12]])
    nothing = {"at_decisions": None, "at_seconds": None}
    assert module.costs(found) == {"decisions": 200, "seconds": None} | nothing


@pytest.mark.parametrize("decisions, words", [(12, "12"), (999, "999"), (1499, "1,000"), (1_603_400, "1,603,000")])
def test_decisions_are_rounded_to_thousands_from_a_thousand_on(decisions, words):
    assert row("sac", 1.0, decisions=decisions).cells(1.0)[7] == words


def test_a_row_says_what_was_earned_at_an_equal_budget_and_by_how_many_agents():
    long, short = np.full(150, 1000.0), np.full(150, 600.0)  # 150,000 and 90,000 decisions
    earned = np.arange(150.0)  # the 100,000th decision ends episode 99: 50 to 99 are the last 50
    two = results(
        "sac", [[1.0]] * 2, [[0]] * 2, [[0]] * 2, np.array([30.0, 40.0]),
        decisions=np.stack([long, short]), **{"return": np.stack([earned, earned])},
    )  # fmt: skip
    found = row_of(two, "sac", "quick", **module.costs(two))
    assert found.at_decisions == (1, 74.5, None)
    assert found.at_seconds.returns == pytest.approx(((50 + 99) / 2 + (25 + 74) / 2) / 2)  # 100 and 75 episodes
    assert replace_interval(found).cells(100)[-2:] == ["74.50, 1 of 2", "62"]


def test_the_highest_return_stands_first_and_equal_ones_by_name():
    rows = [row("b", 1.0), row("c", 2.0), row("a", 1.0, setting="y"), row("a", 1.0, setting="x")]
    assert [(r.method, r.setting) for r in ranked(rows, 1.0).rows] == [
        ("c", "quick"), ("a", "x"), ("a", "y"), ("b", "quick")
    ]  # fmt: skip


def test_a_row_of_one_s_own_stands_in_its_place_and_is_marked_in_every_form():
    drawn = ranked([row("first", 3.0), row("third", 1.0), row("mine", 2.0, own=True)], 4.0)
    lines = repr(drawn).splitlines()
    assert [line.split()[:2] for line in lines[1:4]] == [["first", "quick"], [">", "mine"], ["third", "quick"]]
    assert "> yours" in lines
    assert drawn._repr_html_().count("<td><strong>mine</strong> (yours)</td>") == 1
    assert "yours" not in repr(ranked([row("first", 3.0)], 4.0))


def test_a_name_from_somebody_else_s_file_is_only_text():
    nasty = row(PAYLOAD, 1.0, setting=f"\x1b[2J\n{PAYLOAD}|", own=True)
    drawn = ranked([nasty], 1.0)
    page = drawn._repr_html_()
    assert "<img" not in page and "<script" not in page and "&lt;img src=" in page
    assert "\x1b" not in repr(drawn) and repr(drawn).splitlines()[1].startswith("> ")


def test_the_board_takes_dagger_and_every_experiment_on_its_road_that_does_not_vary_the_paper_s_method():
    one = results("sac", [[1.0, 1.0]], [[0, 0]], [[0, 0]])
    found = StudyResults(
        {"default": one, "calibrated": one, "paper": one},
        experiments={
            "longer-view": {"γ = 0.95": one}, "sensitivity": {"γ = 0.9": one}, "clocks": {},
            "beyond": {"ppo": one, "rlpd": one}, "teachers": {"rule, dagger": one, "late, dagger": one},
        },
    )  # fmt: skip
    settings = ["quick", "paper", "longer-view: γ = 0.95", "beyond", "beyond", "teachers, 2 roads"]
    assert [row.setting for row in study_rows(found)] == settings


def test_everything_that_ships_has_its_row(monkeypatch):
    monkeypatch.setattr(module, "ROADS", bc.held_out_seeds(1, 5))
    shipped = shipped_rows.__wrapped__()
    rows = {(row.method, row.setting): row for row in shipped}
    assert len(rows) == len(shipped), "two rows have the same name"
    ships = in_assets(FOLDER)
    for method in ships.results["default"].methods:
        its = rows[bc.display_name(method), "quick"]
        assert its.escapers == ships.results["default"].escapers(method)
        assert its.decisions > 100_000 and its.seconds > 10
    for method in ships.results["paper"].methods:
        assert rows[bc.display_name(method), "paper"].agents == 10
    for method in ("ibrl", "ppo_cloned"):
        its = rows[bc.display_name(method), "beyond"]
        assert its.at_decisions.agents == its.at_seconds.agents == 10
    assert rows["RLPD", "beyond"].decisions < 100_000 and rows["RLPD", "beyond"].at_decisions is None
    assert rows["DAgger", "teachers, 200 roads"].decisions > 1000
    assert rows["planner", "best drives found"].returns.value == pytest.approx(ships.bound["default"].mean())
    assert rows["PPO after cloning", "lesson 15"].decisions == pytest.approx(300_000, rel=0.01)
    assert {method for method, setting in rows if setting == "lesson 15"} == {
        "PPO", "PPO after cloning", "PPO, shaping reward", "PPO, concave reward"
    }  # fmt: skip
    assert rows["idle driver", "not trained"].returns.value == pytest.approx(IDLE_EARNS)
    assert {"rule controller", "random driver"} <= {method for method, _ in rows}


def test_the_decisions_of_the_default_study_are_those_of_its_runs_within_a_hundredth():
    ships = in_assets(FOLDER).results["default"]
    for method in ("soft", "margin"):
        exact = [np.nansum(bc.load_run(FOLDER / "runs" / f"{method}-{i}").curves["decisions"]) for i in range(5)]
        assert module.costs(ships.of(method).pick(range(5)))["decisions"] == pytest.approx(np.mean(exact), rel=0.01)


def test_a_rule_of_one_s_own_is_driven_and_ranked(few_roads):
    drawn = bc.board(alone)
    assert [row.method for row in drawn.rows] == ["the rule", "alone", "a wreck"]
    mine = drawn.rows[1]
    assert mine.own and mine.setting == "your rule" and mine.returns.value == pytest.approx(IDLE_EARNS)
    assert mine.cells(drawn.best)[5] == "17"  # per cent of the planner's 140.6
    assert np.array_equal(
        driven("idle", [bc.idle_policy]).scores("returns"), driven("rule", [bc.idle_policy]).scores("returns")
    )


@pytest.fixture(scope="module")
def training():
    return bc.Training(bc.with_seeds(bc.settings_for("sac"), 2), 2).run(progress=False)


def test_agents_that_differ_in_their_seed_share_a_row_and_others_do_not(few_roads, training, tmp_path):
    (together,) = entered(training)
    assert (together.method, together.setting, together.agents) == ("plain SAC", "this training", 2)
    assert together.decisions == pytest.approx(training.curves["decisions"].sum(axis=1).mean())
    assert together.seconds == pytest.approx(training.seconds / 2)
    bc.save_runs(training, tmp_path)
    (stored,) = entered(tmp_path)
    assert (stored.setting, stored.returns, stored.decisions) == (str(tmp_path), together.returns, together.decisions)
    other = bc.Training([bc.settings_for("sac", gamma=0.9, seed=7)], 1, teacher=alone).run(progress=False)
    bc.save_runs(other, tmp_path)
    settings = [row.setting for row in entered(str(tmp_path))]
    assert settings == [f"{tmp_path}/sac-0 ...", f"{tmp_path}/sac-7 ..., taught by alone"]


def test_agents_that_see_another_number_of_cars_are_refused(few_roads, tmp_path):
    narrow = replace(DEFAULT, sight=replace(DEFAULT.sight, neighbours=2))
    bc.save_runs(bc.Training([bc.settings_for("bc")], 1, narrow).run(progress=False), tmp_path)
    with pytest.raises(BootcourseError, match="bc-0 sees 16 numbers, and the board's road shows 26"):
        bc.board(tmp_path)


def test_agents_that_drive_with_a_teacher_of_one_s_own_are_entered_with_it(few_roads, tmp_path):
    bc.save_runs(bc.Training([bc.settings_for("ibrl")], 1, teacher=alone).run(progress=False), tmp_path)
    with pytest.raises(BootcourseError, match="give the same teacher"):
        bc.board(tmp_path)
    (mine,) = [row for row in bc.board(tmp_path, teacher=alone).rows if row.own]
    assert mine.setting == f"{tmp_path}, taught by alone"


@pytest.mark.parametrize("entry", [3, None, ["runs"], Sight, {}])
def test_what_does_not_drive_is_refused_in_a_sentence(entry):
    with pytest.raises(BootcourseError, match="cannot be entered: give a folder of runs"):
        entered(entry)


def test_rows_are_kept_in_a_file_and_shown_with_later_ones(few_roads, tmp_path):
    path = tmp_path / "mine.json"
    first = bc.board(alone, keep=path)

    def left(cars, scenario):
        return 3

    both = bc.board(left, keep=path)
    assert {row.method for row in both.rows if row.own} == {"alone", "left"}
    assert bc.board(path).rows == both.rows and set(first.rows) < set(both.rows)
    assert len(bc.board(alone, keep=path).rows) == len(both.rows), "a row is replaced by its newer self"


def test_a_kept_row_keeps_what_was_earned_at_an_equal_budget(tmp_path):
    first = row("a", 1.0, at_decisions=Within(1, 70.0, None), at_seconds=Within(1, 60.0, None), own=True)
    module.keep_rows(tmp_path / "mine.json", [], [first])
    assert read_rows(tmp_path / "mine.json") == [first]


@pytest.mark.parametrize("its", [Within(2, 1.0, (0.0, 2.0)), Within(1, 1e9, None), Within(1, 1.0, (2.0, 0.0))])
def test_a_row_whose_numbers_at_an_equal_budget_contradict_each_other_is_refused(its):
    with pytest.raises(ValueError, match="the numbers of 'a' contradict each other"):
        row("a", 1.0, at_decisions=its)


def test_what_was_earned_on_another_road_is_not_shown_at_an_equal_budget(few_roads):
    trained = bc.Training([bc.settings_for("bc")], 1, replace(DEFAULT, name="mine")).run(progress=False)
    curves = {"decisions": np.full((1, 120), 1000.0), "return": np.ones((1, 120))}
    (there,), (here,) = (
        module.agents_rows([module.Entrant("bc-0", trained.agents[0], scenario, "rule", curves, 30.0)], "mine")
        for scenario in (trained.scenario, DEFAULT)
    )
    assert there.at_decisions is None and there.at_seconds is None and there.decisions == 120_000
    assert here.at_decisions == here.at_seconds == (1, 1.0, None)


def test_a_file_that_is_not_a_board_s_is_refused_and_stays(few_roads, tmp_path):
    for name, sentence in {"mine.txt": "does not end in .json", "mine.json": "is damaged"}.items():
        path = tmp_path / name
        path.write_text("mine")
        with pytest.raises(BootcourseError, match=sentence):
            bc.board(alone, keep=path)
        assert path.read_text() == "mine"
    with pytest.raises(BootcourseError, match="other.json is not there"):
        read_rows(tmp_path / "other.json")


def test_the_command_of_the_readme_prints_the_board_with_the_run(bootcourse, training, few_roads, tmp_path):
    readme = (FOLDER.parent / "README.md").read_text(encoding="utf-8")
    assert "bootcourse evaluate runs/mine --board" in readme
    bc.save_runs(training, tmp_path / "runs" / "mine")
    answer = bootcourse("evaluate", tmp_path / "runs" / "mine", "rule", "--board", "--keep", tmp_path / "kept.json")
    assert answer.status == 0, answer.err
    (marked,) = [line for line in answer.out.splitlines() if line.startswith("> plain SAC")]
    assert "2 of 2" in marked or "0 of 2" in marked
    again = bootcourse("evaluate", tmp_path / "kept.json", "--board")
    assert marked in again.out


REFUSED = {
    "a mistyped driver": (["rul", "--board"], "did you mean 'rule'"),
    "other roads": (["rule", "--board", "--seed", 3], "--board has its own roads"),
    "several drivers without a board": (["rule", "idle"], "Several drivers need --board."),
    "a file without a board": (["rule", "--keep", "mine.json"], "--keep needs --board."),
    "a file of another kind": (["rule", "--board", "--keep", "mine.txt"], "does not end in .json"),
}


@pytest.mark.parametrize("case", REFUSED)
def test_bad_input_gets_one_sentence_and_status_2(case, bootcourse, few_roads):
    arguments, sentence = REFUSED[case]
    answer = bootcourse("evaluate", *arguments)
    assert answer.status == 2 and sentence in answer.err and len(answer.err.splitlines()) == 1, answer.err
