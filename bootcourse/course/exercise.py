"""An exercise: a right answer, cases worked out by hand, hidden cases, hints, and the mistakes that students make.

It is written on its solution, in `lessons/NAME/exercises.py`; `judge.py` judges answers.

    @exercise(
        "D_KL(π ‖ π̃), Section IV-A", minutes=5, difficulty=2, cases=cases, slopes=[logits("log_pi")],
        worked=[((sure(3), torch.tensor([3]), 0.9), torch.tensor([-math.log(0.9)]))],
        hints=("Write log π̃ first.", "The KL is an expectation under the *policy*."),
        mistakes={  # a change of the solution -> what the check says
            "(1 - p) / 8 -> 1 - p": "The other eight actions *share* 1 - p.",
            "return (log_rule.exp() * (log_rule - log_pi)).sum(-1)": "Your KL is the other way round.",
        },
    )
    def soft_constraint(log_pi, rule_action, p):
        log_rule = torch.full_like(log_pi, math.log((1 - p) / 8))
        log_rule.scatter_(-1, rule_action.unsqueeze(-1), math.log(p))
        return (log_pi.exp() * (log_pi - log_rule)).sum(-1)

The function's name and arguments are those that the student writes. A class is decorated in the same way. A solution
that the library has is passed on, if its arguments have these names: `cloning_loss = exercise(...)(bc.cloning_loss)`,
with `name=` if it has another name itself.

A key of `mistakes` is
- "old -> new": `old` stands once in the solution's body and is replaced. It begins and ends with whole names, and a
  space in it matches a line break, too. "old -> new [2 times]" replaces as many; "old ->" takes `old` out;
- one or more statements without an arrow: they replace the solution's last statement (often another `return`);
- a tuple of these, done one after the other: ("log_pi -> log_pi.detach()", "return ...");
- where none of this will do, a function or class of its own, which makes the mistake.
A change that does not fit raises BootcourseError when the lessons are loaded. A changed solution may use all names of
its file. Tensors of hidden and worked cases are given in float32, as training gives them.
"""

import ast
import functools
import inspect
import re
import textwrap
from collections.abc import Callable, Iterable
from dataclasses import dataclass

import numpy as np
import torch

from bootcourse.course.library import LIBRARY, Place, named, places
from bootcourse.course.values import plain
from bootcourse.errors import BootcourseError

MANY_ROWS = 130  # of a case as long as a batch in training, or longer; no multiple of 64


class logits(str):
    """Marks the name of an argument that holds log-probabilities: its slope is taken through its logits."""


@dataclass(frozen=True, eq=False)
class Mistake:
    """A wrong answer that students give."""

    answer: Callable  # a function that makes this mistake
    says: str  # what the check says about it, one or two sentences
    change: str = ""  # of the solution, that makes the mistake; "" if `answer` was written out


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

    name: str  # of the student's function
    solution: Callable
    equation: str  # what is computed and where it stands, as in "D_KL(π ‖ π̃), Equation 9"
    worked: tuple  # tiny cases worked out by hand: ((arguments, answer), ...)
    cases: Callable[[np.random.Generator], Iterable[tuple]]  # the arguments of the hidden cases, corner cases first
    mistakes: tuple[Mistake, ...]
    hints: tuple[str, ...]  # one or two
    minutes: int
    difficulty: int  # 1, 2 or 3
    lesson: str = ""  # "07_soft_constraint"; the registry sets it
    run: Callable = call_it  # run(answer, *case) gives the value to compare, if not what is returned
    # Of a loss: the arguments (tensors) in which its slopes are compared, too. Name all that have a gradient in
    # training, also those that the loss must not change: their slope is 0. Mark log-probabilities as `logits`.
    slopes: tuple[str, ...] = ()
    explain: Callable | None = None  # explain(cases, answers), plain numbers: a sentence on any other wrong answer
    tolerance: float = 1e-4  # relative
    seconds: float = 6.0  # of wall clock, for all cases together; a right answer needs a fraction of a second

    def __post_init__(self):
        if self.difficulty not in (1, 2, 3) or isinstance(self.hints, str) or len(self.hints) not in (1, 2):
            raise BootcourseError(f"{self.name}: give a tuple of one or two hints, and a difficulty of 1, 2 or 3.")

    def __call__(self, *arguments):
        return self.solution(*arguments)

    @property
    def outcome(self) -> Callable:
        """outcome(answer, *case) is what is compared: what `run` gives, or (value, slopes...) of a loss."""
        if not self.slopes:
            return self.run
        from bootcourse.course.slopes import loss_and_slopes

        places = [self.arguments.index(name) for name in self.slopes]
        through = [self.arguments.index(name) for name in self.slopes if isinstance(name, logits)]
        return functools.partial(loss_and_slopes, places, through)

    @property
    def arguments(self) -> list[str]:
        return list(inspect.signature(self.solution).parameters)

    @property
    def call(self) -> str:
        """The student's function with the names of its arguments: "f(reward, gamma)"."""
        return f"{self.name}({', '.join(self.arguments)})"

    @property
    def case_names(self) -> list[str]:
        """The names of the parts of a case: the function's arguments, or those of `run`."""
        return self.arguments if self.run is call_it else list(inspect.signature(self.run).parameters)[1:]

    @functools.cached_property
    def library(self) -> dict[Place, str]:
        """Where the library's functions of the same content are written, the solution included -> their names."""
        others = [(name, named(name)) for name in LIBRARY.get(self.name, ())]
        return places([(f"{self.solution.__module__}.{self.solution.__qualname__}", self.solution), *others])

    @property
    def dots(self) -> str:
        """The difficulty as it is printed: ●●○."""
        return "●" * self.difficulty + "○" * (3 - self.difficulty)

    @functools.cached_property
    def all_arguments(self) -> list[tuple]:
        """The arguments of every case, those of `worked` first. Copy them for a function that may change them."""
        drawn = [*(arguments for arguments, _ in self.worked), *self.cases(np.random.default_rng(0))]
        return [tuple(map(as_in_training, case)) for case in drawn]


def as_in_training(value):
    """A tensor in float32, as training has it; a number that NumPy drew as Python's, as a student would write it."""
    if isinstance(value, torch.Tensor) and value.dtype == torch.float64:
        return value.float()
    return value.item() if isinstance(value, np.generic) else value


def exercise(equation: str, *, worked, mistakes: dict, hints, slopes=(), name="", **more) -> Callable:
    """The decorator of a solution (see above). name: the student's, if not the solution's. more: fields of `Exercise`.

    Raises BootcourseError for a mistake that does not fit the solution.
    """

    def register(solution: Callable) -> Exercise:
        text = source_of(solution)
        known = tuple(mistake_of(solution, text, change, says) for change, says in mistakes.items())
        return Exercise(name or solution.__name__, solution, equation, tuple(worked), mistakes=known, hints=hints,
                        slopes=tuple(slopes), **more)  # fmt: skip

    return register


# A mistake as a change of the solution ----------------------------------------------------------------


def source_of(solution: Callable) -> str:
    """The text of a function or class without its decorators; a compiled function holds its Python."""
    text = textwrap.dedent(inspect.getsource(getattr(solution, "py_func", solution)))
    return "\n".join(text.splitlines()[ast.parse(text).body[0].lineno - 1 :])


def mistake_of(solution: Callable, text: str, change, says: str) -> Mistake:
    """The mistake that a key of `mistakes` describes. text: the solution's."""
    if callable(change):
        return Mistake(change, says)
    changes, space, name = (change,) if isinstance(change, str) else change, {}, solution.__name__
    try:
        for each in changes:
            text = edited(text, each) if "->" in each else with_end(text, each)
        exec(text, vars(inspect.getmodule(solution)), space)
    except (ValueError, SyntaxError) as error:
        raise BootcourseError(f"{name}: the mistake {change!r} does not fit its solution: {error}.") from None
    return Mistake(space[name], says, change="; ".join(changes))


def edited(text: str, change: str) -> str:
    """The text with `old -> new` done in its body."""
    old, new, times = re.fullmatch(r"\s*(.+?)\s+->\s*(.*?)(?:\s*\[(\d+) times\])?", change, re.S).groups()
    node = ast.parse(text).body[0]
    first = 0 if isinstance(node, ast.ClassDef) else node.body[ast.get_docstring(node) is not None].lineno - 1
    head, body = text.splitlines()[:first], "\n".join(text.splitlines()[first:])
    pattern = r"\s+".join(map(re.escape, old.split()))
    begin, end = (r"(?<!\w)" if re.match(r"\w", old) else ""), (r"(?!\w)" if re.search(r"\w$", old) else "")
    body, count = re.subn(begin + pattern + end, lambda _: new, body)
    if count != int(times or 1):
        raise ValueError(f"`{old}` stands there {count} times")
    return "\n".join([*head, body])


def with_end(text: str, statements: str) -> str:
    """The text with these statements in place of its last one."""
    last = ast.parse(text).body[0]
    while isinstance(last, (ast.ClassDef, ast.FunctionDef)):
        last = last.body[-1]
    end = textwrap.indent(textwrap.dedent(statements), " " * last.col_offset)
    return "\n".join([*text.splitlines()[: last.lineno - 1], end])
