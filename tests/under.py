"""A compiled training under test, step by step."""

import math

import numpy as np

from bootcourse.learn import compiled_training, records
from bootcourse.road.constants import constants
from bootcourse.scenario import DEFAULT


class Under:
    """The records of compiled_training.py, each (1,), at the start of a training."""

    def __init__(self, settings, episodes=1000, scenario=DEFAULT):
        self.plan, self.s = compiled_training.plan_of(settings, episodes), records.coefficients(settings)
        kinds = (records.AGENT, records.BATCHES, records.WORK, records.RUN, records.MEMORY, records.CURVES)
        self.agent, self.batch, self.work, self.run, self.memory, self.curves = (np.zeros(1, kind) for kind in kinds)
        self.c = constants(scenario)
        self.agent["log_alpha"] = math.log(settings.alpha_init)
        compiled_training.begin_first(self.agent, self.plan, self.run, settings.seed, self.c)

    def demonstrate(self, episodes: int) -> np.ndarray:
        """Rows of the replay buffer, (transitions, row)."""
        compiled_training.demonstrate_first(self.run, self.memory, self.s, self.plan, self.c, episodes)
        return self.memory["rows"][0, : self.run["demonstrations"][0]]

    def advance(self, decisions: int = 1) -> np.ndarray:
        """The rows of these decisions, (decisions x roads, row)."""
        first = records.MOST_DEMONSTRATIONS + self.run["next"][0]
        everything = (self.agent, self.batch, self.s, self.work, self.plan, self.run, self.memory, self.curves, self.c)
        compiled_training.advance_first(*everything, decisions)
        return self.memory["rows"][0, first : records.MOST_DEMONSTRATIONS + self.run["next"][0]]
