"""What a teacher is worth: its numbers worked by hand, the panel and the figure, on a small invented study."""

from dataclasses import asdict

import numpy as np
import pytest

from bootcourse.course.lessons.beyond_the_paper.figures import teacher_value
from bootcourse.course.shipped import shipped_teachers
from bootcourse.errors import BootcourseError
from bootcourse.learn.settings import settings_for
from bootcourse.panels import teachers_panel
from bootcourse.panels.teachers import TeachersPanel
from bootcourse.research.report import experiments_part
from bootcourse.research.results import Results, StudyResults, save_results
from bootcourse.research.teacher_worth import QUANTITIES, cells, in_words, worth_rows
from tests.panels import from_page, raise_in_callbacks, words  # noqa: F401

pytestmark = pytest.mark.usefixtures("raise_in_callbacks")
EPISODES, TESTS = 120, 20


def ten_agents(teacher: str, method: str, escaping: int) -> Results:
    """Ten agents, of which some escape on every road from training episode 30 on and earn 100, the others 20.

    An episode of training takes 150 decisions. Each agent has an accident in one of its twenty drives.
    """
    agents = [asdict(settings_for(method, seed=seed)) | {"teacher": teacher} for seed in range(10)]
    escapes = (np.arange(10) < escaping)[:, None]
    success = np.broadcast_to(escapes, (10, TESTS)).astype(np.int8)
    accident = np.tile((np.arange(TESTS) == 3).astype(np.int8), (10, 1))
    tested = {"success": success, "returns": 20.0 + 80.0 * success, "accident": accident}
    tested |= dict.fromkeys(("speed", "distance"), np.zeros((10, TESTS)))
    curves = {"success": (escapes & (np.arange(EPISODES) >= 30)).astype(np.float64)}
    return Results(agents, np.full(10, -1), tested, curves | {"decisions": np.full((10, EPISODES), 150.0)})


def invented() -> StudyResults:
    """Three teachers, two methods, a cell left out."""
    made = {("random-50", "soft"): 0, ("rule", "soft"): 7, ("random-50", "rlpd"): 3, ("planner", "rlpd"): 10}
    varied = {f"{teacher}, {method}": ten_agents(teacher, method, hits) for (teacher, method), hits in made.items()}
    return StudyResults({}, experiments={"teachers": varied})


@pytest.fixture
def found():
    return cells(invented().experiments["teachers"])


@pytest.fixture
def panel(found):
    return TeachersPanel(found, "escape")


def estimate(found, place, name):
    return QUANTITIES[name].estimate(QUANTITIES[name].of_agents(found[place]))


def test_teachers_stand_from_bad_to_perfect_whatever_order_they_were_computed_in(found):
    assert list(found) == [("random-50", "soft"), ("random-50", "rlpd"), ("rule", "soft"), ("planner", "rlpd")]


def test_each_number_of_a_cell_is_that_of_its_agents(found):
    escape, until = estimate(found, ("rule", "soft"), "escape"), estimate(found, ("rule", "soft"), "decisions")
    assert escape.value == 70 and (round(escape.low), round(escape.high)) == (35, 93)  # Clopper-Pearson, 7 of 10
    assert in_words(until) == ("12", "[12, –]")  # thousands; the ninth agent does not get there
    assert in_words(estimate(found, ("random-50", "rlpd"), "decisions")) == ("not reached", "[12, –]")
    assert in_words(estimate(found, ("random-50", "soft"), "decisions")) == ("not reached", "")
    assert estimate(found, ("planner", "rlpd"), "accidents") == pytest.approx((5, 5, 5))  # one of twenty
    assert estimate(found, ("rule", "soft"), "return").value == pytest.approx((5 * 100 + 20) / 6)  # the middle six


@pytest.mark.parametrize("name", QUANTITIES)
def test_the_panel_shows_every_cell_its_interval_and_what_was_not_run(panel, found, name):
    from_page(panel.quantity, index=list(QUANTITIES).index(name))
    for place in found:
        for part in in_words(estimate(found, place, name)):
            assert part in panel.view.value and part in panel.svg.alt
    assert panel.svg.count(">not run<") == 2 and QUANTITIES[name].label in panel.svg and "nan" not in panel.svg
    assert panel.picture() == panel.svg and "planner" in panel.svg


def test_not_reached_is_shown_with_how_many_reached_it(panel):
    from_page(panel.quantity, index=3)
    assert "rule, half at random, RLPD: not reached [12, –], reached by 3 of 10" in panel.svg.alt
    assert "rule, half at random, soft constraint only: not reached, reached by 0 of 10" in panel.svg.alt
    assert "planner, RLPD: 11.70 [11.70, 11.70], reached by 10 of 10" in panel.svg.alt


@pytest.mark.parametrize("name", QUANTITIES)
def test_the_figure_has_a_dot_for_each_agent_and_says_what_it_shows(found, name):
    figure = teacher_value(found, name)
    dots = [len(each.get_offsets()) for ax in figure.axes for each in ax.collections]
    assert sum(dots) == 40 and "planner, RLPD" in figure.alt and "nan" not in figure.alt
    assert [ax.get_ylabel() for ax in figure.axes] == ["soft constraint only", "RLPD"]


def test_the_figure_s_title_names_the_lowest_and_the_highest_cell(found):
    title = teacher_value(found, "escape").alt
    assert title.startswith("Agents that escape (%): from 0 (rule, half at random, soft constraint only) to 100 (plan")


def test_the_report_has_a_row_for_each_cell(found):
    headings, rows = worth_rows(found)
    assert [len(row) for row in rows] == [len(headings)] * 4
    assert rows[2][:3] == ["rule", "soft constraint only", "7 of 10 (35 to 93\u00a0%)"] and rows[2][-1].endswith(
        "(7 of 10)"
    )
    assert "## What a teacher is worth\n" in experiments_part(invented().experiments)


def test_a_study_s_folder_is_read_and_one_without_such_jobs_says_what_to_run(tmp_path):
    with pytest.raises(BootcourseError, match="no results of the experiment teachers yet: run `bootcourse study teach"):
        teachers_panel(study=tmp_path)
    path = tmp_path / "jobs/teachers/rule-soft/results.npz"
    path.parent.mkdir(parents=True)
    save_results(ten_agents("rule", "soft", 4), path, {})
    assert list(shipped_teachers(tmp_path)) == [("rule", "soft")]
    assert "rule, soft constraint only: 40" in teachers_panel(study=tmp_path).svg.alt
    for make in (lambda: teachers_panel("returns", tmp_path), lambda: teacher_value({}, "returns")):
        with pytest.raises(BootcourseError, match="'returns' is unknown: did you mean 'return'"):
            make()
