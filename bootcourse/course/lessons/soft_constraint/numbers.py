"""What the numbers and claims in this lesson's text are computed from, beside tools/course/known.py."""

import math
import re
from collections.abc import Callable

import torch

from bootcourse.course.lessons.soft_constraint import explorable
from bootcourse.course.lessons.soft_constraint.figures import ways_out as ways_out
from bootcourse.course.shipped import shipped_agents
from bootcourse.episodes.record import record
from bootcourse.learn.bootstrap import regularised_policy
from bootcourse.panels.compromise import Ways
from bootcourse.research.results import Results
from bootcourse.statistics import HAD as HAD
from bootcourse.statistics import IN_A_ROW as IN_A_ROW
from bootcourse.statistics import LOST as LOST
from bootcourse.statistics import lost
from tools.course.known import RULE_P, SETTINGS, of, others, shipped_experiment


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


def returning_more() -> int:
    """How many agents of `fading` that escape return more than each agent of `floored`."""
    most = max(each.scores("returns").max() for each in floored())
    return sum(int((each.found_and_kept("soft")[1] & (each.scores("returns") > most)).sum()) for each in fading())


def entropy_of_the_rule() -> float:
    """The entropy of the stochastic rule, in nats: p for its action, the rest for the other eight."""
    return -RULE_P * math.log(RULE_P) - (1 - RULE_P) * math.log((1 - RULE_P) / 8)


def accidents_of_the_panel(xi: float) -> list[str]:
    """Which of the panel's three ways on from the start of road 10 end in an accident."""
    helped = shipped_agents("soft")[0]
    drive = record(helped.as_policy(with_q=True), [10])[0]
    return [name for name, way in Ways(drive, helped).at(0, 0.9, xi, 0.01).items() if way.accident]


def entropy_at(alpha: float) -> float:
    """The entropy of the best policy in the thermostat's state with ξ = 200 α, in nats."""
    q, log_rule = explorable.one_state()
    best = regularised_policy(q, log_rule, alpha, SETTINGS.xi_multiplier * alpha)
    return torch.special.entr(best).sum().item()


def thermostat_says(eta: float) -> str:
    """What the panel says that ξ does with this target entropy."""
    panel = explorable.thermostat()
    panel.numbers["target"].value = eta
    return re.search(r", ξ ([a-z ]+):", panel.svg.alt)[1]
