"""What the numbers and claims in this lesson's text are computed from, beside tools/course/known.py."""

import math
from collections.abc import Callable, Sequence
from functools import cache

import numpy as np
import torch

from bootcourse.course.shipped import shipped_agents
from bootcourse.episodes.evaluate import drive_episodes, held_out_seeds
from bootcourse.episodes.record import record
from bootcourse.episodes.rollout import Rollout
from bootcourse.learn.bootstrap import kl_to_rule
from bootcourse.panels.compromise import CHOSEN, Ways, compromise
from bootcourse.policies import rule_policy
from bootcourse.research.results import Results
from bootcourse.scenario import DEFAULT
from bootcourse.statistics import ESCAPES, found_after
from tools.course.known import RULE_P, of, others, shipped_experiment


def stays(xi: float = 2.0) -> Results:
    """The ten agents with the soft constraint whose ξ stays at this number."""
    return shipped_experiment("ablations")[f"ξ stays at {xi:g}"]


def beyond_the_rule() -> int:
    """How many of the ten agents whose ξ fades earn more than twice as much as the rule."""
    return int((of("soft").scores("returns") > 2 * of("rule").scores("returns").mean()).sum())


def actor_only() -> Results:
    """The ten agents with the soft constraint that have the KL in the actor's loss alone."""
    return shipped_experiment("ablations")["KL in the actor only"].of("soft")


def found_between(agents: Results) -> str:
    """The first and the last training episode after which one of the agents has found the way: "484 to 1,037"."""
    after = found_after(agents.curves["success"])
    return f"{after[after > 0].min():,} to {after.max():,}"


def place_row(agents: Results) -> str:
    """After which episodes the agents found the way out, how many escape, and what these return."""
    escape = agents.scores("success") >= ESCAPES
    earned = agents.scores("returns")[escape]
    return f"{found_between(agents)} | {escape.sum()} | {earned.min():.0f} to {earned.max():.0f}"


def sooner_without() -> bool:
    """Does each agent without the KL in the target find the way before any agent with it?"""
    first, then = (found_after(agents.curves["success"]) for agents in (actor_only(), of("soft")))
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
    """A count of the study's ten agents and ten others: of those whose ξ fades (None), or stays at 0.1 or 2."""
    study, more = (of("soft"), "soft") if xi is None else (stays(xi), f"soft, ξ stays at {xi:g}")
    return count(study) + count(others(more))


def row_of(agents: Results) -> str:
    """How many found the way out, after which episodes, how many kept it, and the median return of these."""
    keepers = agents.found_and_kept("soft")[1]
    half = np.median(agents.scores("returns")[keepers])
    return f"{found(agents)} | {found_between(agents)} | {kept(agents)} | {half:.0f}"


def falls() -> Results:
    """The study's agents whose ξ = 200 α falls to 0.1 and stays there."""
    return shipped_experiment("ablations")["ξ falls to 0.1"]


def stopped_row(agents: Results) -> str:
    """How many found the way out and escape, the returns of all, lowest and highest, and their accidents."""
    cells = [str(found(agents)), str(agents.escapers("soft"))]
    for scores in (agents.scores("returns"), 100 * agents.scores("accident")):
        cells.append(f"{scores.min():.0f} to {scores.max():.0f}")
    return " | ".join(cells)


def both_percent(rates: Sequence[float]) -> str:
    """ "89 and 92 %"."""
    return " and ".join(f"{100 * rate:.0f}" for rate in rates) + " %"


def alpha_at_the_end() -> np.ndarray:
    """The temperature α with which the training of each shipped agent ended, (agents,)."""
    return np.array([helped.alpha for helped in shipped_agents("soft")])


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
def as_the_rule(xi: float) -> np.ndarray:
    """The share of its seconds on 100 held-out roads in which each shipped agent does what the rule would, (agents,),
    if it drives by the compromise of its Q and the rule."""
    ways = [compromise(helped, DEFAULT, RULE_P, xi, 0.01) for helped in shipped_agents("soft")]
    driven = [record(way, held_out_seeds(1, 100)) for way in ways]
    return np.array([np.mean(np.concatenate([d.actions == d.rule_actions for d in drives])) for drives in driven])


@cache
def by_their_own() -> list[list[Rollout]]:
    """Each shipped agent's drives by its own π, with its Q, on 100 held-out roads."""
    return [record(helped.as_policy(with_q=True), held_out_seeds(1, 100)) for helped in shipped_agents("soft")]


@cache
def break_even() -> np.ndarray:
    """At which ξ each shipped agent's unhurt drives are charged, after 20 s, what they earn more than the rule's."""
    late, mine = slice(20, None), record(rule_policy(DEFAULT), held_out_seeds(1, 100))
    earned, levels = np.mean([drive.rewards[late] for drive in mine]), []
    for drives in by_their_own():
        parts = [each for each in drives if not each.accident]
        more = np.mean([each.rewards[late] for each in parts]) - earned
        policy = torch.tensor(np.stack([each.policy[late] for each in parts])).clamp_min(1e-12)
        taken = torch.tensor(np.stack([each.rule_actions[late] for each in parts]))
        charged = float(kl_to_rule(policy.log(), taken.long(), torch.tensor(RULE_P)).mean())
        levels.append(more / (charged + math.log(RULE_P)))
    return np.array(levels)


def late_as_the_rule() -> np.ndarray:
    """The share of their seconds, after 20 s, in which the shipped agents do what the rule would, (agents,)."""
    each = [[drive for drive in drives if not drive.accident] for drives in by_their_own()]
    return np.array([np.mean([d.actions[20:] == d.rule_actions[20:] for d in drives]) for drives in each])


def unlike_the_rule() -> np.ndarray:
    """The share of these seconds in which each agent differs from the rule, (agents,)."""
    return np.array([np.mean(np.concatenate([d.actions != d.rule_actions for d in each])) for each in by_their_own()])


@cache
def preferred() -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """The share of these seconds in which the action that is best by each agent's Q is not the one it takes, by how
    much its Q is larger there, and by how much the best Q is larger than the second in all seconds (medians), each
    (agents,)."""
    shares, leads, usual = [], [], []
    for drives in by_their_own():
        q, actions = np.concatenate([d.q_values for d in drives]), np.concatenate([d.actions for d in drives])
        second, first = np.sort(q, axis=1)[:, -2:].T
        lead = first - q[np.arange(len(q)), actions]
        shares.append(np.mean(lead > 0))
        leads.append(np.median(lead[lead > 0]))
        usual.append(np.median(first - second))
    return np.array(shares), np.array(leads), np.array(usual)


def between(numbers: np.ndarray) -> str:
    """The lowest and the highest: "0.04 to 0.22"."""
    return f"{numbers.min():.2f} to {numbers.max():.2f}"


def percent(shares: np.ndarray) -> str:
    """The lowest and the highest share, in per cent: "49 to 88"."""
    return f"{100 * shares.min():.0f} to {100 * shares.max():.0f}"
