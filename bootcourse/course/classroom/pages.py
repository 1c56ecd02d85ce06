"""Pages as HTML files: feedback for each student, and one page about the class. Whatever students wrote is escaped."""

from collections import Counter, defaultdict
from collections.abc import Sequence
from html import escape
from itertools import groupby

from bootcourse.course.classroom.grading import Graduate, did_not_run, identical, other_versions
from bootcourse.course.lessons import registry
from bootcourse.course.predictions import worded
from bootcourse.course.verdict import COLOURS, MARKS, marked

STYLE = """body {font: 16px/1.5 system-ui, sans-serif; max-width: 900px; margin: 2em auto; padding: 0 1em;
  color: #1F2933; background: white}
h2 {margin-top: 1.6em; font-size: 1.2em} table {border-collapse: collapse; width: 100%}
th, td {text-align: left; vertical-align: top; padding: 4px 10px 4px 0; border-bottom: 1px solid #E3E7EB}
td:last-child {overflow-wrap: anywhere; min-width: 9em}
.wide {overflow-x: auto} .short {width: auto} code, pre {font: 13px/1.4 ui-monospace, monospace}
pre {white-space: pre-wrap; overflow-wrap: anywhere; margin: 4px 0} small {color: #5F6B77}
.bar {background: #0072B2; height: 12px; border-radius: 2px} .of {background: #E3E7EB; border-radius: 2px; width: 120px}
@media (max-width: 520px) {.of {width: 60px} body {font-size: 15px}}
@media (prefers-color-scheme: dark) {body {background: #14181D; color: #E3E7EB} th, td {border-color: #38424D}
  .of {background: #38424D} small {color: #9AA5B1}}"""
WORDS = {"missing": "not handed in", "todo": "not written"}
MOST = 12  # answers to a prediction that get a bar of their own


def page(title: str, *parts: str) -> str:
    """A whole page that asks the network for nothing."""
    head = f'<meta charset="utf-8"><meta name="viewport" content="width=device-width"><title>{escape(title)}</title>'
    body = "\n".join(part for part in parts if part)
    return (
        f'<!doctype html><html lang="en"><head>{head}<style>{STYLE}</style></head><body><h1>{escape(title)}</h1>{body}'
    )


def table(headings: Sequence[str], rows: Sequence[Sequence[str]]) -> str:
    """Cells are HTML."""
    head = "".join(f'<th scope="col">{heading}</th>' for heading in headings)
    body = "".join(f"<tr>{''.join(f'<td>{cell}</td>' for cell in row)}</tr>" for row in rows)
    return f'<div class="wide" tabindex="0"><table><thead><tr>{head}</tr></thead><tbody>{body}</tbody></table></div>'


def bullets(heading: str, items: Sequence[str]) -> str:
    """A list under a heading; nothing for no items. Items are HTML."""
    return f"<h2>{heading}</h2><ul>{''.join(f'<li>{item}</li>' for item in items)}</ul>" if items else ""


# A student ------------------------------------------------------------------------------------------


def feedback(graduate: Graduate, points: dict[str, float]) -> str:
    """What a student gets back: points and the check's words on each answer, lesson by lesson."""
    own = graduate.submission
    parts = [f"<p><strong>{graduate.points:g} of {sum(points.values()):g} points.</strong></p>"]
    for lesson, grades in groupby(graduate.grades, lambda grade: registry()[grade.exercise].lesson):
        rows = [
            [f"<code>{grade.exercise}</code>", f"{grade.points:g} of {points[grade.exercise]:g}", said(grade)]
            for grade in grades
        ]
        parts.append(f"<h2>{title_of(lesson)}</h2>" + table(("exercise", "points", "the check says"), rows))
    parts.append(bullets("What could not be read, or did not run", [escape(problem) for problem in own.problems]))
    if own.made:
        late = " That is after the deadline." if own.late else ""
        parts.append(f"<p><small>Handed in {escape(own.made)}.{late}</small></p>")
    return page(f"Feedback for {own.name or own.student}", *parts)


def said(grade) -> str:
    """The check's words, and its numbers."""
    if grade.kind in WORDS:
        return f"<small>{WORDS[grade.kind]}</small>"
    numbers = f"<pre>{escape(chr(10).join(grade.details))}</pre>" if grade.details else ""
    mark = f'<span style="color: {COLOURS.get(grade.kind, "inherit")}">{MARKS.get(grade.kind, "")}</span>'
    return f"{mark} {marked(grade.sentence)}{numbers}"


def title_of(lesson: str) -> str:
    """ "07_soft_constraint" -> "Lesson 7: soft constraint" """
    return f"Lesson {int(lesson[:2])}: {lesson[3:].replace('_', ' ')}"


# The class ------------------------------------------------------------------------------------------


def class_page(graduates: Sequence[Graduate], points: dict[str, float], files: dict[str, str], holds: str) -> str:
    """Which exercise failed whom, the mistakes behind it, what to look at, and what the class predicted.

    files: student -> the file of the feedback page; holds: a sentence about what shut the judging in.
    """
    link = {student: f'<a href="{escape(file)}">{escape(student)}</a>' for student, file in files.items()}
    most = sum(points.values())
    parts = [f"<p>{len(graduates)} submissions, {len(points)} exercises, {most:g} points. {escape(holds)}</p>"]
    ranked = [[link[one.submission.student], escape(one.submission.name), bar(one.points, most),
               f"{one.points:g}"] for one in graduates]  # fmt: skip
    parts += ["<h2>Students</h2>", table(("id", "name", "", "points"), ranked), to_look_at(graduates, link)]
    for lesson, names in groupby(points, lambda name: registry()[name].lesson):
        rows = [row_of(name, graduates, link) for name in names]
        headings = ("exercise", "right", "", "wrong", "what the check told them")
        parts.append(f"<h2>{title_of(lesson)}</h2>" + table(headings, rows))
    parts.append(histograms([one.submission.predictions for one in graduates]))
    return page("The class", *parts)


def bar(value: float, most: float) -> str:
    share = 100 * value / most if most else 0
    return f'<div class="of"><div class="bar" style="width: {share:.0f}%"></div></div>'


def row_of(exercise: str, graduates: Sequence[Graduate], link: dict[str, str]) -> list[str]:
    """An exercise: how many are right, whose answers are wrong, and the mistakes by how many make them."""
    grades = {one.submission.student: grade for one in graduates for grade in one.grades if grade.exercise == exercise}
    right = sum(grade.passed for grade in grades.values())
    wrong = [student for student, grade in grades.items() if grade.kind in ("wrong", "did_not_run")]
    mistakes = Counter(grade.sentence for grade in grades.values() if grade.known)
    others = len(wrong) - sum(mistakes.values())
    told = [f"{escape(sentence)} ({count})" for sentence, count in mistakes.most_common()]
    told += [f"<small>no known mistake ({others})</small>"] * bool(others)
    return [f"<code>{exercise}</code>", f"{right}&nbsp;of&nbsp;{len(grades)}", bar(right, len(grades)),
            ", ".join(link[student] for student in wrong), "<br>".join(told)]  # fmt: skip


def to_look_at(graduates: Sequence[Graduate], link: dict[str, str]) -> str:
    """What a lecturer should look at: unreadable, from another version, did not run, late, identical."""
    submissions = [one.submission for one in graduates]
    items = [f"{link[s.student]}: {escape(problem)}" for s in submissions for problem in s.problems]
    items += [
        f"{link[student]}: made with another version of the exercises." for student in other_versions(submissions)
    ]
    items += [f"{link[one.submission.student]}: did not run: {', '.join(f'<code>{n}</code>' for n in names)}."
              for one in graduates if (names := did_not_run(one))]  # fmt: skip
    items += [f"{link[s.student]}: handed in after the deadline." for s in submissions if s.late]
    items += [f"{', '.join(link[s] for s in group)}: identical in all but spaces." for group in identical(submissions)]
    items += [f"{link[one.submission.student]}: <code>{g.exercise}</code> could not be judged: grade again."
              for one in graduates for g in one.grades if g.kind == "unjudged"]  # fmt: skip
    empty = [link[one.submission.student] for one in graduates if not one.submission.written]
    items += [f"{', '.join(empty)}: no answer written."] * bool(empty)
    return bullets("To look at", items)


def histograms(classes: Sequence[dict[str, dict]]) -> str:
    """A histogram of each prediction's answers, or "" without any. classes: {number: prediction} of each student."""
    answers, asked = defaultdict(Counter), {}
    for own in classes:
        for number, one in own.items():
            answers[number][worded(one["answer"], one.get("unit"))] += 1
            asked.setdefault(number, one["question"])
    if not answers:
        return ""
    order = sorted(answers, key=lambda number: tuple(map(int, number.split("."))))
    return "<h2>Predictions</h2>" + "".join(histogram(number, asked[number], answers[number]) for number in order)


def histogram(number: str, question: str, answers: Counter) -> str:
    """Bars, the most frequent answer first; those that stand alone at the end are counted together."""
    total, rows = sum(answers.values()), []
    for answer, count in answers.most_common(MOST):
        rows.append(f"<tr><td>{bar(count, total)}</td><td>{count}</td><td>{escape(answer[:200])}</td></tr>")
    rest = sum(count for _, count in answers.most_common()[MOST:])
    rows += [f"<tr><td></td><td>{rest}</td><td><small>other answers</small></td></tr>"] * bool(rest)
    head = f"<p><strong>{number}</strong> {escape(question)}</p>"
    return f'{head}<table class="short">{"".join(rows)}</table>'


def file_names(graduates: Sequence[Graduate]) -> dict[str, str]:
    """Student -> a file name of letters and digits, each another."""
    found, times = {}, defaultdict(int)
    for one in graduates:
        student = one.submission.student
        plain = "".join(letter if letter.isascii() and letter.isalnum() else "-" for letter in student).strip("-")[:60]
        plain = plain.lower() or "student"
        times[plain] += 1
        found[student] = f"{plain}{f'-{times[plain]}' if times[plain] > 1 else ''}.html"
    return found
