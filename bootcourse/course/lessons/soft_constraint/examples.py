"""Numbers that the lesson on the soft constraint shows: three policies' KL, and what fast agents earn and do."""

from collections.abc import Callable, Sequence
from functools import cache

import numpy as np
import torch
from scipy.special import entr

from bootcourse.course.shipped import shipped_agents
from bootcourse.episodes.record import record
from bootcourse.episodes.rollout import Rollout
from bootcourse.learn.bootstrap import kl_to_rule
from bootcourse.policies import rule_policy
from bootcourse.road.state import EGO, SPEED
from bootcourse.scenario import ACTION_NAMES, DEFAULT, N_ACTIONS, RULE_P

ROADS, LATER = range(20), 40  # s: from here on the seconds count


def three_agents() -> list[list[str]]:
    """A row for each of three policies: its words, and its KL (nats) where the rule says "keep left" with p = 0.9."""
    rule_says, p = torch.tensor([ACTION_NAMES.index("keep left")]), torch.tensor(0.9)
    rows = []
    for action in ("keep left", "accelerate straight"):
        sure = torch.full((1, N_ACTIONS), 1e-12)
        sure[0, ACTION_NAMES.index(action)] = 1.0
        rows.append([f"sure of {action}", f"{kl_to_rule(sure.log(), rule_says, p).item():.3f}"])
    even = torch.full((1, N_ACTIONS), 1 / N_ACTIONS)
    return [*rows, ["all nine even", f"{kl_to_rule(even.log(), rule_says, p).item():.3f}"]]


@cache
def fast_and_rule() -> dict[str, list[Rollout]]:
    """Drives of the study's first five agents with the soft constraint, and of the rule."""
    by_agents = [drive for agent in shipped_agents("soft") for drive in record(agent.as_policy(), ROADS)]
    return {"five fast agents": by_agents, "the rule": record(rule_policy(DEFAULT), ROADS)}


def policy_in(drive: Rollout) -> np.ndarray:
    """π at each decision, (T, 9): the driver's, or sure of what was done if it has none."""
    return np.eye(N_ACTIONS)[drive.actions] if drive.policy is None else drive.policy


def kl_in(drive: Rollout) -> np.ndarray:
    """The driver's KL from the stochastic rule at each decision, (T,): nats."""
    log_pi = torch.from_numpy(policy_in(drive)).clamp_min(1e-12).log()
    return kl_to_rule(log_pi, torch.from_numpy(drive.rule_actions), torch.tensor(RULE_P)).numpy()


def entropy_in(drive: Rollout) -> np.ndarray:
    """The driver's entropy at each decision, (T,): nats."""
    return entr(policy_in(drive)).sum(-1)


def speed_in(drive: Rollout) -> np.ndarray:
    """The ego's speed at each decision, (T,): m/s."""
    return drive.states[:: drive.scenario.clock.steps][: len(drive.actions), EGO, SPEED]


def later(drives: Sequence[Rollout], of_one: Callable[[Rollout], np.ndarray]) -> float:
    """The mean over all the drives' seconds that count."""
    return float(np.concatenate([of_one(drive)[LATER:] for drive in drives]).mean())


def reward_and_kl(drives: Sequence[Rollout]) -> tuple[float, float]:
    """What a second earns, and its KL (nats)."""
    return later(drives, lambda drive: drive.rewards), later(drives, kl_in)


def fast_seconds() -> list[list[str]]:
    """A row of a table for each of the two kinds of drivers."""
    rows = []
    for name, drives in fast_and_rule().items():
        reward, kl = reward_and_kl(drives)
        rows.append([name, f"{later(drives, speed_in):.1f}", f"{reward:.2f}", f"{kl:.3g}"])
    return rows
