"""Discrete soft actor-critic: the soft value and the three losses, as pure functions.

Shapes: `log_pi` and `q` (..., batch, actions), one number per state (..., batch); coefficients such as alpha broadcast
against (..., batch). Expectations over actions are exact sums. Discrete form: Christodoulou (arXiv 1910.07207);
objective: Section III-C of the paper. The paper's additions are in `bootstrap.py`; `constraint` is ξ KL.
"""

import torch
from torch import Tensor


def log_policy(logits: Tensor) -> Tensor:
    """log π(a|s), the logarithm of softmax: (..., actions) -> (..., actions).

    torch's log_softmax takes four times as long on rows of nine.
    """
    return logits - logits.logsumexp(-1, keepdim=True)


def entropy(log_pi: Tensor) -> Tensor:
    """H(π(·|s)) = -Σ_a π log π (in Equations 6 and 21), in nats: (..., batch, actions) -> (..., batch)."""
    return -(log_pi.exp() * log_pi).sum(-1)


def soft_value(log_pi: Tensor, q: Tensor, alpha: Tensor, constraint: Tensor | float = 0.0) -> Tensor:
    """V(s) = Σ_a π(a|s) Q(s,a) + α H(π(·|s)) - constraint(s), of Equations 6 and 15: (..., batch)."""
    return (log_pi.exp() * (q - alpha.unsqueeze(-1) * log_pi)).sum(-1) - constraint


def critic_target(reward: Tensor, terminated: Tensor, next_value: Tensor, gamma: Tensor) -> Tensor:
    """y = r + γ (1 - terminated) V(s'): (..., batch). An episode that ended at its time limit is not terminated."""
    return reward + gamma * (1 - terminated) * next_value


def critic_loss(q_taken: Tensor, target: Tensor) -> Tensor:
    """Mean over the batch of (Q(s,a) - y)²: (..., batch) -> (...)."""
    return (q_taken - target).square().mean(-1)


def conservative_loss(q: Tensor, actions: Tensor) -> Tensor:
    """Mean over the batch of log Σ_a exp Q(s,a) - Q(s,a_data), CQL's term (arXiv 2006.04779, Equation 4).

    Minimising it lowers the highest values and raises those of the data's actions; it is 0 or more. q (..., batch,
    actions), actions (..., batch) -> (...). Plain SAC has no such term: see `cql.py`.
    """
    return (q.logsumexp(-1) - q.gather(-1, actions.unsqueeze(-1)).squeeze(-1)).mean(-1)


def actor_loss(log_pi: Tensor, q: Tensor, alpha: Tensor, constraint: Tensor | float = 0.0) -> Tensor:
    """Mean over the batch of -V(s), without gradient through Q: (..., batch, actions) -> (...)."""
    return -soft_value(log_pi, q.detach(), alpha, constraint).mean(-1)


def temperature_loss(log_alpha: Tensor, state_entropy: Tensor, target_entropy: Tensor) -> Tensor:
    """α (H(π) - η) with the target entropy η: minimising it raises α while the entropy is below η: (...).

    log_alpha and target_entropy (...), state_entropy (..., batch).
    """
    return log_alpha.exp() * (state_entropy.detach().mean(-1) - target_entropy)


def min_q(q_pair: Tensor) -> Tensor:
    """The smaller of the two critics' values: (2, ..., batch, actions) -> (..., batch, actions)."""
    return torch.minimum(q_pair[0], q_pair[1])
