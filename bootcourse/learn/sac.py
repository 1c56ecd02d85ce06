"""Discrete soft actor-critic: the soft value and the three losses, as pure functions.

Shapes: `log_pi` and `q` are (..., batch, actions), what is per state is (..., batch), coefficients
such as alpha broadcast against (..., batch). Expectations over actions are taken exactly: nothing
is sampled. Christodoulou (arXiv 1910.07207) gives the discrete form, Section III-C of the paper the
objective. What the paper adds to SAC stands in `bootstrap.py`; here it arrives as `constraint`.
"""

import torch
from torch import Tensor


def log_policy(logits: Tensor) -> Tensor:
    """log π(a|s), the logarithm of softmax: (..., actions) -> (..., actions).

    Written out because torch's own log_softmax takes four times as long on rows of nine.
    """
    return logits - logits.logsumexp(-1, keepdim=True)


def entropy(log_pi: Tensor) -> Tensor:
    """H(π(·|s)) = -Σ_a π log π (in Equations 6 and 21), in nats: (..., batch, actions) -> (..., batch)."""
    return -(log_pi.exp() * log_pi).sum(-1)


def soft_value(log_pi: Tensor, q: Tensor, alpha: Tensor, constraint: Tensor | float = 0.0) -> Tensor:
    """V(s) = Σ_a π(a|s) Q(s,a) + α H(π(·|s)) - constraint(s), of Equations 6 and 15: (..., batch)."""
    return (log_pi.exp() * (q - alpha.unsqueeze(-1) * log_pi)).sum(-1) - constraint


def critic_target(reward: Tensor, terminated: Tensor, next_value: Tensor, gamma: Tensor) -> Tensor:
    """y = r + γ (1 - terminated) V(s'). An episode that ran out of time is not terminated."""
    return reward + gamma * (1 - terminated) * next_value


def critic_loss(q_taken: Tensor, target: Tensor) -> Tensor:
    """Mean over the batch of (Q(s,a) - y)²: (..., batch) -> (...)."""
    return (q_taken - target).square().mean(-1)


def conservative_loss(q: Tensor, actions: Tensor) -> Tensor:
    """Mean over the batch of log Σ_a exp Q(s,a) - Q(s,a_data), CQL's term (arXiv 2006.04779, Equation 4).

    It pushes down what is highest and pulls up what the data did; never negative. q (..., batch,
    actions), actions (..., batch) -> (...). SAC has no such term: see `cql.py`.
    """
    return (q.logsumexp(-1) - q.gather(-1, actions.unsqueeze(-1)).squeeze(-1)).mean(-1)


def actor_loss(log_pi: Tensor, q: Tensor, alpha: Tensor, constraint: Tensor | float = 0.0) -> Tensor:
    """Mean over the batch of -V(s), with Q held fixed: (..., batch, actions) -> (...)."""
    return -soft_value(log_pi, q.detach(), alpha, constraint).mean(-1)


def temperature_loss(log_alpha: Tensor, state_entropy: Tensor, target_entropy: Tensor) -> Tensor:
    """α (H(π) - target), whose gradient raises α while the entropy is under its target: (...).

    log_alpha and target_entropy (...), state_entropy (..., batch).
    """
    return log_alpha.exp() * (state_entropy.detach().mean(-1) - target_entropy)


def min_q(q_pair: Tensor) -> Tensor:
    """The smaller of the two critics' values: (2, ..., batch, actions) -> (..., batch, actions)."""
    return torch.minimum(q_pair[0], q_pair[1])
