"""An episode that is driven one decision at a time, by a panel, a program or a test.

Its `Rollout` is the same as that of `record` for the same actions.
"""

import numpy as np
from gymnasium.vector import AutoresetMode

from bootcourse.episodes.record import EpisodeRecorder
from bootcourse.episodes.rollout import Rollout
from bootcourse.errors import BootcourseError, whole
from bootcourse.policies import PolicyOutput
from bootcourse.road.vector_env import TrapVectorEnv
from bootcourse.scenario import DEFAULT, N_ACTIONS, Scenario


class InteractiveEpisode:
    """One episode; `decide(action)` drives the next decision. Raises BootcourseError for an invalid seed."""

    def __init__(self, seed: int, scenario: Scenario = DEFAULT, label: str = "you"):
        self.seed, self.scenario, self.label = whole(seed, "seed"), scenario, label
        self.env = TrapVectorEnv(1, scenario, AutoresetMode.DISABLED, record=True)
        observations, _ = self.env.reset(seed=[self.seed])
        self.recorder, self.over = EpisodeRecorder(self.env.cars, observations), False

    def decide(self, action: int) -> None:
        """Drive one decision. Raises BootcourseError for an action outside 0..8, or after the end of the episode."""
        if self.over:
            raise BootcourseError("This drive is over: start another.")
        whole(action, "action", N_ACTIONS - 1)
        output = PolicyOutput(np.array([action]))
        observations, rewards, terminated, truncated, infos = self.env.step(output.actions)
        self.recorder.add(output, self.env, observations, rewards, infos, running=np.array([True]))
        self.over = bool(terminated[0] or truncated[0])

    @property
    def time(self) -> float:
        """The time driven, in seconds."""
        return (len(self.recorder.driven(0)) - 1) * self.scenario.clock.dt

    @property
    def actions(self) -> list[int]:
        """The actions so far, 0..8."""
        return [int(actions[0]) for actions in self.recorder.actions]

    @property
    def rewards(self) -> list[float]:
        """The rewards so far."""
        return [float(rewards[0]) for rewards in self.recorder.rewards]

    @property
    def terms(self) -> tuple[float, float, float]:
        """r_v, r_y, r_θ of the last decision, unweighted; zeros before the first."""
        r_v, r_y, r_theta = self.recorder.terms[-1][0] if self.recorder.terms else (0.0, 0.0, 0.0)
        return float(r_v), float(r_y), float(r_theta)

    def rollout(self) -> Rollout:
        """The drive so far. Raises BootcourseError before the first decision."""
        if not self.recorder.actions:
            raise BootcourseError("Nothing was driven yet: make a decision first.")
        return self.recorder.rollouts(self.scenario, self.label, [self.seed])[0]
