"""What the numbers and claims in this lesson's text are computed from, beside tools/course/known.py."""

from functools import cache
from typing import NamedTuple

import numpy as np

from bootcourse.course.lessons.found_and_kept.explorable import groups
from bootcourse.course.shipped import shipped_agents
from bootcourse.episodes.record import record
from bootcourse.episodes.rollout import Rollout
from bootcourse.research.experiments import clocks as study_clocks
from bootcourse.research.results import Results
from bootcourse.statistics import HAD, IN_A_ROW, LOST, lost  # noqa: F401 (the text names them)
from tools.course.known import in_training, of, shipped_experiment, shipped_results

WINDOW = IN_A_ROW
SHORTER = study_clocks.TRAINED  # training episodes of the agents of round 3


class Counted(NamedTuple):
    """How many agents found the way out, and how many of these kept it."""

    found: int
    kept: int


class Group(NamedTuple):
    """What round 2 says of a group of agents with both aids."""

    lost: np.ndarray  # which agents lose the way out
    earned: np.ndarray  # return after training, of each agent
    keep: np.ndarray  # which agents keep the way out


def of_all() -> Results:
    """The study's agents, every method's."""
    return shipped_results()


def way(results: Results, method: str) -> Counted:
    """Of a method's agents, see `Results.found_and_kept`."""
    return Counted(*(int(each.sum()) for each in results.found_and_kept(method)))


@cache
def group(ends: str) -> Group:
    """Of round 2: β ends by "300", by "1,000" or "never", or "no bonus"; or "others: never", of the ten others, …"""
    if ends.startswith("others"):
        agents = shipped_experiment("stress")["bootstrapped" + (", β for ever" if "never" in ends else "")]
    else:
        agents = next(results for words, results in groups().items() if ends in words)
    keep = agents.found_and_kept("bootstrapped")[1]
    return Group(lost(agents.curves["success"]), agents.scores("returns"), keep)


def lost_least_if_never(low: int, high: int) -> bool:
    """Do fewer agents lose the way out if β never ends than in each other group, at each limit from low to high?"""
    success = {words: agents.curves["success"] for words, agents in groups().items()}
    never = success.pop("β never ends")
    limits = range(low, high + 1)
    return all(lost(never, at).sum() < min(lost(each, at).sum() for each in success.values()) for at in limits)


def earns_less(never: Group, *others: Group) -> bool:
    """Does each agent of the first group earn less than each of the others that keeps the way out?"""
    return all(bool(never.earned.max() < each.earned[each.keep].min()) for each in others)


def alone_and_staying() -> tuple[int, int, int]:
    """Of twenty agents with demonstrations alone and a β that never ends: how many lose the way out, find, keep it."""
    ours = shipped_experiment("ablations")["β for ever"].of("demos")
    each = ours, shipped_experiment("stress")["demos, β for ever"]
    losers = sum(int(lost(agents.curves["success"]).sum()) for agents in each)
    ways = [way(agents, "demos") for agents in each]
    return losers, sum(each.found for each in ways), sum(each.kept for each in ways)


def crashing_and_waiting(first: int, last: int) -> tuple[float, float]:
    """Of the agent of the lesson's first curve: which share of these training episodes is a crash behind trap 1, and
    which is neither that nor ahead.
    """
    curves, best = of("demos").curves, int(in_training("demos", 700, 900).argmax())
    ahead, crashed = (curves[name][best, first:last] > 0 for name in ("success", "accident"))
    return float((~ahead & crashed).mean()), float((~ahead & ~crashed).mean())


def of_the_agent_shown() -> Rollout:
    """The first drive of the lesson: of an agent with demonstrations alone, after its training."""
    best = int(in_training("demos", 700, 900).argmax())
    return record(shipped_agents("demos")[best].as_policy(), [10])[0]
