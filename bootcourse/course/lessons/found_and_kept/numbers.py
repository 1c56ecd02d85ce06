"""What the numbers and claims in this lesson's text are computed from, beside tools/course/known.py."""

from functools import cache
from math import prod
from typing import NamedTuple

import numpy as np
from scipy import stats

from bootcourse.course.lessons.found_and_kept import counts, ways
from bootcourse.course.lessons.found_and_kept.explorable import groups
from bootcourse.episodes.record import record
from bootcourse.policies import rule_policy
from bootcourse.research.cells import VARIED
from bootcourse.research.experiments import clocks as study_clocks
from bootcourse.research.paper import paper_interval
from bootcourse.research.results import Results
from bootcourse.research.tables import markdown
from bootcourse.road.state import EGO, TRAP_1, X
from bootcourse.scenario import DEFAULT
from bootcourse.statistics import ESCAPES, HAD, IN_A_ROW, LOST, Estimate, found_after, lost  # noqa: F401 (for the text)
from tools.course.known import ROAD, SETTINGS, clocks, others, pattern, shipped_experiment, shipped_results

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
    keep: np.ndarray  # which agents keep the way out


def of_all() -> Results:
    """The study's agents, every method's."""
    return shipped_results()


def way(results: Results, method: str) -> Counted:
    """Of a method's agents, see `Results.found_and_kept`."""
    return Counted(*(int(each.sum()) for each in results.found_and_kept(method)))


@cache
def group(words: str) -> Group:
    """Of round 3: see `groups`; or of the ten others: "others: never", "others: ends"."""
    if words.startswith("others: "):
        cell = {"ends": "", "never": ", β for ever"}[words.removeprefix("others: ")]
        agents = shipped_experiment("stress")[f"bootstrapped{cell}"]
    else:
        agents = groups()[words]
    return Group(lost(agents.curves["success"]), agents.scores("returns"), agents.found_and_kept("bootstrapped")[1])


def earn(words: str) -> float:
    """The mean return of a group's agents that escape."""
    return float(group(words).earned[group(words).keep].mean())


def lost_least_if_both(low: int, high: int) -> bool:
    """Do fewest agents lose the way out if β never ends and the bonus is paid, at each limit from low to high?"""
    success = {words: agents.curves["success"] for words, agents in groups().items()}
    both = success.pop("β never ends, bonus")
    limits = range(low, high + 1)
    return all(lost(both, at).sum() < min(lost(each, at).sum() for each in success.values()) for at in limits)


def others_read() -> float:
    """The chance that single agents of the ten others of each method read as the paper's table."""
    rows = [study_clocks.as_printed(others(method).scores("success"), method) for method in VARIED]
    return prod(float(row.mean()) for row in rows)


@cache
def given(driver: str) -> list[Estimate]:
    """How often single agents give the paper's four rates, in each setting of round 4 with this driver."""
    return [pattern(agents) for agents in counts.by_updates(driver).values()]


def endless_demonstrations() -> Results:
    """Ten agents with demonstrations alone, for whom β never ends."""
    return shipped_experiment("ablations")["β for ever"].of("demos")


def given_in_words(driver: str) -> str:
    """`given`, as "3, 11 and 16 %"."""
    *some, last = (f"{100 * each.value:.0f}" for each in given(driver))
    return f"{', '.join(some)} and {last} %"


def explanations() -> str:
    """What could explain the paper's table, and what was seen of it, as Markdown."""
    ours, lasting = way(of_all(), "demos"), way(endless_demonstrations(), "demos")
    ten, never = way(others("demos"), "demos"), way(shipped_experiment("stress")["demos, β for ever"], "demos")
    rows = [
        ["1. agents lose the way out",
         f"with demonstrations alone {ours.kept} of 10 agents keep it if β ends, {lasting.kept} if β never ends; of "
         f"ten others {ten.kept} and {never.kept}",
         "an endless β helps, but is not needed: in Round 4 all ten keep the way out although β ends"],
        ["2. single agents",
         f"one agent drawn from each row of Round 1 gives the four rates in {100 * pattern(of_all()).value:.0f} % of "
         f"the draws; from the ten others of each method, in {100 * others_read():.0f} %",
         "seldom, taken alone"],
        ["3. another training",
         f"with 2 updates and the stochastic rule they come in {100 * pattern(clocks()['2', 'π̃']).value:.0f} %",
         "possible for the rates, together with 2"],
        ["4. other traffic", "not tested", "*open*"],
    ]  # fmt: skip
    return markdown(["what could explain it", "what we saw", "so"], rows)


def inside(method: str) -> str:
    """How many of a method's agents that escape earn a return in the paper's interval, as "1 of 117".

    Of the study, of round 4, of the ablations (round 3 has some), and of the ten others.
    """
    trained = [of_all(), *clocks().values(), *shipped_experiment("ablations").values()]
    trained += shipped_experiment("stress").values()  # the ten others
    helped = [each.of(method) for each in trained if method in each.methods]
    earned = np.concatenate([each.scores("returns")[each.scores("success") >= ESCAPES] for each in helped])
    paper = paper_interval(method, "returns")
    return f"{((earned > paper.low) & (earned < paper.high)).sum()} of {len(earned)}"


@cache
def watched(cell: str) -> Results:
    """The agents of round 2 that were looked at in training."""
    return shipped_experiment("ways")[cell]


def stays() -> float:
    """The worth of staying behind trap 1."""
    return ways.staying(SETTINGS.gamma)


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


def of_first(episode: int) -> float:
    """What the drives of the first picture's agent are worth at a look."""
    return float(watched("demos").notes["worth"][_shown()][episode // ways.EVERY])


def fates(cell: str) -> tuple[int, int, int]:
    """Of the agents with a way out just before β ends: how many end ahead, behind and unhurt, and with accidents."""
    agents = watched(cell)
    had = ways.at(agents, ways.BEFORE, "success") > 0.5
    ahead, hurt = (agents.notes[name][had, -1] > 0.5 for name in ("success", "accident"))
    return int(ahead.sum()), int((~ahead & ~hurt).sum()), int((~ahead & hurt).sum())


def at_look(name: str, ahead: bool) -> np.ndarray:
    """What was noted just before β ended of those who had a way out then, and end ahead, or do not."""
    agents = watched("demos")
    had = ways.at(agents, ways.BEFORE, "success") > 0.5
    return ways.at(agents, ways.BEFORE, name)[had & ((agents.notes["success"][:, -1] > 0.5) == ahead)]


def crash_on_the_way_back() -> int:
    """How many of those who stay behind, unhurt, crash on half of the roads or more at a look near β's end."""
    agents, looks = watched("demos"), slice(950 // ways.EVERY, 1150 // ways.EVERY + 1)
    had, ahead = ways.at(agents, ways.BEFORE, "success") > 0.5, agents.notes["success"][:, -1] > 0.5
    back = had & ~ahead & (agents.notes["accident"][:, -1] < 0.5)
    return int((agents.notes["accident"][back, looks] >= 0.5).any(axis=1).sum())


def group_scores(words: str, measure: str) -> np.ndarray:
    """The scores of a group of round 3, (agents,)."""
    return groups()[words].scores(measure)


def still(cell: str) -> np.ndarray:
    """The worths at the end of those that end ahead."""
    agents = watched(cell)
    had = ways.at(agents, ways.BEFORE, "success") > 0.5
    return agents.notes["worth"][had & (agents.notes["success"][:, -1] > 0.5), -1]


def early() -> np.ndarray:
    """The worths of the ways out with both aids at episode 500."""
    return ways.out(watched("bootstrapped"), 500 + ways.EVERY // 2)


def at_the_end(cell: str) -> np.ndarray:
    """The worths of all ways out at the end."""
    return ways.out(watched(cell), ways.EPISODES)


def fisher_of_fates() -> float:
    """p of Fisher's exact test: of those with a way out before β ends, do more end ahead if it never ends?"""
    rows = [(ahead, len(before(cell)) - ahead) for cell in ("demos", "demos, β for ever") for ahead in fates(cell)[:1]]
    return float(stats.fisher_exact(rows).pvalue)


@cache
def rule_ahead() -> int:
    """The second after which the rule is ahead of trap 1 on the road that most lessons show."""
    states = record(rule_policy(DEFAULT), [ROAD])[0].states[:: DEFAULT.clock.steps]
    return int(np.argmax(states[:, EGO, X] > states[:, TRAP_1, X]))


def others_earn(cell: str) -> float:
    """The mean return of the ten others of a kind."""
    return float(shipped_experiment("stress")[cell].scores("returns").mean())


def reads(method: str) -> float:
    """The chance that one agent of a method, of round 4's setting, reads as the paper's row."""
    agents = clocks()["2", "π̃"].of(method)
    return float(study_clocks.as_printed(agents.scores("success"), method).mean())


def of_both(words: str, measure: str) -> float:
    """The mean score of a group of round 3."""
    return float(groups()[words].scores(measure).mean())
