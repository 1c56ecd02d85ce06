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
ENDS, STAYS, FADES, STOPS = counts.KINDS
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


def experiments() -> tuple:
    """What the table of round 2 is counted from."""
    return of_all(), shipped_experiment("ablations"), shipped_experiment("stress")


@cache
def fate(kind: str) -> list[str]:
    """What the table says of a kind of agents, without its first cell."""
    return next(row[1:] for row in counts.fates(*experiments()) if row[0] == kind)


def losing(kind: str, group: int) -> int:
    """How many agents of a kind lose the way out at least once: of the study's ten, group 0, or of the ten others."""
    return int(lost(counts.groups(kind, *experiments())[group].curves["success"]).sum())


def early(updates: str, driver: str) -> int:
    """How many agents with both aids, so many updates and this driver lose the way out before episode 900."""
    return int(lost(clocks()[updates, driver].of("bootstrapped").curves["success"][:, :LATE]).sum())


def chances() -> dict[str, float]:
    """How often an agent drawn from each row reads as the paper's, with two updates and π̃."""
    agents = clocks()["2", "π̃"]
    return {m: study_clocks.as_printed(agents.of(m).scores("success"), m).mean() for m in study_clocks.VARIED}


def fades_by(updates: float) -> int:
    """By which episode ξ has lost 99 % in the panel to drag, with so many updates for each decision."""
    return int(EPISODES[np.argmax(Fading().left(updates) < 0.01)])


def of_the_agent_shown() -> Rollout:
    """The first drive of the lesson: of an agent with demonstrations alone, after its training."""
    best = int(in_training("demos", 700, 900).argmax())
    return record(shipped_agents("demos")[best].as_policy(), [10])[0]
