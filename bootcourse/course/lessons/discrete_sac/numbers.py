"""Numbers that the lesson's text prints: the panel of Round 1 as it opens, the highest estimates of Round 3 and the
actor that may move them, and the chain of Round 4.
"""

import math
from collections.abc import Callable
from functools import cache

import numpy as np
import torch

from bootcourse.course.lessons.discrete_sac.explorable import ALPHA, START, highest_estimates
from bootcourse.course.lessons.discrete_sac.own_parts import GAMMA as GAMMA
from bootcourse.course.lessons.discrete_sac.own_parts import LEARNERS as LEARNERS
from bootcourse.course.lessons.discrete_sac.own_parts import STEP as STEP
from bootcourse.course.lessons.discrete_sac.own_parts import SURE, Walked, descended, less_log_2, soft_sweeps, walked
from bootcourse.course.lessons.discrete_sac.own_parts import unpaid as unpaid
from bootcourse.course.lessons.values import chain
from bootcourse.learn import sac

q = np.array(START)
pi = np.exp(q / ALPHA) / np.exp(q / ALPHA).sum()
WORTH = pi @ q - ALPHA * pi @ np.log(pi)
DECISIONS = 1000  # of each learner in the chain
soft, less = sac.soft_value, less_log_2(sac.soft_value)
ALPHAS = (0.01, 0.1, 0.15, 0.2, 0.25, 0.3, 1, 10)  # constant temperatures: Round 4's and more


def highest(actions: int) -> tuple[float, float]:
    """The panel's highest estimate of so many actions, on average: of one critic, and of the smaller of two."""
    return tuple(float(each[actions - 1]) for each in highest_estimates())


def too_high(critics: int = 1) -> float:
    """What nine actions, each worth 0, seem to be worth to softmax(Q), if each Q errs by 1: a mean of 4,000 states.

    critics: 1, or 2 of which the smaller estimate counts.
    """
    q = np.random.default_rng(0).normal(size=(4000, critics, 9)).min(axis=1)
    return float((np.exp(q) * q).sum(axis=1) @ (1 / np.exp(q).sum(axis=1)) / len(q))


def wished() -> float:
    """What going straight seems to be worth to an actor that moves Q, too."""
    return float(descended(lambda log_pi, q, alpha: -sac.soft_value(log_pi, q, alpha).mean()).q[1])


def soft_q(alpha: float) -> np.ndarray:
    """Q of the chain of lesson [[values]] after 40 sweeps of the soft Bellman equation: (5, 2)."""
    return soft_sweeps(sac.soft_value, sac.critic_target, alpha).numpy()


def leave(alpha: float) -> float:
    """How probable leaving is in the chain's trap by the policy softmax(Q / α)."""
    stays, leaves = soft_q(alpha)[0]
    return 1 / (1 + math.exp((stays - leaves) / alpha))


def doubt() -> float:
    """How many nats the entropy rises if a sure policy gives one of its other actions 1 %."""
    return -0.99 * math.log(0.99) - 0.01 * math.log(0.01)


@cache
def first(alpha: float) -> float:
    """Q(stay) in the chain's trap after a first decision to stay; all Q were 0."""
    return float(walked(sac.soft_value, sac.critic_target, torch.tensor([[alpha]]).double()).q[0, :, 0, 0].max())


def stays(alpha: float) -> float:
    """How probable staying is by the softmax then."""
    return 1 / (1 + math.exp(-first(alpha) / alpha))


@cache
def constant(value: Callable = sac.soft_value, seed: int = 0) -> Walked:
    """The chain's learners at each of the ALPHAS, which stay. value: V(s) in their target, see `unpaid`."""
    alphas = torch.tensor(ALPHAS, dtype=torch.float64).expand(DECISIONS, -1)
    return walked(value, sac.critic_target, alphas, seed)


def found(value: Callable, alpha: float) -> int:
    """How many of them find the free road at one of the ALPHAS."""
    return int(constant(value).found[ALPHAS.index(alpha)].sum())


def sure_at(value: Callable, alpha: float, seed: int = 0) -> int:
    """How many of them end sure of leaving at one of the ALPHAS."""
    return int(sure(constant(value, seed))[ALPHAS.index(alpha)])


@cache
def falling(
    value: Callable = sac.soft_value, start: float = 10, seed: int = 0, first_q: float = 0.0, decisions: int = DECISIONS
) -> Walked:
    """Learners whose α falls by equal factors from `start` to 0.01. value: V(s) in their target, see `unpaid`."""
    alphas = torch.tensor(np.geomspace(start, 0.01, decisions))[:, None]
    return walked(value, sac.critic_target, alphas, seed, first_q)


def sure_from(start: float) -> list[int]:
    """How many of them end sure of leaving with the pay α H, α (H − log 2) and none."""
    return [int(sure(falling(value, start))[0]) for value in (sac.soft_value, less, unpaid)]


def others() -> list[int]:
    """How many of two more sets of such learners, which draw other numbers, are sure of leaving in the end."""
    return [int(sure(falling(seed=seed))[0]) for seed in (1, 2)]


@cache
def begun(value: Callable = sac.soft_value) -> Walked:
    """The learners whose α falls from 10 to 0.01 in 1,000 decisions, after the first 100."""
    return walked(value, sac.critic_target, torch.tensor(np.geomspace(10, 0.01, DECISIONS)[:100, None]))


def early(of: np.ndarray) -> np.ndarray:
    """The mean of those learners in each state, (5,): of their decisions there, or of the Q of both actions."""
    return of[0].reshape(LEARNERS, chain.STATES, -1).mean(axis=(0, 2))


def row(of: np.ndarray, digits: int = 1) -> str:
    """The same, as cells of a table."""
    return " | ".join(f"{each:.{digits}f}" for each in early(of))


def most_visited(of: Walked) -> float:
    """For which share of such learners the state with the highest mean Q is the one that they decided in most often."""
    return float((of.q[0].mean(axis=2).argmax(axis=1) == of.decided[0].argmax(axis=1)).mean())


def sure(of: Walked) -> np.ndarray:
    """How many learners are sure of leaving in the end, (kinds,)."""
    return (of.leaves > SURE).sum(axis=1)
