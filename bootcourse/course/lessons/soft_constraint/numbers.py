"""What the numbers and claims in this lesson's text are computed from, beside tools/course/known.py."""

import re
from collections.abc import Callable
from functools import cache

import numpy as np
import torch

from bootcourse.course.lessons.soft_constraint import examples
from bootcourse.course.lessons.soft_constraint.examples import ROADS
from bootcourse.course.lessons.soft_constraint.figures import ways_out as ways_out
from bootcourse.course.shipped import shipped_agents
from bootcourse.episodes.evaluate import drive_episodes
from bootcourse.episodes.record import record
from bootcourse.learn.bootstrap import regularised_policy
from bootcourse.panels.compromise import CHOSEN, Way, Ways
from bootcourse.policies import rule_policy
from bootcourse.research.results import Results
from bootcourse.scenario import DEFAULT
from bootcourse.statistics import ESCAPES, found_after, lost
from bootcourse.statistics import HAD as HAD
from bootcourse.statistics import IN_A_ROW as IN_A_ROW
from bootcourse.statistics import LOST as LOST
from tools.course.known import RULE_P, of, others, shipped_experiment


def stays(xi: float = 2.0) -> Results:
    """The ten agents with the soft constraint whose ξ stays at this number."""
    return shipped_experiment("ablations")[f"ξ stays at {xi:g}"]


def actor_only() -> Results:
    """The ten agents with the soft constraint that have the KL in the actor's loss alone."""
    return shipped_experiment("ablations")["KL in the actor only"].of("soft")


def sooner_without() -> bool:
    """Does each agent without the KL in the target find the way before any agent with it?"""
    then, first = ways_out()
    return bool(0 < first.min() and first.max() < then.min())


def found(agents: Results) -> int:
    """How many agents have found the way out in training."""
    return int(agents.found_and_kept("soft")[0].sum())


def always_crash(groups: list[Results]) -> int:
    """How many agents have an accident in more than nine drives of ten."""
    return sum(int((agents.scores("accident") > 0.9).sum()) for agents in groups)


def crash_of_keepers(groups: list[Results]) -> float:
    """The share of drives that end in an accident of those that escape, on average."""
    hurt = [agents.scores("accident")[agents.scores("success") >= ESCAPES] for agents in groups]
    return float(np.concatenate(hurt).mean())


def finding(agents: Results) -> np.ndarray:
    """The episodes after which these agents have found the way out, (agents,); 0 where they have not."""
    return found_after(agents.of("soft").curves["success"])


def kept(agents: Results) -> int:
    """How many of those that found the way out escape after training."""
    return int(agents.found_and_kept("soft")[1].sum())


def fast_keepers(agents: Results) -> int:
    """How many of those that kept the way out return more than twice as much as the rule."""
    fast = agents.scores("returns") > 2 * of("rule").scores("returns").mean()
    return int((agents.found_and_kept("soft")[1] & fast).sum())


def in_all(count: Callable[[Results], int], xi: float | None = None) -> int:
    """A count of the study's ten agents and ten others: of those whose ξ fades (None), or stays at 0.1."""
    study, more = (of("soft"), "soft") if xi is None else (stays(xi), f"soft, ξ stays at {xi:g}")
    return count(study) + count(others(more))


def fading() -> list[Results]:
    """The study's ten agents and ten others whose ξ = 200 α fades to nothing."""
    return [of("soft"), others("soft")]


def floored() -> list[Results]:
    """The twenty agents whose ξ = 200 α falls to 0.1 and stays there, ten of the study's."""
    return [shipped_experiment("ablations")["ξ falls to 0.1"], others("soft, ξ falls to 0.1")]


def twenty(count: Callable[[Results], int]) -> int:
    """The same count as `in_all` of the agents of `floored`."""
    return sum(map(count, floored()))


def losing(agents: list[Results]) -> int:
    """How many agents of these studies lose the way out at least once in their training."""
    return sum(int(lost(each.of("soft").curves["success"]).sum()) for each in agents)


def crashes(agents: list[Results]) -> float:
    """The share of their drives that end in an accident."""
    return float(np.mean([each.of("soft").scores("accident") for each in agents]))


def returning_more() -> int:
    """How many agents of `fading` that escape return more than each agent of `floored`."""
    most = max(each.scores("returns").max() for each in floored())
    return sum(int((each.found_and_kept("soft")[1] & (each.scores("returns") > most)).sum()) for each in fading())


@cache
def ways_of_the_panel(xi: float) -> dict[str, Way]:
    """The panel's three ways on from the start of road 10, with p = 0.9, by their names."""
    helped = shipped_agents("soft")[0]
    drive = record(helped.as_policy(with_q=True), [10])[0]
    return Ways(drive, helped).at(0, RULE_P, xi, examples.ALPHA)


def way(xi: float, whose: str = CHOSEN) -> str:
    """How far one of the panel's three ways gets: "402 m in 40 s"."""
    return ways_of_the_panel(xi)[whose].words


def metres(xi: float) -> str:
    """How far the panel's compromise gets in its 40 s."""
    return re.fullmatch(r"(\d+) m in 40 s", way(xi))[1]


def accidents_of_the_panel(xi: float) -> list[str]:
    """Which of the panel's three ways end in an accident."""
    return [name for name, each in ways_of_the_panel(xi).items() if each.accident]


@cache
def drives() -> tuple[np.ndarray, np.ndarray]:
    """The mean returns and shares of accidents of the drives in Round 2, (5, agents) each: ξ = 1, 0.3, 0.1, 0, own."""
    return examples.mixed(regularised_policy, [1, 0.3, 0.1, 0])


def rule_on_these_roads() -> float:
    """The rule's mean return on the roads of `drives`."""
    return float(drive_episodes(rule_policy(DEFAULT), ROADS).returns.mean())


def same_until_the_floor() -> bool:
    """Have the study's agents the same episodes, whether ξ falls towards 0 or to 0.1, until it is at 0.1?"""
    stops, goes_on = floored()[0].of("soft").curves, of("soft").of("soft").curves
    at_the_floor = np.maximum.accumulate(stops["xi"] <= 0.1001, axis=1)
    return bool((at_the_floor | (stops["return"] == goes_on["return"])).all() and at_the_floor.any(1).all())


def entropy_where_all_q_are_equal(alpha: float) -> float:
    """The entropy (nats) of the best policy with ξ = 200 α, in a state where all nine Q are equal."""
    log_rule = torch.tensor([[RULE_P] + [(1 - RULE_P) / 8] * 8]).log()
    policy = regularised_policy(torch.zeros(1, 9), log_rule, alpha, 200 * alpha)
    return float(-(policy * policy.log()).sum())
