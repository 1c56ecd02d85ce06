"""Success in an environment that does not report it: `info["is_success"]`, which curves and evaluations read."""

from collections.abc import Callable

import gymnasium as gym


class Success(gym.Wrapper):
    """An environment whose last info of an episode says by your rule whether it succeeded.

    rule: (return of the episode, whether it was terminated rather than out of time) -> bool. It wraps one copy:
    gym.make_vec("MountainCar-v0", n, wrappers=[lambda env: bc.Success(env, lambda earned, at_goal: at_goal)]).
    """

    def __init__(self, env: gym.Env, rule: Callable[[float, bool], bool]):
        super().__init__(env)
        self.rule, self.earned = rule, 0.0

    def reset(self, **options):
        self.earned = 0.0
        return self.env.reset(**options)

    def step(self, action):
        observation, reward, terminated, truncated, info = self.env.step(action)
        self.earned += float(reward)
        if terminated or truncated:
            info["is_success"] = bool(self.rule(self.earned, terminated))
        return observation, reward, terminated, truncated, info
