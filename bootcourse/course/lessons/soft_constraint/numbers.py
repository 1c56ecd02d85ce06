"""What the numbers and claims in this lesson's text are computed from, beside tools/course/known.py."""

import math
from functools import cache

import numpy as np

from bootcourse.course.shipped import shipped_agents
from bootcourse.episodes.evaluate import drive_episodes, held_out_seeds
from bootcourse.episodes.record import record
from bootcourse.panels.compromise import CHOSEN, Ways, compromise
from bootcourse.research.results import Results
from bootcourse.scenario import DEFAULT
from bootcourse.statistics import ESCAPES, found_after
from tools.course.known import RULE_P, escapers, of, shipped_experiment


def stays(xi: float = 2.0) -> Results:
    """The ten agents with the soft constraint whose ξ stays at this number."""
    return shipped_experiment("ablations")[f"ξ stays at {xi:g}"]


def beyond_the_rule() -> int:
    """How many of the ten agents whose ξ fades earn more than twice as much as the rule."""
    return int((of("soft").scores("returns") > 2 * of("rule").scores("returns").mean()).sum())


def with_kl_in_actor_only() -> int:
    """How many of ten agents with the soft constraint escape if the KL is in the actor's loss alone."""
    return escapers(shipped_experiment("ablations")["KL in the actor only"], "soft")


def found_between(agents: Results) -> str:
    """The first and the last training episode after which one of the agents has found the way out: "301 to 367"."""
    after = found_after(agents.curves["success"])
    return f"{after.min()} to {after.max()}"


def losers() -> list[float]:
    """What the agents with the soft constraint earn that do not escape, in ascending order."""
    soft = of("soft")
    return sorted(soft.scores("returns")[soft.scores("success") < ESCAPES])


def sooner_without() -> bool:
    """Does each agent without the KL in the target find the way before any agent with it?"""
    without = shipped_experiment("ablations")["KL in the actor only"].of("soft")
    first, then = (found_after(agents.curves["success"]) for agents in (without, of("soft")))
    return bool(0 < first.min() and first.max() < then.min())


def found(agents: Results) -> int:
    """How many agents have found the way out in training."""
    return int((found_after(agents.curves["success"]) > 0).sum())


def of_the_finders(xi: float) -> str:
    """As `found_between`, of the agents whose ξ stays and who found the way out: "484 to 1,037"."""
    after = found_after(stays(xi).curves["success"])
    return f"{after[after > 0].min():,} to {after.max():,}"


def entropy_of_the_rule() -> float:
    """The entropy of the stochastic rule, in nats: p for its action, the rest for the other eight."""
    return -RULE_P * math.log(RULE_P) - (1 - RULE_P) * math.log((1 - RULE_P) / 8)


def with_target(entropy: float) -> np.ndarray:
    """The returns of the study's agents with the soft constraint and another target entropy, (agents,)."""
    return shipped_experiment("sensitivity")[f"target entropy {entropy:g}"].of("soft").scores("returns")


def compromised(xi: float) -> bool:
    """Does the drive of the panel, by the compromise of the first agent's Q and the rule from the start of road 10,
    end in an accident?"""
    helped = shipped_agents("soft")[0]
    drive = record(helped.as_policy(with_q=True), [10])[0]
    return Ways(drive, helped).at(0, 0.9, xi, 0.01)[CHOSEN].accident != 0


@cache
def crashing(xi: float | None) -> np.ndarray:
    """The share of 100 held-out roads on which each shipped agent has an accident, (agents,): by the compromise of its
    Q and the rule, or by its own π (None)."""
    shares = []
    for helped in shipped_agents("soft"):
        policy = helped.as_policy() if xi is None else compromise(helped, DEFAULT, RULE_P, xi, 0.01)
        shares.append((drive_episodes(policy, held_out_seeds(1, 100)).accident > 0).mean())
    return np.array(shares)


@cache
def unlike_the_rule() -> np.ndarray:
    """The share of its seconds on 100 held-out roads in which each shipped agent differs from the rule, (agents,)."""
    agents = [record(helped.as_policy(), held_out_seeds(1, 100)) for helped in shipped_agents("soft")]
    return np.array([np.mean(np.concatenate([d.actions != d.rule_actions for d in drives])) for drives in agents])


def percent(shares: np.ndarray) -> str:
    """The lowest and the highest share, in per cent: "49 to 88"."""
    return f"{100 * shares.min():.0f} to {100 * shares.max():.0f}"
