"""`clocks_panel`: its sentences against curves worked by hand, and its controls."""

from dataclasses import asdict, replace

import numpy as np
import pytest

from bootcourse.errors import BootcourseError
from bootcourse.learn.settings import settings_for
from bootcourse.panels import clocks_panel
from bootcourse.panels.clocks import ClocksPanel
from bootcourse.research.clocks import faded
from bootcourse.research.plan import VARIED
from bootcourse.research.results import Results, save_results
from tests.panels import raise_in_callbacks, words  # noqa: F401

pytestmark = pytest.mark.usefixtures("raise_in_callbacks")


def measured(half_life: float) -> Results:
    """Two agents per method, of which one escapes; ξ halves every `half_life` episodes."""
    agents = [
        {"method": method, "seed": seed, "beta_episodes": 100, "xi_multiplier": 200.0}
        for method in VARIED
        for seed in (0, 1)
    ]
    xi = np.tile(2.0 * 0.5 ** (np.arange(200) / half_life), (len(agents), 1))
    success = np.tile(np.array([[0.0], [1.0]]), (len(VARIED), 200))
    tested = dict.fromkeys(("success", "returns", "speed", "distance"), success)
    tested["accident"] = np.zeros_like(success, dtype=np.int8)
    curves = {"success": success, "return": success, "xi": xi}
    return Results(agents, np.full(len(agents), -1), tested, curves)


@pytest.fixture
def panel():
    return ClocksPanel({("1/4", "μ"): measured(30), ("2", "π̃"): measured(3)}, ("1/4", "μ"))


def test_xi_that_halves_every_30_episodes_is_down_to_a_tenth_after_100():
    assert faded(measured(30).curves["xi"]) == 100  # 30 log2(10) = 99.66


def test_the_panel_says_when_each_clock_has_run_down_and_who_escapes(panel):
    assert "1/4 updates per decision: ξ is down to a tenth after 100 episodes, β is 0 after 100." in panel.svg.alt
    assert "1 of 2 agents escape with the soft constraint alone, 1 of 2 with demonstrations alone" in panel.svg.alt


def test_another_choice_draws_its_own_curves_and_one_that_was_not_computed_says_so(panel):
    before = panel.svg
    panel.updates.value = "2"
    assert "2 updates per decision with demonstrations by μ were not computed" in words(panel) and panel.svg == before
    panel.driver.value = "π̃"
    assert panel.chosen == ("2", "π̃") and "after 10 episodes" in panel.svg.alt and "not computed" not in words(panel)
    assert panel.view.value == panel.svg != before


def test_its_picture_names_every_line(panel):
    drawn = panel.picture()
    assert all(name in drawn for name in ("ξ = 200α", ">β<", "plain SAC", "soft constraint only"))


def kept(root, half_life=30):
    """A study's folder with the two jobs of one choice."""
    results = measured(half_life)
    for folder, methods in (
        ("no-demonstrations", ("sac", "soft")),
        ("demonstrations-by-rule", ("demos", "bootstrapped")),
    ):
        mine = results.pick([i for i, agent in enumerate(results.agents) if agent["method"] in methods])
        settings = [asdict(settings_for(a["method"], seed=a["seed"], beta_episodes=100)) for a in mine.agents]
        path = root / "jobs" / "clocks" / f"2-updates-{folder}" / "results.npz"
        path.parent.mkdir(parents=True)
        save_results(replace(mine, agents=settings), path, {})


def test_a_study_s_folder_is_what_the_panel_shows(tmp_path):
    kept(tmp_path)
    panel = clocks_panel(study=tmp_path)
    assert panel.chosen == ("2", "μ") and "1 of 2 agents escape" in panel.svg.alt
    with pytest.raises(BootcourseError, match="'4 μ' is unknown"):
        clocks_panel("4", "μ", study=tmp_path)


def test_a_folder_without_such_jobs_says_which_command_makes_them(tmp_path):
    with pytest.raises(BootcourseError, match="bootcourse study clocks --out"):
        clocks_panel(study=tmp_path)
