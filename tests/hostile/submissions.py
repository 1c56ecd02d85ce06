"""Hand in damaged submissions and notebooks, and see whether one of them stops the class.

Each is a valid one with a few changes: a value of another type, a text that is cut, repeated or strange, a byte that
is lost. They are read, given the verdict "wrong", and shown on the pages; answers are not executed.
"""

import json
import random
import tempfile
import time
from pathlib import Path

from bootcourse.course.classroom.grading import Judged, Verdicts, graded, handed_out, key_of, points_of
from bootcourse.course.classroom.pages import write_report
from bootcourse.course.classroom.submission import Submission, collect
from bootcourse.errors import BootcourseError

PATIENCE = 20  # seconds
CELL = "def luck(good, decisions, tries):\n    n = 9\n    return (good / n) ** decisions\n\ncheck.luck(luck)"
SAYS = {"output_type": "execute_result", "data": {"text/plain": ["✓ Right."]}}
NOTEBOOK = {
    "cells": [{"cell_type": "code", "source": source, "outputs": [SAYS]}
              for source in ("%time x = 1", "k = {}\nk['a'] = 1", CELL, "luck?", "x = !ls", "def luck(a:\n")],
    "metadata": {}, "nbformat": 4,
}  # fmt: skip
HANDED_IN = {
    "format": Submission.FORMAT, "name": "Ada", "time": "2030-01-01", "lessons": ["values"],
    "exercises": "a", "answers": {"luck": CELL}, "right": ["luck"], "problems": ["a"],
    "predictions": {"the_barrier.1": {"answer": 3.5, "question": "Why?", "unit": "m"}},
}  # fmt: skip
STRANGE = (
    None, True, 5, -1, 1e308, [], {}, "", "\x00", "\ud800", "\u2028\x0c", "<script>", "{}", "%s", "=1+1", "../..",
    "!ls\n" * 50, "\n" * 60_000, "x = 1\n" * 3000, "(" * 9000, "1+" * 9000 + "1", "lambda: " * 3000 + "0",
    "def luck(): return " + "-" * 5000, "luck.a" + ".b" * 9000 + " = 1", [[[[[]]]]], {"": {"": {}}}, ["luck"] * 300,
)  # fmt: skip


def changed(value, draw: random.Random):
    """The value with one change somewhere in it."""
    if isinstance(value, dict) and value and draw.random() < 0.85:
        key = draw.choice(list(value))
        rest = {name: part for name, part in value.items() if name != key}
        new = draw.choice((key, key, key, str(draw.choice(STRANGE))))
        return rest if draw.random() < 0.1 else rest | {new: changed(value[key], draw)}
    if isinstance(value, list) and value and draw.random() < 0.85:
        place = draw.randrange(len(value))
        return [*value[:place], changed(value[place], draw), *value[place + draw.randrange(2) :]]
    if isinstance(value, str) and draw.random() < 0.5:
        place, piece = draw.randrange(len(value) + 1), draw.choice([each for each in STRANGE if isinstance(each, str)])
        return value[:place] + piece + value[place + draw.randrange(5) :]
    return draw.choice(STRANGE)


def case(draw: random.Random) -> tuple[str, bytes]:
    """The name of a file, and what is in it."""
    name, value = draw.choice((("ada.ipynb", NOTEBOOK), ("ada.json", HANDED_IN)))
    for _ in range(draw.randrange(1, 5)):
        value = changed(value, draw)
    data = json.dumps(value).encode()
    if draw.random() < 0.1:
        place = draw.randrange(len(data))
        data = data[:place] + draw.randbytes(2) + data[place + draw.randrange(9) :]
    return name, data


def read_and_shown(name: str, data: bytes, folder: Path) -> int:
    """Read it as the submission of a class, and write the pages. Returns how many answers it has."""
    for path in (folder / "class").glob("*"):
        path.unlink()
    (folder / "class").mkdir(exist_ok=True)
    (folder / "class" / name).write_bytes(data)
    (one,) = collect(folder / "class")
    worth, verdicts = points_of(handed_out([one])), Verdicts(folder / "none.jsonl")
    verdicts.known |= {key_of(*answer): Judged("wrong", "No.") for answer in one.answers.items()}
    write_report([graded(one, worth, verdicts)], folder / "out.csv", [])
    return len(one.answers)


def failures(cases: int, seed: int) -> tuple[int, list[str]]:
    """(how many had an answer that was read, a line for each that raised an error or took too long)."""
    draw, answered, lines = random.Random(seed), 0, []
    with tempfile.TemporaryDirectory() as folder:
        for number in range(cases):
            name, data = case(draw)
            begin = time.monotonic()
            try:
                answered += bool(read_and_shown(name, data, Path(folder)))
            except BootcourseError as error:  # one sentence, but a student must not stop the class
                lines.append(f"{number} {name}: {error}"[:300])
            except Exception as error:  # what this command looks for
                lines.append(f"{number} {name}: {type(error).__name__} {error}"[:300])
            if (seconds := time.monotonic() - begin) > PATIENCE:
                lines.append(f"{number} {name}: {seconds:.0f} s")
    return answered, lines
