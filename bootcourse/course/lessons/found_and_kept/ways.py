"""What the way out is worth to an agent while it learns.

    bootcourse study ways --out DIR    # some fifteen minutes of one core

The first ten agents of each kind are the *ten others* (research/experiments/stress.py); with demonstrations alone there
are twenty more. They train for as many episodes as the study's.
Every `EVERY` episodes each drives the same roads by its most probable actions. Their worth is Equation 2 with the
learner's own γ; the bonus is not counted. Of each look one drive is kept, beside trap 1, to be shown.
"""

from pathlib import Path

import numpy as np

from bootcourse.episodes.evaluate import drive_episodes, held_out_seeds
from bootcourse.episodes.record import record
from bootcourse.learn import compiled_training
from bootcourse.learn.agent import Agent
from bootcourse.learn.settings import settings_for
from bootcourse.policies import idle_policy
from bootcourse.research.cells import results_of
from bootcourse.research.experiment import Computed, Experiment
from bootcourse.research.experiments.stress import FIRST, KINDS
from bootcourse.research.jobs import HELD_OUT, Interrupted, orphaned
from bootcourse.research.planner import discounted_values
from bootcourse.research.results import Results, agent_entries
from bootcourse.research.tables import markdown
from bootcourse.road.state import EGO, TRAP_1, X, Y
from bootcourse.scenario import DEFAULT

EPISODES, EVERY, ROADS = 2000, 50, 20
BEFORE = 999  # the last look before β ends: at most so many episodes
LATE = 1500  # from here on looks count as the end of the training: an agent crashes in a single one
SHOWN, SECONDS = 10, 40  # the road of the drive that is kept, and how much of it
CELLS = {"demos": 30, "demos, β for ever": 30, "bootstrapped": 10}  # and how many agents
SECTION = f"""Every {EVERY} training episodes agents drive {ROADS} held-out roads by their most probable actions. The
first ten of each kind are those trained for twice the episodes (below), here up to episode {EPISODES:,}. A drive's
worth is its discounted reward without the bonus, at the agent's own γ.
"""


def cells(episodes: int = EPISODES) -> dict[str, dict]:
    """Agents with demonstrations whose share β ends or never ends, and with both aids."""
    return {cell: {"kind": cell, "seeds": seeds, "episodes": episodes} for cell, seeds in CELLS.items()}


def watched(kind: str, seeds: int, episodes: int) -> Results:
    """Train the agents of a kind, and look at each while it learns.

    Notes, (agents, looks, ...): episode, worth, success, return and accident (means of `ROADS` drives), and way (looks,
    `SECONDS` + 1, 2): of one drive the ego's x - x of trap 1 and its y, m, NaN after an accident. Raises Interrupted.
    """
    method, changes = KINDS[kind]
    settings = [settings_for(method, seed=seed, **changes) for seed in range(FIRST, FIRST + seeds)]
    looks, curves = [], []
    for one in settings:
        if orphaned():
            raise Interrupted(kind)
        seen: list[tuple] = []

        def look(finished: int, agent: Agent, seen: list = seen) -> None:
            while finished >= EVERY * len(seen):
                seen.append((finished, *looked_at(agent)))

        trained = compiled_training.train(one, episodes, watch=look)
        end = (episodes, *looked_at(trained.agent))
        looks.append([*seen, *[end] * (episodes // EVERY + 1 - len(seen))])  # the last episodes may end together
        curves.append(trained.curves["success"])
    names = ("episode", "worth", "success", "return", "accident", "way")
    notes = {name: np.array([[row[i] for row in each] for each in looks], np.float32) for i, name in enumerate(names)}
    return Results(
        agent_entries(settings), np.full(seeds, -1), curves={"success": np.array(curves, np.float32)}, notes=notes
    )


def looked_at(agent: Agent) -> tuple[float, float, float, float, np.ndarray]:
    """Worth, success, return and accidents on `ROADS`, and the way of one drive: see `watched`."""
    policy, roads = agent.as_policy(), held_out_seeds(HELD_OUT, ROADS)
    driven = drive_episodes(policy, roads)
    worth = discounted_values(policy, roads, DEFAULT, agent.settings.gamma).mean()
    return worth, driven.success.mean(), driven.returns.mean(), (driven.accident > 0).mean(), way(agent)


def way(agent: Agent) -> np.ndarray:
    """Where the ego is beside trap 1 at each second of one drive: (`SECONDS` + 1, 2), NaN after an accident."""
    drive, path = record(agent.as_policy(), [SHOWN])[0], np.full((SECONDS + 1, 2), np.nan)
    cars = drive.states[:: DEFAULT.clock.steps][: SECONDS + 1]
    path[: len(cars)] = np.column_stack([cars[:, EGO, X] - cars[:, TRAP_1, X], cars[:, EGO, Y]])
    return path


def section(computed: dict[str, Computed], folder: Path) -> list[str]:
    """What the ways out are worth before β ends and at the end of the training."""
    rows = []
    for kind, agents in computed["ways"].items():
        worths = [", ".join(f"{each:.2f}" for each in sorted(out(agents, look))) for look in (BEFORE, EPISODES)]
        rows.append([kind, *worths, f"{(at(agents, EPISODES, 'success') > 0.5).sum()} of {len(agents)}"])
    headings = ["agents", "worth of the ways out just before β ends", f"at episode {EPISODES:,}", "ahead then"]
    idle = f"Staying behind is worth {staying(settings_for('demos').gamma):.2f}.\n"
    return ["## What the way out is worth in training\n", SECTION + idle, markdown(headings, rows)]


def staying(gamma: float) -> float:
    """The worth of a drive that stays behind trap 1."""
    return float(discounted_values(idle_policy, [SHOWN], DEFAULT, gamma)[0])


def gives_up(agents: Results) -> int:
    """The first agent that gets ahead on most roads when β ends and, from 100 episodes later on, on few."""
    ahead, looks = agents.notes["success"] > 0.5, np.arange(agents.notes["success"].shape[1]) * EVERY
    end = EPISODES // 2
    return int(np.flatnonzero(ahead[:, looks == end].all(axis=1) & ~ahead[:, looks >= end + 100].any(axis=1))[0])


def had_a_way(agents: Results) -> np.ndarray:
    """Which agents get ahead on most roads just before β ends, (agents,) bool."""
    return at(agents, BEFORE, "success") > 0.5


def late(agents: Results, name: str = "worth") -> np.ndarray:
    """What was noted of each agent from episode `LATE` on: the median of the looks, (agents,)."""
    return np.median(agents.notes[name][:, LATE // EVERY :], axis=1)


def out(agents: Results, episode: int) -> np.ndarray:
    """The worths at a look of those agents that then get ahead on most roads."""
    return at(agents, episode)[at(agents, episode, "success") > 0.5]


def at(agents: Results, episode: int, name: str = "worth") -> np.ndarray:
    """What was noted of each agent at the last look up to an episode, (agents, ...)."""
    which = [int(np.flatnonzero(row <= episode)[-1]) for row in agents.notes["episode"]]
    return agents.notes[name][np.arange(len(agents)), which]


EXPERIMENT = Experiment("ways", cells, results_of(watched), ("success",), section)
