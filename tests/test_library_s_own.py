"""The library's own function is right, and is not the student's: a check says so, however it is called."""

import ast
import functools
import inspect
import pkgutil
import re
import warnings

import numpy as np
import pytest
import torch

import bootcourse
from bootcourse import rule
from bootcourse.course import check
from bootcourse.course.exercise import call_it
from bootcourse.course.judge import judge, outcomes
from bootcourse.course.lessons import registry, stem
from bootcourse.course.library import LIBRARY, named
from bootcourse.course.values import fitted, plain, same
from bootcourse.learn import bootstrap, sac
from tests.answers import in_this_process
from tools.course.problems import shown_sources
from tools.course.source import lesson_of, read, sources

EXERCISES = registry()


@pytest.fixture(autouse=True)
def fast(monkeypatch):
    in_this_process(monkeypatch)


@pytest.mark.parametrize("name", EXERCISES)
def test_a_solution_handed_in_is_right_and_does_not_count(name):
    verdict = judge(EXERCISES[name], EXERCISES[name].solution)
    assert verdict.kind == "library" and not verdict.passed, verdict
    assert verdict.sentence == "Right, and this is the library's: write your own to learn it."


def helper(log_pi, q, alpha):
    return sac.soft_value(log_pi, q, alpha)


@functools.wraps(sac.soft_value)
def wrapped(*arguments):
    return sac.soft_value(*arguments)


def imports_inside(log_pi, q, alpha):
    from bootcourse.learn.sac import soft_value as mine

    return mine(log_pi, q, alpha)


class WithCall:
    def __call__(self, log_pi, q, alpha):
        return helper(log_pi, q, alpha)


CALLS = {
    "itself": sac.soft_value,
    "a lambda": lambda log_pi, q, alpha: sac.soft_value(log_pi, q, alpha),
    "partial": functools.partial(sac.soft_value, constraint=0.0),
    "a cache": functools.cache(helper),
    "wrapped": wrapped,
    "through a helper": lambda log_pi, q, alpha: helper(log_pi, q, alpha),
    "through the front door": lambda log_pi, q, alpha: bootcourse.learn.sac.soft_value(log_pi, q, alpha),
    "an import inside": imports_inside,
    "an object": WithCall(),
    "the exercise itself": EXERCISES["soft_value"],
}


@pytest.mark.parametrize("how", CALLS)
def test_the_library_s_function_is_known_under_every_name(how):
    assert judge(EXERCISES["soft_value"], CALLS[how]).kind == "library"


def test_a_text_that_calls_it_and_a_compiled_one_are_known_too():
    text = "import bootcourse as bc\n\ndef soft_value(a, b, c):\n    return bc.learn.sac.soft_value(a, b, c)\n"
    assert judge(EXERCISES["soft_value"], text).kind == "library"
    assert judge(EXERCISES["target_speed"], lambda *five: rule.target_speed(*five)).kind == "library"


def test_other_functions_of_the_library_may_be_used():
    def soft_value(log_pi, q, alpha):
        return (log_pi.exp() * q).sum(-1) + alpha * sac.entropy(log_pi)

    def soft_constraint(log_pi, rule_action, p):
        log_rule = bootstrap.log_stochastic_rule(rule_action, torch.tensor(p))
        return (log_pi.exp() * (log_pi - log_rule)).sum(-1)

    assert judge(EXERCISES["soft_value"], soft_value).passed
    assert judge(EXERCISES["soft_constraint"], soft_constraint).passed


def test_it_is_not_kept_as_the_student_s_and_strict_refuses_it():
    assert "From here on" not in check.soft_value(sac.soft_value).footer
    check.strict()
    try:
        with pytest.raises(check.NotPassed, match="write your own"):
            check.soft_value(sac.soft_value)
    finally:
        check.strict(False)


# The table of names -------------------------------------------------------------------------------


def test_the_table_names_exercises_and_functions_that_exist():
    assert set(LIBRARY) <= set(EXERCISES)
    for names in LIBRARY.values():
        assert all(callable(named(name)) for name in names)


def functions_of_the_library() -> dict[str, object]:
    """The public functions that compute a formula, by name."""
    found = {}
    methods = (f"learn.{name}" for name in ("sac", "bootstrap", "bc", "gail", "cql", "ppo", "rlpd", "ibrl", "jsrl"))
    for module in (*methods, "learn.teachers", "rule", "statistics", "road.formulas", "episodes.lookahead"):
        for name, value in vars(pkgutil.resolve_name(f"bootcourse.{module}")).items():
            value = getattr(value, "py_func", value)
            if inspect.isfunction(value) and value.__module__ == f"bootcourse.{module}" and name[0] != "_":
                found[f"bootcourse.{module}.{name}"] = value
    return found


def takes(function, count: int) -> bool:
    try:
        inspect.signature(function).bind(*[None] * count)
    except (TypeError, ValueError):
        return False
    return True


def agrees(exercise, function) -> bool:
    """Does a function of the library do what an exercise asks for, called as an answer is?"""
    rights = outcomes(exercise, exercise.solution)
    for case, right in list(zip(exercise.all_arguments, rights, strict=True))[:6]:
        try:
            with np.errstate(all="ignore"), warnings.catch_warnings(action="ignore"):
                answer = fitted(plain(exercise.outcome(function, *[torch.clone(a) if isinstance(a, torch.Tensor) else a
                                                                   for a in case])), right)  # fmt: skip
        except Exception:  # it is another function
            return False
        if not same(answer, right, exercise.tolerance, nan_too=True):
            return False
    return True


def test_every_function_of_the_library_that_would_pass_is_in_the_table():
    library = functions_of_the_library()
    assert len(library) > 60
    for exercise in EXERCISES.values():
        if exercise.run is not call_it:
            continue
        known = set(exercise.library.values())
        for name, function in library.items():
            if takes(function, len(exercise.arguments)) and name not in known:
                assert not agrees(exercise, function), (exercise.name, name)


# Lessons ------------------------------------------------------------------------------------------


def names_in(code: str) -> set[str]:
    """The functions that a cell names or shows, without the modules before them."""
    nodes = list(ast.walk(ast.parse(re.sub(r"^\s*[%!].*$", "", code, flags=re.M))))
    named = {node.id for node in nodes if isinstance(node, ast.Name)}
    named |= {node.attr for node in nodes if isinstance(node, ast.Attribute)}
    named |= {alias.name for node in nodes if isinstance(node, ast.ImportFrom) for alias in node.names}
    return named | {name.rpartition(".")[2] for name in shown_sources(code)}


@pytest.mark.parametrize("path", sources(), ids=lesson_of)
def test_no_cell_above_an_exercise_calls_or_shows_the_library_s_function(path):
    """A student would find the answer there."""
    own = {name: each for name, each in EXERCISES.items() if each.lesson == stem(lesson_of(path))}
    above = set()
    for cell in read(path):
        for name in cell.checks:
            if name in own:
                theirs = {each.rpartition(".")[2] for each in own[name].library.values()}
                assert not theirs & above, (name, theirs & above)
        above |= names_in(cell.student) if cell.is_code else set()
