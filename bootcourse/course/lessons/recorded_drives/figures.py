"""The lesson on recorded drives: what critics believe."""

from collections.abc import Sequence

import numpy as np

from bootcourse.learn.agent import Agent
from bootcourse.learn.learner import SACLearner


def agents_of(learner: SACLearner) -> list[Agent]:
    """The agents of a learner as they are now; they do not change when it learns on."""
    return [learner.agent(i) for i in range(learner.agents)]


def believed(agents: Sequence[Agent], observations: np.ndarray, actions: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Mean Q of the given action, and of the best other one: (batch, 26) and (batch,) -> twice (agents,)."""
    q = np.stack([agent.q_values(observations) for agent in agents])
    places = np.broadcast_to(actions[:, None], (*q.shape[:2], 1))
    given = np.take_along_axis(q, places, 2).mean((1, 2))
    np.put_along_axis(q, places, -np.inf, 2)
    return given, q.max(2).mean(1)
