"""The paper's additions to SAC (its Section IV): the soft constraint and the demonstrations.

Pure functions of tensors, shapes as in `sac.py`. `rule_actions` (..., batch) are the rule's actions μ(s), in 0..8.
"""

import numpy as np
import torch
from torch import Tensor

from bootcourse.scenario import N_ACTIONS


def log_stochastic_rule(rule_actions: Tensor, p: Tensor, actions: int = N_ACTIONS) -> Tensor:
    """log π̃(a|s) (Equation 16): log p for the rule's action, log((1-p)/8) for others. p (...) -> (..., batch, 9)."""
    others = ((1 - p) / (actions - 1)).log()
    is_rule = torch.arange(actions, device=rule_actions.device) == rule_actions.unsqueeze(-1)
    return torch.where(is_rule, p.log()[..., None, None], others[..., None, None])


def kl_to_rule(log_pi: Tensor, rule_actions: Tensor, p: Tensor) -> Tensor:
    """D_KL(π(·|s) ‖ π̃(·|s)), the soft constraint of Equation 15, in nats: log_pi (..., batch, 9) -> (..., batch).

    It is large where the policy takes actions that the rule would not; the other direction would be large where the
    policy does not take the rule's action.
    """
    return (log_pi.exp() * (log_pi - log_stochastic_rule(rule_actions, p, log_pi.shape[-1]))).sum(-1)


def kl_from_rule(log_pi: Tensor, rule_actions: Tensor, p: Tensor) -> Tensor:
    """D_KL(π̃(·|s) ‖ π(·|s)) in nats, the other direction: log_pi (..., batch, 9) -> (..., batch).

    It is large where the policy does not take the rule's action. Distillation minimises it (arXiv 1803.03835).
    """
    log_rule = log_stochastic_rule(rule_actions, p, log_pi.shape[-1])
    return (log_rule.exp() * (log_rule - log_pi)).sum(-1)


def regularised_policy(q: Tensor, log_rule: Tensor, alpha: float, xi: float) -> Tensor:
    """The policy that maximises Σ π Q + α H - ξ KL: softmax((Q + ξ log π̃) / (α + ξ)), (..., actions)."""
    return ((q + xi * log_rule) / (alpha + xi)).softmax(-1)


def constraint_strength(alpha: Tensor, xi_multiplier: Tensor, xi_fixed: Tensor, xi_min: Tensor) -> Tensor:
    """ξ = 200 α (Equation 15, Section IV-A), or xi_fixed where that is not NaN; at least xi_min. All have one shape."""
    return torch.where(xi_fixed.isnan(), xi_multiplier * alpha, xi_fixed).maximum(xi_min)


def demonstration_share(episode, beta_start, beta_episodes):
    """β after `episode` finished episodes: it decreases linearly from beta_start to 0 (Section IV-B).

    Numbers or arrays; with beta_episodes = None or infinity it stays at beta_start.
    """
    return beta_start * np.clip(1 - episode / (np.inf if beta_episodes is None else beta_episodes), 0, 1)


def augmented_reward(reward: Tensor, is_demonstration: Tensor, bonus: Tensor) -> Tensor:
    """r'(s, a_E) = r(s, a_E) + c (Equation 20) for demonstrations, r for other transitions: (..., batch)."""
    return reward + bonus * is_demonstration


def large_margin_loss(q: Tensor, expert_actions: Tensor, margin: float = 1.0) -> Tensor:
    """J_E(Q) = max_a [Q(s,a) + l(a_E,a)] - Q(s,a_E), l = 0 for a_E, else `margin` (Equations 17, 18): (..., batch)."""
    is_expert = torch.arange(q.shape[-1], device=q.device) == expert_actions.unsqueeze(-1)
    q_expert = q.gather(-1, expert_actions.unsqueeze(-1)).squeeze(-1)
    return (q + margin * (~is_expert).to(q.dtype)).amax(-1) - q_expert


def paper_q_filter(q: Tensor, expert_actions: Tensor) -> Tensor:
    """The printed Q-filter (Equation 19): 1 where the demonstrator's action is already greedy, else 0: (..., batch)."""
    q_expert = q.gather(-1, expert_actions.unsqueeze(-1)).squeeze(-1)
    return (q_expert >= q.amax(-1)).to(q.dtype)


def q_filter(q: Tensor, expert_actions: Tensor, log_pi: Tensor) -> Tensor:
    """The usual Q-filter (Nair et al., arXiv 1709.10089): 1 where the demonstrator's action has a higher value than
    the policy, Q(s,a_E) > Σ_a π(a|s) Q(s,a), else 0: (..., batch)."""
    q_expert = q.gather(-1, expert_actions.unsqueeze(-1)).squeeze(-1)
    return (q_expert > (log_pi.exp() * q).sum(-1)).to(q.dtype)
