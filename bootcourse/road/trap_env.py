"""`gym.make("bootcourse:Trap-v0")`: the scenario on highway-env, the reference for the compiled road.

The road, the cars and the pictures are highway-env's. What differs from its defaults is in our own vehicle classes, so
that other environments are unaffected: the steering gains are stable at 2 Hz; a collision is an overlap at a simulation
step (highway-env also counts an overlap predicted for the next step, half a second early at 2 Hz); no car drives
backwards. The episode ends at the simulation step of the accident.
"""

import gymnasium as gym
import numpy as np
from highway_env.envs.common.graphics import EnvViewer
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
PICTURE = {  # of the viewer: pixels, pixels per metre, where the ego is
    "screen_width": 1000,
    "screen_height": 160,
    "scaling": 8.0,
    "centering_position": [0.3, 0.5],
    "render_agent": True,
    "real_time_rendering": True,
}
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


class TrapEnv(gym.Env):
    """The decision process (Equation 1): observation (26,) float32, nine actions, 150 decisions.

    info contains "rewards" (the terms r_v, r_y, r_theta), "accident" (an `Accident`), "is_success", "distance" (m)
    and "speed" (m/s). `cars()` returns the true state, `trace` those after each simulation step of the last decision.
    Raises BootcourseError for a scenario that is none, and for another render mode.
    """

    metadata = {"render_modes": ["human", "rgb_array"], "render_fps": 1}
    action_type = observation_type = None  # highway-env's viewer asks for them

    def __init__(self, scenario: Scenario = DEFAULT, render_mode: str | None = None):
        if not isinstance(scenario, Scenario):
            raise BootcourseError(f"scenario = {scenario!r}: give a bootcourse.scenario.Scenario.")
        if render_mode not in (None, *self.metadata["render_modes"]):
            raise BootcourseError(f"render_mode = {render_mode!r}: choose from None, 'human', 'rgb_array'.")
        self.scenario, self.render_mode, self.constants = scenario, render_mode, constants(scenario)
        low, high = bounds(scenario)
        self.observation_space = gym.spaces.Box(low, high, dtype=np.float32)
        self.action_space = gym.spaces.Discrete(N_ACTIONS)
        self.decisions, self.accident, self.trace, self.viewer = 0, Accident.NONE, [], None
        self.config = PICTURE | {  # for the viewer
            "simulation_frequency": scenario.clock.simulation_rate,
            "offscreen_rendering": render_mode == "rgb_array",
        }

    def reset(self, *, seed: int | None = None, options: dict | None = None):
        """Start an episode. The same seed gives the same road, here and on the compiled road.

        Raises BootcourseError for a seed that is not a whole number of 0 or more.
        """
        super().reset(seed=None if seed is None else whole(seed, "seed"))
        self.decisions, self.accident = 0, Accident.NONE
        start = twin.empty_cars(1, self.scenario.vehicles)[0]
        twin.place(self.np_random.random(twin.uniforms_needed(len(start))), self.constants, start)
        self.road = Road(_lanes(self.scenario), np_random=self.np_random)
        self.vehicle = EgoCar(self.road, self.scenario, start[EGO])
        others = [TrafficCar(self.road, self.scenario, start[i], i < TRAFFIC) for i in range(1, len(start))]
        self.road.vehicles = [self.vehicle, *others]
        if self.render_mode == "human":
            self.render()
        return self._observe(self.cars()), self._info((0.0, 0.0, 0.0))

    def step(self, action: int):
        """One decision. Raises BootcourseError for an action outside 0..8."""
        if not self.action_space.contains(action):
            raise BootcourseError(f"Action {action!r} is outside 0..8.")
        self._simulate(int(action))
        self.decisions += 1
        cars, weights = self.trace[-1], self.scenario.reward
        terms = twin.reward_terms(cars, self.constants)
        usual = weighted_reward(*terms, weights.w_v, weights.w_y, weights.w_theta)
        reward, terminated = (float(weights.accident) if self.accident else usual), bool(self.accident)
        truncated = not terminated and self.decisions >= self.scenario.clock.decisions
        if self.render_mode == "human":
            self.render()
        return self._observe(cars), reward, terminated, truncated, self._info(terms)

    def _simulate(self, action: int) -> None:
        """The simulation steps of one decision (Equation 8); an accident ends them."""
        ego, self.trace = self.scenario.ego, []
        acceleration, steering = (action // 3 - 1) * ego.acceleration, (action % 3 - 1) * ego.steering
        self.vehicle.act({"acceleration": acceleration, "steering": steering})
        for _ in range(self.scenario.clock.steps):
            self.road.act()
            self.road.step(self.scenario.clock.dt)
            self.trace.append(self.cars())
            self.accident = Accident(twin.ego_accident(self.trace[-1], self.constants))
            if self.accident:
                break

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

    def _info(self, terms: tuple[float, float, float]) -> dict:
        ego, trap_1 = self.road.vehicles[EGO], self.road.vehicles[TRAP_1]
        return {
            "rewards": dict(zip(("r_v", "r_y", "r_theta"), terms, strict=True)),
            "accident": self.accident,
            "is_success": bool(ego.position[0] > trap_1.position[0]),
            "distance": float(ego.position[0]),
            "speed": float(ego.speed),
        }

    def render(self) -> np.ndarray | None:
        """Draw the road by highway-env's viewer; in the mode "rgb_array", the picture (160, 1000, 3) uint8."""
        if self.render_mode is None:
            raise BootcourseError("Nothing is drawn without a render mode: give render_mode='rgb_array' to gym.make.")
        if self.viewer is None:
            self.viewer = EnvViewer(self)
        self.viewer.display()
        if self.render_mode == "rgb_array":
            return self.viewer.get_image()
        self.viewer.handle_events()

    def __getstate__(self) -> dict:
        """What a copy gets, also in another process: all but the window, for which it opens its own."""
        return self.__dict__ | {"viewer": None}

    def close(self) -> None:
        """Close the viewer."""
        if self.viewer is not None:
            self.viewer.close()
            self.viewer = None


def _lanes(scenario: Scenario) -> RoadNetwork:
    """highway-env's description of the straight road."""
    network, road = RoadNetwork(), scenario.road
    for number in range(road.lanes):
        left = LineType.CONTINUOUS_LINE if number == 0 else LineType.STRIPED
        right = LineType.CONTINUOUS_LINE if number == road.lanes - 1 else LineType.NONE
        start, end = [0.0, number * road.lane_width], [road.length, number * road.lane_width]
        lane = StraightLane(start, end, road.lane_width, [left, right], speed_limit=road.speed_limit)
        network.add_lane(*NODES, lane)
    return network
