"""How safe and how good does looking ahead make each base policy, and what does a wrong model cost?

    bootcourse study look-ahead --out DIR

A cell is a base policy in one form: alone, with rollouts, or with the shield; its agents drive the same held-out roads.
It trains nothing. The agents are runs in DIR/agents/METHOD (`bootcourse train --method METHOD --seeds 10 --out
DIR/agents/METHOD`) or, where there is no such folder, those that ship.

In its table accidents are counted over all drives of a base policy's agents, with the exact (Clopper-Pearson) interval
of so many independent drives; returns are means of the agents' means, with a bootstrap interval over agents.
"""

import time
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import NamedTuple

import numpy as np
from gymnasium.vector import AutoresetMode

from bootcourse.episodes.driving import steps
from bootcourse.episodes.evaluate import held_out_seeds
from bootcourse.episodes.lookahead import HORIZON, lookahead, lookahead_shield
from bootcourse.episodes.models import MODELS
from bootcourse.errors import BootcourseError, check_known
from bootcourse.files import write_arrays
from bootcourse.learn.agent import Agent
from bootcourse.methods import display_name
from bootcourse.policies import Policy, rule_policy
from bootcourse.research.experiment import Computed, Experiment, folder
from bootcourse.research.jobs import HELD_OUT, Interrupted, Workplace, orphaned
from bootcourse.research.results import Results, agent_entries, as_arrays, load_results, weights_of
from bootcourse.research.tables import markdown
from bootcourse.road.vector_env import TrapVectorEnv
from bootcourse.scenario import DEFAULT
from bootcourse.statistics import Estimate, interval, rate
from bootcourse.storage.assets import FOLDER, shipped
from bootcourse.storage.runs import find_runs, load_run

NAME, TOGETHER = "look-ahead", 1000  # of the experiment; roads that are driven side by side
FORMS = {"alone": None, "rollouts": lookahead, "shield": lookahead_shield}
FORM_NAMES = {"alone": "alone", "rollouts": "rollouts", "shield": "shield by simulation"}
BASES = {"ppo_cloned": 10, "bootstrapped": 10, "soft": 5, "sac": 10, "demos": 5, "bc": 5, "rule": 1}  # {base: agents}
CLOSELY = ("ppo_cloned", "bootstrapped")  # the base policies whose model is varied
HORIZONS = (3, 6, 15)
ROADS, MANY = 1000, 10_000  # held-out roads of an agent: mostly, and of the safest
FEW, FEWER = 300, 100  # of long computations
AIMS = ((1.0, True), (1.0, False), (0.8, True), (0.8, False))  # (γ of an imagined drive, with W): what leads SAC out?
SHIPPING = 10  # agents of a base policy of which not all ship elsewhere: their actors ship with this experiment


@dataclass(frozen=True)
class Cell:
    """The agents of a base policy, looking ahead in one way, each on the same roads."""

    base: str  # a method, or "rule"
    form: str = "rollouts"  # one of FORMS
    agents: int = 10
    roads: int = ROADS
    horizon: int = HORIZON  # decisions
    model: str = "exact"  # one of MODELS
    gamma: float = 1.0  # of an imagined drive
    with_worth: bool = True  # of the speed at its end, W

    def __post_init__(self):
        check_known("Base policy", self.base, BASES)
        check_known("Form", self.form, FORMS)
        check_known("Model", self.model, MODELS)

    @property
    def name(self) -> str:
        """Such as "ppo_cloned, shield, twice the time gap" or "sac, rollouts, gamma 0.8"."""
        parts = [self.base, self.form]
        parts += [f"{self.horizon} decisions"] if self.horizon != HORIZON else []
        parts += [self.model] if self.model != "exact" else []
        parts += [f"{self.roads} roads"] if self.roads == MANY else []
        parts += [f"gamma {self.gamma:g}"] if self.gamma != 1 else []
        parts += ["without W"] if not self.with_worth else []
        return ", ".join(parts)


def every_cell() -> list[Cell]:
    """Every cell, those that matter most first."""
    wrong = [model for model in MODELS if model != "exact"]
    plain = [Cell(base, form, agents) for form in ("alone", "shield") for base, agents in BASES.items()]
    closely = [Cell(base, agents=BASES[base]) for base in ("ppo_cloned", "rule", "bootstrapped", "sac")]
    shields = [Cell("ppo_cloned", "shield", model=model) for model in wrong]
    horizons = [Cell("ppo_cloned", roads=FEWER, horizon=horizon) for horizon in HORIZONS]
    others = [Cell(base, agents=BASES[base], roads=FEWER) for base in ("soft", "demos", "bc")]
    rollouts = [Cell("ppo_cloned", model=model) for model in wrong]
    most = [Cell("ppo_cloned", "shield", roads=MANY)]
    most += [Cell("bootstrapped", "shield", roads=FEW, model=model) for model in wrong]
    most += [Cell("bootstrapped", roads=ROADS if model == wrong[0] else FEW, model=model) for model in wrong]
    aims = [Cell("sac", roads=FEWER, gamma=gamma, with_worth=worth) for gamma, worth in AIMS[1:]]
    return [*plain, *closely, *shields, *horizons, *others, *rollouts, *most, *aims]


def cells(seeds: int = max(BASES.values()), tests: int = MANY) -> dict[str, dict]:
    """The fields of every cell, with at most so many agents and roads."""
    fields = {cell.name: vars(cell) for cell in every_cell()}
    return {
        name: each | {"agents": min(seeds, each["agents"]), "roads": min(tests, each["roads"])}
        for name, each in fields.items()
    }


def run(at: Workplace, **fields) -> None:
    """Drive a cell with the agents in the study's folder `agents`, and with those that ship."""
    write_arrays(at.job / "results.npz", as_arrays(drive_cell(Cell(**fields), at.study / "agents")))


def drive_cell(cell: Cell, trained: Path) -> Results:
    """Drive a cell with the agents in trained/METHOD, see `agents_of`. Raises Interrupted if it is stopped.

    Measured, (agents,): roads, returns and success (means over the roads), accidents (how many), decisions, overruled
    (of these decisions) and seconds of one core. The weights: actors that ship, see `SHIPPING`.
    """
    make, agents = FORMS[cell.form], agents_of(cell.base, cell.agents, trained)
    drivers = [rule_policy(DEFAULT)] if cell.base == "rule" else [agent.as_policy() for agent in agents]
    measures = []
    for i, driver in enumerate(drivers):
        counted = {"gamma": cell.gamma, "with_worth": cell.with_worth}
        policy = make(driver, cell.horizon, DEFAULT, MODELS[cell.model], seed=i, **counted) if make else driver
        measures.append(measured(policy, held_out_seeds(HELD_OUT, cell.roads)))
    entries = agent_entries([agent.settings for agent in agents])
    return Results(
        entries or [{"method": "rule", "seed": 0, "teacher": "rule"}],
        np.full(len(drivers), -1),
        measured={name: np.array([one[name] for one in measures]) for name in measures[0]},
        weights=weights_of(agents, "actor") if (cell.form, cell.agents) == ("alone", SHIPPING) else {},
    )


def agents_of(base: str, agents: int, trained: Path) -> list[Agent]:
    """The agents 0, 1, ... of a method: runs in trained/METHOD and those that ship. None for the rule.

    Raises BootcourseError, with the command that trains them, if some are missing.
    """
    if base == "rule":
        return []
    places = [*([trained / base] if (trained / base).is_dir() else []), FOLDER / "runs"]
    runs = {path.name: path for place in reversed(places) for path in find_runs(place)}
    by_seed = shipped_actors(base) | {
        seed: load_run(runs[f"{base}-{seed}"]).agent for seed in range(agents) if f"{base}-{seed}" in runs
    }
    if missing := [str(seed) for seed in range(agents) if seed not in by_seed]:
        command = f"bootcourse train --method {base} --seeds {agents} --out {trained / base}"
        raise BootcourseError(f"There is no agent of {base} with the seed {', '.join(missing)}: run `{command}`.")
    return [by_seed[seed] for seed in range(agents)]


def shipped_actors(base: str) -> dict[int, Agent]:
    """{seed: the agent that drove the shipped cell of a base policy alone}; without its critics."""
    path = shipped(NAME) / f"{folder(Cell(base, 'alone').name)}.npz"
    if not path.exists():
        return {}
    results = load_results(path)
    kept = [results.agent(i) for i in range(len(results.weights.get("actor.0", ())))]
    return {agent.settings.seed: agent for agent in kept}


def measured(driver: Policy, roads: Sequence[int]) -> dict[str, float]:
    """What a driver did on some roads, see `drive_cell`."""
    returns, success, began = [], [], time.process_time()
    accidents = decisions = overruled = 0
    for first in range(0, len(roads), TOGETHER):
        seeds = list(roads[first : first + TOGETHER])
        earned, hurt = np.zeros(len(seeds)), np.zeros(len(seeds), dtype=bool)
        for step in steps(driver, TrapVectorEnv(len(seeds), DEFAULT, AutoresetMode.DISABLED), seeds):
            if orphaned():
                raise Interrupted(NAME)
            earned += step.rewards
            hurt |= step.infos["accident"] > 0
            decisions += int(step.running.sum())
            overruled += int((step.running & getattr(driver, "overruled", False)).sum())
        returns, success = [*returns, *earned], [*success, *step.infos["is_success"]]
        accidents += int(hurt.sum())
    return {
        "roads": len(roads), "returns": float(np.mean(returns)), "success": float(np.mean(success)),
        "accidents": accidents, "decisions": decisions, "overruled": overruled, "seconds": time.process_time() - began,
    }  # fmt: skip


class Score(NamedTuple):
    """What some agents of a base policy reached, each on the same roads."""

    agents: int
    drives: int
    returns: Estimate
    accidents: int
    accident_rate: Estimate
    success: float  # share of the drives
    overruled: float  # share of the decisions
    milliseconds: float  # of one core, for each decision

    @property
    def roads(self) -> int:
        """Of each agent."""
        return self.drives // self.agents


def score(cells: dict[str, Results], cell: Cell) -> Score | None:
    """The score of a cell's agents; None if `cells` does not have it."""
    if cell.name not in cells:
        return None
    of = cells[cell.name].measured
    drives, accidents, decisions = (int(of[name].sum()) for name in ("roads", "accidents", "decisions"))
    return Score(
        agents=len(of["roads"]),
        drives=drives,
        returns=interval(of["returns"], np.mean),
        accidents=accidents,
        accident_rate=rate(np.arange(drives) < accidents),
        success=float(of["success"].mean()),
        overruled=float(of["overruled"].sum() / decisions),
        milliseconds=1000 * float(of["seconds"].sum() / decisions),
    )


def rows(cells: dict[str, Results], wanted: Sequence[Cell]) -> tuple[list[str], list[list[str]]]:
    """(headings, rows): the cells of `wanted` that were computed."""
    lines = []
    for cell in wanted:
        if one := score(cells, cell):
            value, low, high = one.returns
            about = f"{value:.1f}" + (f" [{low:.1f}, {high:.1f}]" if np.isfinite(low) else "")
            each, low, high = (1000 * number for number in one.accident_rate)
            accidents = f"{one.accidents} in {one.drives:,}: {each:.2f} [{low:.2f}, {high:.2f}]"
            lines.append(
                [display_name(cell.base), FORM_NAMES[cell.form], str(cell.horizon) if cell.form != "alone" else ""]
                + [cell.model, str(one.agents), f"{one.roads:,}", about, accidents, f"{100 * one.success:.1f}"]
                + [f"{1000 * one.overruled:.1f}", f"{one.milliseconds:.2f}"]
            )
    headings = ["base policy", "form", "horizon", "model", "agents", "roads", "return [95 %]"]
    return [*headings, "accidents in 1,000 [95 %]", "ahead, %", "overruled in 1,000", "ms a decision"], lines


def section(computed: dict[str, Computed], folder: Path) -> list[str]:
    """Every cell that was computed."""
    return ["## Looking ahead\n", LOOK_AHEAD, markdown(*rows(computed[NAME], every_cell()))]


LOOK_AHEAD = """Nothing is trained here: trained agents drive alone, with rollouts, or with a shield that overrules only
an action that is imagined to end in an accident; with the exact model of the road, and with wrong ones. Return: mean
over agents with its 95 % interval over agents. Accidents: over all drives, with the exact (Clopper-Pearson) interval,
as if all drives were independent. The roads are those that each agent drives, the first of the held-out ones. Time: of
one core, on a machine with other work.
"""

EXPERIMENT = Experiment(NAME, cells, run, section=section)
