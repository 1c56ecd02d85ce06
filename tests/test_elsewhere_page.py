"""The page on other problems: its verdicts follow from the scores, and say what was not computed."""

import numpy as np
import pytest

from bootcourse.learn.settings import settings_for
from bootcourse.research.elsewhere import ALONE, METHODS, TAUGHT
from bootcourse.research.elsewhere_claims import SAC, TEACHER, Cells, Claim, claims_of, verdict
from bootcourse.research.elsewhere_page import figure, write_page
from bootcourse.research.results import Results, agent_entries

WORSE, BETTER = np.linspace(0.1, 0.4, 10), np.linspace(0.6, 0.9, 10)


def agents(scores: np.ndarray, teacher_returns: float = 0.5) -> Results:
    """Agents that score this, (10,), in success and return."""
    one = np.repeat(scores[:, None], 4, axis=1)
    measured = {name: np.zeros(10) for name in ("found", "kept", "teacher_success")}
    measured |= {"drawn_success": scores, "drawn_returns": scores, "teacher_returns": np.full(10, teacher_returns)}
    entries = agent_entries([settings_for("sac", seed=seed) for seed in range(10)])
    return Results(entries, np.full(10, -1), {"success": one, "returns": one}, measured=measured)


def cells_of(**scores: np.ndarray) -> Cells:
    """The chain's cells with the random teacher: the named methods, "_" for a space."""
    named = {name.replace("_", " "): agents(each) for name, each in scores.items()}
    return Cells({f"chain, {'none' if name in ALONE else 'random'}, {name}": each for name, each in named.items()})


@pytest.mark.parametrize(
    ("left", "right", "expected", "says"),
    [
        (BETTER, WORSE, ">", "confirmed"),
        (BETTER, WORSE, ">=", "confirmed"),
        (WORSE, BETTER, ">", "contradicted"),
        (WORSE, BETTER, ">=", "contradicted"),
        (BETTER, WORSE, "=", "contradicted"),
        (WORSE, WORSE + 1e-3, ">", "open"),
        (np.ones(10), np.ones(10), ">", "open"),
        (BETTER, 0.5, ">", "confirmed"),
        (0.5, WORSE, ">", "confirmed"),
        (0.5, BETTER, ">=", "contradicted"),
        (np.ones(10), 1.0, ">=", "open"),
    ],
)
def test_a_claim_is_confirmed_or_contradicted_by_a_clear_difference_alone(left, right, expected, says):
    assert Claim("here", "as expected", left, right, expected).verdict == says


def test_a_hypothesis_fails_by_one_contradiction_and_says_what_was_not_run():
    cells = cells_of(soft=WORSE, demonstrations=BETTER, cloning=BETTER)
    assert verdict("H5", cells) == "fails: 1 contradicted, 4 not run"
    (claim,), lacking = claims_of("H5", cells)
    assert claim.where == "chain with a decoy, random" and claim.words == "soft > demonstrations, return"
    assert len(lacking) == 4 and "mountain-car, random, soft" in lacking
    assert verdict("H5", cells_of(soft=BETTER, demonstrations=WORSE)) == "open: 1 confirmed, 4 not run"
    assert verdict("H2", cells) == "open: 1 confirmed, 5 not run"  # the clones are above the teacher's 0.5


def test_the_share_of_the_gap_is_nothing_for_plain_sac_and_one_for_the_best():
    cells = cells_of(SAC=WORSE, soft=BETTER, demonstrations=(WORSE + BETTER) / 2)
    shares = [cells.share("chain", "random", method) for method in (SAC, "demonstrations", "soft", TEACHER)]
    np.testing.assert_allclose(shares, [0, 0.5, 1, 0.5])
    assert np.isnan(cells.share("chain", "random", "both"))


def test_the_page_has_its_figure_its_verdicts_and_every_cell(tmp_path):
    cells = cells_of(SAC=WORSE, soft=BETTER, cloning=(WORSE + BETTER) / 2)
    text = write_page(cells.computed, tmp_path).read_text()
    assert (tmp_path / "figures/elsewhere.png").exists() and "](figures/elsewhere.png)" in text
    assert "| chain with a decoy | random | 25 (0.25) |" in text and "**75 (0.75)**" in text
    assert "### H3 open: 10 not run" in text and "10 of 10 (69 to 100" in text
    assert "- Not run: MountainCar, Acrobot, CartPole, DoorKey 5x5, Lunar lander." in text
    assert "of 1 pairs" in figure(cells).alt.lower() and "soft 100 %" in figure(cells).alt
    assert write_page({}, tmp_path) is None and len(METHODS) == len(ALONE) + len(TAUGHT)
