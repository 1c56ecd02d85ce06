"""The library's own functions of the same content as an exercise, and whether an answer calls one of them.

Such an answer is right, but not the student's own. Code is compared by where it is written, so that a function counts
under another name, wrapped, or inside a lambda that merely calls it.
"""

import functools
import importlib
import inspect
import pkgutil
from collections.abc import Callable, Iterable, Iterator
from types import CodeType, ModuleType

LEARN, COURSE = "bootcourse.learn", "bootcourse.course"
LIBRARY = {  # exercise -> the library's functions; the exercise's own solution counts in any case
    "soft_value": (f"{LEARN}.sac.soft_value",),
    "critic_loss": (f"{LEARN}.sac.critic_loss",),
    "actor_loss": (f"{LEARN}.sac.actor_loss",),
    "target_speed": ("bootcourse.rule.target_speed",),
    "safety_distance": ("bootcourse.rule.safety_distance",),
    "cloning_loss": (f"{LEARN}.sac.conservative_loss",),  # the same, because Σ π is 1
    "soft_constraint": (f"{LEARN}.bootstrap.kl_to_rule",),
    "constrained_loss": (f"{LEARN}.sac.actor_loss",),
    "large_margin_loss": (f"{LEARN}.bootstrap.large_margin_loss",),
    "power": ("bootcourse.statistics.power",),
    "my_rule": (f"{COURSE}.lessons.your_teacher.example_teachers.watchful", f"{COURSE}.gap_rule.gap_rule"),
    "rollout_values": ("bootcourse.episodes.lookahead.rollout_values", "bootcourse.episodes.lookahead.nine_drives"),
    "better_of_two": (f"{LEARN}.ibrl.better_of_two",),
    "guide_shrinks": (f"{LEARN}.jsrl.holds",),
    "climb_rule": ("bootcourse.research.problems.with_the_motion", "bootcourse.research.problems.swing"),
}  # fmt: skip
Place = tuple[str, int, str]  # of code: its file, first line and name


def same_content(answer: Callable, library: dict[Place, str]) -> str:
    """The name of the library's function that an answer is or calls; "" if it is and calls none of them."""
    todo, seen = [answer], set()
    while todo:
        thing = todo.pop()
        for code, space in codes(thing):
            if place(code) in library:
                return library[place(code)]
            if place(code) not in seen and not is_the_kit_s(space):
                seen.add(place(code))
                todo += used_by(code, space)
        if isinstance(thing, functools.partial):
            todo += [each for each in thing.args if callable(each)]
    return ""


def places(functions: Iterable[tuple[str, object]]) -> dict[Place, str]:
    """Where the code of these functions is written -> their names; functions: (name, function)."""
    return {place(code): name for name, function in functions for code, _ in codes(function)}


def named(name: str) -> Callable:
    """The function of a dotted name. Raises AttributeError or ImportError if there is none."""
    return pkgutil.resolve_name(name)


def place(code: CodeType) -> Place:
    return code.co_filename, code.co_firstlineno, code.co_name


def is_the_kit_s(space: dict) -> bool:
    """Are these the global names of a module of bootcourse?"""
    return str(space.get("__name__", "")).partition(".")[0] == "bootcourse"


def codes(thing) -> Iterator[tuple[CodeType, dict]]:
    """The code of a function, of what wraps one, or of the methods of a class, with the global names that it sees."""
    for _ in range(20):  # wrappers around wrappers
        inner = inner_of(thing)
        if inner is None:
            break
        if inspect.isfunction(thing):  # the wrapper's own code, too
            yield thing.__code__, thing.__globals__
        thing = inner
    if inspect.isfunction(thing):
        yield thing.__code__, thing.__globals__
    elif isinstance(thing, type):
        for kind in thing.__mro__[:-1]:
            for part in vars(kind).values():
                part = getattr(part, "__func__", part)  # of a static method
                if inspect.isfunction(part):
                    yield part.__code__, part.__globals__
    elif inspect.isfunction(called := inspect.getattr_static(type(thing), "__call__", None)):  # an object's method
        yield called.__code__, called.__globals__


def inner_of(thing) -> Callable | None:
    """What a partial, a method, a decorated or a compiled function or an `Exercise` holds; None for all else."""
    if isinstance(thing, functools.partial):
        return thing.func
    if inspect.ismethod(thing):
        return thing.__func__
    known = ("__wrapped__", "py_func", "solution") if not isinstance(thing, type) else ()
    held = (inspect.getattr_static(thing, name, None) for name in known)  # which runs no code of the answer's
    return next(filter(callable, held), None)


def used_by(code: CodeType, space: dict) -> list:
    """What a code may call: the globals that it names, and of modules of the kit the functions that it names."""
    names, modules, found = all_names(code), [], []
    for name in names:
        value = space.get(name)
        if isinstance(value, ModuleType):
            modules.append(value)
        elif callable(value):
            found.append(value)
    for name in names:  # `import bootcourse.learn.sac` or `from bootcourse.learn import sac` inside the function
        if name.partition(".")[0] == "bootcourse":
            try:
                modules.append(importlib.import_module(name))
            except ImportError:
                continue
    for module in modules:  # it grows
        if module.__name__.partition(".")[0] == "bootcourse":
            for name in names:
                try:
                    value = getattr(module, name, None)
                except Exception:  # a lazy name that cannot be loaded here
                    continue
                if isinstance(value, ModuleType) and value not in modules:
                    modules.append(value)
                elif callable(value):
                    found.append(value)
    return found


def all_names(code: CodeType) -> list[str]:
    """The names in a code and in the functions inside it, and the modules that it imports."""
    inside = [each for each in code.co_consts if isinstance(each, CodeType)]
    return [*code.co_names, *(name for each in inside for name in all_names(each))]
