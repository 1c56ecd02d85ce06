"""What an exercise is: what the student writes, what is right, and which wrong answers we know by name.

The exercises themselves stand in `exercises/`, one file a lesson. How an answer is judged: `judge.py`.
"""

import inspect
import re
from collections.abc import Callable, Iterable
from dataclasses import dataclass, field

import numpy as np

from bootcourse.errors import BootcourseError


@dataclass(frozen=True)
class Mistake:
    """A wrong answer that people really give."""

    answer: Callable  # gives what they give
    says: str  # what the check tells the student, one or two sentences in their terms
    belief: str  # what they probably think, for the instructor's page


def call_it(answer: Callable, *arguments):
    return answer(*arguments)


@dataclass(frozen=True)
class Exercise:
    """A few lines of code to write, and everything that judges them."""

    call: str  # the student's function with the names of its arguments: "f(reward, gamma)"
    solution: Callable  # the library's own function, or one written beside the exercise
    worked: tuple  # tiny cases worked out by hand: ((arguments, answer), ...)
    cases: Callable[[np.random.Generator], Iterable[tuple]]  # the hidden ones' arguments, corner cases first
    mistakes: tuple[Mistake, ...]
    hints: tuple[str, ...]  # up to three, from a nudge to the line itself
    minutes: int
    difficulty: int  # 1, 2 or 3
    equation: str  # what is computed and where it stands, as in "D_KL(π ‖ π̃), Equation 9"
    lesson: str = ""  # "07_soft_constraint"; the registry fills it in from the file's name
    run: Callable = field(default=call_it)  # run(answer, *case): what is compared; to take gradients, say
    explain: Callable | None = (
        None  # explain(cases, answers): the sentence on a mistake that has no name; plain numbers
    )
    tolerance: float = 1e-4  # relative; absolute it is a hundredth of this
    seconds: float = 10.0  # for all cases together; a right answer needs a fraction of one

    def __post_init__(self):
        if not re.fullmatch(r"\w+\([\w, ]*\)", self.call):
            raise BootcourseError(f"call is '{self.call}': write the function and its arguments, as in 'f(x, y)'.")
        if not 1 <= len(self.hints) <= 3 or self.difficulty not in (1, 2, 3):
            raise BootcourseError(f"{self.name}: give one to three hints, and a difficulty of 1, 2 or 3.")

    @property
    def name(self) -> str:
        return self.call.partition("(")[0]

    @property
    def arguments(self) -> list[str]:
        return re.findall(r"\w+", self.call)[1:]

    @property
    def case_names(self) -> list[str]:
        """What the parts of a case are called: the function's own arguments, or those of `run`."""
        return self.arguments if self.run is call_it else list(inspect.signature(self.run).parameters)[1:]

    @property
    def dots(self) -> str:
        """The difficulty as it is printed: ●●○."""
        return "●" * self.difficulty + "○" * (3 - self.difficulty)

    def all_arguments(self) -> list[tuple]:
        """The arguments of every case, the hand-worked ones first; the same ones every time."""
        return [arguments for arguments, _ in self.worked] + list(self.cases(np.random.default_rng(0)))
