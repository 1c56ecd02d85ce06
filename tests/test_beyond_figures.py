"""What a teacher is worth: the numbers and their figure."""

import numpy as np
import pytest

from bootcourse.learn.settings import settings_for, with_seeds
from bootcourse.research.experiments.teacher_worth import QUANTITIES, by_teacher, value_and_interval, worth_rows
from bootcourse.research.results import Results, agent_entries

EPISODES, TESTS = 120, 20


def ten_agents(teacher: str, method: str, escaping: int) -> Results:
    """Ten agents, of which some escape on every road from training episode 30 on and earn 100, the others 20.

    An episode of training takes 150 decisions. Each agent has an accident in one of its twenty drives.
    """
    escapes = (np.arange(10) < escaping)[:, None]
    success = np.broadcast_to(escapes, (10, TESTS)).astype(np.int8)
    accident = np.tile((np.arange(TESTS) == 3).astype(np.int8), (10, 1))
    tested = {"success": success, "returns": 20.0 + 80.0 * success, "accident": accident}
    tested |= dict.fromkeys(("speed", "distance"), np.zeros((10, TESTS)))
    curves = {"success": (escapes & (np.arange(EPISODES) >= 30)).astype(np.float64)}
    agents = agent_entries(with_seeds(settings_for(method), 10), teacher)
    return Results(agents, np.full(10, -1), tested, curves | {"decisions": np.full((10, EPISODES), 150.0)})


ESCAPING = {("planner", "rlpd"): 10, ("rule", "soft"): 7, ("random-50", "soft"): 0, ("random-50", "rlpd"): 3}


@pytest.fixture(scope="module")
def worth():
    return by_teacher({f"{t}, {m}": ten_agents(t, m, escaping) for (t, m), escaping in ESCAPING.items()})


@pytest.mark.parametrize(
    ("place", "quantity", "words"),
    [
        (("rule", "soft"), "escape", ("70", "[35, 93]")),  # Clopper-Pearson, 7 of 10
        (("rule", "soft"), "return", ("87", "[47, 100]")),  # the middle six: (5 x 100 + 20) / 6
        (("planner", "rlpd"), "accidents", ("5.00", "[5.00, 5.00]")),  # one of twenty
        (("rule", "soft"), "decisions", ("12", "[12, –]")),  # thousands; the ninth agent does not get there
        (("random-50", "rlpd"), "decisions", ("not reached", "[12, –]")),
        (("random-50", "soft"), "decisions", ("not reached", "")),
    ],
)
def test_each_number_of_a_cell_is_that_of_its_agents(worth, place, quantity, words):
    number = QUANTITIES[quantity]
    assert value_and_interval(number.estimate(number.of_agents(worth[place]))) == words


def test_the_table_has_a_row_for_each_cell_with_teachers_from_bad_to_perfect(worth):
    headings, rows = worth_rows(worth)
    assert [row[0] for row in rows] == ["rule, half at random", "rule, half at random", "rule", "planner"]
    assert len(rows[2]) == len(headings) and rows[2][2] == "7 of 10 (35 to 93\u00a0%)" and "(7 of 10)" in rows[2][-1]
