"""Commands for a class: handout, submit, grade."""

import re
import sys
from pathlib import Path

import typer

from bootcourse.cli.places import ask_for
from bootcourse.cli.training import INTERRUPTED
from bootcourse.errors import BootcourseError
from bootcourse.processes import usable_processors

NOT_ALL = 1  # exit status of a grading in which our own check broke off on an answer


def submit(
    name: str = typer.Option(..., prompt="Your name or student number", help="Your name or student number."),
    folder: Path = typer.Argument(Path("."), help="The folder with your notebooks."),
    out: Path | None = typer.Option(None, help="The file to write; by default submission-NAME.json in the folder."),
) -> None:
    """Put your answers and predictions into one file to hand in. Nothing is run."""
    from bootcourse.course.classroom.submission import around, prediction_files
    from bootcourse.course.classroom.submission import submit as write
    from bootcourse.course.predictions import FILE

    path, submission = write(folder, name, out)
    written = submission.written
    print(path)
    print(f"Answers: {len(written)}. Predictions: {len(submission.predictions)}.", end=" ")
    print("Hand in this file." if written else "No exercise is answered yet.")
    if found := prediction_files(folder, around(folder)):
        print(f"The predictions are those of {' and '.join(map(str, found))}.")
    else:
        looked = " or ".join(map(str, around(folder)))
        print(f"No predictions were found: there is no {FILE} in {looked}.")
    print(*submission.problems, sep="\n", end="\n" * bool(submission.problems))


def grade(
    folder: Path = typer.Argument(..., help="A file or a folder for each student: submissions or notebooks."),
    out: Path = typer.Option(Path("grades.csv"), help="The table to write; more is written beside it."),
    lessons: str = typer.Option("", help="Only these lessons, such as 2-7; by default those that were handed out."),
    workers: int = typer.Option(0, min=0, help="Answers judged at once; 0: one for each core that may be used."),
) -> None:
    """Judge every answer of a class again; write tables, a page for each student and one for the class.

    The exit status is 1 if our own check broke off on an answer: the pages say on which.
    """
    from bootcourse.course.classroom.grading import Verdicts, graded, handed_out, judge_all, points_of
    from bootcourse.course.classroom.pages import check_places, write_report
    from bootcourse.course.classroom.submission import collect

    check_places(out, folder)
    ask_for(out)
    submissions, chosen = collect(folder), read_lessons(lessons)
    worth = points_of(chosen or handed_out(submissions))
    verdicts = Verdicts(out.with_name(f"{out.stem}-verdicts.jsonl"))
    try:
        holds = judge_all(submissions, list(worth), verdicts, workers or usable_processors())
    except KeyboardInterrupt:
        print("Interrupted. Verdicts are kept: start the same command again to continue.", file=sys.stderr)
        raise typer.Exit(INTERRUPTED) from None
    graduates = [graded(one, worth, verdicts) for one in submissions]
    for path in write_report(graduates, out, holds):
        print(path)
    for one in submissions:
        if one.problems:
            more = f" (and {len(one.problems) - 1} more)" if len(one.problems) > 1 else ""
            words = f"{one.student}: not all could be read. {one.problems[0]}{more}"
            print("".join(each if each.isprintable() else "?" for each in words), file=sys.stderr)
    broke = [f"{name} of {one.submission.student}" for one in graduates for name in one.of_kind("broke")]
    if broke:
        print(f"Our own check broke off on {len(broke)} answers, which have no points and may be right: "
              f"{', '.join(broke[:5])}{' ...' * (len(broke) > 5)}. {out.with_suffix('.html')} shows what to send us.",
              file=sys.stderr)  # fmt: skip
        raise typer.Exit(NOT_ALL)


def handout(
    folder: Path = typer.Argument(..., help="The folder to write; FOLDER.zip is written beside it."),
    lessons: str = typer.Option("", help="Only these lessons, such as 2-7 or 1,5,7."),
    solutions: bool | None = typer.Option(None, help="Let `check.solution` show solutions; by default it does not."),
    update: bool = typer.Option(False, "--update", help="Bring this handout up to date; what was changed stays."),
) -> None:
    """Write what students get: lessons, the kit, a lock and one page. The kit's checks hold right answers."""
    from bootcourse.course.classroom import handout

    chosen = read_lessons(lessons)
    if update:
        said = handout.update(folder, chosen, solutions)
    else:
        said = handout.write(folder, chosen, bool(solutions))
    print(*said, sep="\n")


def read_lessons(text: str) -> set[int] | None:
    """ "2-7" or "1,5,7" as numbers; "" is None, all lessons. Raises BootcourseError for what is no lesson."""
    from bootcourse.course.lessons import LESSONS

    if not text:
        return None
    parts = [re.fullmatch(r"(\d{1,4})(?:-(\d{1,4}))?", part.strip()) for part in text.split(",")]
    numbers = {n for part in parts if part for n in range(int(part[1]), int(part[2] or part[1]) + 1)}
    if not numbers or not all(parts):
        raise BootcourseError(f"--lessons {text}: give numbers of lessons, such as 2-7 or 1,5,7.")
    if max(numbers) >= len(LESSONS):
        raise BootcourseError(f"--lessons {text}: there is no lesson {max(numbers)}, the last is {len(LESSONS) - 1}.")
    return numbers
