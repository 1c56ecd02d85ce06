"""The exercises of the course, one file a lesson: lesson_07_soft_constraint.py belongs to 07_soft_constraint.

Every `Exercise` that stands in such a file is registered, under the name of the student's function.
"""

import functools
import importlib
import pkgutil
from dataclasses import replace

from bootcourse.lessons.exercise import Exercise

PREFIX = "lesson_"


@functools.cache
def registry() -> dict[str, Exercise]:
    """name -> exercise, in the order of the lessons and of the files' lines."""
    found = {}
    for module in sorted(m.name for m in pkgutil.iter_modules(__path__) if m.name.startswith(PREFIX)):
        for value in vars(importlib.import_module(f"{__name__}.{module}")).values():
            if isinstance(value, Exercise):
                if value.name in found:
                    raise ValueError(f"Two exercises are called {value.name}: {found[value.name].lesson} and {module}")
                found[value.name] = replace(value, lesson=module.removeprefix(PREFIX))
    return found
