"""What the numbers and claims in this lesson's text are computed from, beside tools/course/known.py."""

from functools import cache
from typing import NamedTuple

import numpy as np
from scipy import stats

from bootcourse.course.lessons.found_and_kept import counts
from bootcourse.course.lessons.found_and_kept.exercises import forgetting as forgetting
from bootcourse.course.lessons.found_and_kept.explorable import EPISODES, Fading
from bootcourse.course.shipped import shipped_agents
from bootcourse.episodes.record import record
from bootcourse.episodes.rollout import Rollout
from bootcourse.research.experiments import clocks as study_clocks
from bootcourse.research.results import Results
from bootcourse.rule import stochastic_rule
from bootcourse.statistics import HAD as HAD
from bootcourse.statistics import IN_A_ROW as WINDOW
from bootcourse.statistics import LOST as LOST
from bootcourse.statistics import lost
from tools.course.known import clocks, in_training, of, shipped_experiment, shipped_results

LATE = 900  # an episode: a tenth of β is left
ENDS, STAYS, FADES, STOPS, ALONE_ENDS, ALONE_STAYS = counts.KINDS
SHORTER = study_clocks.TRAINED  # training episodes of the agents of rounds 3 and 4


def rule_actions() -> float:
    """Among how many actions the stochastic rule chooses: e to the power of its entropy."""
    return float(np.exp(stats.entropy(stochastic_rule(np.array(0), 0.9))))


class Counted(NamedTuple):
    """How many agents found the way out, and how many of these kept it."""

    found: int
    kept: int


def of_all() -> Results:
    """The study's agents, every method's."""
    return shipped_results()


def way(results: Results, method: str) -> Counted:
    """Of a method's agents, see `Results.found_and_kept`."""
    return Counted(*(int(each.sum()) for each in results.found_and_kept(method)))


def losers() -> np.ndarray:
    """Which of the study's agents with both aids lose the way out at least once, (agents,)."""
    return lost(of("bootstrapped").curves["success"])


def kept_until_late(method: str) -> bool:
    """Does each agent of a method have the way out in each window from its first good one to episode 900?"""
    windows = np.lib.stride_tricks.sliding_window_view(of(method).curves["success"], WINDOW, axis=1)
    return all(bool(row[int(row.argmax()) : LATE - WINDOW + 1].all()) for row in windows.mean(axis=-1) > 0.5)


def lost_where_the_first_bar_ends(method: str) -> bool:
    """Does each agent of a method first lose the way out where its first good windows in a row end?"""
    windows = np.lib.stride_tricks.sliding_window_view(of(method).curves["success"], WINDOW, axis=1).sum(axis=-1)
    places = []
    for ahead in windows:
        good = ahead > WINDOW / 2
        end = int(good.argmax()) + int((~good[good.argmax() :]).argmax())
        places.append((end, int((np.maximum.accumulate(ahead >= HAD) & (ahead <= LOST)).argmax())))
    return all(0 < end == loss for end, loss in places)


def experiments() -> tuple:
    """What the table of round 2 is counted from."""
    return of_all(), shipped_experiment("ablations"), shipped_experiment("stress")


@cache
def fate(kind: str) -> list[str]:
    """What the table says of a kind of agents, without its first cell."""
    return next(row[1:] for row in counts.fates(*experiments()) if row[0] == kind)


def without_bonus() -> tuple[int, float]:
    """With both aids, a β that never ends and c = 0: how many agents keep the way out, and the return of these."""
    agents = shipped_experiment("ablations")["β for ever, c = 0"].of("bootstrapped")
    kept = agents.found_and_kept("bootstrapped")[1]
    return int(kept.sum()), float(agents.scores("returns")[kept].mean())


def first_losses() -> list[tuple[int, int]]:
    """Of each of the study's agents with both aids: the failures in the window in which it first loses the way out, and
    how many of these are accidents.
    """
    counted, curves = [], of("bootstrapped").curves
    for success, accident in zip(curves["success"], curves["accident"], strict=True):
        ahead, failed, crashed = (
            np.lib.stride_tricks.sliding_window_view(each, WINDOW).sum(axis=-1)
            for each in (success == 1, success == 0, (success == 0) & (accident > 0))
        )
        first = int((np.maximum.accumulate(ahead >= HAD) & (ahead <= LOST)).argmax())
        counted.append((int(failed[first]), int(crashed[first])))
    return counted


def crashing_and_waiting(first: int, last: int) -> tuple[float, float]:
    """Of the agent of the lesson's first curve: which share of these training episodes is a crash behind trap 1, and
    which is neither that nor ahead.
    """
    curves, best = of("demos").curves, int(in_training("demos", 700, 900).argmax())
    ahead, crashed = (curves[name][best, first:last] > 0 for name in ("success", "accident"))
    return float((~ahead & crashed).mean()), float((~ahead & ~crashed).mean())


def kept_of_sac() -> tuple[float, float]:
    """Of the agent of plain SAC that keeps the way out with ¼ update: (accidents for a test drive, return)."""
    agents = clocks()["1/4", "μ"].of("sac")
    (which,) = np.flatnonzero(agents.found_and_kept("sac")[1])
    return float((agents.episodes("accident")[which] > 0).mean()), float(agents.scores("returns")[which])


def fades_by(updates: float) -> int:
    """By which episode ξ has lost 99 % in the panel to drag, with so many updates for each decision."""
    return int(EPISODES[np.argmax(Fading().left(updates) < 0.01)])


def of_the_agent_shown() -> Rollout:
    """The first drive of the lesson: of an agent with demonstrations alone, after its training."""
    best = int(in_training("demos", 700, 900).argmax())
    return record(shipped_agents("demos")[best].as_policy(), [10])[0]
