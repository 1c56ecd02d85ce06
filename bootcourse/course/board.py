"""The leaderboard: every method of the kit on the same held-out roads, beside drivers of your own.

    board()                                 # what ships
    board("runs/mine", my_rule)             # and the agents in a folder, and a rule of your own
    board(mine=look_ahead(...))             # and any policy, under a name
    board("class/anna", "class/ben", block=2026)   # a class, on roads that nobody has seen before

Everyone drives 1,000 held-out roads of the default scenario, on which no agent of the kit trains: those of block 1,
unless you name another.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cache
from pathlib import Path
from typing import NamedTuple

import numpy as np

from bootcourse.course.gap_rule import gap_rule
from bootcourse.episodes.evaluate import MAX_SEED, Episodes, drive_episodes, held_out_seeds
from bootcourse.errors import BootcourseError, whole
from bootcourse.learn.teachers import Rule, course_rule, teacher_of, teacher_policy
from bootcourse.learn.training import Result
from bootcourse.markup import html, joined
from bootcourse.methods import AFTER, display_name
from bootcourse.policies import Policy, idle_policy, random_policy, rule_policy
from bootcourse.research.computed import in_assets
from bootcourse.research.equal_decisions import by_method
from bootcourse.research.experiments.lookahead import CLOSELY, Cell
from bootcourse.research.jobs import HELD_OUT
from bootcourse.research.results import Results
from bootcourse.scenario import DEFAULT
from bootcourse.statistics import Estimate, interval, mean, rate
from bootcourse.storage.assets import shipped
from bootcourse.storage.runs import find_runs, load_run
from bootcourse.terminal import printable

ROADS = held_out_seeds(HELD_OUT, 1000)
HEADINGS = ("method", "return", "success %", "accidents %")
LONGEST = 32  # letters of a name
BELOW = (
    f"{len(ROADS):,} held-out roads, [95 % interval]. One driver: over roads. Several agents: over agents, the",
    "interquartile mean of returns, the mean of rates.",
)


class Row(NamedTuple):
    """A line of the board. success, accidents: shares of the drives, None if not known."""

    method: str
    returns: Estimate
    success: Estimate | None = None
    accidents: Estimate | None = None
    own: bool = False  # the user's

    @property
    def cells(self) -> list[str]:
        """In words, in the order of `HEADINGS`, without the control characters that a terminal would obey."""
        name = "".join(letter if letter.isprintable() else "?" for letter in self.method)
        name = name if len(name) <= LONGEST else f"{name[: LONGEST - 1]}…"
        return [name, in_words(self.returns), in_words(self.success, 100), in_words(self.accidents, 100)]


def in_words(estimate: Estimate | None, scale: float = 1) -> str:
    """ "62 [39, 83]", with a decimal if the interval is short."""
    if estimate is None:
        return "–"
    value, low, high = (scale * number for number in estimate)
    decimals = 0 if high - low >= 10 else 1
    return f"{value:.{decimals}f} [{low:.{decimals}f}, {high:.{decimals}f}]"


@dataclass(frozen=True, repr=False)
class Board:
    """The rows, from the highest return to the lowest: printed as text, shown as a table in a notebook."""

    rows: tuple[Row, ...]

    def __repr__(self) -> str:
        lines = [("", HEADINGS), *((">" if row.own else "", row.cells) for row in self.rows)]
        text = [
            f"{mark:2}{name:{LONGEST}}" + "".join(f"{cell:>22}" for cell in cells) for mark, (name, *cells) in lines
        ]
        return printable("\n".join([*text, "", *BELOW]))

    def _repr_html_(self) -> str:
        lines = [html("<tr>{}</tr>", joined(html("<th>{}</th>", heading) for heading in HEADINGS))]
        for row in self.rows:
            name, *cells = row.cells
            first = html("<strong>{}</strong> (yours)", name) if row.own else name
            lines.append(html("<tr>{}</tr>", joined(html("<td>{}</td>", cell) for cell in (first, *cells))))
        return str(html("<table>{}</table><p>{}</p>", joined(lines), " ".join(BELOW)))


def board(
    *own: str | Path | Result | Rule, teacher: Rule = course_rule, block: int = HELD_OUT, **drivers: Policy
) -> Board:
    """The leaderboard of what ships, with rows of your own.

    own: a folder that `bootcourse train` wrote, the result of a `Training`, or a rule `my_rule(cars, scenario) ->
    action`. Agents that differ in nothing but their seed share a row. drivers: policies by name. teacher: of the
    agents in folders, if they need it to drive. block: of held-out roads, 0 to 4,293; in another than block 1 the kit's
    rows are those of its rules, since its trained agents were tested in block 1. Raises BootcourseError for anything
    else, for a damaged file, and for agents that see another number of cars or need another teacher.
    """
    roads = ROADS if block == HELD_OUT else held_out_seeds(whole(block, "block", MAX_SEED), len(ROADS))
    rows = [*(shipped_rows() if block == HELD_OUT else untrained_rows(roads))]
    rows += [row for one in own for row in own_rows(one, teacher, roads)]
    rows += [row_of(name, [drive_episodes(policy, roads)], own=True) for name, policy in drivers.items()]
    return Board(tuple(sorted(rows, key=lambda row: (-row.returns.value, row.method))))


def row_of(name: str, agents: Sequence[Episodes], own: bool = False) -> Row:
    """The row of a driver, or of several agents of a method: the drives of each on the same roads."""
    if len(agents) == 1:
        (one,) = agents
        return Row(name, mean(one.returns), rate(one.success > 0), rate(one.accident > 0), own)
    each = [(one.returns.mean(), one.success.mean(), (one.accident > 0).mean()) for one in agents]
    returns, success, accidents = np.array(each).T
    return Row(name, interval(returns), interval(success, np.mean), interval(accidents, np.mean), own)


def untrained_rows(roads: Sequence[int]) -> list[Row]:
    """The rows of the drivers that are not trained."""
    drivers = {"rule": rule_policy(DEFAULT), "idle": idle_policy, "random": random_policy(np.random.default_rng(0))}
    named = {display_name(name): policy for name, policy in drivers.items()}
    named["gap acceptance (rule)"] = teacher_policy(gap_rule)
    return [row_of(name, [drive_episodes(policy, roads)]) for name, policy in named.items()]


@cache
def shipped_rows() -> tuple[Row, ...]:
    """The rows of what ships, and of the drivers that are not trained, in block 1."""
    study, rows = in_assets(shipped()), untrained_rows(ROADS)
    rows.append(Row(display_name("planner"), mean(study.bound[DEFAULT.name])))
    default, later = study.results["default"], by_method(study.experiments["beyond"])
    for method, results in (later | {method: default.of(method) for method in default.methods}).items():
        if method in default.methods or method in AFTER:
            drives = [{name: values[i] for name, values in results.tested.items()} for i in range(len(results))]
            rows.append(row_of(display_name(method), [Episodes(**each) for each in drives]))
    return (*rows, *lookahead_rows(study.experiments["look-ahead"]))


def lookahead_rows(cells: dict[str, Results]) -> list[Row]:
    """The agents that look ahead with the exact model, where several drove all of the board's roads."""
    rows = []
    for base in CLOSELY:
        results = cells.get(Cell(base, "rollouts").name)
        if results is not None and (results.measured["roads"] == len(ROADS)).all():
            measured = results.measured
            accidents = interval(measured["accidents"] / measured["roads"], np.mean)
            returns, success = interval(measured["returns"]), interval(measured["success"], np.mean)
            rows.append(Row(f"{display_name(base)}, looking ahead", returns, success, accidents))
    return rows


def own_rows(one: str | Path | Result | Rule, teacher: Rule, roads: Sequence[int]) -> list[Row]:
    """The rows of an entry on these roads, see `board`."""
    if isinstance(one, Result):
        agents = [(agent, one.scenario) for agent in one.agents]
    elif isinstance(one, str | Path):
        runs = [load_run(path, teacher) for path in find_runs(Path(one))]
        agents = [(run.agent.taught_by(teacher_of(teacher, DEFAULT)), run.scenario) for run in runs]
    elif callable(one) and not isinstance(one, type):
        name = str(getattr(one, "__name__", type(one).__name__))
        return [row_of(name, [drive_episodes(teacher_policy(one), roads)], own=True)]
    else:
        raise BootcourseError(f"{one!r:.80} cannot be entered: give a folder of runs, a training's result, or a rule.")
    where, groups = "this training" if isinstance(one, Result) else str(one), {}
    for agent, scenario in agents:
        sees, shows = scenario.observation_size, DEFAULT.observation_size
        if sees != shows:
            raise BootcourseError(
                f"{where}: an agent sees {sees} numbers, and the board's road shows {shows}: "
                "train it on a scenario with the default's Sight."
            )
        groups.setdefault((replace(agent.settings, seed=0), scenario), []).append(agent)
    return [
        row_of(
            f"{display_name(settings.method)}, {where}",
            [drive_episodes(agent.as_policy(), roads) for agent in group],
            own=True,
        )
        for (settings, _), group in groups.items()
    ]
