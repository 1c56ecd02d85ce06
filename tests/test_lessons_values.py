"""Whatever value an answer returns, the judge says something about it, and nothing in the judge breaks off."""

import array
import itertools
import math
import time
from collections import deque
from decimal import Decimal
from fractions import Fraction

import numpy as np
import pytest
import torch

from bootcourse.course import answer_process, judge
from bootcourse.course.answer_process import Report
from bootcourse.course.exercise import call_it
from bootcourse.course.lessons import registry
from bootcourse.course.values import NUMERIC, SEVERAL, Plain, plain
from tests.answers import in_this_process

EXERCISES = registry()
every_exercise = pytest.mark.parametrize("exercise", EXERCISES.values(), ids=lambda exercise: exercise.name)
NOT_BROKEN = ("wrong", "passed", "did_not_run", "todo")
CASES = 3  # in which an exercise's own `run` is tried with each value; the others get the same


THEIRS = """
class Strange:
    def __getattr__(self, name):
        raise ValueError(name)

class Evil:
    def __eq__(self, *others):
        raise ValueError

    __len__ = __iter__ = __float__ = __int__ = __index__ = __bool__ = __array__ = __repr__ = __str__ = __eq__
    __hash__ = None

def answer(value):
    return lambda *arguments: value
"""  # objects with which nothing works
space = {"__name__": "__main__"}
exec(compile(THEIRS, "an answer", "exec"), space)
Strange, Evil, answer = space["Strange"], space["Evil"], space["answer"]


def endless():
    while True:
        yield 1.0


def in_itself():
    one = [1.0]
    one.append(one)
    return one


def in_each_other(depth):
    nested = 1.0
    for _ in range(depth):
        nested = [nested]
    return nested


NUMBERS = (0, 1, 2, 8, 9, -1, 10**400, -(10**400), 0.0, -0.0, 0.5, 1.0, 3.0, -43.0, 1e-320, 1e308, math.nan, math.inf,
           -math.inf, True, False, np.True_, np.int8(3), np.uint64(2**63), np.float16(0.5), np.longdouble(2), 1j,
           np.complex64(1j), Fraction(1, 3), Fraction(10**400), Decimal("0.1"), Decimal("sNaN"),
           Decimal("-Infinity"))  # fmt: skip
SHAPES = ((), (0,), (1,), (2,), (3,), (9,), (1, 1), (2, 9), (9, 2), (3, 1), (2, 3, 9), (0, 4))
FILLED = (0.0, 1.0, -3.0, math.nan, math.inf)


def values() -> list:
    """Two hundred and more values of every plain kind. Made anew for each exercise: a generator is used up."""
    made = [None, "", "words", "flipped_kl", "A", "\ud800", "x" * 10_000, b"bytes", bytearray(2), object(), Strange(),
            Evil(), Strange, len, print, math, NotImplemented, ..., type, slice(2), {}, {1: 2}, set(), {1.0, 2.0},
            frozenset({1}), range(3), (x for x in (1.0, 2.0)), map(float, "12"), zip((1, 2)),
            deque([1.0, 2.0]), array.array("d", [1.0, 2.0]), {1: 2}.keys(), {1: 2}.items(), iter([]), memoryview(b"ab"),
            [], (), [[]], [None], [1, "a"], [1.0, [2.0]], in_itself(), in_each_other(20), in_each_other(2),
            [[1.0, 2.0], [3.0]], [torch.ones(2), np.ones(2)], (torch.ones(2), torch.ones(3)), ("a", 1),
            [Fraction(1, 2), Decimal(1)], torch.nn.Linear(1, 1), torch.nn.Parameter(torch.ones(2)),
            torch.ones(2, requires_grad=True) * 2, torch.eye(2).to_sparse(), torch.ones(2, device="meta"),
            torch.tensor([True, False]),
            torch.tensor(1j).conj(), torch.float32, torch.Size([2]), torch.ones(2, 2).max(0),
            torch.distributions.Categorical(torch.ones(9)), torch.Generator(), np.random.default_rng(0),
            np.array(["a"]), np.array([None]), np.array([Fraction(1, 2)]), np.datetime64("2030-01-01"),
            np.zeros(2, dtype=[("x", float)]), np.ma.masked_array([1.0, 2.0], [0, 1]),
            np.array([1j]), np.array(3), np.where(True, 2, 0), np.nditer(np.ones(2)),
            torch.ones(2, dtype=torch.bfloat16), torch.tensor(4), torch.tensor([4])]  # fmt: skip
    made += NUMBERS
    made += [np.full(shape, each) for shape, each in itertools.product(SHAPES, FILLED)]
    made += [torch.full(shape, each) for shape, each in itertools.product(SHAPES, FILLED[:4])]
    return made


def answered(exercise, value, rights) -> Report:
    """What the process of an answer would report that returns this value in every case."""
    called = answer_process.Called(answer(value))
    try:
        if exercise.run is not call_it:
            some = [plain(exercise.run(called, *case)) for case in exercise.all_arguments[:CASES]]
            return Report(list(itertools.islice(itertools.cycle(some), len(rights))))
        mine = plain(called())
    except Exception as error:
        said = answer_process.in_words(error, called.answer)
        is_ours = error is not called.error and answer_process.is_ours(error, said)
        return Report(error=said, is_ours=is_ours, refused=is_ours * answer_process.why_no_array(called.value))
    if not exercise.slopes or value is None:
        return Report([mine] * len(rights))
    slopes = [[Plain("tensor", 0 * part.array) for part in right.parts[1:]] for right in rights]
    return Report([Plain("tuple", parts=(mine, *each)) for each in slopes])


def judged(exercise, report, monkeypatch) -> tuple:
    """The kind, sentence and details of the verdict on this report, which is drawn, too."""
    twice = Report(report.answers * 2)
    in_this_process(monkeypatch, lambda *_, times=1, **more: twice if times == 2 else report)
    verdict = judge.judge(exercise, call_it, 1.0)
    assert repr(verdict) and verdict._repr_mimebundle_()
    assert len(verdict.sentence) < 500, verdict.sentence
    return verdict.kind, verdict.sentence, verdict.details


@every_exercise
def test_no_value_that_an_answer_returns_breaks_its_check(exercise, monkeypatch):
    rights, made = judge.outcomes(exercise, exercise.solution), values()
    for value in made:
        report = answered(exercise, value, rights)
        answer_process.decoder.decode(answer_process.encoder.encode(report))
        kind, *said = judged(exercise, report, monkeypatch)
        assert kind in NOT_BROKEN, (type(value), said)
    assert len(made) >= 200


@pytest.mark.parametrize("value, words", [
    ([0] * 70_000, "list of more than 65,536 values"), (range(10**12), "range of more than 65,536 values"),
    (endless(), "generator of more than 65,536 values"), (in_each_other(2000), "list with more than 8 lists"),
    ([[0] * 300] * 300, "list of more than 65,536 values"), (np.zeros(2**20 + 1), "of 1,048,577 numbers"),
    (torch.zeros(2**20 + 1), "of 1,048,577 numbers"), ("x" * 10_000, "a text"),
])  # fmt: skip
def test_what_is_far_too_large_is_said_and_not_copied(value, words):
    begin = time.process_time()
    assert words in str(plain(value)) + plain(value).words and time.process_time() - begin < 3


def changed(part: Plain, how: str, other: Plain) -> Plain:
    """An answer of the right kind and shape, with other numbers. other: of another case."""
    if part.kind in SEVERAL:
        others = other.parts if other.kind in SEVERAL and len(other.parts) == len(part.parts) else part.parts
        pairs = zip(part.parts, others, strict=True)
        return Plain(part.kind, parts=tuple(changed(each, how, its) for each, its in pairs))
    if part.kind not in NUMERIC:
        return Plain("text", text={"other": other.text, "words": "words"}.get(how, part.text)) if part.text else part
    numbers = part.array.astype(float)
    made = {
        "other": other.array if other.kind == part.kind and other.shape == part.shape else numbers + 1,
        "half": numbers / 2, "turned": -numbers, "moved": numbers + 1, "cut": np.trunc(numbers),
        "infinite": np.full(numbers.shape, np.inf), "none": np.full(numbers.shape, np.nan), "zero": 0 * numbers,
        "large": np.full(numbers.shape, 1e300), "backwards": numbers[::-1] if numbers.ndim else numbers,
        "words": numbers,
    }[how]  # fmt: skip
    return Plain(part.kind, np.array(made, float))


HOW = ("other", "half", "turned", "moved", "cut", "infinite", "none", "zero", "large", "backwards", "words")


@every_exercise
@pytest.mark.parametrize("where", ["everywhere", "in the last case", "in all but the first"])
def test_no_wrong_number_in_the_right_form_breaks_its_check(exercise, where, monkeypatch):
    rights = judge.outcomes(exercise, exercise.solution)
    kept = {"everywhere": 0, "in the last case": len(rights) - 1, "in all but the first": 1}[where]
    for how in HOW:
        others = zip(rights[kept:], [*rights[kept + 1 :], rights[0]], strict=True)
        answers = [*rights[:kept], *(changed(right, how, other) for right, other in others)]
        kind, *said = judged(exercise, Report(answers), monkeypatch)
        assert kind in NOT_BROKEN or exercise.run is not call_it, (how, said)  # only a forged report can say this
