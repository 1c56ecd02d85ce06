"""What the numbers and claims in this lesson's text are computed from, beside tools/course/known.py."""

from functools import cache
from typing import NamedTuple

import numpy as np
from scipy import stats

from bootcourse.course.lessons.found_and_kept import ways
from bootcourse.course.lessons.found_and_kept.explorable import groups
from bootcourse.episodes.record import record
from bootcourse.policies import idle_policy, rule_policy
from bootcourse.research.cells import VARIED
from bootcourse.research.experiments import clocks as study_clocks
from bootcourse.research.paper import EPISODES, PRINTED
from bootcourse.research.results import Results
from bootcourse.road.state import EGO, TRAP_1, X
from bootcourse.scenario import DEFAULT
from bootcourse.statistics import ESCAPES, HAD, IN_A_ROW, LOST, found_after, lost
from tools.course.known import ROAD, SETTINGS, clocks, fisher, others, shipped_experiment, shipped_results

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
    earned: np.ndarray  # return after training, of each agent
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
    return Group(lost(agents.curves["success"]), agents.scores("returns"), agents.scores("success") >= ESCAPES)


def earned_by_escapers(words: str) -> str:
    """The returns of a group's agents that escape, as "49 to 86"."""
    earned = group(words).earned[group(words).escapes]
    return f"{earned.min():.0f} to {earned.max():.0f}"


def accidents_of_rest(words: str) -> np.ndarray:
    """In which share of their test drives the agents of a group crash that do not escape."""
    return groups()[words].scores("accident")[~group(words).escapes]


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
def resampled() -> tuple[float, float]:
    """How often, in %, single agents give the paper's rates: the bootstrap's 95 % over the agents of each method."""
    rng, chance = np.random.default_rng(0), 1.0
    for method in VARIED:
        success = clocks()["2", "π̃"].of(method).scores("success")
        drives = (success if PRINTED[method]["success"].mean else 1 - success) ** EPISODES
        chance = chance * drives[rng.integers(len(drives), size=(10_000, len(drives)))].mean(axis=1)
    low, high = 100 * np.quantile(chance, [0.025, 0.975])
    return float(low), float(high)


@cache
def watched(cell: str) -> Results:
    """The agents of round 2 that were looked at in training."""
    return shipped_experiment("ways")[cell]


def stays(gamma: float = SETTINGS.gamma) -> float:
    """The worth of staying behind trap 1."""
    return ways.staying(gamma)


def undiscounted() -> np.ndarray:
    """What the ways out of `before` earn without discount, the bonus not counted."""
    return ways.at(watched("demos"), ways.BEFORE, "return")[had_a_way("demos")]


def falls_back(later: bool = False) -> np.ndarray:
    """By how many m the agents of `before` fall back behind trap 1 in ten seconds, on the one road that was noted.

    later: instead, at the end of training, those of them that are then ahead on ways worth more than 1.
    """
    agents = watched("demos")
    had, way = had_a_way("demos"), ways.at(agents, ways.BEFORE, "way")
    if later:
        way = agents.notes["way"][:, -1]
        had = had & (agents.notes["success"][:, -1] > 0.5) & (agents.notes["worth"][:, -1] > 1)
    return (way[:, 0, 0] - way[:, 10, 0])[had]


def stays_back() -> float:
    """The same of a car that stays."""
    states = record(idle_policy, [ways.SHOWN])[0].states[:: DEFAULT.clock.steps]
    gap = states[:, EGO, X] - states[:, TRAP_1, X]
    return float(gap[0] - gap[10])


def had_a_way(cell: str) -> np.ndarray:
    """Which agents get ahead on most roads just before β ends, (agents,) bool."""
    return ways.at(watched(cell), ways.BEFORE, "success") > 0.5


def before(cell: str) -> np.ndarray:
    """The worths of the ways out, just before β ends."""
    return ways.out(watched(cell), ways.BEFORE)


def _shown() -> int:
    """Which of the agents is the first picture's."""
    return ways.gives_up(watched("demos"))


def first_had() -> int:
    """The training episode after which the agent of the first picture had found the way out."""
    return int(found_after(watched("demos").curves["success"])[_shown()])


@cache
def _lows(cell: str) -> np.ndarray:
    """Of each agent, at which training episodes a window ends that counts as a loss: (agents, windows) bool."""
    sums = np.cumsum(np.pad(watched(cell).curves["success"], ((0, 0), (1, 0))), axis=1)
    ahead = sums[:, WINDOW:] - sums[:, :-WINDOW]
    return np.maximum.accumulate(ahead >= HAD, axis=1) & (ahead <= LOST)


def p_of_returns() -> float:
    """p of Mann and Whitney's test: do the agents whose β ends earn more without the bonus?"""
    return float(stats.mannwhitneyu(group("β ends, no bonus").earned, group("β ends, bonus").earned).pvalue)


def escapers_of_others(kind: str) -> int:
    """How many of the ten others of a kind escape."""
    return int((others(kind).scores("success") >= ESCAPES).sum())


def first_losses(cell: str = "demos") -> np.ndarray:
    """The training episode after which each agent had lost the way out, 0 if it never did: (agents,)."""
    lows = _lows(cell)
    return np.where(lows.any(axis=1), lows.argmax(axis=1) + WINDOW, 0)


def first_lost() -> int:
    """That of the agent of the first picture."""
    return int(first_losses()[_shown()])


def lost_later(cell: str) -> np.ndarray:
    """Which agents with a way out just before β ends lose it in a window that ends later: (agents,) bool."""
    return had_a_way(cell) & _lows(cell)[:, ENDS - WINDOW + 1 :].any(axis=1)


def crashes_of_losers() -> float:
    """Of the looks at those whose β never ends that find them behind after all: on how many most drives crash."""
    agents = watched("demos, β for ever")
    after = np.arange(agents.notes["success"].shape[1]) * ways.EVERY > ENDS
    behind = (agents.notes["success"] <= 0.5) & after & lost_later("demos, β for ever")[:, None]
    return float((agents.notes["accident"][behind] > 0.5).mean())


def gone() -> int:
    """The look from which on it is behind trap 1 on most roads."""
    ahead = watched("demos").notes["success"][_shown()] > 0.5
    return int(np.flatnonzero(ahead)[-1] + 1) * ways.EVERY


def fates(cell: str) -> tuple[int, int, int]:
    """Of the agents with a way out just before β ends: how many end ahead, behind and unhurt, and with accidents."""
    agents = watched(cell)
    had = had_a_way(cell)
    ahead, hurt = (agents.notes[name][had, -1] > 0.5 for name in ("success", "accident"))
    return int(ahead.sum()), int((~ahead & ~hurt).sum()), int((~ahead & hurt).sum())


def fisher_of_fates() -> float:
    """p of Fisher's exact test: of those with a way out before β ends, do more end ahead if it never ends?"""
    cells = ("demos", "demos, β for ever")
    return fisher(*(fates(cell)[0] for cell in cells), *(len(before(cell)) for cell in cells))


@cache
def rule_ahead() -> int:
    """The second after which the rule is ahead of trap 1 on the road that most lessons show."""
    states = record(rule_policy(DEFAULT), [ROAD])[0].states[:: DEFAULT.clock.steps]
    return int(np.argmax(states[:, EGO, X] > states[:, TRAP_1, X]))


def ends(cell: str, ahead: bool) -> np.ndarray:
    """The worths at the end of those with a way out just before β ends that end ahead, or do not."""
    agents = watched(cell)
    had = had_a_way(cell)
    return agents.notes["worth"][had & ((agents.notes["success"][:, -1] > 0.5) == ahead), -1]


def rise(cell: str) -> int:
    """How many of those with a way out just before β ends drive at the end what is worth more."""
    agents = watched(cell)
    had = had_a_way(cell)
    return int((agents.notes["worth"][had, -1] > before(cell)).sum())


def accidents_of_those_behind() -> np.ndarray:
    """In which share of their test drives the agents of round 3 crash that get ahead on fewer than half of them."""
    scores = [(each.scores("success"), each.scores("accident")) for each in groups().values()]
    return np.concatenate([accident[success < 0.5] for success, accident in scores])


def speed(words: str) -> float:
    """The mean speed of a group of round 3 in the test."""
    return float(groups()[words].scores("speed").mean())
