"""`gym.make("bootcourse:Trap-v0")`: the scenario on highway-env, the reference for the compiled road.

The road, the cars and the pictures are highway-env's. What differs from its defaults is in our own vehicle classes, so
that other environments are unaffected: the steering gains are stable at 2 Hz; a collision is an overlap at a simulation
step (highway-env also counts an overlap predicted for the next step, half a second early at 2 Hz); no car drives
backwards. The episode ends at the simulation step of the accident.
"""

from typing import Any

import numpy as np
from highway_env.envs.common.graphics import EnvViewer
from highway_env.road.lane import LineType, StraightLane
from highway_env.road.road import Road, RoadNetwork
from highway_env.vehicle.behavior import IDMVehicle
from highway_env.vehicle.kinematics import Vehicle

from bootcourse.road import twin
from bootcourse.road.one_car import OneCar
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
    X,
    Y,
)
from bootcourse.scenario import DEFAULT, Scenario

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
        overlapping, _, _ = super()._is_colliding(other, 0.0)  # type: ignore[misc]
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


class TrapEnv(OneCar):
    """`OneCar` on highway-env, whose viewer draws it."""

    metadata = {"render_modes": ["human", "rgb_array"], "render_fps": 1}
    action_type = observation_type = None  # highway-env's viewer asks for them

    def __init__(self, scenario: Scenario | str | dict = DEFAULT, render_mode: str | None = None):
        """As `OneCar`."""
        super().__init__(scenario, render_mode)
        self.viewer = None
        self.config = PICTURE | {  # for the viewer
            "simulation_frequency": self.scenario.clock.simulation_rate,
            "offscreen_rendering": render_mode == "rgb_array",
        }

    def _start(self, cars: np.ndarray) -> None:
        self.road = Road(_lanes(self.scenario), np_random=self.np_random)
        self.vehicle = EgoCar(self.road, self.scenario, cars[EGO])
        others = [TrafficCar(self.road, self.scenario, cars[i], i < TRAFFIC) for i in range(1, len(cars))]
        self.road.vehicles = [self.vehicle, *others]

    def _simulate(self, action: int) -> None:
        ego, self.trace = self.scenario.ego, []
        acceleration, steering = (action // 3 - 1) * ego.acceleration, (action % 3 - 1) * ego.steering
        self.vehicle.act({"acceleration": acceleration, "steering": steering})
        for _ in range(self.scenario.clock.steps):
            self.road.act()
            self.road.step(self.scenario.clock.dt)
            self.trace.append(self.cars())
            self.accident = twin.ego_accident(self.trace[-1], self.constants)
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

    def render(self) -> np.ndarray | None:
        """Draw the road by highway-env's viewer; in the mode "rgb_array", the picture (160, 1000, 3) uint8."""
        self.check_rendered()
        viewer: Any = self.viewer or EnvViewer(self)
        self.viewer = viewer
        viewer.display()
        if self.render_mode == "rgb_array":
            return viewer.get_image()
        viewer.handle_events()
        return None

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
