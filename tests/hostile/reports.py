"""Forge the reports of answers, and see whether one of them stops the judge.

An answer can find the function that sends its report and send its own. No process is started here: the judge is given
reports that are right in part, of other types and shapes, with numbers that are too large or no numbers.
"""

import random
from unittest.mock import patch

import numpy as np

from bootcourse.course import runner
from bootcourse.course.judge import LONGEST, judge, outcomes
from bootcourse.course.lessons import registry
from bootcourse.course.runner import Report, decoder, encoder
from bootcourse.course.values import Plain

SHAPES = (), (0,), (3,), (2, 3), (9,), (4, 9)
FACTORS = 1.0, 1.0, -1.0, 0.0, 1e9, np.inf, np.nan


def strange(draw: random.Random, depth: int = 0) -> Plain:
    """A value that no honest answer needs to have."""
    kind = draw.choice(("tensor", "array", "number", "text", "tuple", "list", "NoneType", "x" * 5000))
    if kind in ("tuple", "list"):
        return Plain(kind, parts=tuple(strange(draw, depth + 1) for _ in range(draw.randrange(4) * (depth < 3))))
    if kind in ("tensor", "array", "number"):
        return Plain(kind, np.full(draw.choice(SHAPES), draw.choice(FACTORS)))
    return Plain(kind, text=draw.choice((None, "y" * 5000)))


def changed(value: Plain, draw: random.Random) -> Plain:
    """A right value with some numbers changed."""
    if value.parts is not None:
        return Plain(value.kind, parts=tuple(changed(part, draw) for part in value.parts))
    with np.errstate(all="ignore"):
        return value if value.array is None else Plain(value.kind, value.array * draw.choice(FACTORS))


def forged(exercise, times: int, draw: random.Random) -> Report:
    right = outcomes(exercise, exercise.solution) * times
    answers = [draw.choice((one, changed(one, draw), strange(draw))) for one in right]
    report = Report(answers[: draw.choice((len(answers), len(answers), 1, 0))] * draw.choice((1, 1, 2)))
    if draw.random() < 0.3:
        report.error = draw.choice(("E", "NotAsAsked", "MemoryError")), "t" * 9000, draw.choice((None, -5, 0, 10**12))
    if draw.random() < 0.3:
        report.changed = draw.choice((-1, 0, 99)), draw.choice((-3, 0, 99))
    if draw.random() < 0.3:
        report.printed = "p" * 9000
    return decoder.decode(encoder.encode(report))


def failures(cases: int, seed: int) -> list[str]:
    """A line for each that raised an error, or whose verdict is too long to show."""
    draw, lines, names = random.Random(seed), [], list(registry())
    with patch.object(
        runner, "run", lambda exercise, answer, seconds, times=1, begin=None: forged(exercise, times, draw)
    ):
        for number in range(cases):
            exercise = registry()[draw.choice(names)]
            try:
                verdict = judge(exercise, f"def {exercise.call}:\n    return 1\n")
                if max(map(len, (verdict.sentence, *verdict.details))) > LONGEST:
                    lines.append(f"{number} {exercise.name}: a verdict without an end")
            except Exception as error:  # what this command looks for
                lines.append(f"{number} {exercise.name}: {type(error).__name__} {error}"[:300])
    return lines
