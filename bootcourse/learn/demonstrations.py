"""Demonstrations: what the rule drove, as transitions for the replay (Section IV-B)."""

import numpy as np
import torch
from gymnasium.vector import AutoresetMode
from torch import Tensor

from bootcourse.drivers import Driver, rule_driver
from bootcourse.learn.replay import pack
from bootcourse.road.vector_env import TrapVectorEnv
from bootcourse.rule import rule
from bootcourse.scenario import DEFAULT, Scenario

FIRST_SEED = 2**34  # of the demonstrations' roads; training and held-out roads have other seeds


def collect(episodes: int = 200, scenario: Scenario = DEFAULT, driver: Driver | None = None) -> Tensor:
    """Rows for a `Replay` from `episodes` episodes: (transitions, row).

    The demonstrator executes the rule's own action unless another driver is given. (The paper runs
    the 0.9-stochastic rule, and says that every demonstration escapes: at one decision a second its
    random steering knocks the car off the road, so the two cannot both be. Both can be had here.)
    """
    driver = driver or rule_driver(scenario)
    env = TrapVectorEnv(episodes, scenario, AutoresetMode.DISABLED)
    states, _ = env.reset(seed=FIRST_SEED)
    rule_actions = rule(env.cars, scenario).actions
    awake = np.ones(episodes, dtype=bool)
    rows = []
    while awake.any():
        actions = driver(states, env.cars).actions
        next_states, rewards, terminated, truncated, _ = env.step(actions)
        next_rule_actions = rule(env.cars, scenario).actions
        rows.append(pack(states, next_states, actions, rewards, terminated, rule_actions, next_rule_actions)[awake])
        awake &= ~(terminated | truncated)
        states, rule_actions = next_states, next_rule_actions
    return torch.cat(rows)
