"""`gym.make("bootcourse:Trap-v0")`: the scenario on highway-env, the reference for the compiled road.

It differs from highway-env's defaults in four ways, all in our own vehicle classes, so that other environments are
unaffected: the steering gains are stable at 2 Hz; a collision is an overlap at a simulation step (highway-env also
counts an overlap predicted for the next step, half a second early at 2 Hz); the episode ends at the simulation step
of the accident; no car drives backwards.
"""

import gymnasium as gym
import numpy as np
from highway_env.envs.common.abstract import AbstractEnv
from highway_env.road.lane import LineType, StraightLane
from highway_env.road.road import Road, RoadNetwork
from highway_env.vehicle.behavior import IDMVehicle
from highway_env.vehicle.kinematics import Vehicle

from bootcourse.errors import BootcourseError, whole
from bootcourse.road import twin
from bootcourse.road.constants import constants
from bootcourse.road.formulas import weighted_reward
from bootcourse.road.observation import bounds, observe
from bootcourse.road.state import (
    ACCELERATION,
    COLUMNS,
    CRASHED,
    EGO,
    HEADING,
    LANE,
    SPEED,
    STEERING,
    TARGET_LANE,
    TIMER,
    TRAFFIC,
    TRAP_1,
    Accident,
    X,
    Y,
)
from bootcourse.scenario import DEFAULT, N_ACTIONS, Scenario

NODES = ("start", "end")  # highway-env names a lane (node, node, number)
TRAP_COLOUR, TRAFFIC_COLOUR, EGO_COLOUR = (122, 31, 31), (184, 190, 198), (213, 94, 0)


class _CollidesByOverlap:
    """A collision is an overlap at this step, not one predicted for the next step."""

    def _is_colliding(self, other, dt: float):
        overlapping, _, _ = super()._is_colliding(other, 0.0)
        return overlapping, False, None


class EgoCar(_CollidesByOverlap, Vehicle):
    """The ego. `target_speed` is the desired speed that the traffic's MOBIL assumes for it."""

    def __init__(self, road, scenario: Scenario, row: np.ndarray):
        self.LENGTH, self.WIDTH = scenario.car.length, scenario.car.width
        self.MIN_SPEED, self.MAX_SPEED = 0.0, scenario.ego.max_speed
        super().__init__(road, row[[X, Y]], row[HEADING], row[SPEED])
        self.target_speed = scenario.traffic.desired_speed
        self.color = EGO_COLOUR


class TrafficCar(_CollidesByOverlap, IDMVehicle):
    """A trap or a traffic car: highway-env's IDM and MOBIL with the scenario's numbers."""

    def __init__(self, road, scenario: Scenario, row: np.ndarray, is_trap: bool):
        t = scenario.traffic
        self.LENGTH, self.WIDTH = scenario.car.length, scenario.car.width
        self.MIN_SPEED, self.MAX_SPEED = 0.0, scenario.road.speed_limit
        self.KP_HEADING, self.KP_LATERAL = 1 / t.tau_heading, 1 / t.tau_lateral
        self.ACC_MAX, self.COMFORT_ACC_MAX, self.COMFORT_ACC_MIN = t.braking_limit, t.a_max, -t.b
        self.DISTANCE_WANTED, self.TIME_WANTED, self.DELTA = t.s0, t.time_gap, t.delta
        self.POLITENESS, self.LANE_CHANGE_MIN_ACC_GAIN = t.politeness, t.a_threshold
        self.LANE_CHANGE_MAX_BRAKING_IMPOSED, self.LANE_CHANGE_DELAY = t.safe_braking, t.lane_change_delay
        super().__init__(
            road,
            row[[X, Y]],
            row[HEADING],
            row[SPEED],
            target_lane_index=(*NODES, int(row[TARGET_LANE])),
            enable_lane_change=not is_trap,
        )
        self.target_speed = scenario.traps.speed if is_trap else t.desired_speed
        self.timer = row[TIMER]
        self.color = TRAP_COLOUR if is_trap else TRAFFIC_COLOUR


class TrapEnv(AbstractEnv):
    """The decision process (Equation 1): observation (26,) float32, nine actions, 150 decisions.

    info contains "rewards" (the terms r_v, r_y, r_theta), "accident" (an `Accident`), "is_success", "distance" (m)
    and "speed" (m/s). `cars()` returns the true state. Raises BootcourseError for a scenario that is none.
    """

    def __init__(self, scenario: Scenario = DEFAULT, config: dict | None = None, render_mode: str | None = None):
        if not isinstance(scenario, Scenario):
            raise BootcourseError(f"scenario = {scenario!r}: give a bootcourse.scenario.Scenario.")
        if render_mode not in (None, *self.metadata["render_modes"]):
            raise BootcourseError(f"render_mode = {render_mode!r}: choose from None, 'human', 'rgb_array'.")
        self.scenario = scenario
        self.constants = constants(scenario)
        self.accident = Accident.NONE
        self._terms = (0.0, 0.0, 0.0)
        self.trace: list[np.ndarray] = []  # the state after each simulation step of the last decision
        super().__init__(config, render_mode)
        self.update_metadata()

    @classmethod
    def default_config(cls) -> dict:
        """highway-env's configuration, with the size and the scale of the rendered picture."""
        return super().default_config() | {
            "screen_width": 1000,
            "screen_height": 160,
            "centering_position": [0.3, 0.5],
            "scaling": 8.0,
        }

    def configure(self, config: dict | None) -> None:
        """Set the configuration; the two frequencies are the scenario's."""
        super().configure(config)
        clock = self.scenario.clock
        self.config |= {"simulation_frequency": clock.simulation_rate, "policy_frequency": clock.decision_rate}

    def define_spaces(self) -> None:
        """Make the spaces once: highway-env makes new ones at each reset, which would undo `action_space.seed()`."""
        if self.action_space is None:
            low, high = bounds(self.scenario)
            self.observation_space = gym.spaces.Box(low, high, dtype=np.float32)
            self.action_space = gym.spaces.Discrete(N_ACTIONS)
            self.action_type = _NineActions(self)

    def reset(self, *, seed: int | None = None, options: dict | None = None):
        """Start an episode. The same seed gives the same road, here and on the compiled road.

        Raises BootcourseError for a seed that is not a whole number of 0 or more.
        """
        gym.Env.reset(self, seed=None if seed is None else whole(seed, "seed"), options=options)
        if options and "config" in options:
            self.configure(options["config"])
        self.time = self.steps = 0
        self.done, self.accident, self._terms = False, Accident.NONE, (0.0, 0.0, 0.0)
        self._reset()
        if self.render_mode == "human":
            self.render()
        return self._observe(self.cars()), self._info()

    def _reset(self) -> None:
        start = twin.empty_cars(1, self.scenario.vehicles)[0]
        twin.place(self.np_random.random(twin.uniforms_needed(len(start))), self.constants, start)
        network = RoadNetwork()
        shape = self.scenario.road
        for number in range(shape.lanes):
            lines = [
                LineType.CONTINUOUS_LINE if number == 0 else LineType.STRIPED,
                LineType.CONTINUOUS_LINE if number == shape.lanes - 1 else LineType.NONE,
            ]
            y = number * shape.lane_width
            lane = StraightLane([0.0, y], [shape.length, y], shape.lane_width, lines, speed_limit=shape.speed_limit)
            network.add_lane(*NODES, lane)
        self.road = Road(network, np_random=self.np_random)
        self.vehicle = EgoCar(self.road, self.scenario, start[EGO])
        others = [TrafficCar(self.road, self.scenario, start[i], i < TRAFFIC) for i in range(1, len(start))]
        self.road.vehicles = [self.vehicle, *others]

    def step(self, action: int):
        """One decision. Raises BootcourseError for an action outside 0..8."""
        if not self.action_space.contains(action):
            raise BootcourseError(f"Action {action!r} is outside 0..8.")
        self.time += 1 / self.scenario.clock.decision_rate
        self._simulate(int(action))
        self._terms = twin.reward_terms(self.trace[-1], self.constants)
        observation, reward = self._observe(self.trace[-1]), self._reward(action)
        terminated, truncated = self._is_terminated(), self._is_truncated()
        if self.render_mode == "human":
            self.render()
        return observation, reward, terminated, truncated, self._info()

    def _simulate(self, action: int) -> None:
        """The simulation steps of one decision; an accident ends them."""
        self.action_type.act(action)
        self.trace = []
        for frame in range(self.scenario.clock.steps):
            self.road.act()
            self.road.step(self.scenario.clock.dt)
            self.steps += 1
            self.trace.append(self.cars())
            self.accident = Accident(twin.ego_accident(self.trace[-1], self.constants))
            if self.accident:
                break
            if frame < self.scenario.clock.steps - 1:
                self._automatic_rendering()
        self.enable_auto_render = False

    def cars(self) -> np.ndarray:
        """The state of all cars, (vehicles, 10), columns in `bootcourse.road.state`."""
        cars = np.empty((len(self.road.vehicles), COLUMNS))
        for row, car in zip(cars, self.road.vehicles, strict=True):
            row[X], row[Y] = car.position
            row[HEADING], row[SPEED] = car.heading, car.speed
            row[STEERING], row[ACCELERATION] = car.action["steering"], car.action["acceleration"]
            row[LANE] = car.lane_index[2]
            row[TARGET_LANE] = car.target_lane_index[2] if isinstance(car, TrafficCar) else row[LANE]
            row[TIMER] = car.timer if isinstance(car, TrafficCar) else 0.0
            row[CRASHED] = car.crashed
        return cars

    def _observe(self, cars: np.ndarray) -> np.ndarray:
        observation = np.empty(self.scenario.observation_size, dtype=np.float32)
        observe(cars, self.constants, observation)
        return observation

    def _reward(self, action: int) -> float:
        weights = self.scenario.reward
        if self.accident:
            return float(weights.accident)
        return weighted_reward(*self._terms, weights.w_v, weights.w_y, weights.w_theta)

    def _rewards(self, action: int | None = None) -> dict[str, float]:
        return dict(zip(("r_v", "r_y", "r_theta"), self._terms, strict=True))

    def _is_terminated(self) -> bool:
        return self.accident != Accident.NONE

    def _is_truncated(self) -> bool:
        return not self.accident and self.time * self.scenario.clock.decision_rate >= self.scenario.clock.decisions

    def _info(self, obs=None, action=None) -> dict:
        ego, trap_1 = self.road.vehicles[EGO], self.road.vehicles[TRAP_1]
        return {
            "rewards": self._rewards(),
            "accident": self.accident,
            "is_success": bool(ego.position[0] > trap_1.position[0]),
            "distance": float(ego.position[0]),
            "speed": float(ego.speed),
        }


class _NineActions:
    """The nine actions in the form of a highway-env action type."""

    def __init__(self, env: TrapEnv):
        self.env = env

    def act(self, action: int) -> None:
        """Set the ego's acceleration (m/s²) and steering (rad) to those of an action (Equation 8)."""
        ego = self.env.scenario.ego
        self.env.vehicle.act(
            {"acceleration": (action // 3 - 1) * ego.acceleration, "steering": (action % 3 - 1) * ego.steering}
        )
