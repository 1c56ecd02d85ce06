"""How often a table of single agents reads as the paper's: `bootcourse.research.experiments.clocks`."""

import numpy as np
import pytest

from bootcourse.research.experiments.clocks import choices, pattern, pattern_rows
from bootcourse.research.results import Results
from bootcourse.research.tables import found_and_kept
from bootcourse.statistics import found_after, lost


def agents(**success):
    """Agents whose held-out success rates are given: agents(sac=[0, 1])."""
    settings = [{"method": method, "seed": seed} for method, rates in success.items() for seed in range(len(rates))]
    rates = np.array([rate for each in success.values() for rate in each])
    tested = {"success": np.arange(100)[None] < 100 * rates[:, None]}
    trained = {"success": np.repeat(rates[:, None], 60, axis=1)}
    return Results(settings, np.full(len(rates), -1), tested, trained)


def test_a_table_of_single_agents_is_the_paper_s_if_every_row_is():
    some = pattern(agents(sac=[0, 0], soft=[1, 0], demos=[0.95, 1, 1, 0], bootstrapped=[1, 1]))
    assert some.value == pytest.approx(1 * 0.5 * (0.95**20 + 2) / 4 * 1) and some.low < some.value < some.high
    none = pattern(agents(sac=[0] * 10, soft=[1] * 10, demos=[1] * 10, bootstrapped=[1] * 10))
    assert none.value == none.low.__round__(3) == 0 and 0.02 < none.high < 0.3  # no agent of `soft` fits


def test_a_row_stands_for_a_choice_whose_four_methods_were_computed():
    alone, helped = agents(sac=[0, 0], soft=[0, 1]), agents(demos=[1, 1], bootstrapped=[1, 1])
    varied = {"2 updates, no demonstrations": alone, "2 updates, demonstrations by π̃": helped}
    varied["1 updates, demonstrations by μ"] = helped  # sac and soft are missing there
    assert list(choices(varied)) == [("2", "π̃")]
    headings, rows = pattern_rows(varied)
    assert rows[0][:6] == ["2", "π̃", "0, 0 of 2", "1, 1 of 2", "2, 2 of 2", "2, 2 of 2"] and rows[0][6].startswith(
        "50 ["
    )
    assert len(headings) == len(rows[0])


def test_an_agent_has_found_the_way_out_if_most_of_fifty_episodes_in_a_row_end_ahead_and_kept_it_if_it_escapes():
    episodes = np.arange(200)
    success = np.array([episodes >= 150, (50 <= episodes) & (episodes < 76), episodes % 2 == 0, episodes < 0], float)
    success[0, 190:] = np.nan  # an agent that ended fewer episodes
    settings = [{"method": "soft", "seed": seed} for seed in range(4)]
    tested = {"success": np.array([[1, 1, 1], [1, 1, 0], [1, 1, 1], [0, 0, 0]])}
    results = Results(settings, np.full(4, -1), tested, {"success": success})
    found, kept = results.found_and_kept("soft")
    assert found.tolist() == [True, True, False, False]  # half of the episodes is not more than half
    assert kept.tolist() == [True, False, False, False]
    assert found_and_kept(results, "soft") == "2, 1 of 4"


def test_a_window_with_an_episode_that_was_not_driven_does_not_count():
    success = np.array([[1, 1, np.nan, np.nan], [0, 1, 1, np.nan], [1, 1, 1, 0]])
    assert found_after(success, 3).tolist() == [0, 3, 3]
    assert found_after(success, 3, least=3).tolist() == [0, 0, 3]
    assert found_after(success, 2).tolist() == [2, 3, 2] and found_after(success, 5).tolist() == [0, 0, 0]


def test_an_agent_has_lost_the_way_out_once_it_is_ahead_in_half_of_fifty_after_forty_of_fifty():
    ahead = np.array([[1] * 40 + [0] * 25 + [1] * 35, [1] * 39 + [0] * 61, [1] * 100, [0] * 60 + [1] * 40])
    assert lost(ahead).tolist() == [True, False, False, False]
    assert lost(ahead, bar=15).tolist() == [False] * 4 and lost(ahead[:, :49]).tolist() == [False] * 4
