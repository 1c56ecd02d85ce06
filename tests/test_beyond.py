"""What learners cost: decisions until the way out is learned, and returns at an equal budget, by hand."""

from dataclasses import replace

import numpy as np
import pytest

from bootcourse.course.shipped import shipped_experiment
from bootcourse.episodes.evaluate import held_out_seeds
from bootcourse.learn.settings import settings_for, with_seeds
from bootcourse.research import beyond, equal_decisions
from bootcourse.research.beyond import at_budget, decisions_until, learner_rows
from bootcourse.research.equal_decisions import (
    BUDGETS,
    CHOSEN,
    budget_rows,
    by_method,
    seconds_rows,
    trained_and_tested,
    tried,
)
from bootcourse.research.results import Results, agent_entries

NAN = np.nan
SUCCESS = np.array([[0, 1, 1, 0, 1, 1], [1, 1, 0, 0, 0, 0], [0, 1, 0, 1, 0, 0], [1, 1, NAN, NAN, NAN, NAN]])
DECISIONS = np.array([[5, 10, 20, 40, 80, 160], [1, 2, 3, 4, 5, 6], [1] * 6, [7, 8, NAN, NAN, NAN, NAN]])


@pytest.mark.parametrize(
    ("share", "window", "expected"),
    [(1.0, 2, [35, 3, np.inf, 15]), (0.5, 2, [15, 3, 2, 15]), (0.5, 7, [np.inf] * 4), (0.5, 3, [35, 6, 4, np.inf])],
)
def test_the_decisions_are_counted_up_to_the_first_window_with_enough_successes(share, window, expected):
    assert decisions_until(SUCCESS, DECISIONS, share, window).tolist() == expected


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
    ahead = {"decisions": LEARNING["decisions"], "success": LEARNING["return"]}
    np.testing.assert_array_equal(at_budget(ahead, np.array(budget), "success"), expected)


# At equal decisions: trained in small, the tables by hand, and the choice that the search makes


def test_agents_are_trained_and_tested_after_each_budget(monkeypatch):
    monkeypatch.setattr(equal_decisions, "BOARD", 400)
    settings = with_seeds(settings_for("ppo", envs_per_agent=4, horizon=8, batch=32), 2)
    results = trained_and_tested(settings, (200, 400, 600), held_out_seeds(19, 3))
    assert {"returns_200", "success_400", "accident_600", "seconds_200"} <= results.measured.keys()
    np.testing.assert_allclose(results.measured["returns_400"], results.tested["returns"].mean(axis=1), rtol=1e-6)
    running = 4 * 150  # decisions that the last episodes, which have not ended, may have
    driven = np.nansum(results.curves["decisions"], axis=1)
    assert (600 - running <= driven).all() and (driven <= 604).all()
    assert (results.seconds > results.measured["seconds_400"]).all()


def invented(settings: list, returns: list) -> Results:
    """One road and two training episodes of each agent. The second agent does not escape."""
    values = {
        "returns": returns,
        "seconds": returns,
        "success": [1.0, 0.9][: len(returns)] + [1.0] * (len(returns) - 2),
    }
    values["accident"] = [0.25] * len(returns)
    measured = {f"{name}_{budget}": np.array(values[name]) for name in values for budget in BUDGETS}
    tested = {"returns": np.array(returns)[:, None], "success": np.ones((len(returns), 1))}
    curves = {"return": np.zeros((len(returns), 2)), "decisions": np.full((len(returns), 2), 100.0)}
    return Results(agent_entries(settings), np.full(len(returns), -1), tested, curves, measured=measured)


def test_a_row_counts_the_agents_of_all_jobs_that_made_so_many_decisions():
    settings = with_seeds(settings_for("ibrl", target_entropy=0.1), 3)
    shorter = invented(settings[2:], [100.0])
    measured = {name: each for name, each in shorter.measured.items() if not name.endswith("_800000")}
    jobs = {"ibrl-0": invented(settings[:2], [100.0, 100.0]), "ibrl-2": replace(shorter, measured=measured)}
    headings, rows = budget_rows(by_method(jobs))
    assert rows[0] == ["100,000", "IBRL", "2 of 3", "100.00 [100.00, 100.00]", "25.0", "100.0"]
    assert [row[:3:2] for row in rows[1:]] == [["200,000", "2 of 3"], ["800,000", "1 of 2"]]
    assert len(headings) == 6


def test_the_chosen_settings_are_those_that_earned_most_in_the_search_that_ships():
    ships = shipped_experiment("beyond-search")
    best = {method: int(np.argmax(list(tried(results).values()))) for method, results in ships.items()}
    assert len(best) > 4 and best.items() <= CHOSEN.items()


def test_the_return_after_equal_seconds_follows_from_what_a_decision_takes():
    results = invented(with_seeds(settings_for("ibrl"), 2), [10.0, 10.0])  # 100,000 decisions in 10 s
    curves = {"return": np.repeat([[1.0, 3.0]], 500, axis=1), "decisions": np.full((1, 1000), 100.0)}
    curves = {name: np.repeat(values, 2, axis=0) for name, values in curves.items()}
    _, (row,) = seconds_rows({"ibrl": replace(results, curves=curves)})
    assert equal_decisions.SECONDS == 5
    assert row == ["IBRL", "50,000", "1.00 [1.00, 1.00]"]  # the 500 episodes of the first half
