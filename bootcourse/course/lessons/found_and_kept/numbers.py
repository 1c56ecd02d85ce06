"""What the numbers and claims in this lesson's text are computed from, beside tools/course/known.py."""

from functools import cache
from typing import NamedTuple

import numpy as np
from scipy import stats

from bootcourse.course.lessons.found_and_kept import walks, ways  # noqa: F401 (the text names walks)
from bootcourse.course.lessons.found_and_kept.explorable import groups
from bootcourse.episodes.record import record
from bootcourse.policies import rule_policy
from bootcourse.research.experiments import clocks as study_clocks
from bootcourse.research.paper import PRINTED  # noqa: F401 (the text names it)
from bootcourse.research.results import Results
from bootcourse.road.state import EGO, TRAP_1, X
from bootcourse.scenario import DEFAULT, IDLE  # noqa: F401 (the text names IDLE)
from bootcourse.statistics import ESCAPES, HAD, IN_A_ROW, LOST, found_after, lost  # noqa: F401 (the text names them)
from tools.course.known import ROAD, SETTINGS, clocks, fisher, shipped_experiment, shipped_results

WINDOW = IN_A_ROW
STUDY = shipped_results().curves["success"].shape[1]  # training episodes of the study's agents
SHORTER = study_clocks.TRAINED  # training episodes of the agents of round 4
ENDS = SETTINGS.beta_episodes  # the episode from which on β is 0


class Counted(NamedTuple):
    """How many agents found the way out, and how many of these kept it."""

    found: int
    kept: int


class Group(NamedTuple):
    """What is said of a group of ten agents."""

    lost: np.ndarray  # which agents lose the way out
    escapes: np.ndarray  # which agents escape in the test


def of_all() -> Results:
    """The study's agents, every method's."""
    return shipped_results()


def way(results: Results, method: str) -> Counted:
    """Of a method's agents, see `Results.found_and_kept`."""
    return Counted(*(int(each.sum()) for each in results.found_and_kept(method)))


@cache
def group(words: str) -> Group:
    """Of round 3: see `groups`."""
    agents = groups()[words]
    return Group(lost(agents.curves["success"]), agents.scores("success") >= ESCAPES)


def lost_least_if_both(low: int, high: int) -> bool:
    """Do fewest agents lose the way out if β never ends and the bonus is paid, at each limit from low to high?"""
    success = {words: agents.curves["success"] for words, agents in groups().items()}
    both = success.pop("β never ends, bonus")
    limits = range(low, high + 1)
    return all(lost(both, at).sum() < min(lost(each, at).sum() for each in success.values()) for at in limits)


def lost_if_both(limit: int) -> int:
    """How many lose it, at this limit, if β never ends and the bonus is paid."""
    return int(lost(groups()["β never ends, bonus"].curves["success"], limit).sum())


def lowest() -> int:
    """A round number that the return of each agent of round 4's setting exceeds, of the two methods with
    demonstrations.
    """
    agents = clocks()["2", "π̃"]
    return int(min(agents.of(method).scores("returns").min() for method in ("demos", "bootstrapped")) // 10 * 10)


@cache
def watched(cell: str) -> Results:
    """The agents of round 2 that were looked at in training."""
    return shipped_experiment("ways")[cell]


def stays(gamma: float = SETTINGS.gamma) -> float:
    """The worth of staying behind trap 1."""
    return ways.staying(gamma)


def before(cell: str) -> np.ndarray:
    """The worths of the ways out, just before β ends."""
    return ways.out(watched(cell), ways.BEFORE)


def _shown() -> int:
    """Which of the agents is the first picture's."""
    return ways.gives_up(watched("demos"))


def first_had() -> int:
    """The training episode after which the agent of the first picture had found the way out."""
    return int(found_after(watched("demos").curves["success"])[_shown()])


def gone() -> int:
    """The look from which on it is behind trap 1 on most roads."""
    ahead = watched("demos").notes["success"][_shown()] > 0.5
    return int(np.flatnonzero(ahead)[-1] + 1) * ways.EVERY


def fisher_of_fates() -> float:
    """p of Fisher's exact test: of those with a way out before β ends, do more end ahead if it never ends?"""
    cells = ("demos", "demos, β for ever")
    return fisher(*(fates(cell)[0] for cell in cells), *(len(before(cell)) for cell in cells))


@cache
def rule_ahead() -> int:
    """The second after which the rule is ahead of trap 1 on the road that most lessons show."""
    states = record(rule_policy(DEFAULT), [ROAD])[0].states[:: DEFAULT.clock.steps]
    return int(np.argmax(states[:, EGO, X] > states[:, TRAP_1, X]))


def speed(words: str) -> float:
    """The mean speed of a group of round 3 in the test."""
    return float(groups()[words].scores("speed").mean())


def had_a_way(cell: str) -> np.ndarray:
    """Which agents get ahead on most roads just before β ends, (agents,) bool."""
    return ways.had_a_way(watched(cell))


def falls_back() -> np.ndarray:
    """By how many m the agents of `before` fall back behind trap 1 in ten seconds, on the one road that was noted."""
    way = ways.at(watched("demos"), ways.BEFORE, "way")[had_a_way("demos")]
    return way[:, 0, 0] - way[:, 10, 0]


def ahead_late(cell: str) -> np.ndarray:
    """Which of those with a way out just before β ends are ahead of trap 1 later, (those,) bool."""
    return ways.late(watched(cell), "success")[had_a_way(cell)] > 0.5


def fates(cell: str) -> tuple[int, int]:
    """Of those with a way out just before β ends: how many are ahead of trap 1 later, and how many are behind."""
    ahead = ahead_late(cell)
    return int(ahead.sum()), int((~ahead).sum())


def ends(cell: str, ahead: bool) -> np.ndarray:
    """What the drives of those are worth later that are then ahead, or are not."""
    return ways.late(watched(cell))[had_a_way(cell)][ahead_late(cell) == ahead]


def before_of(cell: str, ahead: bool) -> np.ndarray:
    """What their ways out were worth just before β ended."""
    return before(cell)[ahead_late(cell) == ahead]


def below_0(cell: str) -> int:
    """Of how many a drive is worth less than 0 at some look after β has ended."""
    return int((watched(cell).notes["worth"][had_a_way(cell)][:, ENDS // ways.EVERY + 1 :] < 0).any(axis=1).sum())


def crashes_of_not_kept() -> np.ndarray:
    """The share of drives with an accident, of the study's agents that found the way out and did not keep it."""
    each = []
    for method in ("sac", "soft", "demos", "bootstrapped"):
        found, kept = of_all().found_and_kept(method)
        each.append(of_all().of(method).scores("accident")[found & ~kept])
    return np.concatenate(each)


def crashes_in(words: str) -> np.ndarray:
    """The share of drives with an accident in the test, of each agent of a group of round 3."""
    return groups()[words].scores("accident")


def earned(words: str) -> float:
    """The mean return of a group of round 3 in the test."""
    return float(groups()[words].scores("returns").mean())


def escapes_of_twenty() -> tuple[int, int]:
    """How many of twenty escape whose β ends, without the bonus and with it: the ten of round 3 and ten others."""
    others = shipped_experiment("stress")
    cells = {"β ends, no bonus": "bootstrapped, c = 0", "β ends, bonus": "bootstrapped"}
    first, second = (
        int(group(words).escapes.sum()) + others[cell].escapers("bootstrapped") for words, cell in cells.items()
    )
    return first, second


def of_soft_row() -> str:
    """The success of each agent of round 4 with the soft constraint alone, %."""
    return ", ".join(f"{100 * each:.0f}" for each in np.sort(clocks()["2", "π̃"].of("soft").scores("success")))


def rise(cell: str) -> int:
    """Of how many the drives are worth more later than the way out was."""
    return int((ways.late(watched(cell))[had_a_way(cell)] > before(cell)).sum())


def p_of_hills() -> float:
    """p of Mann and Whitney's test: were the ways out of those that are ahead later worth more?"""
    return float(stats.mannwhitneyu(*(before_of("demos", ahead) for ahead in (True, False))).pvalue)


def crashing(cell: str) -> int:
    """How many crash on more than half of the roads at some look after β has ended."""
    accident = watched(cell).notes["accident"][had_a_way(cell)][:, ENDS // ways.EVERY + 1 :]
    return int((accident > 0.5).any(axis=1).sum())
