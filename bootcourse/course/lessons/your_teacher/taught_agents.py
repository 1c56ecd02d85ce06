"""Ten students each of the rule and of six other teachers, and ten agents that learn alone.

    bootcourse study students --out DIR    # some minutes

One training depends on the processor's rounding; the lesson's text rests on the results that ship.
"""

from dataclasses import replace
from functools import cache
from typing import NamedTuple

import numpy as np
import scipy

from bootcourse.course.lessons.your_teacher.example_teachers import careful, racer, reckless, slower_racer, timid
from bootcourse.episodes.evaluate import drive_episodes, held_out_seeds
from bootcourse.episodes.record import record
from bootcourse.episodes.rollout import Rollout
from bootcourse.errors import BootcourseError
from bootcourse.learn.agent import Agent
from bootcourse.learn.demonstrations import FIRST_SEED
from bootcourse.learn.settings import Settings, settings_for, with_seeds
from bootcourse.learn.teachers import Rule, all_roads, course_rule, teacher_of, teacher_policy
from bootcourse.learn.training import Training
from bootcourse.research.cells import results_of
from bootcourse.research.computed import experiment
from bootcourse.research.experiment import Experiment
from bootcourse.research.results import Results, agent_entries
from bootcourse.research.teachers import RULE
from bootcourse.research.teachers import TEACHERS as STUDIED
from bootcourse.scenario import Scenario
from bootcourse.statistics import holm

SEEDS, UPDATES, EVERY = 10, 3500, 250  # students of each teacher; updates of each; updates between two notes
ROADS = held_out_seeds(13, 200)  # that every student is tested on
NEAR = 30.0  # m, the sight of a teacher that is the rule otherwise


@all_roads
def near_sighted(cars: np.ndarray, scenario: Scenario) -> np.ndarray:
    """The rule if it sees no car that is further away than `NEAR`: it follows fewer cars, and drives faster."""
    return course_rule(cars, replace(scenario, sight=replace(scenario.sight, distance=NEAR)))


TEACHERS = {"the rule": course_rule, f"the rule, {NEAR:g} m": near_sighted}
TEACHERS |= {teacher.__name__: teacher for teacher in (careful, timid, reckless, racer)}
SLOWER = "racer at 15"  # m/s in the free lane, in place of 20
TEACHERS[SLOWER] = slower_racer
SHOWN = ("the rule", "careful", "timid", "racer")  # in the lesson; the experiment has them all
ALONE = "alone"  # agents without a teacher, as plain SAC
RACER_LONG, LONG = "racer, long", 40_000  # updates, after which both aids have faded
SLOWER_LONG = f"{SLOWER}, long"


class Taught(NamedTuple):
    """A finished training: each agent's escapes while it learned, and what was left of the two aids at the end."""

    agents: list[Agent]
    updates: np.ndarray  # (points,)
    escapes: np.ndarray  # (agents, points) share of the last 30 training episodes
    beta: np.ndarray  # (agents,) share of demonstrations in a batch
    xi: np.ndarray  # (agents,) weight of the KL


def teach(teacher: Rule, settings: list[Settings], updates: int = UPDATES, **options) -> Taught:
    """Train agents from a teacher for a number of updates, and note their escapes every `EVERY` updates.

    options: of `Training`, such as learner="compiled", or demonstrations in place of the teacher's.
    """
    training, notes = Training(settings, episodes=10**4, teacher=teacher, **options), []

    def note(training: Training) -> None:
        if training.updates and training.updates % EVERY == 0:
            notes.append([training.updates, *training.curves.recent("success", 30)])

    result = training.run(progress=False, callback=note, stop=lambda: training.updates >= updates)
    table = np.array(notes)
    xi = np.array([agent.settings.xi_multiplier * agent.alpha for agent in result.agents])
    return Taught(result.agents, table[:, 0], table[:, 1:].T, training.beta, xi)


def tested(agents: list[Agent]) -> dict[str, np.ndarray]:
    """Each agent's share of escapes, by its most probable actions; its return and accidents."""
    greedy = [drive_episodes(agent.as_policy(), ROADS) for agent in agents]
    return {
        "success": np.array([each.success.mean() for each in greedy]),
        "returns": np.array([each.returns.mean() for each in greedy]),
        "accident": np.array([np.mean(each.accident > 0) for each in greedy]),
    }


def drawn(agents: list[Agent]) -> np.ndarray:
    """Each agent's share of escapes by actions that are drawn: (agents,)."""
    drives = [drive_episodes(agent.as_policy(np.random.default_rng(0)), ROADS) for agent in agents]
    return np.array([each.success.mean() for each in drives])


def alike(agents: list[Agent], teacher: Rule, roads: int = 4) -> np.ndarray:
    """The share of each agent's decisions, on its own drives, in which its teacher would do the same: (agents,)."""
    shares, ask = [], teacher_of(teacher)
    for agent in agents:
        drives = record(agent.as_policy(), ROADS[:roads])
        asked = ask(np.concatenate([drive.cars for drive in drives]))
        shares.append(np.mean(asked == np.concatenate([drive.actions for drive in drives])))
    return np.array(shares)


def train_group(group: str, seeds: int = SEEDS, updates: int = UPDATES) -> Results:
    """Train and test the students of a teacher, or the agents that learn alone."""
    teacher, method = TEACHERS.get(group, course_rule), "sac" if group == ALONE else "bootstrapped"
    settings = with_seeds(settings_for(method), seeds)
    taught = teach(teacher, settings, updates)
    measured = tested(taught.agents) | {"drawn": drawn(taught.agents), "alike": alike(taught.agents, teacher)}
    measured |= {"beta": taught.beta, "xi": taught.xi}
    notes = {"updates": np.tile(taught.updates, (seeds, 1)), "escapes": taught.escapes}
    agents = agent_entries(settings, group if group in TEACHERS else RULE)
    return Results(agents, np.full(seeds, -1), notes=notes, measured=measured)


def cells() -> dict[str, dict]:
    """A teacher each, nobody, and two teachers for longer."""
    groups = {name: {"group": name} for name in (ALONE, *TEACHERS)}
    longer = {RACER_LONG: racer.__name__, SLOWER_LONG: SLOWER}
    return groups | {name: {"group": group, "updates": LONG} for name, group in longer.items()}


EXPERIMENT = Experiment("students", cells, results_of(train_group))


def reference() -> dict[str, dict[str, np.ndarray]]:
    """{one of `SHOWN` or "alone": what `tested` and `teach` say of its ten students}, as it ships.

    Raises BootcourseError if the students of a teacher are missing.
    """
    return {name: shipped(name) for name in (ALONE, *SHOWN)}


def shipped(name: str) -> dict[str, np.ndarray]:
    """The same of one group of the experiment."""
    groups = experiment("students")
    if name not in groups:
        raise BootcourseError(f"No students of {name} ship: run `bootcourse study students --out DIR`.")
    group = groups[name]
    return group.measured | {"updates": group.notes["updates"][0], "escapes": group.notes["escapes"]}


def verdicts(groups: dict[str, dict[str, np.ndarray]]) -> dict[str, dict[str, str]]:
    """{teacher: {"success" or "returns": "helps", "hurts" or "not shown"}} against the agents that learned alone.

    A rank test for each, at 5 % after Holm's correction for them all. groups: as `reference` returns them.
    """
    pairs = [(name, score) for name in groups if name != ALONE for score in ("success", "returns")]
    both = [(groups[name][score], groups[ALONE][score]) for name, score in pairs]
    found = {name: {} for name in groups if name != ALONE}
    for (name, score), (taught, alone), p in zip(pairs, both, holm([p_value(*each) for each in both]), strict=True):
        direction = "helps" if np.sign(taught[:, None] - alone).mean() > 0 else "hurts"
        found[name][score] = direction if p < 0.05 else "not shown"
    return found


@cache
def demonstrated(teacher: str) -> list[Rollout]:
    """The drives that one of the study's teachers demonstrates."""
    roads = [FIRST_SEED + number for number in range(Settings.demonstration_episodes)]
    return record(teacher_policy(STUDIED[teacher].rule), roads)


def p_value(taught: np.ndarray, alone: np.ndarray) -> float:
    """Mann and Whitney's two-sided p-value of the scores of two groups of agents, (m,) and (n,)."""
    return float(scipy.stats.mannwhitneyu(taught, alone).pvalue)
