"""The decision process for one car (Equation 1), as a `gymnasium.Env`: what both environments of one car share.

`TrapEnv` simulates the road with highway-env, `FastTrapEnv` with the compiled road. Observation, reward, the ends of an
episode and `info` are computed here, from the cars that either of them returns.
"""

from dataclasses import replace

import gymnasium as gym
import numpy as np
from gymnasium.envs.registration import EnvSpec

from bootcourse.errors import BootcourseError, whole
from bootcourse.road import twin
from bootcourse.road.constants import constants
from bootcourse.road.formulas import weighted_reward
from bootcourse.road.observation import bounds, observe
from bootcourse.road.state import EGO, SPEED, TRAP_1, X
from bootcourse.scenario import DEFAULT, N_ACTIONS, Scenario, scenario_from


class OneCar(gym.Env):
    """Observation (26,) float32, nine actions, 150 decisions. A subclass has `_start`, `_simulate`, `cars`, `render`.

    info contains the reward's terms "r_v", "r_y", "r_theta", "accident" (the number of an `Accident`), "is_success",
    "distance" (m) and "speed" (m/s): the names of `TrapVectorEnv`. `cars()` returns the true state, `trace` those after
    each simulation step of the last decision.
    """

    def __init__(self, scenario: Scenario | str | dict = DEFAULT, render_mode: str | None = None):
        """scenario: a `Scenario`, the name of one, or a dictionary (see `scenario_from`).

        Raises BootcourseError for a scenario that is none, and for an unknown render mode.
        """
        if render_mode not in (None, *self.metadata["render_modes"]):
            modes = ", ".join(repr(mode) for mode in (None, *self.metadata["render_modes"]))
            raise BootcourseError(f"render_mode = {render_mode!r}: choose from {modes}.")
        self.scenario, self.render_mode = scenario_from(scenario), render_mode
        self.constants = constants(self.scenario)
        low, high = bounds(self.scenario)
        self.observation_space = gym.spaces.Box(low, high, dtype=np.float32)
        self.action_space = gym.spaces.Discrete(N_ACTIONS)
        self.decisions, self.accident, self.trace, self.was_reset = 0, 0, [], False
        self._spec: EnvSpec | None = None

    @property
    def spec(self) -> EnvSpec | None:
        """How gymnasium made this environment. Its limit is the scenario's clock, which wrappers such as
        `TimeAwareObservation` read."""
        return self._spec

    @spec.setter
    def spec(self, spec: EnvSpec | None) -> None:
        self._spec = spec and replace(spec, max_episode_steps=self.scenario.clock.decisions)

    def _start(self, cars: np.ndarray) -> None:
        """Put the cars (vehicles, 10) on the road."""
        raise NotImplementedError

    def _simulate(self, action: int) -> None:
        """The simulation steps of one decision (Equation 8), which an accident ends. Sets `trace` and `accident`."""
        raise NotImplementedError

    def cars(self) -> np.ndarray:
        """The state of all cars, (vehicles, 10), columns in `bootcourse.road.state`."""
        raise NotImplementedError

    def reset(self, *, seed: int | None = None, options: dict | None = None):
        """Start an episode. The same seed gives the same road in all environments of the trap.

        Raises BootcourseError for a seed that is not a whole number of 0 or more.
        """
        super().reset(seed=None if seed is None else whole(seed, "seed"))
        self.decisions, self.accident, self.trace, self.was_reset = 0, 0, [], True
        start = twin.empty_cars(1, self.scenario.vehicles)[0]
        twin.place(self.np_random.random(twin.uniforms_needed(len(start))), self.constants, start)
        self._start(start)
        if self.render_mode == "human":
            self.render()
        cars = self.cars()
        return self._observe(cars), self._info(cars, (0.0, 0.0, 0.0))

    def step(self, action: int):
        """One decision. Raises BootcourseError for an action outside 0..8, and before the first reset."""
        if not self.action_space.contains(action):
            raise BootcourseError(f"Action {action!r} is outside 0..8.")
        self.check_reset("step")
        self._simulate(int(action))
        self.decisions += 1
        cars, weights = self.cars(), self.scenario.reward
        terms = twin.reward_terms(cars, self.constants)
        usual = weighted_reward(*terms, weights.w_v, weights.w_y, weights.w_theta)
        reward, terminated = (float(weights.accident) if self.accident else usual), bool(self.accident)
        truncated = not terminated and self.decisions >= self.scenario.clock.decisions
        if self.render_mode == "human":
            self.render()
        return self._observe(cars), reward, terminated, truncated, self._info(cars, terms)

    def check_reset(self, what: str) -> None:
        """Raise BootcourseError before the first reset. what: the method that was called."""
        if not self.was_reset:
            raise BootcourseError(f"There are no cars on the road yet: call env.reset(seed=0) before env.{what}.")

    def check_rendered(self) -> None:
        """Raise BootcourseError if the environment was made without a render mode, and before the first reset."""
        if self.render_mode is None:
            raise BootcourseError("Nothing is drawn without a render mode: give render_mode='rgb_array' to gym.make.")
        self.check_reset("render")

    def _observe(self, cars: np.ndarray) -> np.ndarray:
        observation = np.empty(self.scenario.observation_size, dtype=np.float32)
        observe(cars, self.constants, observation)
        return observation

    def _info(self, cars: np.ndarray, terms: tuple[float, float, float]) -> dict:
        r_v, r_y, r_theta = terms
        return {
            "r_v": r_v,
            "r_y": r_y,
            "r_theta": r_theta,
            "accident": int(self.accident),
            "is_success": bool(cars[EGO, X] > cars[TRAP_1, X]),
            "distance": float(cars[EGO, X]),
            "speed": float(cars[EGO, SPEED]),
        }
