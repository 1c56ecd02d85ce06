"""An exercise: what the student writes, the right answer, and the known mistakes.

`exercises/` has the exercises, one file for each lesson; `judge.py` judges the answers.
"""

import functools
import inspect
import re
from collections.abc import Callable, Iterable
from dataclasses import dataclass, field

import numpy as np

from bootcourse.course.values import plain
from bootcourse.errors import BootcourseError


@dataclass(frozen=True)
class Mistake:
    """A wrong answer that students give."""

    answer: Callable  # a function that makes this mistake
    says: str  # what the check says about it, one or two sentences
    belief: str  # what the student probably thinks, for the instructor's page


class NotAsAsked(Exception):
    """A `run` raises it: what the answer returned is of no use. Its text is the verdict's sentence."""


def refuse(value, asked: str) -> None:
    """For a `run` that got something else than the exercise asks for. None passes: nothing was returned.

    Raises NotAsAsked for everything else.
    """
    if value is not None:
        raise NotAsAsked(f"Your function returns {plain(value).words}: the exercise asks for {asked}.")


def call_it(answer: Callable, *arguments):
    return answer(*arguments)


@dataclass(frozen=True, eq=False)
class Exercise:
    """A function to write, and all that is needed to judge it. Two are equal only if they are one and the same."""

    call: str  # the student's function with the names of its arguments: "f(reward, gamma)"
    solution: Callable  # the library's own function, or one written beside the exercise
    worked: tuple  # tiny cases worked out by hand: ((arguments, answer), ...)
    cases: Callable[[np.random.Generator], Iterable[tuple]]  # the arguments of the hidden cases, corner cases first
    mistakes: tuple[Mistake, ...]
    hints: tuple[str, ...]  # up to three, from a first idea to the line itself
    minutes: int
    difficulty: int  # 1, 2 or 3
    equation: str  # what is computed and where it stands, as in "D_KL(π ‖ π̃), Equation 9"
    lesson: str = ""  # "07_soft_constraint"; the registry sets it from the file's name
    run: Callable = field(default=call_it)  # run(answer, *case) gives the value to compare, if not what is returned
    # Of a loss: the arguments (tensors) in which its slopes are compared, too; those in log_pi through its logits.
    # Name all that have a gradient in training, also those that the loss must not change: their slope is 0.
    slopes: tuple[str, ...] = ()
    explain: Callable | None = None  # explain(cases, answers), plain numbers: a sentence on any other wrong answer
    tolerance: float = 1e-4  # relative; the absolute tolerance is a hundredth of it
    seconds: float = 10.0  # limit for all cases together; a right answer needs a fraction of a second

    def __post_init__(self):
        if not re.fullmatch(r"\w+\([\w, ]*\)", self.call):
            raise BootcourseError(f"call is '{self.call}': write the function and its arguments, as in 'f(x, y)'.")
        if not 1 <= len(self.hints) <= 3 or self.difficulty not in (1, 2, 3):
            raise BootcourseError(f"{self.name}: give one to three hints, and a difficulty of 1, 2 or 3.")

    def answers(self, answer: Callable, *case):
        """What is compared with the solution's: what `run` gives, or (value, slopes...) of a loss."""
        if not self.slopes:
            return self.run(answer, *case)
        from bootcourse.course.slopes import loss_and_slopes

        places = [self.arguments.index(name) for name in self.slopes]
        logits = [place for place in places if self.arguments[place] == "log_pi"]
        return loss_and_slopes(answer, case, places, logits)

    @property
    def name(self) -> str:
        return self.call.partition("(")[0]

    @property
    def arguments(self) -> list[str]:
        return re.findall(r"\w+", self.call)[1:]

    @property
    def case_names(self) -> list[str]:
        """The names of the parts of a case: the function's arguments, or those of `run`."""
        names = list(inspect.signature(self.run).parameters)[1:]
        return self.arguments if names == ["arguments"] else names

    @property
    def dots(self) -> str:
        """The difficulty as it is printed: ●●○."""
        return "●" * self.difficulty + "○" * (3 - self.difficulty)

    @functools.cached_property
    def all_arguments(self) -> list[tuple]:
        """The arguments of every case, those of `worked` first. Copy them for a function that may change them.

        A number that NumPy drew becomes Python's, as a student would write it.
        """
        drawn = self.cases(np.random.default_rng(0))
        plainly = [tuple(one.item() if isinstance(one, np.generic) else one for one in case) for case in drawn]
        return [arguments for arguments, _ in self.worked] + plainly
