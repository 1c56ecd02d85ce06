"""One source, three products: what is wrong with a lesson is found, and what is made from it is right."""

import re
import shutil
from pathlib import Path

import nbformat
import pytest
from nbclient.exceptions import CellExecutionError

from bootcourse.course.lessons import registry
from tools.course import problems as problems_module
from tools.course.problems import dead_names, has_alt, of_pictures, problems
from tools.course.products import WIDGET, instructor_file, make, refresh_prose, solved_file, student_file, tidy
from tools.course.reference import BOOK
from tools.course.source import (
    NOTEBOOKS,
    one_folder_down,
    read,
    sources,
    with_solutions,
    without_marks,
    without_solution,
)

SOURCES = sources()
EXAMPLE = re.search(r"```python\n(.*?)```", (NOTEBOOKS / "source/README.md").read_text(encoding="utf-8"), re.S)[1]

# The lessons ----------------------------------------------------------------------------------------


@pytest.mark.parametrize("path", SOURCES, ids=lambda path: path.stem)
def test_nothing_is_wrong_with_a_lesson(path):
    assert problems(path) == []


def test_nothing_lies_about_that_has_no_source():
    names = {path.stem for path in SOURCES}
    made = [file for pattern in ("*.ipynb", "solved/*", "instructor/*") for file in NOTEBOOKS.glob(pattern)]
    assert {file.stem for file in made if not file.name.startswith(".")} == names


@pytest.mark.parametrize("exercise", registry().values(), ids=lambda exercise: exercise.name)
def test_the_lesson_of_a_registered_exercise_uses_it(exercise):
    lessons = {path.stem: path for path in SOURCES}
    assert exercise.lesson in lessons
    assert exercise.name in [name for cell in read(lessons[exercise.lesson]) for name in cell.checks]


@pytest.mark.parametrize("page", sorted(BOOK.glob("*.md")), ids=lambda page: page.stem)
def test_the_code_that_a_page_of_the_book_names_exists(page):
    assert dead_names(page.read_text(encoding="utf-8")) == []


# The example of the writers' README -----------------------------------------------------------------


def write_source(folder: Path, text: str = EXAMPLE, name: str = "03_the_rule") -> Path:
    path = folder / "notebooks/source" / f"{name}.py"
    path.parent.mkdir(parents=True)
    path.write_text(text, encoding="utf-8")
    return path


@pytest.fixture(scope="module")
def made(tmp_path_factory):
    """The example, executed once."""
    path = write_source(tmp_path_factory.mktemp("example"))
    make(path)
    return path


@pytest.fixture
def few_exercises(monkeypatch):
    """As if each lesson had one exercise, as the example has; the real lessons have more."""
    few = {name: registry()[name] for name in ("safety_distance", "critic_target", "soft_constraint")}
    monkeypatch.setattr(problems_module, "registry", lambda: few)


@pytest.fixture
def copy(made, few_exercises, tmp_path):
    """A copy that a test may spoil."""
    shutil.copytree(made.parent.parent, tmp_path / "notebooks")
    return tmp_path / "notebooks/source" / made.name


def text_of(file: Path) -> list[str]:
    return [cell.source for cell in nbformat.read(file, as_version=4).cells]


def result_of(file: Path) -> dict:
    cells = nbformat.read(file, as_version=4).cells
    return next(c for c in cells if "check.safety_distance" in c.source and c.cell_type == "code").outputs[0].data


def test_nothing_is_wrong_with_the_example(made, few_exercises):
    assert problems(made) == []


def test_the_student_gets_a_stub_that_was_executed_and_failed_politely(made):
    stub = next(text for text in text_of(student_file(made)) if text.startswith("def safety_distance"))
    assert "\n    ...\n" in stub and "closing_speed" not in stub and "# solution" not in stub
    assert "Nothing to check yet" in result_of(student_file(made))["text/plain"]


def test_the_solved_notebook_has_the_solution_and_every_check_passes_strictly(made):
    texts = text_of(solved_file(made))
    assert "This notebook is solved" in texts[0] and any(text.startswith("check.strict()") for text in texts)
    assert any("    closing_speed = " in text and "# solution" not in text for text in texts)
    assert result_of(solved_file(made))["text/plain"].startswith("✓ Right.")


def test_neither_notebook_shows_what_is_for_the_instructor(made):
    for file in (student_file(made), solved_file(made)):
        assert not any("They say 4 m" in text for text in text_of(file))
        counts = [c.execution_count for c in nbformat.read(file, as_version=4).cells if c.cell_type == "code"]
        assert counts == list(range(1, len(counts) + 1))


def test_the_instructor_s_page_has_timings_questions_answers_and_misconceptions(made):
    page = instructor_file(made).read_text(encoding="utf-8")
    assert "| Round 1: how far is safe? | 8 | 5 |" in page and "**Time** 10 minutes." in page
    assert "> **Predict.** You drive 12 m/s" in page and "They say 4 m at once" in page
    assert "closing_speed = " in page and "## An exercise" not in page
    exercise = registry()["safety_distance"]
    assert all(mistake.says in page for mistake in exercise.mistakes)
    assert all(hint in page for hint in exercise.hints)


def test_text_is_refreshed_without_execution_and_code_is_not(copy):
    copy.write_text(EXAMPLE.replace("how far is safe", "what is safe"), encoding="utf-8")
    assert refresh_prose(copy) and problems(copy) == []
    assert result_of(solved_file(copy))["text/plain"].startswith("✓ Right.")
    copy.write_text(EXAMPLE.replace("import check, source", "import source, check"), encoding="utf-8")
    assert not refresh_prose(copy)


def test_a_solution_that_does_not_pass_stops_the_making(tmp_path):
    path = write_source(tmp_path, EXAMPLE.replace("min(v_current, v_new)", "max(v_current, v_new)"))
    with pytest.raises(CellExecutionError, match="speed of the faster car"):
        make(path)


# Spoilt ---------------------------------------------------------------------------------------------

SPOILT = {
    "a cell is too long": ("    # solution\n", "    # solution\n" + "    v_ego += 0\n" * 22, "longer than 25 lines"),
    "a mark has no partner": ("    # end solution\n", "", "`# solution` has no `# end solution`"),
    "a mark comes twice": ("    # solution\n", "    # solution\n    # solution\n", "do not come in pairs"),
    "an exercise is not registered": ("check.safety_distance(", "check.safe_distance(", "safe_distance: no such"),
    "an exercise of the lesson is not used": ("check.safety_distance(safety_distance)", "", "is not used in it"),
    "an exercise is another lesson's": ("check.safety_distance(", "check.critic_target(", "04_discrete_sac"),
    "check is not imported": ("import check, source", "import source", "has no `from bootcourse"),
    "it imports too much": ("import check, source", "import check, source" + "\nimport re" * 5, "more than 5 imports"),
    "a later cell imports": ("check.safety_distance(", "import math\ncheck.safety_distance(", "A later cell imports"),
    "a public name is dead": ("check.safety_distance(", "bc.nobody\ncheck.safety_distance(", "`bootcourse.nobody`"),
    "the announcement has other minutes": ("(5 min, ●○○)", "(9 min, ●○○)", "Exercise N.N (5 min, ●○○)"),
    "the stub has other arguments": ("v_new, t_safe, floor):", "v_new, floor, t_safe):", "other arguments than"),
    "the stub has no docstring": ('    """The gap', '    _ = """The gap', "no docstring"),
    "a name of code is dead": ("`bootcourse.rule.safety", "`bootcourse.rule.unsafety", "unsafety_distance` names"),
    "a shown source is dead": ('", "safety', '", "unsafety', "`bootcourse.rule.unsafety_distance`"),
    "text has changed": ("how far is safe", "what is safe", "03_the_rule.ipynb is out of date"),
    "a note for the instructor has changed": ("They say 4 m", "They say 5 m", "03_the_rule.md is out of date"),
    "a solution has changed": ("closing_speed", "closing", "solved/03_the_rule.ipynb is out of date"),
}  # fmt: skip


@pytest.mark.parametrize("old, new, words", SPOILT.values(), ids=SPOILT)
def test_it_is_found_when(copy, old, new, words):
    assert old in EXAMPLE
    copy.write_text(EXAMPLE.replace(old, new), encoding="utf-8")
    assert any(words in problem for problem in problems(copy)), problems(copy)


def test_it_is_found_when_an_exercise_has_no_solution(copy):
    copy.write_text(re.sub(r"    # (end )?solution\n", "", EXAMPLE), encoding="utf-8")
    assert "safety_distance: its cell has no `# solution`" in problems(copy)[0]


def test_a_solution_shown_on_request_must_be_the_source_s(few_exercises, tmp_path):
    text = """\
# %%
from bootcourse.course import check

# %% [markdown]
# # 7
# **Exercise 7.1 (5 min, ●●○).**

# %%
def soft_constraint(log_pi, rule_action, p):
    '''Docstring.'''
    # solution
    return log_pi
    # end solution

check.soft_constraint(soft_constraint)
"""
    assert problems(write_source(tmp_path, text, "07_soft_constraint")) == [
        "soft_constraint: the source's solution is not the one that check.solution shows."
    ]


def test_predictions_are_numbered_after_the_lesson_and_answered_at_its_end(few_exercises, tmp_path):
    text = """\
# %%
from bootcourse.course import compare_predictions, predict

# %%
predict("3.1", "Left?", ["yes", "no"])

# %%
predict("3.1", "Right?", ["yes", "no"])

# %%
predict("4.2", "How far?", unit="m")

# %%
compare_predictions("03", {"3.1": "yes"})
"""
    assert problems(write_source(tmp_path, text, "03_the_rule"))[-3:] == [
        "The prediction 4.2 does not begin with 3.",
        "There are two predictions 3.1.",
        "No compare_predictions answers 4.2.",
    ]


def spoil(file: Path, old: str, new: str) -> None:
    text = file.read_text(encoding="utf-8")
    assert old in text
    file.write_text(text.replace(old, new), encoding="utf-8")


def test_a_file_that_was_made_and_then_edited_is_found(copy):
    spoil(student_file(copy), '    ...\\n"', '    return 3\\n"')
    assert problems(copy) == ["notebooks/03_the_rule.ipynb is out of date: run make notebooks."]


def test_a_picture_without_alt_text_is_found(copy):
    assert of_pictures(copy) == []
    spoil(student_file(copy), '<div role=\\"status\\"', '<img src=\\"data:,\\"><div role=\\"status\\"')
    assert "without alt text" in of_pictures(copy)[0]
    assert has_alt({"text/html": f'<img src="data:," alt="{"words " * 7}">'})
    assert not has_alt({"text/html": '<img src="data:," alt="too short">'}) and not has_alt({"image/png": "…"})


# Pieces ---------------------------------------------------------------------------------------------


def test_each_solution_of_a_cell_becomes_dots_at_its_own_indent():
    text = "a\n    # solution\n    b\n    # end solution\nc\n# solution\nd\n# end solution"
    assert without_solution(text) == "a\n    ...\nc\n..."


def test_a_source_takes_the_solution_that_its_exercise_holds():
    text = """\
class ReplayBuffer:
    def __init__(self, size):
        # solution
        self.rows = []
        # end solution

    def sample(self, batch, rng):
        '''Rows drawn at random.'''
        # solution: the exercise's own


check.ReplayBuffer(ReplayBuffer)
"""
    assert without_solution(with_solutions(text)).count("        ...\n") == 2
    solved = without_marks(with_solutions(text))
    assert "        self.rows = []\n\n    def sample" in solved
    assert "random.'''\n        drawn = rng.integers(len(self.rows), size=batch)\n" in solved


def test_links_lead_to_the_same_place_from_a_folder_further_down():
    text = "[a](x.ipynb) [b](../y.md) [c](https://z.org) [d](#here) ![e](p.png)"
    assert one_folder_down(text) == "[a](../x.ipynb) [b](../../y.md) [c](https://z.org) [d](#here) ![e](../p.png)"


def test_a_widget_that_shows_a_picture_is_written_as_the_picture():
    def output(**data):
        return nbformat.v4.new_output("display_data", data={k.replace("_", "/"): v for k, v in data.items()})

    with_picture, alone = output(text_html="<img>"), output()
    with_picture.data[WIDGET] = alone.data[WIDGET] = {"model_id": "1"}
    kept = tidy([with_picture, alone])
    assert list(kept[0].data) == ["text/html"] and list(kept[1].data) == [WIDGET]
