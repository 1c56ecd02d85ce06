"""`gym.make_vec("bootcourse:Trap-v0", num_envs=256)`: the compiled road as a gymnasium VectorEnv."""

from collections.abc import Sequence

import gymnasium as gym
import numpy as np
from gymnasium.utils import seeding
from gymnasium.vector import AutoresetMode, VectorEnv
from gymnasium.vector.utils import batch_space

from bootcourse.errors import BootcourseError, whole
from bootcourse.road import twin
from bootcourse.road.constants import constants
from bootcourse.road.observation import bounds, observe_all
from bootcourse.road.state import EGO, SPEED, TRAP_1, X
from bootcourse.scenario import DEFAULT, N_ACTIONS, Scenario


class TrapVectorEnv(VectorEnv):
    """`num_envs` roads (Equation 1) that are stepped together.

    observation (num_envs, 26) float32; action (num_envs,) in 0..8; reward (num_envs,) float64. Road i, reset with
    `seed`, is the same as `TrapEnv` reset with `seed + i`. An episode that ends is restarted in the same step
    (same-step autoreset); its last observation is infos["final_obs"], its last infos are infos["final_info"]. With
    `autoreset_mode=AutoresetMode.DISABLED` the road stands still, with reward 0, until all are reset.

    `cars` (num_envs, vehicles, 10) is the true state (columns in `bootcourse.road.state`), `final_cars` the state
    before the last autoreset. With `record=True`, `trace` (num_envs, steps, vehicles, 10) is the state after each
    simulation step of the last decision. Raises BootcourseError for an argument that is not supported.
    """

    def __init__(
        self,
        num_envs: int = 1,
        scenario: Scenario = DEFAULT,
        autoreset_mode: AutoresetMode = AutoresetMode.SAME_STEP,
        record: bool = False,
    ):
        if not isinstance(scenario, Scenario):
            raise BootcourseError(f"scenario = {scenario!r}: give a bootcourse.scenario.Scenario.")
        if autoreset_mode not in (AutoresetMode.SAME_STEP, AutoresetMode.DISABLED):
            raise BootcourseError(f"autoreset_mode = {autoreset_mode!r}: the compiled road has SAME_STEP and DISABLED.")
        self.metadata = {"autoreset_mode": autoreset_mode, "render_modes": []}
        self.num_envs, self.scenario = whole(num_envs, "num_envs", low=1), scenario
        low, high = bounds(scenario)
        self.single_observation_space = gym.spaces.Box(low, high, dtype=np.float32)
        self.single_action_space = gym.spaces.Discrete(N_ACTIONS)
        self.observation_space = batch_space(self.single_observation_space, self.num_envs)
        self.action_space = batch_space(self.single_action_space, self.num_envs)

        n, vehicles = self.num_envs, scenario.vehicles
        self.constants = constants(scenario)
        self.cars = twin.empty_cars(n, vehicles)
        self.final_cars = self.cars
        steps = self.constants.steps
        self.trace = np.zeros((n, steps, vehicles, self.cars.shape[2])) if record else twin.NO_TRACE
        self.decisions = np.zeros(n, dtype=np.int64)
        self.asleep = np.ones(n, dtype=bool)  # roads that stand still
        self.was_reset = False
        self._uniforms = twin.uniforms_needed(vehicles)
        self._generators = [seeding.np_random()[0] for _ in range(n)]
        self._rewards, self._terms = np.zeros(n), np.zeros((n, 3))
        self._accidents = np.zeros(n, dtype=np.int64)

    def reset(self, *, seed: int | Sequence[int | None] | None = None, options: dict | None = None):
        """Reset all roads; road i has the seed `seed + i` or `seed[i]`. options: none are known.

        Returns observations (num_envs, 26) and infos. Raises BootcourseError, before any road is reset, for a wrong
        seed or number of seeds.
        """
        if seed is not None:
            seeds = seeds_of(seed, self.num_envs)
            super().reset(seed=seeds[0])
            for i, each in enumerate(seeds):
                if each is not None:
                    self._generators[i] = seeding.np_random(each)[0]
        everywhere = np.ones(self.num_envs, dtype=bool)
        self._start(everywhere)
        self._rewards[:], self._terms[:], self._accidents[:] = 0.0, 0.0, 0
        self.was_reset = True
        return self.observe(), self._infos(everywhere)

    def step(self, actions):
        """One decision on every road, actions (num_envs,).

        Raises BootcourseError for an action outside 0..8, and before the first reset.
        """
        actions = np.asarray(actions)
        if actions.shape != (self.num_envs,) or actions.dtype.kind not in "iu":
            received = f"actions have shape {actions.shape} and type {actions.dtype}"
            raise BootcourseError(f"{received}: give {self.num_envs} whole numbers.")
        if actions.min() < 0 or actions.max() >= N_ACTIONS:
            raise BootcourseError(f"Action {int(actions[(actions < 0) | (actions >= N_ACTIONS)][0])} is outside 0..8.")
        if not self.was_reset:
            raise BootcourseError("There are no cars on these roads yet: call env.reset(seed=0) before env.step.")
        self._rewards[self.asleep], self._terms[self.asleep] = 0.0, 0.0
        twin.decide(
            self.cars, actions.astype(np.int64), self.asleep, self.constants,
            self._rewards, self._terms, self._accidents, self.trace,
        )  # fmt: skip
        self.decisions[~self.asleep] += 1
        terminated = self._accidents != 0
        truncated = ~terminated & (self.decisions >= self.scenario.clock.decisions)
        rewards = self._rewards.copy()
        observations, infos = self.observe(), self._infos(~self.asleep)
        done = terminated | truncated
        if self.metadata["autoreset_mode"] is AutoresetMode.DISABLED:
            self.asleep |= done
        elif done.any():
            self.final_cars = self.cars.copy()
            infos = self._restart(done, observations, infos)
            observations = self.observe()
        return observations, rewards, terminated, truncated, infos

    def observe(self) -> np.ndarray:
        """The present observations, (num_envs, 26)."""
        observations = np.empty((self.num_envs, self.scenario.observation_size), dtype=np.float32)
        observe_all(self.cars, self.constants, observations)
        return observations

    def _start(self, mask: np.ndarray) -> None:
        for i in np.flatnonzero(mask):
            twin.place(self._generators[i].random(self._uniforms), self.constants, self.cars[i])
        self.decisions[mask] = 0
        self.asleep[mask] = False

    def _restart(self, done: np.ndarray, observations: np.ndarray, infos: dict) -> dict:
        final_obs = np.full(self.num_envs, None, dtype=object)
        for i in np.flatnonzero(done):
            final_obs[i] = observations[i]
        final_info = {name: value for name, value in infos.items() if not name.startswith("_")}
        final_info |= {f"_{name}": done.copy() for name in final_info}
        self._start(done)
        self._terms[done], self._accidents[done] = 0.0, 0
        infos = self._infos(np.ones(self.num_envs, dtype=bool))
        return infos | {
            "final_obs": final_obs,
            "_final_obs": done.copy(),
            "final_info": final_info,
            "_final_info": done.copy(),
        }

    def _infos(self, mask: np.ndarray) -> dict:
        """gymnasium's vector infos: an array for each name; `_name` is the mask of the roads that it is valid for."""
        infos = {
            "r_v": self._terms[:, 0].copy(),
            "r_y": self._terms[:, 1].copy(),
            "r_theta": self._terms[:, 2].copy(),
            "accident": self._accidents.copy(),
            "is_success": self.cars[:, EGO, X] > self.cars[:, TRAP_1, X],
            "distance": self.cars[:, EGO, X].copy(),
            "speed": self.cars[:, EGO, SPEED].copy(),
        }
        return infos | {f"_{name}": mask.copy() for name in infos}


def seeds_of(seed, roads: int) -> list[int | None]:
    """The seed of each road: seed, seed + 1, ... for a whole number, otherwise those given. Raises BootcourseError."""
    if not np.iterable(seed):
        return [whole(seed, "seed") + i for i in range(roads)]
    seeds = [None if each is None else whole(each, "seed") for each in seed]
    if len(seeds) != roads:
        raise BootcourseError(f"{len(seeds)} seeds for {roads} roads: give one, or one for each road.")
    return seeds
