"""`gym.make_vec("bootcourse:Trap-v0", num_envs=256)`: the compiled road as a gymnasium VectorEnv."""

from collections.abc import Sequence

import gymnasium as gym
import numpy as np
from gymnasium.utils import seeding
from gymnasium.vector import AutoresetMode, VectorEnv
from gymnasium.vector.utils import batch_space

from bootcourse.errors import BootcourseError, check_known, require, whole
from bootcourse.road import twin
from bootcourse.road.constants import constants
from bootcourse.road.observation import bounds, observe_all
from bootcourse.road.state import EGO, SPEED, TRAP_1, X
from bootcourse.scenario import DEFAULT, N_ACTIONS, Scenario, scenario_from


class TrapVectorEnv(VectorEnv):
    """`num_envs` roads (Equation 1) that are stepped together: the numbers of gymnasium's `SyncVectorEnv` of `TrapEnv`.

    observation (num_envs, 26) float32; action (num_envs,) in 0..8; reward (num_envs,) float64. Road i, reset with
    `seed`, is the same as `TrapEnv` reset with `seed + i`.

    autoreset_mode: what follows an episode's end, as an `AutoresetMode` or its value. SAME_STEP: the road starts anew
    in the same step; the last observation is infos["final_obs"], the last infos are infos["final_info"]. NEXT_STEP: it
    starts anew in the next step, whose action is ignored and whose reward is 0. DISABLED: it stands still, with
    reward 0, until it is reset (`SyncVectorEnv` refuses such a step).
    max_episode_steps: truncates an episode after so many decisions, as gymnasium's `TimeLimit`; None or -1: only the
    scenario's clock does.

    `cars` (num_envs, vehicles, 10) is the true state (columns in `bootcourse.road.state`), `final_cars` the state
    before the last autoreset of SAME_STEP. With `record=True`, `trace` (num_envs, steps, vehicles, 10) is the state
    after each simulation step of the last decision. Raises BootcourseError for an argument that is not supported.
    """

    def __init__(
        self,
        num_envs: int = 1,
        scenario: Scenario | str | dict = DEFAULT,
        autoreset_mode: AutoresetMode | str = AutoresetMode.SAME_STEP,
        record: bool = False,
        max_episode_steps: int | None = None,
        render_mode: None = None,
    ):
        require(
            render_mode is None,
            f"render_mode = {render_mode!r}: these roads draw nothing. Leave it out, or draw one road of "
            "gym.make('bootcourse:FastTrap-v0', render_mode='rgb_array').",
        )
        modes = {mode.value: mode for mode in AutoresetMode}
        mode = modes.get(autoreset_mode, autoreset_mode) if isinstance(autoreset_mode, str) else autoreset_mode
        wanted = f"choose from {', '.join(modes)}"
        require(isinstance(mode, AutoresetMode), f"autoreset_mode = {autoreset_mode!r}: {wanted}.")
        self.metadata = {"autoreset_mode": mode, "render_modes": []}
        self.num_envs, self.scenario = whole(num_envs, "num_envs", low=1), scenario_from(scenario)
        has_limit = max_episode_steps not in (None, -1)
        self.max_episode_steps = whole(max_episode_steps, "max_episode_steps", low=1) if has_limit else None
        low, high = bounds(self.scenario)
        self.single_observation_space = gym.spaces.Box(low, high, dtype=np.float32)
        self.single_action_space = gym.spaces.Discrete(N_ACTIONS)
        self.observation_space = batch_space(self.single_observation_space, self.num_envs)
        self.action_space = batch_space(self.single_action_space, self.num_envs)

        n, vehicles = self.num_envs, self.scenario.vehicles
        self.constants = constants(self.scenario)
        self.cars = twin.empty_cars(n, vehicles)
        self.final_cars = self.cars
        steps = self.constants.steps
        self.trace = np.zeros((n, steps, vehicles, self.cars.shape[2])) if record else twin.NO_TRACE
        self.decisions = np.zeros(n, dtype=np.int64)
        self.asleep = np.ones(n, dtype=bool)  # roads that stand still
        self._ended = np.zeros(n, dtype=bool)  # roads that NEXT_STEP starts anew in the next step
        self.was_reset = False
        self._uniforms = twin.uniforms_needed(vehicles)
        self._generators = [seeding.np_random()[0] for _ in range(n)]
        self._rewards, self._terms = np.zeros(n), np.zeros((n, 3))
        self._accidents = np.zeros(n, dtype=np.int64)

    def reset(self, *, seed: int | Sequence[int | None] | None = None, options: dict | None = None):
        """Reset all roads, or those of options["reset_mask"], (num_envs,) bool. Road i has `seed + i` or `seed[i]`.

        Returns observations (num_envs, 26) and infos, whose masks name the roads that were reset. Raises
        BootcourseError, before any road is reset, for a wrong seed, number of seeds or mask, and for another option.
        """
        mask = mask_of(options or {}, self.num_envs)
        require(self.was_reset or bool(mask.all()), "There are no cars on the other roads yet: first reset all roads.")
        if seed is not None:
            seeds = seeds_of(seed, self.num_envs)
            super().reset(seed=seeds[0])
            for i, each in enumerate(seeds):
                if each is not None and mask[i]:
                    self._generators[i] = seeding.np_random(each)[0]
        self._start(mask)
        self.was_reset = True
        return self.observe(), self._infos(mask)

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
        began, decides = self._ended.copy(), ~(self._ended | self.asleep)
        self._start(began)
        self._rewards[~decides], self._terms[~decides] = 0.0, 0.0
        twin.decide(
            self.cars, actions.astype(np.int64), ~decides, self.constants,
            self._rewards, self._terms, self._accidents, self.trace,
        )  # fmt: skip
        self.decisions[decides] += 1
        terminated = self._accidents != 0
        truncated = ~terminated & (self.decisions >= self.scenario.clock.decisions)
        if self.max_episode_steps is not None:
            truncated |= self.decisions >= self.max_episode_steps
        rewards = self._rewards.copy()
        observations, infos = self.observe(), self._infos(decides | began)
        done, mode = terminated | truncated, self.metadata["autoreset_mode"]
        if mode is AutoresetMode.DISABLED:
            self.asleep |= done
        elif mode is AutoresetMode.NEXT_STEP:
            self._ended = done
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
        self.decisions[mask], self._accidents[mask] = 0, 0
        self.asleep[mask], self._ended[mask] = False, False
        self._rewards[mask], self._terms[mask] = 0.0, 0.0

    def _restart(self, done: np.ndarray, observations: np.ndarray, infos: dict) -> dict:
        final_obs = np.full(self.num_envs, None, dtype=object)
        for i in np.flatnonzero(done):
            final_obs[i] = observations[i]
        final_info = {name: value for name, value in infos.items() if not name.startswith("_")}
        final_info |= {f"_{name}": done.copy() for name in final_info}
        self._start(done)
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


def mask_of(options: dict, roads: int) -> np.ndarray:
    """The roads that a reset with these options resets, (roads,) bool. Raises BootcourseError for a wrong mask."""
    for name in options:
        check_known("Option", name, ("reset_mask",))
    mask = options.get("reset_mask", np.ones(roads, dtype=bool))
    is_mask = isinstance(mask, np.ndarray) and mask.shape == (roads,) and mask.dtype == bool and bool(mask.any())
    require(is_mask, f"reset_mask = {mask!r:.80}: give an array of {roads} booleans, at least one of them True.")
    return mask


def seeds_of(seed, roads: int) -> list[int | None]:
    """The seed of each road: seed, seed + 1, ... for a whole number, otherwise those given. Raises BootcourseError."""
    if not np.iterable(seed):
        return [whole(seed, "seed") + i for i in range(roads)]
    seeds = [None if each is None else whole(each, "seed") for each in seed]
    if len(seeds) != roads:
        raise BootcourseError(f"{len(seeds)} seeds for {roads} roads: give one, or one for each road.")
    return seeds
