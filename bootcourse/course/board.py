"""The leaderboard: every method of the kit on the same held-out roads, beside agents and teachers of your own.

    board()                        # what ships
    board("runs/mine", my_rule)    # and the agents in a folder, and a rule controller of your own

Everyone drives the 1,000 roads of block 1 of the default scenario, on which no agent of the kit trains. The last
two columns compare at an equal budget (study/beyond.py). Experiments that vary the paper's method or the teacher to
learn about them (`ASIDE` there) stay out, but for DAgger: their tables stand in the report.
"""

import textwrap
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cache
from pathlib import Path
from typing import NamedTuple

import numpy as np
from msgspec.structs import replace as changed

from bootcourse.course.board_row import HEADINGS, Row, keep_rows, kept_rows, read_rows
from bootcourse.course.shipped import shipped_bound
from bootcourse.episodes.evaluate import drive_episodes, held_out_seeds
from bootcourse.errors import BootcourseError
from bootcourse.files import read_json
from bootcourse.learn.agent import Agent
from bootcourse.learn.teachers import Rule, course_rule, teacher_of, teacher_policy
from bootcourse.learn.training import Result
from bootcourse.markup import html, joined
from bootcourse.methods import DRIVERS, display_name
from bootcourse.policies import Policy, idle_policy, random_policy, rule_policy
from bootcourse.research.beyond import (
    DECISIONS,
    SECONDS,
    WINDOW,
    Within,
    after_seconds,
    at_budget,
    entries,
    lengths,
    within,
)
from bootcourse.research.jobs import HELD_OUT
from bootcourse.research.results import Results, StudyResults, in_assets
from bootcourse.research.tables import score
from bootcourse.scenario import DEFAULT, Scenario
from bootcourse.statistics import ESCAPES, mean
from bootcourse.storage.assets import FOLDER
from bootcourse.storage.runs import find_runs, load_run

ROADS = held_out_seeds(HELD_OUT, 1000)
BELOW = (
    f"{len(ROADS):,} roads that no agent of the kit trained on. setting: quick, paper, the name of an experiment, or "
    "lesson 15, whose networks are small. escape: the agents that escape on at least "
    f"{100 * ESCAPES:g} % of them; drives: the share of all drives that escape. return: the interquartile mean over "
    "agents, of a single driver the mean over roads; best: its share of the planner's. decisions: of one agent's whole "
    "training; a method with demonstrations also had 200 drives of its teacher, about 30,000 decisions. seconds of one "
    "core: wall time of training and test in our studies, of training alone for your own; other work on the machine "
    "makes it up to twice as long. The planner has no training and takes about 12.5 ms for a decision."
)
EQUAL = (
    f"The last two columns are at an equal budget: {DECISIONS[0]:,} decisions, or {SECONDS[0]} seconds of one core as "
    f"if every decision took equally long. They show the return in training, with drawn actions: of the last {WINDOW} "
    "episodes that ended by then, the interquartile mean over the agents that trained as long. 9 of 10: one did not. "
    "A training has a fixed number of episodes and is short where an agent crashes early, so the mean of the others "
    "can be too high. Decisions of episodes that had not ended are not counted, of PPO's 512 roads up to 76,800, "
    "and the first to end are those with an early accident. The teacher drives the beginning of "
    "jump-start RL's episodes. –: not recorded, or the training ended before."
)


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
        return "\n".join([*lines, "", *yours, textwrap.fill(BELOW, 116), "", textwrap.fill(EQUAL, 116)])

    def _repr_html_(self) -> str:
        head = joined(html('<th scope="col">{}</th>', heading) for heading in HEADINGS)
        lines = []
        for row, (name, *cells) in zip(self.rows, self.table(), strict=True):
            first = html("<td><strong>{}</strong> (yours)</td>", name) if row.own else html("<td>{}</td>", name)
            lines.append(html("<tr>{}{}</tr>", first, joined(html("<td>{}</td>", cell) for cell in cells)))
        table = html("<table><thead><tr>{}</tr></thead><tbody>{}</tbody></table>", head, joined(lines))
        below = joined(html("<p>{}</p>", text) for text in (BELOW, EQUAL))
        return str(html('<div style="overflow-x: auto" tabindex="0">{}</div>{}', table, below))


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
    bound = shipped_bound()
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
    return *rows, *study_rows(found)


def study_rows(found: StudyResults) -> list[Row]:
    """The rows of the studies on the default scenario, of every experiment there that is not `ASIDE`, and of DAgger."""
    parts = [(setting, timed(its) if setting == "quick" else its) for setting, its in entries(found)]
    if dagger := found.experiments.get("teachers", {}).get("rule, dagger"):
        parts.append((f"teachers, {dagger.tested['returns'].shape[1]} roads", dagger))
    return [
        row_of(results, method, setting, **costs(results.of(method)))
        for setting, results in parts
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


Cost = dict[str, float | Within | None]


def costs(results: Results) -> Cost:
    """What the training of some agents cost, and what they earned at an equal budget, as `in_row` puts it."""
    return in_row(of_agents(results.curves, results.seconds))


def of_agents(curves: dict[str, np.ndarray], seconds: np.ndarray) -> dict[str, np.ndarray]:
    """Numbers of each agent, (agents,), NaN where no file tells. curves: each (agents, episodes)."""
    return {
        "decisions": decisions_of(curves),
        "seconds": seconds,
        "at_decisions": at_budget(curves, DECISIONS[0]),
        "at_seconds": after_seconds(curves, SECONDS[0], seconds),
    }


def in_row(found: dict[str, np.ndarray]) -> Cost:
    """The fields of a row: mean decisions and seconds, and the returns at each budget; None if not known."""
    return {name: within(its) if name.startswith("at_") else known(its) for name, its in found.items()}


def decisions_of(curves: dict[str, np.ndarray]) -> np.ndarray:
    """The decisions of each agent's training, (agents,); NaN if no curve tells. curves: each (agents, episodes)."""
    found = lengths(curves)
    return np.array([np.nan]) if found is None else np.nansum(found, axis=1, dtype=float)


def known(values: Sequence[float] | np.ndarray) -> float | None:
    """The mean, None if a value is not known."""
    return float(np.mean(values)) if np.isfinite(values).all() else None


# Your own -------------------------------------------------------------------------------------------


class Entrant(NamedTuple):
    """An agent of the user's."""

    name: str
    agent: Agent
    scenario: Scenario  # that it was trained on
    teacher: str  # see `teachers.teacher_name`
    curves: dict[str, np.ndarray]  # of its training, each (1, episodes)
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
    found, seconds = [], result.seconds / len(result.agents)
    for i, agent in enumerate(result.agents):
        name, curves = f"{agent.settings.method}-{agent.settings.seed}", {n: v[[i]] for n, v in result.curves.items()}
        found.append(Entrant(name, agent, result.scenario, result.teacher, curves, seconds))
    return found


def of_folder(folder: Path, teacher: Rule) -> list[Entrant]:
    """The agents of a folder of runs. Raises BootcourseError if it holds none, a damaged one, or another teacher's."""
    found = []
    for path in find_runs(folder):
        run = load_run(path, teacher)
        agent, made = run.agent.taught_by(teacher_of(teacher, DEFAULT)), run.provenance
        curves = {name: values[None] for name, values in run.curves.items()}
        seconds = made["seconds"] / made["agents"]
        found.append(Entrant(path.name, agent, run.scenario, made.get("teacher", "rule"), curves, seconds))
    return found


def agents_rows(entrants: Sequence[Entrant], where: str) -> list[Row]:
    """A row for all agents that differ in nothing but their training seed."""
    groups: dict[tuple, list[Entrant]] = {}
    for one in entrants:
        seen = one.agent.actor[0].shape[1]
        if seen != DEFAULT.observation_size:
            raise BootcourseError(
                f"{where}: {one.name} sees {seen} numbers, and the board's road shows {DEFAULT.observation_size}: "
                "train it on a scenario with the default's Sight."
            )
        groups.setdefault((replace(one.agent.settings, seed=0), one.scenario, one.teacher), []).append(one)
    methods = [settings.method for settings, *_ in groups]
    rows = []
    for (settings, scenario, teacher), group in groups.items():
        words = [where if methods.count(settings.method) == 1 else f"{where}/{group[0].name} ..."]
        words += [f"trained on {scenario.name}"] if scenario != DEFAULT else []
        words += [f"taught by {teacher.partition(' ')[0]}"] if teacher != "rule" else []
        results = driven(settings.method, [one.agent.as_policy() for one in group])
        each = [of_agents(one.curves, np.array([one.seconds])) for one in group]
        took = in_row({name: np.concatenate([its[name] for its in each]) for name in each[0]})
        if scenario != DEFAULT:  # its returns are those of another road
            took |= {"at_decisions": None, "at_seconds": None}
        rows.append(row_of(results, settings.method, ", ".join(words), own=True, **took))
    return rows
