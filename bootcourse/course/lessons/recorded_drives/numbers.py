"""What the numbers and claims in this lesson's text are computed from, beside tools/course/known.py."""

from functools import cache

import numpy as np
import torch

from bootcourse.course.lessons.recorded_drives import choosing, eight_seeds
from bootcourse.course.lessons.recorded_drives.exercises import conservative_loss  # noqa: F401 (the text names it)
from bootcourse.course.lessons.recorded_drives.reachable_entropy import by_entropy
from bootcourse.course.shipped import shipped_agents
from bootcourse.episodes.evaluate import Episodes, drive_episodes
from bootcourse.episodes.record import record
from bootcourse.learn.replay_buffer import decode_transitions
from bootcourse.learn.settings import settings_for
from bootcourse.learn.training import Training
from bootcourse.policies import Policy, rule_policy, stochastic_rule_policy
from bootcourse.road.state import EGO, SPEED
from bootcourse.scenario import DEFAULT
from bootcourse.statistics import ESCAPES
from tools.course.known import of, shipped_experiment

SETS = 3  # of five agents, one of each of `choosing.METHODS`


@cache
def agents() -> list[Policy]:
    """The notebook's 15, one set after the other."""
    return [agent for which in range(SETS) for agent in choosing.agents(which).values()]


@cache
def overlaps() -> np.ndarray:
    """In which share of the recorded seconds each would do what was done, (sets, agents)."""
    return choosing.by_set([choosing.overlap(agent, choosing.recorded()) for agent in agents()])


@cache
def estimated() -> np.ndarray:
    """What each is worth by the notebook's two fits, (fits, sets, agents)."""
    return np.stack([choosing.by_set(fit) for fit in choosing.fits(agents(), choosing.recorded(), times=2)])


@cache
def truth() -> np.ndarray:
    """What each is worth on the road, (sets, agents)."""
    return choosing.by_set([choosing.worth(agent, range(100), 0.8) for agent in agents()])


def off() -> np.ndarray:
    """By how much each estimate is too high, (fits, sets, agents)."""
    return estimated() - truth()


@cache
def constant() -> float:
    """What the rule is worth: the picture's control, said of every agent."""
    return choosing.worth(rule_policy(DEFAULT), range(100), 0.8)


def agreeing() -> tuple[int, int]:
    """On how many agents the two fits agree within 0.1, and for how many of these both are within 0.1 of the truth."""
    agree = abs(np.diff(estimated(), axis=0)[0]) < 0.1
    return int(agree.sum()), int((agree & (abs(off()) < 0.1).all(axis=0)).sum())


def did() -> float:
    """In which share of the recorded seconds the rule accelerated."""
    return eight_seeds.accelerates(choosing.recorded().actions)


DROVE = 50  # drives of the stochastic rule, for its speed


@cache
def _stochastic_drives() -> list:
    return record(stochastic_rule_policy(DEFAULT, np.random.default_rng(0)), range(DROVE))


def fastest(seconds: int | None = None) -> float:
    """The stochastic rule's highest speed in the first seconds, or in the whole of its drives, m/s."""
    steps = None if seconds is None else seconds * DEFAULT.clock.steps + 1
    return float(max(drive.states[:steps, EGO, SPEED].max() for drive in _stochastic_drives()))


@cache
def fastest_likely() -> Episodes:
    """Fifty drives of the fastest of the actions that the lesson's clone finds likely."""
    return drive_episodes(choosing.fastest(shipped_agents("bc")[0].as_policy()), range(50))


@cache
def likely() -> float:
    """How many actions the lesson's clone finds likely in a recorded second, on average."""
    clone = shipped_agents("bc")[0].as_policy()
    return float(choosing.likely_actions(clone, choosing.recorded().states.numpy()).sum(-1).mean())


@cache
def with_accident() -> int:
    """How many of the stochastic rule's drives, from which two agents of Round 2 learned, end in an accident."""
    replay = Training([settings_for("cql", stochastic_demonstrations=True)]).replay
    rows = replay.table[: replay.demonstrations]
    batch = decode_transitions(rows, DEFAULT.observation_size, torch.zeros(len(rows)))
    return int(batch.terminated.sum())


CLOSE = "CQL's term, γ = 0.01"  # a kind of agents of Round 2


def eight(kind: str, measure: str) -> list[float]:
    """What was measured of the eight shipped agents of a kind of Round 2."""
    return shipped_experiment(eight_seeds.NAME)[kind].measured[measure].tolist()


def crash_on(kind: str) -> str:
    """On how many of 100 roads the eight crash: "100", or "8 to 31" of these."""
    crashes = eight(kind, "crashes")
    fewest, most = (f"{each:.0f}" for each in (min(crashes), max(crashes)))
    return f"all {most}" if fewest == most == "100" else f"{fewest} to {most}"


@cache
def accelerating(method: str) -> list[float]:
    """In which share of the recorded seconds each of a method's five shipped agents would accelerate."""
    states = choosing.recorded().states
    policies = [agent.as_policy() for agent in shipped_agents(method)]
    return [eight_seeds.accelerates(choosing.actions_of(policy, states)) for policy in policies]


def apart() -> np.ndarray:
    """How far apart the two fits are, (sets, agents)."""
    return abs(np.diff(estimated(), axis=0)[0])


def accidents_of_escapers() -> np.ndarray:
    """In which share of its drives each GAIL agent that escapes leaves the road, (agents,)."""
    return of("gail").scores("road_departure")[of("gail").scores("success") >= ESCAPES]


def departures(which: int) -> str:
    """In how many % of drives each of five GAIL agents leaves the road: 0, our target entropy; 1, a reachable one."""
    results = list(by_entropy(shipped_experiment("reachable-entropy")["gail"]).values())[which]
    return ", ".join(f"{100 * share:.1f}" for share in results.scores("road_departure"))
