"""One text, three products: what is wrong with a lesson is found, and what is made from it is right."""

import re
import shutil
import subprocess
import sys
from pathlib import Path

import nbformat
import pytest

from bootcourse.course import lessons
from bootcourse.course.lessons import LESSONS, exercises_of, minutes_of, number, registry, stem
from bootcourse.course.predictions import number_of
from tools.course import numbering
from tools.course import problems as problems_module
from tools.course.numbering import BY_HAND, LESSON_FOLDERS, ROOT, refreshed, resolved, text_file
from tools.course.problems import dead_names, problems
from tools.course.products import folded, instructor_file, make, make_solved, refresh_prose, solved_file, student_file
from tools.course.source import lesson_of, numbered, read, sources

EXAMPLE = re.search(r"```python\n(.*?)```", (LESSON_FOLDERS / "README.md").read_text(encoding="utf-8"), re.S)[1]
PAGES = [*ROOT.glob("book/*.md"), *ROOT.glob("book/teaching/*.md")]
TEXTS = [*sources(), *PAGES, ROOT / "book/paper_map.toml"]

# The lessons ----------------------------------------------------------------------------------------


@pytest.mark.parametrize("path", sources(), ids=lesson_of)
def test_nothing_is_wrong_with_a_lesson(path):
    assert problems(path) == []


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.stem)
def test_the_code_that_a_page_of_the_book_names_exists(page):
    assert dead_names(page.read_text(encoding="utf-8")) == []


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.stem)
def test_no_line_of_a_page_begins_like_a_comment_or_a_list_for_markdown(page):
    assert problems_module.MISREAD.findall(page.read_text(encoding="utf-8")) == []


# Numbers --------------------------------------------------------------------------------------------


@pytest.mark.parametrize("path", TEXTS, ids=lambda path: f"{path.parent.name}-{path.stem}")
def test_no_number_of_a_lesson_is_written_by_hand(path):
    text = path.read_text(encoding="utf-8").replace("\n# ", "\n")
    if path.name != "cloud.md":  # is read as it is, and kept up to date
        assert [found[0] for found in BY_HAND.finditer(text)] == []
    assert re.findall(r"^# \w+ · |\*\*Exercise \d|predict\(\s*\"\d", text, re.M) == []


def test_a_text_names_lessons_and_its_tables_are_in_their_order():
    text = "| [[the_rule]] · [](the_rule.ipynb) | ● |\n| [[start]] · see [lesson [[the_trap]]](x/the_trap.ipynb) |\n"
    rule, start, trap = map(number, ("the_rule", "start", "the_trap"))
    assert resolved(text) == (
        f"| {start} · see [lesson {trap}](x/{stem('the_trap')}.ipynb) |\n"
        f"| {rule} · [The rule]({stem('the_rule')}.ipynb) | ● |\n"
    )
    assert resolved("[[the_rule]]", "lessons/") == f"[{rule}](lessons/{stem('the_rule')}.ipynb)"
    with pytest.raises(ValueError, match="no such lesson"):
        resolved("[[nothing]]")


def test_only_a_lesson_s_title_gets_its_number_not_a_comment_in_its_code():
    text, _ = numbered("# The rule\n\n```python\n# a comment\n```", "the_rule", 0)
    assert text == f"# {number('the_rule')} · The rule\n\n```python\n# a comment\n```"


def test_two_lessons_that_change_places_change_their_numbers(monkeypatch):
    list(registry())  # as the lessons stand
    places = {"the_rule": number("recorded_drives"), "recorded_drives": number("the_rule")}
    order = tuple({"the_rule": "recorded_drives", "recorded_drives": "the_rule"}.get(name, name) for name in LESSONS)
    for module in (lessons, numbering):
        monkeypatch.setattr(module, "LESSONS", order)
    for name, place in places.items():
        text = "\n".join(cell.text for cell in read(text_file(name)))
        assert text.startswith(f"# {place} · ") and f"**Exercise {place}.1 (" in text
        assert stem(name) == f"{place:02}_{name}" and number_of(f"{name}.1") == f"{place}.1"
    readme = refreshed((ROOT / "README.md").read_text(encoding="utf-8"))
    assert re.findall(r"^\| \d+ \| \[[^]]*\]\(notebooks/\d\d_(\w+)\.ipynb", readme, re.M) == list(order)


@pytest.mark.parametrize("name", ["README.md", "book/cloud.md", "tests/check.txt"])
def test_the_pages_that_hold_the_numbers_are_up_to_date(name):
    text = (ROOT / name).read_text(encoding="utf-8")
    assert text == refreshed(text), "run make notebooks"


def test_what_answers_a_prediction_is_folded_outputs_and_text_and_what_comes_next_is_not():
    code, text = nbformat.v4.new_code_cell, nbformat.v4.new_markdown_cell
    cells = folded([
        code('predict("a.1", "Which?")'),
        text("**Exercise.** Write it."),
        code('predicted("a.1")\nprint(7)'),
        text("Now all of them:"),
        code("print(8)"),
        text("**See.** It is 7.\n\nSo there.\n\n> **Predict.** And now?"),
        code('predict("a.2", "And now?")'),
        text("**See.** Nothing was answered here."),
        code('compare_predictions("a", {1: 7})'),
    ])  # fmt: skip
    hidden = {"outputs_hidden": True}, {"source_hidden": True}
    marks = [cell.metadata.get("jupyter") for cell in cells]
    assert marks == [None, None, hidden[0], None, hidden[0], hidden[1], None, None, None, hidden[0]]
    assert [cell.source for cell in cells[5:7]] == ["See.\nIt is 7.\n\nSo there.", "> **Predict.** And now?"]


def test_a_wall_of_imports_is_folded_and_runs():
    wall, short = "from a import (\n    b,\n    c,\n)\n\nprogress()", "import a\n\nprogress()"
    first, second = folded([nbformat.v4.new_code_cell(wall), nbformat.v4.new_code_cell(short)])
    assert first.metadata == {"jupyter": {"source_hidden": True}, "tags": ["hide-input"]} and first.source == wall
    assert second.metadata == {}


# The example of the writers' README -----------------------------------------------------------------


def write_source(folder: Path, text: str = EXAMPLE, name: str = "the_rule") -> Path:
    path = folder / "bootcourse/course/lessons" / name / "text.py"
    path.parent.mkdir(parents=True)
    path.write_text(text, encoding="utf-8")
    return path


@pytest.fixture(scope="module")
def made(tmp_path_factory):
    """The example, executed once."""
    path = write_source(tmp_path_factory.mktemp("example"))
    make(path)
    make_solved(path)
    return path


@pytest.fixture
def few_exercises(monkeypatch):
    """As if each lesson had one exercise, as the example has; the real lessons have more."""
    few = {name: registry()[name] for name in ("safety_distance", "critic_target", "soft_constraint")}
    monkeypatch.setattr(problems_module, "registry", lambda: few)


@pytest.fixture
def copy(made, few_exercises, tmp_path):
    """A copy that a test may spoil."""
    shutil.copytree(made.parents[4], tmp_path, dirs_exist_ok=True)
    return tmp_path / made.relative_to(made.parents[4])


def text_of(file: Path) -> list[str]:
    return [cell.source for cell in nbformat.read(file, as_version=4).cells]


def result_of(file: Path) -> dict:
    cells = nbformat.read(file, as_version=4).cells
    return next(c for c in cells if "check.safety_distance" in c.source and c.cell_type == "code").outputs[0].data


def test_the_student_gets_a_stub_that_failed_politely_and_the_solved_notebook_passes(made, few_exercises):
    assert problems(made) == []
    texts = text_of(student_file(made))
    stub = next(text for text in texts if text.startswith("def safety_distance"))
    assert "\n    ...\n" in stub and "closing_speed" not in stub and "# solution" not in stub
    assert "Nothing to check yet" in result_of(student_file(made))["text/plain"]
    assert texts[0].startswith(f"# {number('the_rule')} · The rule") and not any(
        "They say 4 m" in each for each in texts
    )
    solved = next(text for text in text_of(solved_file(made)) if text.startswith("def safety_distance"))
    assert "closing_speed = " in solved and "..." not in solved


def test_the_instructor_s_page_has_timings_questions_answers_and_misconceptions(made):
    page = instructor_file(made).read_text(encoding="utf-8")
    assert "| Round 1: how far is safe? | 8 | 5 |" in page and "**Time** 13 minutes." in page
    assert "> **Predict.** You drive 12 m/s" in page and "They say 4 m at once" in page and "closing_speed = " in page
    exercise = registry()["safety_distance"]
    assert all(mistake.says in page for mistake in exercise.mistakes) and all(hint in page for hint in exercise.hints)


def test_text_is_refreshed_without_execution_and_code_is_not(copy):
    copy.write_text(EXAMPLE.replace("how far is safe", "what is safe"), encoding="utf-8")
    assert refresh_prose(copy) and problems(copy) == []
    assert "Nothing to check yet" in result_of(student_file(copy))["text/plain"]
    copy.write_text(EXAMPLE.replace("import check, source", "import source, check"), encoding="utf-8")
    assert not refresh_prose(copy)


SPOILT = {
    "a mark has no partner": ("    # end solution\n", "", "`# solution` has no `# end solution`"),
    "an exercise is not registered": ("check.safety_distance(", "check.safe_distance(", "safe_distance: no such"),
    "an exercise of the lesson is not used": ("check.safety_distance(safety_distance)", "", "is not used in it"),
    "the announcement has other minutes": ("(5 min, ●○○)", "(9 min, ●○○)", "announce it, **Exercise (5 min, ●○○)"),
    "the stub has other arguments": ("v_new, t_safe, floor):", "v_new, floor, t_safe):", "other arguments than"),
    "a name of code is dead": ("`bootcourse.rule.safety", "`bootcourse.rule.unsafety", "unsafety_distance` names"),
    "a shown source is dead": ('", "safety', '", "unsafety', "`bootcourse.rule.unsafety_distance`"),
    "a prediction is not answered": ("check.safety_distance(", 'predict("the_rule.1")\ncheck.safety_distance(',
                                     "No compare_predictions answers the_rule.1"),
    "a line begins like a comment": ("You drive 12 m/s", "You drive 12\n# % of", "a line that begins with `%`"),
    "a line begins like a list": ("You drive 12 m/s", "You drive Q(4,\n# 1) rises", "a line that begins with `1) `"),
    "a claim is false": ("You drive 12 m/s", "<!-- claim: 1 == 2 -->", "`1 == 2` is False"),
    "a table is shown to nobody": ("check.safety_distance(", "table([], [])\ncheck.safety_distance(",
                                   "loses what table("),
    "the rows have other minutes": ("**Time** 13", "**Time** 14", "the rows add up to 13 minutes"),
    "a text has changed": ("You drive 12 m/s", "You drive 13 m/s", "the_rule.ipynb is out of date"),
    "a solution has changed": ("closing_speed", "closing", "the source's solution is not the one"),
}  # fmt: skip


@pytest.mark.parametrize("old, new, words", SPOILT.values(), ids=SPOILT)
def test_it_is_found_when(copy, old, new, words):
    assert old in EXAMPLE
    copy.write_text(EXAMPLE.replace(old, new), encoding="utf-8")
    assert any(words in problem for problem in problems(copy)), problems(copy)


def test_the_first_cells_of_the_course_load_neither_torch_nor_an_exercise_and_know_the_minutes_of_all():
    code = (
        "import sys, bootcourse as bc; from bootcourse.course import predict, progress, shipped; progress(); "
        "predict('start.1', unit=''); bc.world(ghosts=[]); print(*sys.modules)"
    )
    loaded = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True).stdout.split()
    assert {"torch", "scipy.stats", "bootcourse.course.exercise"}.isdisjoint(
        loaded
    ) and "bootcourse.web.widget" in loaded
    for lesson in LESSONS:
        assert minutes_of(lesson) == {name: each.minutes for name, each in exercises_of(lesson).items()}


def test_an_exercise_is_looked_up_in_its_own_lesson_and_no_other_is_loaded():
    code = (
        "import sys; from bootcourse.course.lessons import registry; registry()['soft_constraint']; print(*sys.modules)"
    )
    loaded = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True).stdout.split()
    assert "bootcourse.course.lessons.soft_constraint.exercises" in loaded
    assert {"bootcourse.course.lessons.the_trap.exercises", "scipy.stats"}.isdisjoint(loaded)
    assert "soft_constraints" not in registry() and len(registry()) == len(set(registry()))
