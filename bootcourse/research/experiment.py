"""An experiment: cells that are computed one by one, kept, shipped and reported. Each is one file.

To add one, write `experiments/NAME.py` (or a file of the lesson it belongs to) with

    a first sentence that says what is asked, for `bootcourse study --help`
    def cells(seeds=10, tests=200): {cell: the arguments of what it runs}; the command line may change its numbers
    def run(...) -> Results: what a cell runs; `cells.results_of(run)` writes it, `cells.train_and_test` trains it
    EXPERIMENT = Experiment("NAME", cells, run, curves=..., section=...)

and one line in the room's `door.py`, whose order is that of the report. `bootcourse study NAME` runs it.
"""

import inspect
import re
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from pkgutil import resolve_name
from typing import TYPE_CHECKING, Any

from bootcourse.errors import BootcourseError, check_known
from bootcourse.research.jobs import Job, Run
from bootcourse.rooms import added

if TYPE_CHECKING:
    from bootcourse.research.results import Results

EXPERIMENTS = added("EXPERIMENTS")  # {name: module}, see `experiment_named`
Computed = Mapping[str, "Results"]  # {cell: its agents}, of the cells that were computed


@dataclass(frozen=True)
class Experiment:
    """What is computed, kept and reported under one name."""

    name: str  # of its command, its folders and its files
    cells: Callable[..., dict[str, dict]]  # (seeds=, episodes=, tests=, of these its own) -> {cell: arguments of `run`}
    run: Run  # what a cell runs
    curves: tuple[str, ...] | None = None  # that ship; None: all that a cell has
    section: Callable[[dict[str, Computed], Path], list[str]] | None = None  # of the report, see `report.write_report`
    page: Callable[[Computed], str] | None = None  # Markdown, in place of the means of what was measured; it ships
    obstacle: Callable[[Mapping[str, Any]], str] = lambda arguments: ""  # why a cell cannot run on this machine, or ""

    @property
    def reported(self) -> bool:
        """Is it in the report, or has it a page of its own?"""
        return bool(self.section or self.page)

    def jobs(self, only: str = "", **numbers: int) -> list[Job]:
        """One job for each cell that this machine can run, the longest training first; prints why others are left out.

        only: see `chosen`. numbers: of seeds, episodes and tests, 0 for the experiment's own. Raises BootcourseError
        for a number that the experiment fixes, and for an unknown word in `only`.
        """
        numbers, own = {word: n for word, n in numbers.items() if n}, inspect.signature(self.cells).parameters
        if fixed := [f"--{word}" for word in numbers if word not in own]:
            raise BootcourseError(f"The experiment {self.name} fixes its numbers: leave out {' and '.join(fixed)}.")
        cells = chosen(self.cells(**numbers), only)
        obstacles = {cell: self.obstacle(arguments) for cell, arguments in cells.items()}
        for sentence in dict.fromkeys(filter(None, obstacles.values())):
            print(sentence)
        jobs = [
            Job(f"{self.name}/{folder(cell)}", self.run, arguments)
            for cell, arguments in cells.items()
            if not obstacles[cell]
        ]
        return sorted(jobs, key=size, reverse=True)


def size(job: Job) -> float:
    """How long a job trains beside others: by its neurons and updates, 0 for what is not known."""
    settings = job.arguments.get("settings")
    return sum(settings[0].hidden) * settings[0].updates if settings else 0


def experiment_named(name: str) -> Experiment:
    """The experiment of that name. Raises BootcourseError for an unknown one."""
    check_known("Experiment", name, EXPERIMENTS)
    return resolve_name(f"{EXPERIMENTS[name]}:EXPERIMENT")


def chosen(cells: dict[str, dict], words: str) -> dict[str, dict]:
    """The cells that words such as "planner-dagger" or "ppo_cloned, soft" name, all for "".

    A cell is named by its folder, by an argument that is a word, such as its teacher, and by its method if it has one.
    Raises BootcourseError for an unknown word.
    """
    names = {cell: names_of(cell, arguments) for cell, arguments in cells.items()}
    wanted, known = {word.strip() for word in words.split(",")} - {""}, sorted(set().union(*names.values()))
    for word in sorted(wanted):
        check_known("Part", word, known)
    return {cell: arguments for cell, arguments in cells.items() if not wanted or wanted & names[cell]}


def names_of(cell: str, arguments: Mapping[str, Any]) -> set[str]:
    """What a cell may be called, see `chosen`."""
    methods = {settings.method for settings in arguments.get("settings", ())}
    words = {folder(word) for word in (cell, *arguments.values()) if isinstance(word, str)}
    return words | (methods if len(methods) == 1 else set())


def folder(name: str) -> str:
    """A name as a folder, of letters, digits and any of . _ - : "γ = 0.9" -> "gamma-0.9"."""
    words = {"γ": "gamma", "β": "beta", "ξ": "xi", "α": "alpha", "η": "eta", "π̃": "stochastic-rule", "μ": "rule"}
    for letter, word in (words | {"1/4": "quarter", "m/s": ""}).items():
        name = name.replace(letter, word)
    words = (re.sub(r"[^\w.-]", "", word) for word in name.split() if word not in ("x", "at"))
    return "-".join(word for word in words if word)
