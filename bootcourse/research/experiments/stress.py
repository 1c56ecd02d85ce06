"""Do our claims survive twice the episodes, other seeds, another implementation of the learner, half the time step?

Each agent is trained by the compiled learner (learn/compiled_training.py), which shares no update and no random number
with the study's, for twice as many episodes, and is tested on the study's held-out roads, and on 200 of them with half
the time step. `bootcourse.research.claims` reads the results, and makes the report's section of them.
"""

from dataclasses import replace
from pathlib import Path

import numpy as np

from bootcourse.episodes.evaluate import drive_episodes, held_out_seeds
from bootcourse.learn import compiled_training
from bootcourse.learn.settings import settings_for
from bootcourse.research.cells import TESTS, results_of, smaller
from bootcourse.research.experiment import Computed, Experiment
from bootcourse.research.jobs import HELD_OUT, Interrupted, orphaned
from bootcourse.research.results import Results, agent_entries
from bootcourse.research.tables import bracketed, escaped, markdown
from bootcourse.scenario import DEFAULT
from bootcourse.statistics import interval

FIRST = 100  # the first seed: those of the study begin at 0
EPISODES = 4000  # the study has 2,000
ROADS = 200  # with half the time step
FINER = replace(DEFAULT, clock=replace(DEFAULT.clock, simulation_rate=2 * DEFAULT.clock.simulation_rate))
SECTION = f"""Ten agents of each kind, seeds {FIRST} to {FIRST + 9}, learned on {EPISODES:,} roads each by the compiled
learner, whose updates and random numbers are not the study's. They are tested on the study's 1,000 held-out roads, and
on the first {ROADS} of them with half the time step ({FINER.clock.dt:g} s).
"""
KINDS = {  # {cell: (method, what is changed)}
    "sac": ("sac", {}),
    "soft": ("soft", {}),
    "demos": ("demos", {}),
    "bootstrapped": ("bootstrapped", {}),
    "soft, ξ stays at 2": ("soft", {"xi_fixed": 2.0}),
    "soft, ξ stays at 0.1": ("soft", {"xi_fixed": 0.1}),
    "soft, ξ falls to 0.1": ("soft", {"xi_min": 0.1}),
    "bootstrapped, c = 0": ("bootstrapped", {"bonus": 0.0}),
    "demos, β for ever": ("demos", {"beta_episodes": None}),
    "bootstrapped, β for ever": ("bootstrapped", {"beta_episodes": None}),
}


def cells(seeds: int = 10, episodes: int = EPISODES, tests: int = TESTS) -> dict[str, dict]:
    """The kinds of agents that the claims are about."""
    numbers = {"seeds": seeds, "episodes": episodes, "tests": tests}
    return {cell: {"kind": cell, **numbers} for cell in KINDS}


def stressed(kind: str, seeds: int, episodes: int, tests: int) -> Results:
    """Train and test the agents of a kind. Measured, (agents,): finer_success, finer_returns, finer_accident, with half
    the time step. Raises Interrupted.
    """
    method, changes = KINDS[kind]
    trained = []
    for seed in range(FIRST, FIRST + seeds):
        if orphaned():
            raise Interrupted(kind)
        trained.append(compiled_training.train(settings_for(method, seed=seed, **changes), episodes))
    roads = held_out_seeds(HELD_OUT, tests)
    each = [drive_episodes(one.agent.as_policy(), roads) for one in trained]
    finer = [drive_episodes(one.agent.as_policy(), roads[:ROADS], FINER) for one in trained]
    measured = {f"finer_{name}": [getattr(one, name).mean() for one in finer] for name in ("success", "returns")}
    measured["finer_accident"] = [(one.accident > 0).mean() for one in finer]
    return Results(
        agent_entries([one.agent.settings for one in trained]),
        np.full(seeds, -1),
        {name: smaller(np.stack([getattr(one, name) for one in each])) for name in vars(each[0])},
        {name: np.stack([one.curves[name] for one in trained]).astype(np.float32) for name in ("success", "return")},
        measured={name: np.array(values) for name, values in measured.items()},
    )


def section(computed: dict[str, Computed], folder: Path) -> list[str]:
    """Who escapes after twice the episodes, and with half the time step."""
    rows = []
    for kind, agents in computed["stress"].items():
        finer = {name: each.mean() for name, each in agents.measured.items()}
        rows.append([
            kind, escaped(agents, agents.methods[0]), bracketed(interval(agents.scores("returns"))),
            f"{100 * agents.scores('accident').mean():.1f}", f"{finer['finer_returns']:.1f}",
            f"{100 * finer['finer_accident']:.1f}",
        ])  # fmt: skip
    headings = ["agents", "escape", "return [95 %]", "accidents, %", "return, half the step", "accidents, %"]
    return ["## Twice the episodes, another implementation, other seeds\n", SECTION, markdown(headings, rows)]


EXPERIMENT = Experiment("stress", cells, results_of(stressed), ("success",), section)
