"""What learners cost: decisions until the way out is learned, and returns at an equal budget, by hand."""

import numpy as np
import pytest

from bootcourse.research import beyond
from bootcourse.research.beyond import at_budget, decisions_until, learner_rows, lengths
from bootcourse.research.results import Results

NAN = np.nan
SUCCESS = np.array([[0, 1, 1, 0, 1, 1], [1, 1, 0, 0, 0, 0], [0, 1, 0, 1, 0, 0], [1, 1, NAN, NAN, NAN, NAN]])
DECISIONS = np.array([[5, 10, 20, 40, 80, 160], [1, 2, 3, 4, 5, 6], [1] * 6, [7, 8, NAN, NAN, NAN, NAN]])


@pytest.mark.parametrize(
    ("share", "window", "expected"),
    [(1.0, 2, [35, 3, np.inf, 15]), (0.5, 2, [15, 3, 2, 15]), (0.5, 7, [np.inf] * 4), (0.5, 3, [35, 6, 4, np.inf])],
)
def test_the_decisions_are_counted_up_to_the_first_window_with_enough_successes(share, window, expected):
    assert decisions_until(SUCCESS, DECISIONS, share, window).tolist() == expected


def test_a_length_is_recorded_or_follows_from_distance_and_speed_or_is_not_known():
    assert lengths({"decisions": np.ones((1, 2))}).tolist() == [[1, 1]]
    assert lengths({"distance": np.array([[300.0]]), "speed": np.array([[10.0]])}).tolist() == [[30]]
    assert lengths({"success": np.ones((1, 2))}) is None


def test_the_table_counts_agents_and_says_how_many_learned_the_way_out():
    tested = {"success": np.array([[1.0, 1.0], [0.0, 0.0]]), "returns": np.array([[100.0, 110.0], [20.0, 20.0]])}
    tested["accident"] = np.array([[0, 3], [0, 0]])
    curves = {"success": np.stack([np.ones(60), np.zeros(60)]), "decisions": np.full((2, 60), 100.0)}
    agents = [{"method": "rlpd", "seed": seed} for seed in (0, 1)]
    headings, rows = learner_rows({"RLPD": Results(agents, np.full(2, -1), tested, curves)})
    assert len(headings) == len(rows[0]) and rows[0][:3] == ["RLPD", "1 of 2", "50.0"]
    assert rows[0][4:] == ["25.0", "5 (5 to 5), 1 of 2"]


LEARNING = {
    "decisions": np.array([[10, 20, 30, 40], [10, 10, 10, NAN], [60, 40, 40, 40]]),  # ended at 10, 30, 60, 100 ...
    "return": np.array([[1, 3, 5, 7], [2, 4, 6, NAN], [8, 8, 8, 8.0]]),
}


@pytest.mark.parametrize(
    ("budget", "expected"),
    [(60, [4, NAN, NAN]), (59, [2, NAN, NAN]), (30, [2, 5, NAN]), ([100, 29, 100], [6, 3, 8]), (101, [NAN, NAN, 8])],
)
def test_the_return_at_a_budget_is_the_mean_of_the_last_episodes_that_ended_within_it(budget, expected, monkeypatch):
    monkeypatch.setattr(beyond, "WINDOW", 2)
    np.testing.assert_array_equal(at_budget(LEARNING, np.array(budget)), expected)
    assert np.isnan(at_budget({"decisions": LEARNING["decisions"]}, np.array(budget))).all()
    ahead = {"decisions": LEARNING["decisions"], "success": LEARNING["return"]}
    np.testing.assert_array_equal(at_budget(ahead, np.array(budget), "success"), expected)
