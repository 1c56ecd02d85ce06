"""What students might write: for each exercise right answers in other styles, and wrong ones beside its mistakes.

They stand in the lesson's folder, answers.py. `@right("name")` marks an answer that must pass,
`@wrong("name", "words")` one that must not; the words must then stand in the check's sentence. Without
words any sentence will do. A known mistake of the exercise is tested itself and belongs here only in another style; a
constant, a sign or a mean that is another is tried by `tests/mutants.py`.

Short answers stand in a table, `right_lines` or `wrong_lines`: the exercise's name, then for each answer what it is,
a colon, and its statements, the last of which is what it returns. Its arguments have the exercise's names; `solution`
is the exercise's own. The words, after " # ", come last.

    wrong_lines('''luck
        per cent: 100 * solution(good, decisions, tries)
        the others: once = (good / 9) ** decisions; 1 - once  # the words
    ''')
"""

import ast
import faulthandler
import importlib
import linecache
import re
import sys
import textwrap
import warnings
from collections import defaultdict
from collections.abc import Callable, Iterator
from types import FunctionType

import cloudpickle

from bootcourse.course import answer_process, runner
from bootcourse.course.lessons import LESSONS, registry
from tools.course.numbering import LESSON_FOLDERS

RIGHT: dict[str, list[Callable]] = defaultdict(list)
EQUIVALENT: dict[str, dict[str, str]] = defaultdict(dict)
WRONG: dict[str, list[tuple[Callable, str]]] = defaultdict(list)


def right(exercise: str):
    def note(function):
        RIGHT[exercise].append(function)
        return function

    return note


def wrong(exercise: str, words: str = ""):
    def note(function):
        WRONG[exercise].append((function, words))
        return function

    return note


IMPORTS = """
import math
import statistics
import numpy as np
import torch
from scipy import optimize, stats
from torch.nn import functional
import bootcourse as bc
from bootcourse.learn.bootstrap import kl_to_rule
from bootcourse.course.lessons.demonstrations import cloning
from bootcourse.course.lessons.values import chain
from bootcourse.course.lessons.your_teacher.example_teachers import watchful
"""  # for the tables


def right_lines(table: str) -> None:
    for exercise, function, _ in answers_of(table, sys._getframe(1).f_globals):
        right(exercise)(function)


def wrong_lines(table: str) -> None:
    for exercise, function, words in answers_of(table, sys._getframe(1).f_globals):
        wrong(exercise, words)(function)


def answers_of(table: str, module: dict) -> Iterator[tuple[str, Callable, str]]:
    """(exercise, function, words) of a table. module: the names that its answers may use besides the imports'."""
    exercise, rows = table.split("\n", 1)
    known = registry()[exercise]
    space = {"__name__": "__main__", "solution": getattr(known.solution, "py_func", known.solution)}  # as in a notebook
    exec(IMPORTS, space)
    for row in re.split(r"\n(?=\S)", textwrap.dedent(rows).strip()):
        row, _, words = row.partition(" # ")
        head, _, rest = row.partition("\n")
        name, _, first = head.partition(":")
        lines = [first.strip()] * bool(first.strip()) + textwrap.dedent(rest).strip().splitlines()
        yield exercise, function_of(re.sub(r"\W", "_", name), known.arguments, lines, module | space), words.strip()


def function_of(name: str, arguments: list[str], lines: list[str], space: dict) -> Callable:
    """The function of these statements, which returns its last one's value. `inspect` finds its text."""
    last = ast.parse("\n".join(lines)).body[-1]
    line = lines[last.lineno - 1]
    lines[last.lineno - 1] = f"{line[: last.col_offset]}return {line[last.col_offset :]}"
    text = f"def {name}({', '.join(arguments)}):\n" + textwrap.indent("\n".join(lines), "    ") + "\n"
    file = f"<{name}, a right or wrong answer, {len(linecache.cache)}>"
    linecache.cache[file] = len(text), None, text.splitlines(keepends=True), file
    exec(compile(text, file, "exec"), space)
    return space[name]


def equivalent(exercise: str, change: str, why: str) -> None:
    """Of the changes that `python -m tests.mutants` makes to the solution: one that is no mistake."""
    EQUIVALENT[exercise][change] = why


def here(exercise, answer, seconds, times=1, begin=None):
    """What a function answers in this process: faster than one of its own, for answers that do no harm.

    A class is put back as it was: where it was pickled, its pickle makes no new class but gives this one new methods.
    """
    settings, kinds = (sys.stdout, sys.stderr), answer.__mro__ if isinstance(answer, type) else ()
    methods = [(kind, *each) for kind in kinds for each in vars(kind).items() if isinstance(each[1], FunctionType)]
    try:
        with warnings.catch_warnings():
            return answer_process.work(runner.packed(exercise), runner.pickled(answer, times, 600))
    finally:
        faulthandler.cancel_dump_traceback_later()
        sys.stdout, sys.stderr = settings
        for method in methods:
            setattr(*method)


def in_this_process(monkeypatch, run: Callable = here) -> None:
    """Answers run as `run` says, and no process is started, or asked whether it lives, for those that come next."""
    monkeypatch.setattr(runner, "run", run)
    monkeypatch.setattr(runner, "get_ready", lambda: None)


def one_sentence(verdict) -> bool:
    """No line breaks, a full stop at the end, and HTML without a trace of Python's own noise."""
    html = verdict._repr_mimebundle_()["text/html"]
    return "\n" not in verdict.sentence and verdict.sentence.endswith((".", "?")) and "Traceback" not in html


for _lesson in LESSONS:
    if (LESSON_FOLDERS / _lesson / "answers.py").exists():
        cloudpickle.register_pickle_by_value(importlib.import_module(f"bootcourse.course.lessons.{_lesson}.answers"))
