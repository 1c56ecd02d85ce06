"""The claims and their stress: what stands and what falls is counted, and a lesson shows its own."""

import numpy as np
import pytest

from bootcourse.course.lessons import LESSONS
from bootcourse.research import claimed, claims
from bootcourse.research.claims import Claim
from bootcourse.research.computed import StudyResults
from bootcourse.research.experiments import stress
from bootcourse.research.results import Results
from bootcourse.statistics import holm
from bootcourse.storage.assets import FOLDER
from tools.course.stressed import computed, survived


@pytest.fixture(scope="module")
def shipped() -> StudyResults:
    return computed(FOLDER)


def group(method: str, successes: list[float], returns: float = 0.0) -> Results:
    """Agents with these shares of success, as if tested on twenty roads."""
    tested = {"success": np.array([[i < 20 * share for i in range(20)] for share in successes])}
    tested |= {"returns": np.full(tested["success"].shape, returns), "accident": 0 * tested["success"]}
    entries = [{"method": method, "seed": seed} for seed in range(len(successes))]
    return Results(entries, np.full(len(successes), -1), tested)


def test_there_are_at_most_thirty_claims_and_each_has_a_lesson_and_stress(shipped):
    made = claimed.claims(shipped)
    assert 15 <= len(made) <= 30 and set(claimed.CLAIMS) <= set(LESSONS)
    assert len({claim.name for claim in made}) == len(made) == sum(map(len, claimed.CLAIMS.values()))
    assert all(claim.stress and claim.sentence.endswith(".") for claim in made)


def test_a_claim_falls_if_one_attempt_to_refute_it_succeeds():
    stands = Claim("a", "It holds.", "1 of 2", {"twice": (True, "2 of 4")})
    falls = Claim("b", "It does not.", "1 of 2", {"twice": (True, "2 of 4"), "half": (False, "0 of 4")}, 0.02)
    assert stands.stands and not falls.stands
    text = "\n".join(claims.section([stands, falls]))
    assert "| half | **falls** | 0 of 4 |" in text and text.count("open question") == 1
    assert "adjusted by Holm: 0.02." in text and "These 2 sentences" in text


def test_holm_multiplies_the_smallest_p_most_and_never_orders_anew():
    assert holm([0.01, 0.04, 0.03]).tolist() == pytest.approx([0.03, 0.06, 0.06])
    assert holm([0.6, 0.9]).tolist() == [1.0, 1.0]


def test_what_is_told_of_a_group_has_the_return_and_the_accidents_beside_the_success():
    assert claimed.told(group("sac", [1.0, 0.95, 0.5], 42)) == "2 of 3 escape, return 42, accidents 0 %"
    pair = group("sac", [0.0] * 10), group("soft", [1.0] * 10)
    assert claimed.different(*pair, claimed.escaping) == pytest.approx(2 / 184756)  # 1 of 20 over 10, both tails


def test_the_compiled_learner_s_agents_are_trained_with_other_seeds_and_tested_twice():
    made = stress.stressed("soft, ξ stays at 2", seeds=1, episodes=30, tests=5)
    assert made.agents[0]["seed"] == stress.FIRST and made.agents[0]["xi_fixed"] == 2.0
    assert made.sizes == (5, 30) and set(made.measured) == {"finer_success", "finer_returns", "finer_accident"}
    assert stress.FINER.clock.dt == 0.25 and stress.FINER.clock.decisions == 150


def test_a_lesson_shows_what_its_claims_survived_and_the_others_show_nothing(shipped):
    shown = survived("the_rule")
    for claim in claimed.claims(shipped, "the_rule"):
        assert f"**{claim.sentence}**" in shown
    assert shown.strip().startswith("<details>") and "half the time step" in shown
    assert survived("values") == ""
