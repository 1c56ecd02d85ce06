"""Numbers that the lesson's text prints: the panel of Round 1 as it opens, the best policy of Round 2, the highest
estimates of Round 3, and the chain of Round 4.
"""

import math

import numpy as np
import torch

from bootcourse.course.lessons.discrete_sac.explorable import ALPHA, START, highest_estimates
from bootcourse.course.lessons.values import chain
from bootcourse.learn import sac

q = np.array(START)
pi = np.exp(q / ALPHA) / np.exp(q / ALPHA).sum()
BY_Q = pi @ q
WORTH = BY_Q - ALPHA * pi @ np.log(pi)
SOFTMAX = math.exp(3) / (math.e + math.exp(3))  # of Q = 1 and 3 with α = 1, the second action


def highest(actions: int) -> tuple[float, float]:
    """The panel's highest estimate of so many actions, on average: of one critic, and of the smaller of two."""
    return tuple(float(each[actions - 1]) for each in highest_estimates())


def soft_q(alpha: float) -> np.ndarray:
    """Q of the chain of lesson [[values]] after 40 sweeps of the soft Bellman equation: (5, 2)."""
    reward, temperature = torch.tensor(chain.REWARD).flatten(), torch.tensor(alpha, dtype=torch.float64)
    q = torch.zeros(chain.REWARD.shape, dtype=torch.float64)
    for _ in range(40):
        value = sac.soft_value(sac.log_policy(q / alpha), q, temperature)
        following = value[torch.tensor(chain.NEXT).flatten()]
        q = sac.critic_target(reward, torch.zeros(10), following, 0.8).reshape(q.shape)
    return q.numpy()


def leave(alpha: float) -> float:
    """How probable leaving is in the chain's trap by the policy softmax(Q / α)."""
    stays, leaves = soft_q(alpha)[0]
    return 1 / (1 + math.exp((stays - leaves) / alpha))
