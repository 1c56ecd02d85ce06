"""The soft constraint in one state: π, π̃, the KL between them, and the policy that is best under it.

`policy.py` draws these numbers and lets you move them. π̃ is the paper's stochastic rule and ξ the
weight of its KL (Section IV-A); the formulas stand in `bootcourse.learn.bootstrap`.
"""

import math
from dataclasses import dataclass

import numpy as np
import scipy
import torch

from bootcourse.errors import BootcourseError
from bootcourse.learn import bootstrap
from bootcourse.rule import stochastic_rule
from bootcourse.scenario import check_p


@dataclass(frozen=True)
class PolicyNumbers:
    """The nine actions in one state, each (9,); None where the driver has no π or no Q."""

    rule: np.ndarray  # π̃(a|s)
    price: np.ndarray  # -log π̃(a|s), nats: what the KL charges for the action
    policy: np.ndarray | None  # π(a|s)
    shares: np.ndarray | None  # π log(π/π̃), nats: they add up to
    kl: float | None  # KL(π ‖ π̃), nats
    q: np.ndarray | None  # Q(s,a)
    worth: np.ndarray | None  # Q - ξ price, of which
    optimum: np.ndarray | None  # is the softmax, at temperature α + ξ


def check_weights(xi: float, alpha: float) -> None:
    """Refuse a ξ below 0, an α that is not above 0, and what is no finite number."""
    for symbol, value, above in (("ξ", xi, "≥ 0"), ("α", alpha, "> 0")):
        fine = isinstance(value, (int, float)) and math.isfinite(value) and (value > 0 or value == 0 and symbol == "ξ")
        if not fine:
            raise BootcourseError(f"{symbol} = {value!r}: give a finite number, {symbol} {above}.")


def policy_numbers(
    policy: np.ndarray | None, q: np.ndarray | None, rule_action: int, p: float, xi: float, alpha: float
) -> PolicyNumbers:
    """The soft constraint's numbers in one state. policy and q: (9,) or None; rule_action: μ(s), 0..8.

    Raises BootcourseError for a p outside [1/9, 1), a ξ below 0, or an α that is not above 0.
    """
    check_p(p)
    check_weights(xi, alpha)
    log_rule = bootstrap.log_stochastic_rule(torch.tensor([rule_action]), torch.tensor(p, dtype=torch.float64))
    price = -log_rule[0].numpy()
    shares = worth = optimum = None
    if policy is not None:
        shares = scipy.special.xlogy(policy, policy) + policy * price
    if q is not None:
        worth = q - xi * price
        values = torch.from_numpy(np.asarray(q, dtype=np.float64))
        optimum = bootstrap.regularised_policy(values[None], log_rule, alpha, xi)[0].numpy()
    kl = None if shares is None else float(shares.sum())
    return PolicyNumbers(stochastic_rule(rule_action, p), price, policy, shares, kl, q, worth, optimum)
