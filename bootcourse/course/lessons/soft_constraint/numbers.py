"""What the numbers and claims in this lesson's text are computed from, beside tools/course/known.py."""

import math
from collections.abc import Callable
from functools import cache

import numpy as np
import torch

from bootcourse.course.lessons.soft_constraint.examples import (
    entropy_in,
    fast_and_rule,
    later,
    reward_and_kl,
    three_agents,
)
from bootcourse.course.lessons.soft_constraint.figures import ways_out as ways_out
from bootcourse.course.shipped import shipped_agents
from bootcourse.episodes.record import record
from bootcourse.learn.bootstrap import regularised_policy
from bootcourse.panels.compromise import CHOSEN, Way, Ways
from bootcourse.research.results import Results
from bootcourse.statistics import HAD as HAD
from bootcourse.statistics import IN_A_ROW as IN_A_ROW
from bootcourse.statistics import LOST as LOST
from bootcourse.statistics import lost
from tools.course.known import RULE_P, of, others, shipped_experiment

ALPHA = 0.01  # of the opening panel


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


@cache
def ways_of_the_panel(xi: float, road: int) -> dict[str, Way]:
    """The panel's three ways on from the start of a road, with p = 0.9, by their names."""
    helped = shipped_agents("soft")[0]
    drive = record(helped.as_policy(with_q=True), [road])[0]
    return Ways(drive, helped).at(0, RULE_P, xi, ALPHA)


def way(xi: float, whose: str = CHOSEN, road: int = 10) -> str:
    """How far one of the panel's three ways gets: "402 m in 40 s"."""
    return ways_of_the_panel(xi, road)[whose].words


def paid(xi: float) -> list[float]:
    """What a second pays with this ξ, reward − ξ KL: for driving as the fast agents, and as the rule."""
    return [reward - xi * kl for reward, kl in map(reward_and_kl, fast_and_rule().values())]


def paid_equally() -> float:
    """The ξ with which both are paid the same."""
    (fast, its_kl), (rule, rules_kl) = map(reward_and_kl, fast_and_rule().values())
    return (fast - rule) / (its_kl - rules_kl)


def paid_equally_by_each() -> list[float]:
    """The same ξ, from each of the five fast agents' drives alone."""
    drives, by_rule = fast_and_rule().values()
    rule, rules_kl = reward_and_kl(by_rule)
    one = len(by_rule)
    fast = (reward_and_kl(drives[k : k + one]) for k in range(0, len(drives), one))
    return [(reward - rule) / (kl - rules_kl) for reward, kl in fast]


def weak() -> list[Results]:
    """The twenty agents whose ξ stays at 0.1, ten of the study's."""
    return [stays(0.1), others("soft, ξ stays at 0.1")]


def returns_of_keepers(agents: list[Results]) -> np.ndarray:
    """The returns of those agents of these studies that kept the way out."""
    return np.concatenate([each.scores("returns")[each.found_and_kept("soft")[1]] for each in agents])


def returns_of(agents: list[Results]) -> np.ndarray:
    """The returns of all agents of these studies."""
    return np.concatenate([each.of("soft").scores("returns") for each in agents])


def entropy_of_the_fast() -> float:
    """The fast agents' mean entropy in these seconds: nats."""
    return later(fast_and_rule()["five fast agents"], entropy_in)


def same_until_the_floor() -> bool:
    """Have the study's agents the same episodes, whether ξ falls towards 0 or to 0.1, until it is at 0.1?"""
    stops, goes_on = floored()[0].of("soft").curves, of("soft").of("soft").curves
    at_the_floor = np.maximum.accumulate(stops["xi"] <= 0.1001, axis=1)
    return bool((at_the_floor | (stops["return"] == goes_on["return"])).all() and at_the_floor.any(1).all())


def at_a_twentieth() -> list[int]:
    """After which training episodes of the study's ten agents ξ has fallen from 2 to 0.1."""
    return (floored()[0].of("soft").curves["xi"] <= 0.1001).argmax(1).tolist()


def early(agents: Results, first: int) -> float:
    """The mean return of the study's agents in fifty training episodes from this one on."""
    return float(agents.of("soft").curves["return"][:, first : first + 50].mean())


def of_the_even() -> float:
    """The KL (nats) of a policy with nine equal probabilities, as Round 1 shows it."""
    return round(float(three_agents()[-1][-1]), 2)


def leaving_costs(xi: float) -> float:
    """What a second with another action than the rule's costs more than one with it, with this ξ."""
    return xi * math.log(8 * RULE_P / (1 - RULE_P))


def q_lead(alpha: float) -> float:
    """How much larger the best policy's log π of an action is whose Q is 1 above, with ξ = 200 α: nats."""
    return 1 / (201 * alpha)


def head_start() -> float:
    """How much larger the best policy's log π of the rule's action is where all Q are equal, with ξ = 200 α: nats."""
    return leaving_costs(200 / 201)


def entropy_where_all_q_are_equal(alpha: float) -> float:
    """The entropy (nats) of the best policy with ξ = 200 α, in a state where all nine Q are equal."""
    log_rule = torch.tensor([[RULE_P] + [(1 - RULE_P) / 8] * 8]).log()
    policy = regularised_policy(torch.zeros(1, 9), log_rule, alpha, 200 * alpha)
    return float(-(policy * policy.log()).sum())
