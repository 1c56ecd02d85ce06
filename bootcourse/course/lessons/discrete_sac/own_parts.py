"""What the student's own parts do in this lesson: an actor steps down its loss, and learners walk the chain of lesson
[[values]]. Neither is a whole SAC: there is no replay buffer, and no network.
"""

import math
from collections.abc import Callable
from typing import NamedTuple

import numpy as np
import torch
from torch import Tensor

from bootcourse.course.lessons.discrete_sac.explorable import ALPHA, START
from bootcourse.course.lessons.values import chain

STEPS = 100  # down the actor's loss, each of size 1
LEARNERS, STEP, GAMMA = 300, 0.3, 0.8  # on the chain; step and discount as in lesson [[values]]
SWEEPS = 40


class Descent(NamedTuple):
    """Where an actor ends: its policy, the estimates Q, and the loss, of the three actions of Round 1."""

    pi: np.ndarray
    q: np.ndarray
    loss: float


def descended(loss: Callable[[Tensor, Tensor, Tensor], Tensor]) -> Descent:
    """From an even policy, gradient steps on `loss(log_pi, q, alpha)` for all that it has a gradient for."""
    logits, q = torch.zeros(1, len(START), requires_grad=True), torch.tensor([START], requires_grad=True)
    for _ in range(STEPS):
        loss(logits.log_softmax(-1), q, torch.tensor(ALPHA)).backward()
        with torch.no_grad():
            for numbers in (logits, q):
                if numbers.grad is not None:
                    numbers -= numbers.grad
                    numbers.grad = None
    value = loss(logits.log_softmax(-1), q, torch.tensor(ALPHA)).item()
    return Descent(logits.detach().softmax(-1)[0].numpy(), q.detach()[0].numpy(), value)


def soft_sweeps(value: Callable, target: Callable, alpha: float) -> Tensor:
    """The chain's Q after SWEEPS of the soft Bellman equation: (5, 2). Its policy is softmax(Q / α).

    value, target: `soft_value` and `critic_target`, a student's or the library's.
    """
    reward, following = torch.tensor(chain.REWARD), torch.tensor(chain.NEXT)
    q, alpha = torch.zeros(reward.shape, dtype=torch.float64), torch.tensor(float(alpha), dtype=torch.float64)
    for _ in range(SWEEPS):
        v = value((q / alpha).log_softmax(-1), q, alpha)
        q = target(reward.flatten(), torch.zeros(reward.numel()), v[following.flatten()], GAMMA).reshape(q.shape)
    return q


SURE = 0.9  # a learner that leaves with a higher probability is sure of it


class Walked(NamedTuple):
    """How probable leaving is for each learner in the end, (kinds, LEARNERS), and how it got there."""

    leaves: np.ndarray
    walks: np.ndarray  # on how many it was on the free road, (kinds, LEARNERS)
    decided: np.ndarray  # how often in each state, (kinds, LEARNERS, 5)
    q: np.ndarray  # in the end, (kinds, LEARNERS, 5, 2)

    @property
    def found(self) -> np.ndarray:
        """Which learners were on the free road: (kinds, LEARNERS) bool."""
        return self.walks > 0


def unpaid(log_pi: Tensor, q: Tensor, alpha: Tensor) -> Tensor:
    """V(s) without the pay, to put in the place of `soft_value`: the mean of Q under the policy, (batch,)."""
    return (log_pi.exp() * q).sum(-1)


def less_log_2(value: Callable) -> Callable:
    """Such a V(s) with the pay α (H − log 2), which is 0 for an even policy of two actions. value: `soft_value`."""
    return lambda log_pi, q, alpha: value(log_pi, q, alpha) - alpha * math.log(2)


def walked(value: Callable, target: Callable, alphas: Tensor, seed: int = 0, first_q: float = 0.0) -> Walked:
    """Learners that act by softmax(Q / α) and move Q to the soft target; alphas: (decisions, kinds).

    All kinds draw the same numbers. seed: of these; first_q: what all Q are at first.
    """
    decisions, kinds = alphas.shape
    reward, following = torch.tensor(chain.REWARD), torch.tensor(chain.NEXT)
    drawn = torch.tensor(np.random.default_rng(seed).random((decisions, LEARNERS))).repeat(1, kinds)
    alphas, one = alphas.repeat_interleave(LEARNERS, dim=1)[..., None], torch.ones((), dtype=torch.float64)
    each, goes_on = torch.arange(kinds * LEARNERS), torch.zeros(kinds * LEARNERS)
    q = torch.full((len(each), *reward.shape), first_q, dtype=torch.float64)
    walks = torch.zeros_like(each)
    decided = torch.zeros(len(each), chain.STATES)
    for t, alpha in enumerate(alphas):
        if t % chain.EPISODE == 0:
            s, was_free = torch.zeros_like(each), torch.zeros_like(each, dtype=torch.bool)
        a = (drawn[t] < (q[each, s] / alpha).softmax(-1)[:, 1]).long()
        is_free = s == chain.STATES - 1
        walks += is_free & ~was_free
        decided[each, s] += 1
        s_next = following[s, a]
        scaled = q[each, s_next] / alpha  # V of Q at α is α times V of Q / α at 1: one call for all kinds
        v = alpha[:, 0] * value(scaled.log_softmax(-1), scaled, one)
        q[each, s, a] += STEP * (target(reward[s, a], goes_on, v, GAMMA) - q[each, s, a])
        s, was_free = s_next, is_free
    leaves = (q[:, 0] / alpha).softmax(-1)[:, 1]
    return Walked(*(of.reshape(kinds, LEARNERS, *of.shape[1:]).numpy() for of in (leaves, walks, decided, q)))
