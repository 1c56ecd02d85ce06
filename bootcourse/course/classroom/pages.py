"""The files of a grading: a table as CSV, a feedback page for each student, and one page about the class.

Every page is made with `markup.html`, which escapes what students wrote.
"""

import csv
import hashlib
import io
import os
import re
import sys
from collections import Counter
from collections.abc import Iterable, Sequence
from itertools import groupby
from pathlib import Path
from urllib.parse import quote

from bootcourse.course.classroom.grading import MISSING, Graduate, Judged, check_own
from bootcourse.course.classroom.sandbox import HOLDS
from bootcourse.course.classroom.submission import composed, fingerprint
from bootcourse.course.lessons import registry
from bootcourse.course.predictions import number_of, worded
from bootcourse.course.verdict import COLOURS, MARKS, marked
from bootcourse.errors import BootcourseError, described
from bootcourse.files import write_bytes
from bootcourse.markup import Markup, html, joined

STYLE = """<style>:root {color-scheme: light dark} small {opacity: 0.7}
body {font: 16px/1.5 system-ui, sans-serif; max-width: 900px; margin: 2em auto; padding: 0 1em}
h1, h2 {overflow-wrap: anywhere} h2 {margin-top: 1.6em; font-size: 1.2em}
table {border-collapse: collapse; width: 100%} .wide {overflow-x: auto}
th, td {text-align: left; vertical-align: top; padding: 4px 10px 4px 0; border-bottom: 1px solid #8886}
td:last-child {overflow-wrap: anywhere; min-width: 9em} code, pre {font: 13px/1.4 ui-monospace, monospace}
pre {white-space: pre-wrap; margin: 4px 0}</style>"""
MADE_BY = '<meta name="generator" content="bootcourse">'
WORDS = {"missing": "not handed in", "todo": "not written"}
LOOK_AT = {"did_not_run": "did not run", "broke": "our check broke off", "library": "the library's own, not counted"}
MOST = 12  # different answers to a prediction that are listed
NOT_ON_WINDOWS = re.compile(r'[<>:"|?*\\]')  # in the name of a file
LONGEST_NAME = 200  # bytes of a student's name in the name of a page; systems allow 255 in all


def check_places(out: Path, folder: Path) -> None:
    """Raise BootcourseError if the table cannot be `out`, or a file would replace one that is not a grading's."""
    if out.suffix != ".csv":
        raise BootcourseError(f"--out {out}: give the table a name that ends in .csv.")
    if folder.resolve() in out.resolve().parents:
        raise BootcourseError(f"{out} is among the submissions: write it elsewhere, such as --out ../{out.name}.")
    check_own(out, "id,name,points")
    for path in [out.with_suffix(".html"), *pages_of(out).glob("*.html")]:
        check_own(path, MADE_BY)


def pages_of(out: Path) -> Path:
    return out.with_name(f"{out.stem}-pages")


def write_report(graduates: Sequence[Graduate], out: Path, holds: list[str]) -> list[Path]:
    """Write them to `out`, the table, and beside it. Returns the table and the page about the class."""
    pages, index = pages_of(out), out.with_suffix(".html")
    write_csv(graduates, out)
    link, alike = {}, Counter(same_file(one.submission.student) for one in graduates)
    for one in graduates:
        student = one.submission.student
        name = f"{page_name(student, alone=alike[same_file(student)] == 1)}.html"
        write_bytes(pages / name, page_for(one).encode("utf-8", "replace"))
        link[student] = html('<a href="{}">{}</a>', quote(os.fsencode(f"{pages.name}/{name}")), student)
    write_bytes(index, class_page(graduates, link, holds).encode("utf-8", "replace"))
    return [out, index]


def page_name(student: str, alone: bool) -> str:
    """The student's name, which is the name of a file, as every system can write it.

    A name that is long, that holds what Windows does not allow, or that is not alone (see `same_file`) gets a hash,
    which makes it unique; of a long one the beginning stays.
    """
    name, portable = os.fsencode(student), NOT_ON_WINDOWS.sub("-", student)
    if portable == student and alone and len(name) <= LONGEST_NAME:
        return student
    return f"{os.fsdecode(os.fsencode(portable)[:LONGEST_NAME])}-{hashlib.sha256(name).hexdigest()[:8]}"


def same_file(student: str) -> str:
    """Names of which this is the same are one file on Windows or macOS, whose disks do not tell "Ada" from "ada"."""
    return composed(student).casefold()


def write_csv(graduates: Sequence[Graduate], path: Path) -> None:
    """id, name, points, then the points of each exercise: UTF-8, as spreadsheets read it."""
    text = io.StringIO()
    table = csv.writer(text)
    table.writerow(["id", "name", "points", *graduates[0].worth])
    for one in graduates:
        points = [f"{number:g}" for number in (one.total, *one.points.values())]
        table.writerow([harmless(one.submission.student), harmless(one.submission.name), *points])
    write_bytes(path, text.getvalue().encode("utf-8-sig", "replace"))


def harmless(text: str) -> str:
    """A text that a spreadsheet would take for a formula gets an apostrophe."""
    return f"'{text}" if text.startswith(("=", "+", "-", "@", "\t", "\r")) else text


# Parts of a page ------------------------------------------------------------------------------------


def page(title: str, *parts: Markup) -> Markup:
    """A whole page that asks the network for nothing."""
    head = '<meta charset="utf-8">{}<meta name="viewport" content="width=device-width"><title>{}</title>{}'
    head = html(head, Markup(MADE_BY), title, Markup(STYLE))
    whole = '<!doctype html><html lang="en"><head>{}</head><body><h1>{}</h1>{}</body></html>'
    return html(whole, head, title, joined(parts, "\n"))


def table(heading: str, columns: Iterable[str], rows: Iterable[Iterable]) -> Markup:
    head = joined(html('<th scope="col">{}</th>', column) for column in columns)
    body = joined(html("<tr>{}</tr>", joined(html("<td>{}</td>", cell) for cell in row)) for row in rows)
    whole = '<h2>{}</h2><div class="wide" tabindex="0"><table><tr>{}</tr>{}</table></div>'
    return html(whole, heading, head, body)


def bullets(heading: str, items: Sequence) -> Markup:
    """A list under a heading; nothing for no items."""
    listed = joined(html("<li>{}</li>", item) for item in items)
    return html("<h2>{}</h2><ul>{}</ul>", heading, listed) if items else Markup()


def code(names: Iterable[str]) -> Markup:
    return joined((html("<code>{}</code>", name) for name in names), ", ")


def by_lesson(exercises: Iterable[str]) -> Iterable[tuple[str, list[str]]]:
    """The heading of each lesson, and its exercises."""
    for lesson, names in groupby(exercises, lambda name: registry()[name].lesson):
        yield f"Lesson {int(lesson[:2])} ({lesson}.ipynb)", list(names)


# A student ------------------------------------------------------------------------------------------


def page_for(graduate: Graduate) -> Markup:
    """The student's page; if our own code cannot draw it, one that says so: the others get theirs."""
    try:
        return feedback(graduate)
    except Exception as error:  # our own code's
        said = html("<p>{:g} points. This page could not be made ({}).</p>", graduate.total, described(error))
        return page(f"Feedback for {graduate.submission.student}", said)


def feedback(graduate: Graduate) -> Markup:
    """What a student gets back: points and the check's words on each answer, lesson by lesson."""
    own, worth, points = graduate.submission, graduate.worth, graduate.points
    parts = [html("<p><strong>{:g} of {:g} points.</strong></p>", graduate.total, sum(worth.values()))]
    for heading, names in by_lesson(worth):
        rows = [
            [code([n]), f"{points[n]:g} of {worth[n]:g}", said(graduate.verdicts[n], own.answers.get(n, ""))]
            for n in names
        ]
        parts.append(table(heading, ("exercise", "points", "the check says"), rows))
    parts.append(bullets("What could not be read", own.problems))
    if own.time:
        parts.append(html("<p><small>Made {}.</small></p>", own.time))
    return page(f"Feedback for {own.name or own.student}", *parts)


def said(judged: Judged, answer: str) -> Markup:
    """The check's words, its numbers, and the answer itself if it is not right."""
    if judged.kind in WORDS:
        return html("<small>{}</small>", WORDS[judged.kind])
    numbers = html("<pre>{}</pre>", "\n".join(judged.details)) if judged.details else ""
    colour, mark = COLOURS.get(judged.kind, "inherit"), MARKS.get(judged.kind, "")
    own = html("<details><summary>your code</summary><pre>{}</pre></details>", answer)
    own = own if judged.kind != "passed" else ""
    return html('<span style="color: {}">{}</span> {}{}{}', colour, mark, marked(judged.sentence), numbers, own)


# The class ------------------------------------------------------------------------------------------


def class_page(graduates: Sequence[Graduate], link: dict[str, Markup], holds: list[str]) -> Markup:
    """Who has how many points, what to look at, what failed whom, and what the class predicted.

    link: student -> a link to the feedback page; holds: what shut the answers in.
    """
    worth = graduates[0].worth
    most = sum(worth.values())
    head = html(
        "<p>{} submissions, {} exercises, {:g} points. {}</p>", len(graduates), len(worth), most, shut_in(holds)
    )
    students = [(link[one.submission.student], one.submission.name, f"{one.total:g}") for one in graduates]
    if broke := sum(len(one.of_kind("broke")) for one in graduates):
        words = (
            "<p><strong>Our own check broke off on {} answers.</strong> They have no points, and may be right: "
            "see below. Please send them to those who make the course.</p>"
        )
        head = joined([head, html(words, broke)])
    parts = [head, table("Students", ("id", "name", "points"), students)]
    parts.append(bullets("To look at", to_look_at(graduates, link)))
    for heading, names in by_lesson(worth):
        rows = [row_of(name, graduates, link) for name in names]
        parts.append(table(heading, ("exercise", "right", "not written", "wrong", "known mistakes"), rows))
    if predicted := prediction_rows(graduates):
        parts.append(table("Predictions", ("", "question", "answers"), predicted))
    return page("The class", *parts)


def shut_in(holds: list[str]) -> str:
    """A sentence about what the answers could reach while they were judged; nothing if nothing was judged."""
    if not holds and sys.platform == "linux":
        return ""
    if missing := [words for what, words in HOLDS.items() if what not in holds]:
        return f"On this system an answer could {', and '.join(missing)} while it was judged."
    return "Answers were judged without network and processes; they could write to a folder in memory."


def row_of(exercise: str, graduates: Sequence[Graduate], link: dict[str, Markup]) -> list:
    """An exercise: how many are right, whose answers are wrong, and which mistakes how many make."""
    verdicts = {one.submission.student: one.verdicts[exercise] for one in graduates}
    right = sum(judged.kind == "passed" for judged in verdicts.values())
    wrong = {student: judged for student, judged in verdicts.items() if judged.kind in ("wrong", "did_not_run")}
    known = Counter(judged.sentence for judged in wrong.values() if judged.is_known)
    mistakes = [html("{} ({})", marked(sentence), count) for sentence, count in known.most_common()]
    if others := len(wrong) - known.total():
        mistakes.append(html("<small>another ({})</small>", others))
    for kind, words in {"library": "the library's own, not counted", "broke": "our check broke off"}.items():
        if count := sum(judged.kind == kind for judged in verdicts.values()):
            mistakes.append(html("<small>{} ({})</small>", words, count))
    students = joined((link[student] for student in wrong), ", ")
    return [
        code([exercise]),
        f"{right} of {len(verdicts)}",
        str(sum(judged.kind in WORDS for judged in verdicts.values())),
        students,
        joined(mistakes, "<br>"),
    ]


def to_look_at(graduates: Sequence[Graduate], link: dict[str, Markup]) -> list[Markup]:
    """What a lecturer should look at, a sentence each."""
    items = []
    for one in graduates:
        own, sentences = one.submission, list(one.submission.problems)
        if own.exercises not in ("", fingerprint()):
            sentences.append("made with another version of the exercises.")
        if not own.written:
            sentences.append("no answer written.")
        for kind, words in LOOK_AT.items():
            if names := one.of_kind(kind):
                sentences.append(html("{}: {}.", words, code(names)))
        elsewhere = [name for name in own.right if one.verdicts.get(name, MISSING).kind not in ("passed", "missing")]
        if elsewhere:
            sentences.append(html("right in the notebook, not here: {}.", code(elsewhere)))
        items += [html("{}: {}", link[own.student], sentence) for sentence in sentences]
    return items


def prediction_rows(graduates: Sequence[Graduate]) -> list[list]:
    """A row for each prediction: its question, and how many gave which answer, the most frequent first."""
    answers, questions = {}, {}
    for one in graduates:
        for name, given in one.submission.predictions.items():
            answers.setdefault(name, Counter())[worded(given.answer, given.unit)] += 1
            questions.setdefault(name, given.question)
    rows = []
    for name in sorted(answers, key=lambda name: [part.zfill(3) for part in number_of(name).split(".")]):
        shown = [html("{} ({})", answer[:200], count) for answer, count in answers[name].most_common(MOST)]
        rows.append([number_of(name), questions[name], joined(shown, "<br>")])
    return rows
