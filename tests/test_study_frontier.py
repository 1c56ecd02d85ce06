"""Fast and safe: which kinds of agents no other beats, and the figure that shows it, from invented results."""

import numpy as np
import pytest

from bootcourse.research.frontier import frontier, safe_and_fast, scored
from bootcourse.research.plan import EXPERIMENTS
from bootcourse.research.report import safe_part
from bootcourse.research.results import Results, StudyResults
from tests.test_figures import overlaps, words_of


def agents(accidents, returns) -> Results:
    """Agents with these shares of accidents, of different kinds, and these returns, in 200 drives each."""
    happened = np.arange(200) < 200 * np.array(accidents)[:, None]
    kinds = happened * (1 + np.arange(200) % 3)
    tested = {"accident": kinds, "returns": np.repeat(np.array(returns, dtype=float)[:, None], 200, axis=1)}
    tested["success"] = np.ones_like(kinds)
    settings = [{"method": "ppo_safe", "seed": seed} for seed in range(len(accidents))]
    curves = {"success": np.ones((len(settings), 60)), "decisions": np.full((len(settings), 60), 100.0)}
    return Results(settings, np.full(len(settings), -1), tested, curves)


VARIED = {
    "plain": agents([0.01, 0.02, 0.03], [134.0, 135.0, 136.0]),
    "slow": agents([0.0, 0.0, 0.01], [120.0, 121.0, 122.0]),
    "worse": agents([0.02, 0.03, 0.03], [130.0, 131.0, 132.0]),
    "best": agents([0.0, 0.0, 0.0], [133.0, 134.0, 135.0]),
}


def test_all_agents_and_all_kinds_of_accidents_count():
    accidents, returns = scored(VARIED["plain"])
    assert accidents.value == pytest.approx(2.0) and 1.0 <= accidents.low < 2.0 < accidents.high <= 3.0
    assert returns.value == pytest.approx(135.0) and returns.low < 135 < returns.high


def test_the_frontier_is_what_nothing_beats_in_both_from_safest_to_fastest():
    assert frontier(VARIED) == ["best", "plain"]
    assert frontier({"one": VARIED["plain"], "other": VARIED["plain"]}) == ["one", "other"]


def test_the_figure_says_what_the_frontier_is_and_names_everyone_in_its_words():
    figure = safe_and_fast(VARIED, bound=140.6)
    assert figure.alt.startswith("The 2 filled dots are the frontier")
    assert all(f"{name} (3 agents)" in figure.alt for name in VARIED) and "140.6" in figure.alt
    assert "On the frontier: best, plain." in figure.alt
    alone = safe_and_fast({name: VARIED[name] for name in ("plain", "worse")}, bound=140.6)
    assert alone.alt.startswith("Nothing here is both safer and faster than plain.")
    assert {*VARIED, "planner 140.6"} <= set(words_of(figure)) and overlaps(figure) == []


def test_the_report_has_it_once_the_experiment_and_the_planner_s_bound_are_there(tmp_path):
    found = StudyResults({}, {"default": np.array([140.0, 141.0])}, {}, {"safe": VARIED})
    text = "\n".join(safe_part(found, tmp_path))
    assert "140.5" in text and "| slow |" in text and (tmp_path / "figures" / "safe.png").exists()
    assert safe_part(StudyResults({}, {}, {}, {"safe": VARIED}), tmp_path) == []
    assert safe_part(StudyResults({}, {"default": np.array([140.0])}, {}, {"safe": {}}), tmp_path) == []


def test_a_variation_switches_on_what_it_is_named_for():
    changes = {name: its.changes for name, its in EXPERIMENTS["safe"].variations.items()}
    plain = {"accident_cost": 0.0, "multiplier_step": 0.0, "risk_limit": 1.0, "shield": False, "restart_share": 0.0,
             "value_quantiles": 1}  # fmt: skip
    alone = {"accident cost": "accident_cost", "multiplier": "multiplier_step", "learned mask": "risk_limit",
             "shield by hand": "shield", "restarts": "restart_share",
             "distributional critic": "value_quantiles"}  # fmt: skip
    for name, setting in alone.items():
        assert {key for key in plain if changes[name][key] != plain[key]} == {setting}
    remembers = EXPERIMENTS["safe"].variations["memory"]
    assert remembers.changes == plain and remembers.scenario.sight.memory == 3
