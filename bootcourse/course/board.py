"""The leaderboard: every method of the kit on the same held-out roads, beside drivers of your own.

    board()                                 # what ships
    board("runs/mine", my_rule)             # and the agents in a folder, and a rule of your own
    board(mine=look_ahead(...))             # and any policy, under a name

Everyone drives the 1,000 roads of block 1 of the default scenario, on which no agent of the kit trains.
"""

from collections.abc import Iterable
from dataclasses import dataclass, replace
from functools import cache
from itertools import product
from pathlib import Path
from typing import NamedTuple

import numpy as np

from bootcourse.course.gap_rule import gap_rule
from bootcourse.episodes.evaluate import Episodes, drive_episodes, held_out_seeds
from bootcourse.errors import BootcourseError
from bootcourse.learn.agent import Agent
from bootcourse.learn.teachers import Rule, course_rule, teacher_of, teacher_policy
from bootcourse.learn.training import Result
from bootcourse.markup import html, joined
from bootcourse.methods import AFTER, display_name
from bootcourse.policies import Policy, idle_policy, random_policy, rule_policy
from bootcourse.research.beyond import lengths
from bootcourse.research.equal_decisions import BOARD, by_method
from bootcourse.research.jobs import HELD_OUT
from bootcourse.research.lookahead import CLOSELY, Cell
from bootcourse.research.results import Results, in_assets
from bootcourse.scenario import DEFAULT, Scenario
from bootcourse.statistics import Estimate, interval, mean, rate
from bootcourse.storage.assets import FOLDER
from bootcourse.storage.runs import find_runs, load_run

ROADS = held_out_seeds(HELD_OUT, 1000)
HEADINGS = ("method", "return", "success %", "accidents %", "decisions")
FORM_WORDS = {"rollouts": "{}, rollouts", "shield": "{}, shield", "alone": "{}, longer"}
LONGEST = 27  # letters of a name in a terminal, so that no line is longer than 100
BELOW = (
    f"{len(ROADS):,} held-out roads, [95 % interval]. One driver: over roads. Several agents: over agents, the",
    "interquartile mean of returns, the mean of rates; where all agents agree, the interval has length 0.",
    "decisions: of one agent's training, without its demonstrations (about 30,000). –: not known.",
)


class Row(NamedTuple):
    """A line of the board."""

    method: str
    returns: Estimate
    success: Estimate | None = None  # share of the drives
    accidents: Estimate | None = None  # share of the drives
    decisions: float | None = None  # of one agent's training
    own: bool = False  # the user's

    @property
    def cells(self) -> list[str]:
        """In words, in the order of `HEADINGS`, without the control characters that a terminal would obey."""
        name = "".join(letter if letter.isprintable() else "?" for letter in self.method)
        shares = ((self.success, 0), (self.accidents, 1))
        rates = ["–" if share is None else in_words(share, 100, decimals) for share, decimals in shares]
        decisions = "–" if self.decisions is None else f"{float(f'{self.decisions:.3g}'):,.0f}"
        return [name, in_words(self.returns), *rates, decisions]


def in_words(estimate: Estimate, scale: float = 1, decimals: int = 1) -> str:
    """ "62 [39, 83]", with decimals if the interval is short; one agent of one road has none."""
    value, low, high = (scale * number for number in estimate)
    decimals = 0 if high - low >= 10 else decimals
    return f"{value:.{decimals}f} [{low:.{decimals}f}, {high:.{decimals}f}]"


@dataclass(frozen=True, repr=False)
class Board:
    """The rows, from the highest return to the lowest: printed as text, shown as a table in a notebook."""

    rows: tuple[Row, ...]

    @property
    def cells(self) -> list[list[str]]:
        """The rows in words."""
        return [row.cells for row in self.rows]

    def __repr__(self) -> str:
        short = [[name if len(name) <= LONGEST else f"{name[: LONGEST - 1]}…", *cells] for name, *cells in self.cells]
        lines = [HEADINGS, *short]
        widths = [max(map(len, column)) for column in zip(*lines, strict=True)]
        marks = ["  ", *("> " if row.own else "  " for row in self.rows)]
        text = []
        for mark, (name, *cells) in zip(marks, lines, strict=True):
            numbers = [cell.rjust(width) for cell, width in zip(cells, widths[1:], strict=True)]
            text.append(mark + "  ".join([name.ljust(widths[0]), *numbers]))
        return "\n".join([*text, "", *BELOW])

    def _repr_html_(self) -> str:
        head = joined(html('<th scope="col">{}</th>', heading) for heading in HEADINGS)
        lines = []
        for row, (name, *cells) in zip(self.rows, self.cells, strict=True):
            first = html("<td><strong>{}</strong> (yours)</td>", name) if row.own else html("<td>{}</td>", name)
            lines.append(html("<tr>{}{}</tr>", first, joined(html("<td>{}</td>", cell) for cell in cells)))
        table = html("<table><thead><tr>{}</tr></thead><tbody>{}</tbody></table>", head, joined(lines))
        return str(html('<div style="overflow-x: auto" tabindex="0">{}</div><p>{}</p>', table, " ".join(BELOW)))


def board(*own: str | Path | Result | Rule, teacher: Rule = course_rule, **drivers: Policy) -> Board:
    """The leaderboard of what ships, with rows of your own.

    own: a folder that `bootcourse train` wrote, the result of a `Training`, or a rule `my_rule(cars, scenario) ->
    action`. Agents that differ in nothing but their seed share a row. drivers: policies by name. teacher: of the
    agents in folders, if they need it to drive. Raises BootcourseError for anything else, for a damaged file, and for
    agents that see another number of cars or need another teacher.
    """
    rows = [*shipped_rows(), *(row for one in own for row in own_rows(one, teacher))]
    rows += [row_of(name, [drive_episodes(policy, ROADS)], own=True) for name, policy in drivers.items()]
    return Board(tuple(sorted(rows, key=lambda row: (-row.returns.value, row.method))))


def row_of(name: str, drives: Iterable[Episodes], **more) -> Row:
    """The row of a driver, or of several agents of a method: the drives of each on the same roads."""
    agents = list(drives)
    if len(agents) == 1:
        (one,) = agents
        return Row(name, mean(one.returns), rate(one.success > 0), rate(one.accident > 0), **more)
    returns = interval([each.returns.mean() for each in agents])
    success = interval([each.success.mean() for each in agents], np.mean)
    accidents = interval([(each.accident > 0).mean() for each in agents], np.mean)
    return Row(name, returns, success, accidents, **more)


@cache
def shipped_rows() -> tuple[Row, ...]:
    """The rows of what ships, and of the drivers that are not trained."""
    study = in_assets(FOLDER)
    drivers = {"rule": rule_policy(DEFAULT), "idle": idle_policy, "random": random_policy(np.random.default_rng(0))}
    rows = [row_of(display_name(name), [drive_episodes(policy, ROADS)]) for name, policy in drivers.items()]
    rows.append(row_of("gap acceptance (rule)", [drive_episodes(teacher_policy(gap_rule), ROADS)]))
    rows.append(Row(display_name("planner"), mean(study.bound[DEFAULT.name])))
    later = [results for method, results in by_method(study.experiments["beyond"]).items() if method in AFTER]
    default = study.results["default"]
    rows += [row_of_study(default.of(method), method) for method in default.methods]
    for results in later:
        rows.append(row_of_study(results, results.methods[0], BOARD))
    return (*rows, *lookahead_rows(study.experiments["look-ahead"]))


def lookahead_rows(cells: dict[str, Results]) -> list[Row]:
    """The agents that look ahead with the exact model, in the forms in which several drove all of the board's roads.

    PPO after cloning without a look-ahead, too: those of `study beyond` stop after fewer decisions.
    """
    rows = []
    for base, (form, words) in product(CLOSELY, FORM_WORDS.items()):
        if form == "alone" and base not in AFTER:
            continue
        if results := cells.get(Cell(base, form).name):
            of = results.measured
            if (of["roads"] == len(ROADS)).all():
                accidents = interval(of["accidents"] / of["roads"], np.mean)
                success = interval(of["success"], np.mean)
                rows.append(Row(words.format(display_name(base)), interval(of["returns"]), success, accidents))
    return rows


def row_of_study(results: Results, method: str, decisions: float | None = None) -> Row:
    """The row of a study's agents of one method. decisions: before the test; those of their curves if None."""
    tested = results.tested
    drives = [Episodes(**{name: values[i] for name, values in tested.items()}) for i in range(len(results))]
    if decisions is None:
        decisions = float(np.nansum(lengths(results.curves), axis=1, dtype=float).mean())
    return row_of(display_name(method), drives, decisions=decisions)


class Entrant(NamedTuple):
    """An agent of the user's."""

    agent: Agent
    scenario: Scenario  # that it was trained on
    decisions: float  # of its training


def own_rows(one: str | Path | Result | Rule, teacher: Rule) -> list[Row]:
    """The rows of an entry, see `board`."""
    if isinstance(one, Result):
        decisions = np.nansum(one.curves["decisions"], axis=1)
        each = [Entrant(agent, one.scenario, spent) for agent, spent in zip(one.agents, decisions, strict=True)]
        return agents_rows(each, "this training")
    if isinstance(one, str | Path):
        each = []
        for path in find_runs(Path(one)):
            run = load_run(path, teacher)
            agent = run.agent.taught_by(teacher_of(teacher, DEFAULT))
            each.append(Entrant(agent, run.scenario, float(np.nansum(run.curves["decisions"]))))
        return agents_rows(each, str(one))
    if not callable(one) or isinstance(one, type):
        raise BootcourseError(f"{one!r:.80} cannot be entered: give a folder of runs, a training's result, or a rule.")
    name = str(getattr(one, "__name__", type(one).__name__))
    return [row_of(name, [drive_episodes(teacher_policy(one), ROADS)], own=True)]


def agents_rows(entrants: list[Entrant], where: str) -> list[Row]:
    """A row for all agents that differ in nothing but their training seed."""
    groups: dict[tuple, list[Entrant]] = {}
    for one in entrants:
        sees, shows = one.scenario.observation_size, DEFAULT.observation_size
        if sees != shows:
            raise BootcourseError(
                f"{where}: an agent sees {sees} numbers, and the board's road shows {shows}: "
                "train it on a scenario with the default's Sight."
            )
        groups.setdefault((replace(one.agent.settings, seed=0), one.scenario), []).append(one)
    return [
        row_of(
            f"{display_name(settings.method)}, {where}",
            [drive_episodes(one.agent.as_policy(), ROADS) for one in group],
            decisions=float(np.mean([one.decisions for one in group])),
            own=True,
        )
        for (settings, _), group in groups.items()
    ]
