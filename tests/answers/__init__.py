"""What students might write: for each exercise at least two right answers, and wrong ones beside its known mistakes.

One file a lesson, named like its exercises' file. `@right("name")` marks an answer that must pass,
`@wrong("name", "words")` one that must not; the words must then stand in the check's sentence. Without
words any sentence will do. A wrong answer that answers as a known mistake of the exercise does belongs
here only if it is written in another style (a loop, other rounding): the mistakes are tested themselves.
"""

import contextlib
import importlib
import io
import pickle
import pkgutil
import sys
import warnings
from collections import defaultdict
from collections.abc import Callable
from unittest import mock

import cloudpickle

from bootcourse.lessons import guard, worker

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


def equivalent(exercise: str, change: str, why: str) -> None:
    """Of the changes that `python -m tests.mutants` makes to the solution: one that is no mistake."""
    EQUIVALENT[exercise][change] = why


def here(job: bytes, seconds: float):
    """What a function answers in this process: faster than one of its own, for answers that do no harm."""
    job, stream = pickle.loads(job), io.BytesIO()
    with contextlib.redirect_stdout(sys.stdout), contextlib.redirect_stderr(sys.stderr), warnings.catch_warnings():
        worker.work(job, *worker.prepared(job["exercise"]), stream)
    return "", stream.getvalue()


def one_sentence(verdict) -> bool:
    """No line breaks, a full stop at the end, and HTML without a trace of Python's own noise."""
    html = verdict._repr_mimebundle_()["text/html"]
    return "\n" not in verdict.sentence and verdict.sentence.endswith((".", "?")) and "Traceback" not in html


in_this_process = mock.patch.multiple(guard, _in_a_fork=here, _alone=here)

for _module in pkgutil.iter_modules(__path__):
    cloudpickle.register_pickle_by_value(importlib.import_module(f"{__name__}.{_module.name}"))
