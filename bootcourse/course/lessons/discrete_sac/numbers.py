"""What the numbers and claims in this lesson's text are computed from, beside tools/course/known.py."""

from functools import cache

import numpy as np

from bootcourse.research.experiments import checks


@cache
def pushes(weights: tuple[float, ...], episodes: int = 20) -> float:
    """For how many pushes the rule balances the pole that pushes right where this weighted sum is positive: a mean."""
    lasted = []
    for seed in range(episodes):
        env, steps, over = checks.cartpole(), 0, False
        state, _ = env.reset(seed=seed)
        while not over:
            state, _, terminated, truncated, _ = env.step(int(state @ np.array(weights) > 0))
            steps, over = steps + 1, terminated or truncated
        lasted.append(steps)
    return float(np.mean(lasted))
