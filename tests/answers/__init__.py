"""What students might write: for each exercise at least two right answers, and wrong ones beside its known mistakes.

One file a lesson, named like its exercises' file. `@right("name")` marks an answer that must pass,
`@wrong("name", "words")` one that must not; the words must then stand in the check's sentence. Without
words any sentence will do. A wrong answer that answers as a known mistake of the exercise does belongs
here only if it is written in another style (a loop, other rounding): the mistakes are tested themselves.
"""

import importlib
import pkgutil
from collections import defaultdict
from collections.abc import Callable

RIGHT: dict[str, list[Callable]] = defaultdict(list)
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


for _module in pkgutil.iter_modules(__path__):
    importlib.import_module(f"{__name__}.{_module.name}")
