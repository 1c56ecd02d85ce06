"""A distributional critic: V(s) as N quantiles of the returns from s, and what the worst of them say. Pure functions.

Quantile regression as in Dabney et al. (arXiv 1710.10044); the mean of the lowest quantiles is a conditional value at
risk, which Tang et al. (arXiv 1911.03618) give to a driver's critics. A state from which one drive in ten crashes looks
worse to it than one with the same mean return and no crash.
"""

import torch
from torch import Tensor


def quantile_loss(quantiles: Tensor, returns: Tensor) -> Tensor:
    """E[(τ_i - 1{R < θ_i}) (R - θ_i)], summed over the N quantiles θ_i: (..., batch, N), (..., batch) -> (...).

    Equation 8 of arXiv 1710.10044 with the midpoints τ_i = (i + 1/2) / N of its Lemma 2.
    """
    n = quantiles.shape[-1]
    tau = (torch.arange(n, device=quantiles.device) + 0.5) / n
    error = returns[..., None] - quantiles  # (..., batch, N)
    return ((tau - (error < 0).float()) * error).mean(-2).sum(-1)


def mean_of_the_worst(quantiles: Tensor, share: float) -> Tensor:
    """CVaR: the mean of the lowest `share` of the quantiles, of one at least: (..., N) -> (...)."""
    lowest = max(1, round(share * quantiles.shape[-1]))
    return quantiles.sort(-1).values[..., :lowest].mean(-1)
