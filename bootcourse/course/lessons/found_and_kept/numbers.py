"""What the numbers and claims in this lesson's text are computed from, beside tools/course/known.py."""

from functools import cache
from math import prod
from typing import NamedTuple

import numpy as np

from bootcourse.course.lessons.found_and_kept import counts
from bootcourse.course.lessons.found_and_kept.explorable import groups
from bootcourse.course.shipped import shipped_agents
from bootcourse.episodes.record import record
from bootcourse.episodes.rollout import Rollout
from bootcourse.research.cells import VARIED
from bootcourse.research.experiments import clocks as study_clocks
from bootcourse.research.paper import paper_interval
from bootcourse.research.results import Results
from bootcourse.research.tables import markdown
from bootcourse.statistics import ESCAPES, HAD, IN_A_ROW, LOST, Estimate, lost  # noqa: F401 (for the text)
from tools.course.known import SETTINGS, clocks, in_training, others, pattern, shipped_experiment, shipped_results

WINDOW = IN_A_ROW
STUDY = shipped_results().curves["success"].shape[1]  # training episodes of the study's agents
SHORTER = study_clocks.TRAINED  # training episodes of the agents of round 3
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
    """Of round 2: see `groups`; or of the ten others: "others: never", "others: ends"."""
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
    """How often single agents give the paper's four rates, in each setting of round 3 with this driver."""
    return [pattern(agents) for agents in counts.by_updates(driver).values()]


def endless_demonstrations() -> Results:
    """Ten agents with demonstrations alone, for whom β never ends."""
    return shipped_experiment("ablations")["β for ever"].of("demos")


def explanations() -> str:
    """What could explain the paper's table, and what was seen of it, as Markdown."""
    ours, lasting = way(of_all(), "demos"), way(endless_demonstrations(), "demos")
    rows = [
        ["1. agents lose the way out",
         f"Round 2: with demonstrations alone {ours.kept or 'none'} of 10 agents keeps it if β ends, "
         f"{lasting.kept} keep it if β never ends",
         "possible for 'demonstrations only', if the paper's β never reached 0"],
        ["2. single agents",
         f"one agent drawn from each row of Round 1 gives the four rates in {100 * pattern(of_all()).value:.0f} % of "
         f"the draws; from the ten others of each method, in {100 * others_read():.0f} %",
         "seldom, taken alone"],
        ["3. another training",
         f"Round 3: in the setting shown they come in {100 * pattern(clocks()['2', 'π̃']).value:.0f} %",
         "possible for the rates, together with 2"],
        ["4. other traffic", "not tested", "*open*"],
    ]  # fmt: skip
    return markdown(["what could explain it", "what we saw", "so"], rows)


def returns_with_demonstrations() -> str:
    """The paper's interval of the return beside `least_earned`, as Markdown."""
    rows = []
    for words, method in {"alone": "demos", "with both aids": "bootstrapped"}.items():
        paper = paper_interval(method, "returns")
        lowest = [least_earned(method, lasting) for lasting in (False, True)]
        cells = [f"{'✓ ' if paper.low < each < paper.high else ''}{each:.0f}" for each in lowest]
        rows.append([words, f"{paper.low:.0f} to {paper.high:.0f}", *cells])
    heads = ["demonstrations", "the paper's interval over 20 drives", "our lowest: β ends", "our lowest: β never ends"]
    return markdown(heads, rows)


def least_earned(method: str, lasting: bool) -> float:
    """The lowest return of a method's agent that escapes, of the lesson's sources; lasting: β never ends.

    Of the study, of round 3, of the ablations (round 2 has some), and of the ten others.
    """
    trained = [of_all(), *clocks().values(), *shipped_experiment("ablations").values()]
    trained += shipped_experiment("stress").values()  # the ten others
    helped = [each.of(method) for each in trained if method in each.methods]
    chosen = [each for each in helped if (each.agents[0]["beta_episodes"] is None) == lasting]
    return float(min(each.scores("returns")[each.scores("success") >= ESCAPES].min(initial=np.inf) for each in chosen))


def of_the_agent_shown() -> Rollout:
    """The first drive of the lesson: of an agent with demonstrations alone, after its training."""
    best = int(in_training("demos", 700, 900).argmax())
    return record(shipped_agents("demos")[best].as_policy(), [10])[0]
