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
from bootcourse.research.tables import markdown
from bootcourse.statistics import HAD, IN_A_ROW, LOST, lost, rolling_means
from tools.course.known import clocks, in_training, others, pattern, shipped_experiment, shipped_results

WINDOW = IN_A_ROW
SHORTER = study_clocks.TRAINED  # training episodes of the agents of round 3


class Counted(NamedTuple):
    """How many agents found the way out, and how many of these kept it."""

    found: int
    kept: int


class Group(NamedTuple):
    """What round 2 says of a group of agents with both aids."""

    lost: np.ndarray  # which agents lose the way out
    first: np.ndarray  # after which episode they first have, ∞ for those that do not
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
    """Of round 2: see `groups`; or "others: never", of the ten others, where β never ends; "others: ends", …"""
    if words.startswith("others: "):
        cell = {"ends": "", "never": ", β for ever", "no bonus": ", c = 0"}[words.removeprefix("others: ")]
        agents = shipped_experiment("stress")[f"bootstrapped{cell}"]
    else:
        agents = groups()[words]
    success = agents.curves["success"]
    return Group(lost(success), first_lost(success), agents.scores("returns"), agents.found_and_kept("bootstrapped")[1])


def first_lost(success: np.ndarray) -> np.ndarray:
    """The training episode after which each agent has first lost the way out, ∞ for one that does not."""
    at, share = rolling_means(success, IN_A_ROW, success.shape[1])
    losing = np.maximum.accumulate(share >= HAD / IN_A_ROW, axis=1) & (share <= LOST / IN_A_ROW)
    return np.where(losing.any(axis=1), at[losing.argmax(axis=1)], np.inf)


def lost_least_if_both(low: int, high: int) -> bool:
    """Do fewest agents lose the way out if β never ends and the bonus is paid, at each limit from low to high?"""
    success = {words: agents.curves["success"] for words, agents in groups().items()}
    both = success.pop("β never ends, bonus")
    limits = range(low, high + 1)
    return all(lost(both, at).sum() < min(lost(each, at).sum() for each in success.values()) for at in limits)


def kept_earned(words: str) -> np.ndarray:
    """What those of a group earn that keep the way out."""
    return group(words).earned[group(words).keep]


def kept_elsewhere() -> np.ndarray:
    """The same of the three other groups."""
    return np.concatenate([kept_earned(words) for words in groups() if words != "β never ends, bonus"])


def earns_less(both: Group, *others: Group) -> bool:
    """Does each agent of the first group earn less than each of the others that keeps the way out?"""
    return all(bool(both.earned.max() < each.earned[each.keep].min()) for each in others)


def with_teacher(updates: str) -> float:
    """The chance of round 3 with these updates per decision, where the stochastic rule demonstrates."""
    return pattern(clocks()[updates, "π̃"]).value


def row_reads(method: str) -> float:
    """The chance that one row of the right panel of round 3 reads as the paper's."""
    return float(study_clocks.as_printed(clocks()["2", "π̃"].of(method).scores("success"), method).mean())


def others_pattern() -> float:
    """The chance of round 3 where each row's agent is one of the ten others."""
    methods = ("sac", "soft", "demos", "bootstrapped")
    return float(np.prod([study_clocks.as_printed(others(m).of(m).scores("success"), m).mean() for m in methods]))


def alone_and_ending() -> Counted:
    """Of twenty agents with demonstrations alone and a β that ends: how many find the way out, and keep it."""
    each = [way(agents, "demos") for agents in (shipped_results(), shipped_experiment("stress")["demos"])]
    return Counted(sum(one.found for one in each), sum(one.kept for one in each))


def finders_where_it_stays() -> Counted:
    """Of the study's ten with demonstrations alone whose β stays."""
    return way(shipped_experiment("ablations")["β for ever"], "demos")


def losers(beta: str) -> int:
    """How many of the study's ten with demonstrations alone ever lose the way out, where β "ends" or "stays"."""
    agents = of_all() if beta == "ends" else shipped_experiment("ablations")["β for ever"]
    return int(lost(agents.of("demos").curves["success"]).sum())


def chances_table() -> str:
    """How often single agents read as the paper's four rows, by training, as Markdown."""
    quarter, *more = (pattern(clocks()[updates, "π̃"]) for updates in study_clocks.UPDATES)
    low, high = (100 * end for end in (min(each.low for each in more), max(each.high for each in more)))
    by_rule, *others_by_rule = (pattern(clocks()[updates, "μ"]) for updates in study_clocks.UPDATES)
    ours = [by_rule.value, pattern(of_all()).value, others_pattern()]
    both = [f"{100 * one.value:.0f} ({100 * two.value:.0f})" for one, two in zip(more, others_by_rule, strict=True)]
    rows = [
        [
            "as our study's: 1,200 episodes; 2,000; the ten others",
            f"{'; '.join(f'{100 * each:.0f}' for each in ours)} %",
        ],
        ["the same with π̃, 1,200 episodes", f"{100 * quarter.value:.0f} %"],
        ["one road, and 1, 2 or 4 updates: with π̃ (with μ)", f"{', '.join(both)} %; with π̃ {low:.0f} to {high:.0f} %"],
        ["in other traffic", "not tested"],
    ]
    return markdown(["trained", "of the draws (95 % intervals)"], rows)


def alone_and_staying() -> tuple[int, int, int]:
    """Of twenty agents with demonstrations alone and a β that never ends: how many lose the way out, find, keep it."""
    ours = shipped_experiment("ablations")["β for ever"].of("demos")
    each = ours, shipped_experiment("stress")["demos, β for ever"]
    losers = sum(int(lost(agents.curves["success"]).sum()) for agents in each)
    ways = [way(agents, "demos") for agents in each]
    return losers, sum(each.found for each in ways), sum(each.kept for each in ways)


def of_the_agent_shown() -> Rollout:
    """The first drive of the lesson: of an agent with demonstrations alone, after its training."""
    best = int(in_training("demos", 700, 900).argmax())
    return record(shipped_agents("demos")[best].as_policy(), [10])[0]
