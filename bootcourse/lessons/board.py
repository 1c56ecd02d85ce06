"""The leaderboard: every method of the kit on the same held-out roads, beside agents and teachers of your own.

    board()                        # what ships
    board("runs/mine", my_rule)    # and the agents in a folder, and a rule controller of your own

Everyone drives the 1,000 roads of block 1 of the default scenario, on which no agent of the kit trains. Experiments
that vary the paper's method or the teacher to learn about them (`ASIDE`) stay out: their tables stand in the report.
"""

import textwrap
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cache
from pathlib import Path
from typing import Annotated, NamedTuple

import numpy as np
from msgspec import Meta, Struct, convert, to_builtins
from msgspec.structs import replace as changed

from bootcourse.episodes.evaluate import drive_episodes, held_out_seeds
from bootcourse.errors import BootcourseError
from bootcourse.files import decoding, read_json
from bootcourse.learn.agent import Agent
from bootcourse.learn.teachers import Rule, course_rule, teacher_of, teacher_policy
from bootcourse.learn.training import Result
from bootcourse.lessons.ppo_reference import KINDS, reference
from bootcourse.markup import html, joined
from bootcourse.methods import DRIVERS, METHODS, display_name
from bootcourse.policies import Policy, idle_policy, random_policy, rule_policy
from bootcourse.scenario import DEFAULT, Scenario
from bootcourse.statistics import ESCAPES, Estimate, mean
from bootcourse.storage.assets import FOLDER
from bootcourse.storage.runs import find_runs, load_run
from bootcourse.storage.sealed import read_sealed, write_sealed
from bootcourse.study.beyond import lengths
from bootcourse.study.jobs import HELD_OUT
from bootcourse.study.plan import EXPERIMENTS, STUDIES
from bootcourse.study.results import Results, StudyResults, in_assets
from bootcourse.study.tables import bracketed, score

ROADS = held_out_seeds(HELD_OUT, 1000)
ASIDE = ("sensitivity", "clocks", "ablations", "teachers")
LONGEST = 48  # letters of a name that a table shows
MOST = 1e6  # of a return
FORMAT = "bootcourse board 1"
HEADINGS = ("method", "setting", "escape", "drives %", "return [95 %]", "best %", "accidents %", "decisions", "seconds")
BELOW = (
    f"{len(ROADS):,} roads that no agent of the kit trained on. setting: quick, paper, the name of an experiment, or "
    "lesson 15, whose networks are small. escape: the agents that escape on at least "
    f"{100 * ESCAPES:g} % of them; drives: the share of all drives that escape. return: the interquartile mean over "
    "agents, of a single driver the mean over roads; best: its share of the planner's. decisions, seconds of one core: "
    "what the training of one agent took, – where it was not recorded; a method with demonstrations also had 200 "
    "drives of its teacher, about 30,000 decisions."
)

Share = Annotated[float, Meta(ge=0, le=1)]
Cost = Annotated[float, Meta(ge=0)]
Name = Annotated[str, Meta(max_length=1000)]


class Row(Struct, frozen=True, forbid_unknown_fields=True):
    """One line of the board. None: not known."""

    method: Name
    setting: Name
    agents: Annotated[int, Meta(ge=1)]
    returns: Estimate
    escapers: Annotated[int, Meta(ge=0)] | None = None  # agents that escape
    success: Share | None = None  # of all drives
    accidents: Share | None = None  # of all drives
    decisions: Cost | None = None  # of training, per agent
    seconds: Cost | None = None  # of training, per agent, on one core
    own: bool = False  # entered by the user

    def __post_init__(self):
        value, low, high = self.returns
        if not -MOST <= low <= high <= MOST or not abs(value) <= MOST or (self.escapers or 0) > self.agents:
            raise ValueError(f"the numbers of {self.method!r:.40} contradict each other")

    def cells(self, best: float) -> list[str]:
        """In words, in the order of `HEADINGS`. best: the planner's return."""
        shares = [None if share is None else f"{100 * share:.1f}" for share in (self.success, self.accidents)]
        thousands = None if self.decisions is None else round(self.decisions, -3)
        costs = [None if cost is None else f"{cost:,.0f}" for cost in (thousands, self.seconds)]
        escapers = None if self.escapers is None else f"{self.escapers} of {self.agents}"
        found = [
            escapers,
            shares[0],
            bracketed(self.returns),
            f"{100 * self.returns.value / best:.0f}",
            shares[1],
            *costs,
        ]
        return [_short(self.method), _short(self.setting), *("–" if cell is None else cell for cell in found)]


def _short(name: str) -> str:
    """A name on one line, its middle left out if it is long, without control characters, which a terminal obeys."""
    name = "".join(letter if letter.isprintable() else "?" for letter in name)
    return name if len(name) <= LONGEST else f"{name[: LONGEST // 2]}…{name[1 - LONGEST // 2 :]}"


@dataclass(frozen=True, repr=False)
class Board:
    """The rows, from the highest return to the lowest: printed as text, shown as a table in a notebook."""

    rows: tuple[Row, ...]
    best: float  # the planner's return

    def table(self) -> list[list[str]]:
        """The cells of every row, in words."""
        return [row.cells(self.best) for row in self.rows]

    def __repr__(self) -> str:
        table = [list(HEADINGS), *self.table()]
        widths = [max(map(len, column)) for column in zip(*table, strict=True)]
        marks = ["  ", *("> " if row.own else "  " for row in self.rows)]
        lines = []
        for mark, cells in zip(marks, table, strict=True):
            sides = [cell.ljust if column < 2 else cell.rjust for column, cell in enumerate(cells)]
            lines.append(mark + "  ".join(side(width) for side, width in zip(sides, widths, strict=True)).rstrip())
        yours = ["> yours"] if any(row.own for row in self.rows) else []
        return "\n".join([*lines, "", *yours, textwrap.fill(BELOW, 116)])

    def _repr_html_(self) -> str:
        head = joined(html('<th scope="col">{}</th>', heading) for heading in HEADINGS)
        lines = []
        for row, (name, *cells) in zip(self.rows, self.table(), strict=True):
            first = html("<td><strong>{}</strong> (yours)</td>", name) if row.own else html("<td>{}</td>", name)
            lines.append(html("<tr>{}{}</tr>", first, joined(html("<td>{}</td>", cell) for cell in cells)))
        table = html("<table><thead><tr>{}</tr></thead><tbody>{}</tbody></table>", head, joined(lines))
        return str(html('<div style="overflow-x: auto" tabindex="0">{}</div><p>{}</p>', table, BELOW))


def board(*own: str | Path | Result | Rule, keep: str | Path | None = None, teacher: Rule = course_rule) -> Board:
    """The leaderboard of what ships, with rows of your own.

    own: a folder that `bootcourse train` wrote, the result of a `Training`, a rule of your own
    `my_rule(cars, scenario) -> action`, or a file that `keep` made. Agents that differ in nothing but their seed share
    a row. keep: a file such as mine.json, to which your rows are added; those in it already are shown too. teacher: of
    the agents in folders, if they need it to drive. Raises BootcourseError for anything else, for a damaged file, and
    for agents that see another number of cars or need another teacher.
    """
    before = kept_rows(Path(keep)) if keep is not None else []
    mine = [row for one in own for row in entered(one, teacher)]
    if keep is not None:
        mine = keep_rows(Path(keep), before, mine)
    bound = in_assets(FOLDER).bound[DEFAULT.name]
    return ranked([*shipped_rows(), *mine], float(bound.mean()))


def ranked(rows: Sequence[Row], best: float) -> Board:
    """The rows from the highest return to the lowest; equal ones by name."""
    return Board(tuple(sorted(rows, key=lambda row: (-row.returns.value, row.method, row.setting))), best)


def row_of(results: Results, method: str, setting: str, **more) -> Row:
    """The row of one method's agents. more: fields that the scores do not tell."""
    mine = results.of(method)
    return Row(
        display_name(method),
        setting,
        agents=len(mine),
        returns=score(mine, method, "returns"),
        escapers=results.escapers(method),
        success=float(mine.episodes("success").mean()),
        accidents=float(mine.episodes("accident").mean()),
        **more,
    )


def driven(method: str, policies: Sequence[Policy]) -> Results:
    """The drives of some policies on `ROADS`, as agents of a method without a history."""
    drives = [vars(drive_episodes(policy, ROADS)) for policy in policies]
    tested = {name: np.stack([each[name] for each in drives]) for name in drives[0]}
    agents = [{"method": method, "seed": seed} for seed in range(len(drives))]
    return Results(agents, np.full(len(drives), -1), tested, {})


# What ships -----------------------------------------------------------------------------------------


@cache
def shipped_rows() -> tuple[Row, ...]:
    """The rows of what ships, and of the drivers that are not trained."""
    found = in_assets(FOLDER)
    drivers = {"rule": rule_policy(DEFAULT), "idle": idle_policy, "random": random_policy(np.random.default_rng(0))}
    rows = [row_of(driven(name, [policy]), name, "not trained") for name, policy in drivers.items()]
    rows.append(Row(DRIVERS["planner"][0], "best drives found", 1, mean(found.bound[DEFAULT.name])))
    return *rows, *study_rows(found), *second_trap_rows()


def study_rows(found: StudyResults) -> list[Row]:
    """The rows of the studies on the default scenario, and of every experiment there that is not `ASIDE`."""
    parts = []  # (setting, results)
    for name, results in found.results.items():
        if name == "default":
            parts.append(("quick", timed(results)))
        elif STUDIES[name].scenario == DEFAULT:
            parts.append((name, results))
    for name, varied in found.experiments.items():
        for variation, results in varied.items():
            if name not in ASIDE and EXPERIMENTS[name].variations[variation].scenario == DEFAULT:
                parts.append((name if variation in METHODS else f"{name}: {variation}", results))
    return [
        row_of(results, method, words, **costs(results.of(method)))
        for words, results in parts
        for method in results.methods
    ]


def timed(results: Results) -> Results:
    """The default study: where it has no seconds of a method, those in the provenance of the runs that ship."""
    seconds = results.seconds.copy()
    for i, agent in enumerate(results.agents):
        runs = sorted(FOLDER.glob(f"runs/{agent['method']}-*/provenance.json"))
        if np.isnan(seconds[i]) and runs:
            made = read_json(runs[0])
            seconds[i] = made["seconds"] / made["agents"]
    return replace(results, seconds=seconds)


def costs(results: Results) -> dict[str, float | None]:
    """{decisions, seconds}: the means over the agents of what their training took, None where no file tells."""
    return {"decisions": known(decisions_of(results.curves)), "seconds": known(results.seconds)}


def decisions_of(curves: dict[str, np.ndarray]) -> np.ndarray:
    """The decisions of each agent's training, (agents,); NaN if no curve tells. curves: each (agents, episodes)."""
    found = lengths(curves)
    return np.array([np.nan]) if found is None else np.nansum(found, axis=1, dtype=float)


def known(values: Sequence[float] | np.ndarray) -> float | None:
    """The mean, None if a value is not known."""
    return float(np.mean(values)) if np.isfinite(values).all() else None


def second_trap_rows() -> list[Row]:
    """The rows of the agents of the lesson on the second trap."""
    rows = []
    for kind, kept in reference().items():
        method, agents = KINDS[kind].method, len(kept["at"])
        tested = {name: kept[f"study {name}"] for name in ("success", "returns", "accident")}
        results = Results([{"method": method, "seed": i} for i in range(agents)], np.full(agents, -1), tested, {})
        mine = row_of(results, method, "lesson 15", decisions=float(kept["at"][:, -1].mean()))
        rows.append(changed(mine, method=mine.method + KINDS[kind].paid))
    return rows


# Your own -------------------------------------------------------------------------------------------


class Entrant(NamedTuple):
    """An agent of the user's."""

    name: str
    agent: Agent
    scenario: Scenario  # that it was trained on
    teacher: str  # see `teachers.teacher_name`
    decisions: float
    seconds: float


def entered(one: str | Path | Result | Rule, teacher: Rule = course_rule) -> list[Row]:
    """The rows of an entry, see `board`."""
    if isinstance(one, Result):
        return agents_rows(of_training(one), "this training")
    if isinstance(one, str | Path):
        is_file = Path(one).suffix == ".json"
        return read_rows(Path(one)) if is_file else agents_rows(of_folder(Path(one), teacher), str(one))
    if not callable(one) or isinstance(one, type):
        raise BootcourseError(f"{one!r:.80} cannot be entered: give a folder of runs, a training's result, or a rule.")
    row = row_of(driven("rule", [teacher_policy(one)]), "rule", "your rule", own=True)
    return [changed(row, method=str(getattr(one, "__name__", type(one).__name__)))]


def of_training(result: Result) -> list[Entrant]:
    """The agents of a training."""
    seconds = result.seconds / len(result.agents)
    return [
        Entrant(f"{agent.settings.method}-{agent.settings.seed}", agent, result.scenario, result.teacher, its, seconds)
        for agent, its in zip(result.agents, decisions_of(result.curves), strict=True)
    ]


def of_folder(folder: Path, teacher: Rule) -> list[Entrant]:
    """The agents of a folder of runs. Raises BootcourseError if it holds none, a damaged one, or another teacher's."""
    found = []
    for path in find_runs(folder):
        run = load_run(path, teacher)
        agent, made = run.agent.taught_by(teacher_of(teacher, DEFAULT)), run.provenance
        (decisions,) = decisions_of({name: values[None] for name, values in run.curves.items()})
        seconds = made["seconds"] / made["agents"]
        found.append(Entrant(path.name, agent, run.scenario, made.get("teacher", "rule"), decisions, seconds))
    return found


def agents_rows(entrants: Sequence[Entrant], where: str) -> list[Row]:
    """A row for all agents that differ in nothing but their training seed."""
    groups: dict[tuple, list[Entrant]] = {}
    for one in entrants:
        seen = one.agent.actor[0].shape[1]
        if seen != DEFAULT.observation_size:
            raise BootcourseError(
                f"{where}: {one.name} sees {seen} numbers, and the board's road shows {DEFAULT.observation_size}: "
                "train it on a scenario with as many neighbours as the default has."
            )
        groups.setdefault((replace(one.agent.settings, seed=0), one.scenario, one.teacher), []).append(one)
    methods = [settings.method for settings, *_ in groups]
    rows = []
    for (settings, scenario, teacher), group in groups.items():
        words = [where if methods.count(settings.method) == 1 else f"{where}/{group[0].name} ..."]
        words += [f"trained on {scenario.name}"] if scenario != DEFAULT else []
        words += [f"taught by {teacher.partition(' ')[0]}"] if teacher != "rule" else []
        results = driven(settings.method, [one.agent.as_policy() for one in group])
        took = {name: known([getattr(one, name) for one in group]) for name in ("decisions", "seconds")}
        rows.append(row_of(results, settings.method, ", ".join(words), own=True, **took))
    return rows


# Kept in a file -------------------------------------------------------------------------------------


class Kept(Struct, forbid_unknown_fields=True):
    """What the file of `keep` holds, beside its seal."""

    format: str
    rows: list[Row]


def kept_rows(path: Path) -> list[Row]:
    """The rows in a file to which others will be added; none if it is not there. Raises BootcourseError as above."""
    if path.suffix != ".json":
        raise BootcourseError(f"{path} does not end in .json: give the file that ending.")
    return read_rows(path) if path.exists() else []


def read_rows(path: Path) -> list[Row]:
    """The rows that `keep` wrote. Raises BootcourseError if the file is missing or damaged."""
    content = read_sealed(path, FORMAT)
    with decoding(path):
        return [changed(row, own=True) for row in convert(content, Kept).rows]


def keep_rows(path: Path, before: Sequence[Row], mine: Sequence[Row]) -> list[Row]:
    """Write both to a file; of two rows with the same method and setting, mine. Returns what the file holds."""
    rows = list({(row.method, row.setting): row for row in (*before, *mine)}.values())
    write_sealed(path, {"format": FORMAT, "rows": to_builtins(rows)})
    return rows
