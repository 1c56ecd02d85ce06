"""Drives that tests of the replay share: short ones, ten cars, and an agent's thoughts."""

from dataclasses import replace

import numpy as np

from bootcourse.scenario import DEFAULT, Clock

SHORT = replace(DEFAULT, clock=Clock(decisions=20))
TEN_CARS = replace(DEFAULT, traffic=replace(DEFAULT.traffic, cars=7))


def thinking(rollout, label="bootstrapped"):
    """The drive with random probabilities and values, as if an agent had driven it."""
    rng = np.random.default_rng(0)
    policy = rng.dirichlet(np.ones(9), size=len(rollout.actions))
    return replace(rollout, label=label, policy=policy, q_values=rng.normal(size=policy.shape))
