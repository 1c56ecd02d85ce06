"""What the later learners cost: decisions until the way out is learned, by hand."""

import numpy as np

from bootcourse.study.beyond import decisions_until, learner_rows, lengths, thousands
from bootcourse.study.results import Results

NAN = np.nan


def test_the_decisions_are_counted_up_to_the_first_window_with_enough_successes():
    success = np.array([[0, 1, 1, 0, 1, 1], [1, 1, 0, 0, 0, 0], [0, 1, 0, 1, 0, 0]])
    decisions = np.array([[5, 10, 20, 40, 80, 160], [1, 2, 3, 4, 5, 6], [1, 1, 1, 1, 1, 1]])
    assert decisions_until(success, decisions, share=1.0, window=2).tolist() == [35, 3, np.inf]
    assert decisions_until(success, decisions, share=0.5, window=2).tolist() == [15, 3, 2]


def test_episodes_that_were_not_driven_are_no_successes():
    success, decisions = np.array([[1, 1, NAN, NAN], [NAN, NAN, NAN, NAN]]), np.array([[7, 8, NAN, NAN], 4 * [NAN]])
    assert decisions_until(success, decisions, share=0.5, window=3).tolist() == [np.inf, np.inf]
    assert decisions_until(success, decisions, share=1.0, window=2).tolist() == [15, np.inf]
    assert decisions_until(success, decisions, share=0.5, window=5).tolist() == [np.inf, np.inf]


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
    assert thousands(np.array([np.inf, np.inf])) == "none of 2"
