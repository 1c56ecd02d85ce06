"""The pages for lecturers: their minutes are the lessons' own, and the exam is in the instructor's edition alone."""

import functools
import re

import pytest

from bootcourse.course.lessons import LESSONS, number, stem
from tools import book
from tools.course import claims
from tools.course.known import minutes
from tools.course.numbering import resolved

TEACHING = book.ROOT / "book/teaching"
EXAM = (TEACHING / "exam.md").read_text(encoding="utf-8")


@functools.cache
def plans() -> str:
    """The page of plans, with its numbers."""
    text = (TEACHING / "plans.md").read_text(encoding="utf-8")
    return resolved(claims.fill_in(book.INSTRUCTOR.sub("", text)), "../lessons/")


def rows(heading: str) -> list[list[str]]:
    """The cells of the table below a heading, without its head."""
    lines = re.search(rf"^## {heading}\n.*?(?=^## |\Z)", plans(), re.M | re.S)[0].splitlines()
    return [[cell.strip(" *") for cell in line.strip("|").split("|")] for line in lines if line.startswith("|")][2:]


def lessons_in(text: str) -> list[str]:
    files = {stem(name): name for name in LESSONS}
    return [files[file] for file in re.findall(r"\(\.\./lessons/(\w+)\.ipynb\)", text)]


@pytest.mark.parametrize(("heading", "cell"), [("One week", 1), ("One term", 2)])
def test_a_plan_has_every_lesson_once_and_its_minutes(heading, cell):
    *parts, total = rows(heading)
    named = [name for part in parts for name in lessons_in(part[cell])]
    assert not set(LESSONS) - set(named), f"plans.md, '{heading}', lacks {set(LESSONS) - set(named)}: add them to a row"
    assert sorted(named) == sorted(LESSONS), f"plans.md, '{heading}', names a lesson twice"
    for part in parts:
        assert int(part[cell + 1]) == minutes(*lessons_in(part[cell])), part
    assert sum(int(part[cell + 1]) for part in parts) == int(total[cell + 1])


@pytest.mark.parametrize(("route", "shown"), [("evening", "| an evening | "), ("week", "| a week | ")])
def test_the_readme_says_how_long_a_route_is_and_which_lessons_it_has(route, shown):
    [row] = [line for line in (book.ROOT / "README.md").read_text(encoding="utf-8").splitlines() if shown in line]
    known = claims.names("start")
    whole = [number(name) for name, part in known["ROUTES"][route].items() if part == known["ALL"]]
    named = f"0 to {whole[-1]}" if len(whole) > 5 else f"{', '.join(map(str, [0, *whole[:-1]]))} and {whole[-1]}"
    assert f"lessons {named}:" in row and f"({known['hours'](route)} hours)" in row


def test_the_evening_and_the_homework_add_up_and_a_meeting_fits_into_90_minutes():
    *parts, total = rows("One evening")
    assert sum(int(part[1]) for part in parts) == int(total[1])
    *weeks, total = rows("One term")
    assert sum(int(week[4]) for week in weeks) == int(total[4])
    assert [week[0] for week in weeks if int(week[3]) - int(week[4]) > 90] == []


def test_the_board_has_a_sketch_for_every_lesson_in_their_order():
    sketches = rows("The board and one question for each lesson")
    drawn = [name for row in sketches for name in lessons_in(row[0])]
    assert drawn == list(LESSONS), f"plans.md's board has no row for {set(LESSONS) - set(drawn)}, or another order"
    assert sketches[0][0].startswith(f"[{number(LESSONS[0])}]")


def test_each_of_twenty_questions_has_an_answer_and_five_points():
    questions = re.split(r"^### \d+\. ", EXAM, flags=re.M)[1:]
    assert len(questions) == 20 and all("**Answer.**" in question for question in questions)
    rubrics = [question.split("**Points.**")[1] for question in questions]
    assert [sum(map(int, re.findall(r"\([a-d]\)\s(\d)", rubric))) for rubric in rubrics] == [5] * 20


@pytest.mark.parametrize("edition", ["student", "instructor"])
def test_the_exam_and_what_leads_to_solutions_are_in_the_instructor_s_edition_alone(edition, tmp_path, monkeypatch):
    monkeypatch.setattr(claims, "claims_page", lambda: "# Claims\n")
    monkeypatch.setattr("bootcourse.web.build.main", lambda arguments: None)
    book.gather(tmp_path / "source", edition)
    pages = [tmp_path / "source" / name for name in ("index.md", *(f"teaching/{p.name}" for p in TEACHING.iterdir()))]
    there = [page for page in pages if page.exists()]
    text = "".join(page.read_text(encoding="utf-8") for page in there if page.name != "exam.md")
    of_the_instructor = edition == "instructor"
    assert (tmp_path / "source/teaching/exam.md").exists() == of_the_instructor
    assert ("teaching/exam" in text) == ("lessons/instructor/" in text) == of_the_instructor
    assert "<!-- instructor -->" not in text
