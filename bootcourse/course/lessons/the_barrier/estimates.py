"""What an agent expects from a speed mid-lane, by its own Q, beside what its drive from there is worth."""

from collections.abc import Sequence

import numpy as np

from bootcourse.course.lessons.the_barrier.attempts import drive
from bootcourse.course.lessons.the_barrier.easier import UPDATES, MidLaneStart, mid_lane_at
from bootcourse.course.lessons.the_barrier.explorable import FEW, SPEEDS
from bootcourse.learn.agent import Agent
from bootcourse.learn.settings import settings_for, with_seeds
from bootcourse.learn.training import Training

ROADS = FEW[:50]


def from_mid_lane(agents: int = 4) -> list[Agent]:
    """Agents of plain SAC with the paper's γ that begin mid-lane, trained as long as the lesson's others."""
    settings = with_seeds(settings_for("sac"), agents)
    training = Training(settings, episodes=20_000, make_env=MidLaneStart, learner="compiled")
    return training.run(progress=False, stop=lambda: training.updates >= UPDATES).agents


def expected(agent: Agent) -> np.ndarray:
    """Q of the action that it takes at each of `SPEEDS`, mean of the roads."""
    env = _at_each_speed()(len(SPEEDS) * len(ROADS))
    observations, _ = env.reset(seed=_roads())
    q, actions = agent.q_values(observations), agent.as_policy()(observations, env.cars).actions
    return q[np.arange(len(q)), actions].reshape(len(SPEEDS), -1).mean(axis=1)


def found(agent: Agent) -> np.ndarray:
    """What its drives from each of `SPEEDS` are worth at its γ, by its most probable actions, mean of the roads."""
    values = drive(agent.as_policy(), _roads(), _at_each_speed()).values(agent.settings.gamma)
    return values.reshape(len(SPEEDS), -1).mean(axis=1)


def ahead(agent: Agent) -> float:
    """The share of the roads, from mid-lane as it is, on which it ends ahead."""
    return float(drive(agent.as_policy(), ROADS, MidLaneStart).ahead.mean())


def _at_each_speed() -> type[MidLaneStart]:
    return mid_lane_at(np.repeat(SPEEDS, len(ROADS)))


def _roads() -> Sequence[int]:
    return list(ROADS) * len(SPEEDS)
