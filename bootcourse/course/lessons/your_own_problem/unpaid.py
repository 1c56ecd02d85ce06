"""What do agents with the soft constraint earn on CartPole with and without its reward, and what if the cart is hidden?

    bootcourse study unpaid --out DIR    # about two minutes

The teacher pushes to where the pole leans. Ten agents of a kind train side by side and are tested after several
budgets, by their most probable actions: as they are, and with the cart's place and speed put to 0 in what they see.
Other processors round otherwise, and may give other tests.
"""

from pathlib import Path

import gymnasium as gym
import numpy as np
from gymnasium.vector import VectorEnv

from bootcourse.course.lessons.your_own_problem import loops
from bootcourse.episodes.evaluate import held_out_seeds
from bootcourse.learn.agent import Agent
from bootcourse.learn.demonstrations import demonstrate
from bootcourse.research.cells import results_of
from bootcourse.research.experiment import Computed, Experiment
from bootcourse.research.results import Results, agent_entries
from bootcourse.research.tables import markdown

NAME = "unpaid"
BUDGETS = (500, 1_000, 2_000, 3_000, 5_000, 8_000)  # decisions of an agent
KINDS = {"without reward": {"pays": 0, "gamma": 0}, "with reward": {"pays": 1, "gamma": 0.99}}
TESTS = 20  # held-out episodes
MEASURES = ("returns", "hidden", "copied", "copied hidden", "together")


def pole(n: int) -> VectorEnv:
    """CartPole, as the lesson makes it."""
    return gym.make_vec("CartPole-v1", n, vectorization_mode="sync")


def angle_rule(seen: np.ndarray) -> int:
    """The lesson's teacher: push to where the pole leans."""
    return int(seen[2] > 0)


def cells(seeds: int = 10) -> dict[str, dict]:
    """Without the reward, and with it."""
    return {kind: {"kind": kind, "seeds": seeds} for kind in KINDS}


def train_kind(kind: str, seeds: int) -> Results:
    """Train the agents of a kind. Notes, (agents, budgets), are named after `MEASURES`: see `measured`."""
    tested = loops.trained(BUDGETS, pole, angle_rule, **KINDS[kind], seeds=seeds)
    found = np.array([[measured(agent) for agent in agents] for agents, _ in tested.values()])
    settings = [agent.settings for agent in tested[BUDGETS[0]][0]]
    notes = dict(zip(MEASURES, found.transpose(2, 1, 0).astype(np.float32), strict=True))
    return Results(agent_entries(settings, "angle rule"), np.full(seeds, -1), notes=notes)


def measured(agent: Agent) -> tuple[float, ...]:
    """What an agent earns as it is, and with the cart hidden; in which share of its decisions it does as its teacher.

    The same share, in the same states, with the cart hidden; and how the speeds of cart and pole go together there
    (their correlation).
    """
    as_it_is, hidden = agent.as_policy(), loops.without_the_cart(agent.as_policy())
    roads = {"teacher": angle_rule, "make_env": pole, "first_seed": held_out_seeds(1, TESTS)[0]}
    drives, others = (demonstrate(TESTS, None, policy=policy, **roads) for policy in (as_it_is, hidden))
    seen, taught = drives.observations, np.array([angle_rule(each) for each in drives.observations])
    copied = [(policy(seen, seen).actions == taught).mean() for policy in (as_it_is, hidden)]
    each_pays_1 = [len(driven.actions) / TESTS for driven in (drives, others)]
    return *each_pays_1, *copied, float(np.corrcoef(seen[:, 1], seen[:, 3])[0, 1])


def section(computed: dict[str, Computed], folder: Path) -> list[str]:
    """What they earn after each budget, means over the agents."""
    rows = []
    for kind, agents in computed[NAME].items():
        for measure, words in (("returns", kind), ("hidden", f"{kind}, the cart hidden in the test")):
            rows.append([words, *(f"{mean:.0f}" for mean in agents.notes[measure].mean(axis=0))])
    headings = ["return after so many decisions", *(f"{budget:,}" for budget in BUDGETS)]
    return ["## CartPole with the soft constraint, with reward and without\n", ABOUT, markdown(headings, rows)]


ABOUT = f"""Means of ten agents of the lesson on your own problem, in {TESTS} held-out episodes of at most 500
decisions. Their teacher pushes to where the pole leans. Hidden: the cart's place and speed are 0 in what they see.
"""

EXPERIMENT = Experiment(NAME, cells, results_of(train_kind), section=section)
