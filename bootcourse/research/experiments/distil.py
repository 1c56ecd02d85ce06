"""Can a network learn from the 26 numbers what the look-ahead does? Four tries.

    bootcourse study distil --out DIR

In each round the student drives, and the look-ahead of PPO after cloning (the base, whose weights ship) labels every
state that the student reaches. The student then learns from the labels of all rounds (DAgger, Ross, Gordon & Bagnell,
arXiv 1011.0686). The one after the last round is tested, never a chosen one.
"""

from dataclasses import replace
from pathlib import Path

import numpy as np
import torch
from torch.nn.functional import cross_entropy

from bootcourse.episodes.driving import steps
from bootcourse.episodes.evaluate import held_out_seeds
from bootcourse.episodes.lookahead import nine_drives
from bootcourse.learn.agent import Agent
from bootcourse.learn.networks import init_mlp, mlp
from bootcourse.research.cells import results_of
from bootcourse.research.experiment import Computed, Experiment
from bootcourse.research.experiments.lookahead import NAME as LOOK_AHEAD
from bootcourse.research.experiments.lookahead import ROADS, Cell, measured, shipped_actors
from bootcourse.research.jobs import HELD_OUT
from bootcourse.research.results import Results, agent_entries
from bootcourse.research.tables import markdown
from bootcourse.road.branching import advance
from bootcourse.road.constants import constants
from bootcourse.road.observation import observe_all
from bootcourse.road.vector_env import TrapVectorEnv
from bootcourse.scenario import DEFAULT, N_ACTIONS

BASE, AGENTS, ROUNDS, DRIVES = "ppo_cloned", 2, 4, 250  # DRIVES: roads of a round
UPDATES, BATCH, RATE = 1500, 512, 3e-4  # gradient steps of a round, states in each, Adam's step
WORST = -5.0  # regression: a value further below the best counts as this
OFTEN, SECONDS = 20.0, 5  # weight of a state in which the label is not the base's action; decisions driven on from it

TRIES = {  # {what is learned: arguments of `distilled`}
    "the best action": {"target": "actions"},
    "the action of the shield": {"target": "shield", "weight": OFTEN},
    "the best action, also further on": {"target": "actions", "onward": SECONDS},
    "nine values, 256 x 256 neurons": {"target": "values", "hidden": (256, 256)},
}


def distilled(target: str, hidden: tuple[int, ...] = (), weight: float = 1.0, onward: int = 0) -> Results:
    """Train a student from each of some base agents, and test it alone.

    target: "actions", "shield" or "values". hidden: of a new network; () begins with the base's weights. weight: of a
    state in which the label is not the base's action. onward: from such states, do what the label says, let the student
    drive on for so many decisions, and label what it reaches. Measured, (agents,): see `lookahead.drive_cell`.
    """
    bases = [shipped_actors(BASE)[seed] for seed in range(AGENTS)]
    students = [_student(base, target, hidden, weight, onward) for base in bases]
    each = [measured(student.as_policy(), held_out_seeds(HELD_OUT, ROADS)) for student in students]
    numbers = {name: np.array([one[name] for one in each]) for name in each[0]}
    return Results(agent_entries([student.settings for student in students]), np.full(AGENTS, -1), measured=numbers)


def _student(base: Agent, target: str, hidden: tuple[int, ...], weight: float, onward: int) -> Agent:
    generator, rounds = torch.Generator().manual_seed(base.settings.seed), []
    sizes = (DEFAULT.observation_size, *hidden, N_ACTIONS)
    layers = [layer.clone().requires_grad_() for layer in (init_mlp(sizes, [generator]) if hidden else base.actor)]
    student = Agent(replace(base.settings, hidden=hidden or base.settings.hidden), layers, [], 0.0)
    optimiser, driver = torch.optim.Adam(layers, RATE), (base if hidden else student).as_policy()
    for roads in np.array_split(held_out_seeds(23, ROUNDS * DRIVES), ROUNDS):
        driven = steps(driver, TrapVectorEnv(len(roads)), roads.tolist())
        cars, driver = np.concatenate([step.cars[step.running] for step in driven]), student.as_policy()
        rounds.append(labelled(cars, base, target))
        _, actions, _, differs = rounds[-1]
        cars, actions = cars[differs], actions[differs]
        for _ in range(onward):
            accidents = np.zeros(len(cars), dtype=np.int64)
            advance(cars, actions, accidents, DEFAULT)
            cars = cars[accidents == 0]
            rounds.append(labelled(cars, base, target))
            actions = student.probabilities(rounds[-1][0]).argmax(-1)
        states, actions, values, differs = (
            torch.from_numpy(np.concatenate(part)) for part in zip(*rounds, strict=True)
        )
        weights = torch.where(differs, weight, 1.0)
        for _ in range(UPDATES):
            some = torch.randint(len(states), (BATCH,), generator=generator)
            outputs = mlp(layers, states[None, some])[0]
            errors = (outputs - values[some]).square().mean(-1)
            losses = errors if target == "values" else cross_entropy(outputs, actions[some], reduction="none")
            optimiser.zero_grad()
            ((losses * weights[some]).sum() / weights[some].sum()).backward()
            optimiser.step()
    return student


def labelled(cars: np.ndarray, base: Agent, target: str) -> tuple[np.ndarray, ...]:
    """(states (n, 26), actions (n,) to do there, (n, 9) values below the best, (n,) bool: not the base's action)."""
    states = np.zeros((len(cars), DEFAULT.observation_size), dtype=np.float32)
    observe_all(cars, constants(DEFAULT), states)
    parts = [nine_drives(part, base.as_policy()) for part in np.array_split(cars, len(cars) // 2000 + 1)]
    values, hurt = (np.concatenate([getattr(one, name) for one in parts]) for name in ("values", "accidents"))
    own, actions = base.probabilities(states).argmax(-1), values.argmax(axis=1)
    if target == "shield":
        actions = np.where(hurt[np.arange(len(own)), own] > 0, actions, own)
    below = (values - values.max(axis=1, keepdims=True)).clip(WORST).astype(np.float32)
    return states, actions, below, actions != own


def learned_rows(tried: Computed, cells: Computed) -> tuple[list[str], list[list[str]]]:
    """(headings, rows): what the students of the look-ahead do alone (`distil.py`), below the agents that they were.

    tried: the students by what they learned; cells: the look-ahead's, which hold these agents before.
    """
    before, lines = cells.get(Cell(BASE, "alone").name), []
    as_they_were = {"nothing: the agents as they were": before.pick(range(AGENTS))} if before else {}
    for words, results in (as_they_were | tried).items():
        of = results.measured
        accidents = ", ".join(f"{1000 * k / n:.0f}" for k, n in zip(of["accidents"], of["roads"], strict=True))
        lines.append([words, ", ".join(f"{value:.1f}" for value in of["returns"]), accidents])
    return ["learned", "return of each agent", "accidents in 1,000 of each"], lines


def section(computed: dict[str, Computed], folder: Path) -> list[str]:
    """The students below the agents that they were."""
    learned = markdown(*learned_rows(computed["distil"], computed[LOOK_AHEAD]))
    return ["### What networks learned of it\n", DISTIL, learned]


DISTIL = """Agents of PPO after cloning that learned, from the 26 numbers, what their own look-ahead does in the states
that they reached themselves. Tested alone on 1,000 held-out roads.
"""

EXPERIMENT = Experiment("distil", lambda: TRIES, results_of(distilled), section=section)
