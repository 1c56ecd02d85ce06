"""Models of the road that are wrong in a known way: what a look-ahead imagines where it is not told the truth.

The compiled road with its true state is the exact model: it contains how the other cars drive. A real car has no
simulator of its neighbours, so each `Model` changes one thing. `MODELS` are the experiment's.
"""

from dataclasses import dataclass, replace

import numpy as np

from bootcourse.errors import BootcourseError
from bootcourse.road.state import EGO, HEADING, LANE, SPEED, TARGET_LANE, X, Y
from bootcourse.scenario import Scenario

NEVER, TINY = 1e9, 1e-9  # m/s², an incentive that no lane change has; an acceleration that no car notices
FAR_BEHIND = -1e6  # m, the place of a car that the model leaves out
SPEED_OFF, GAP_OFF = 2.0, 2.0  # drawn drivers: m/s around the desired speed; up to so many times the time gap, or less


@dataclass(frozen=True)
class Model:
    """How the imagined road differs from the true one. The default is the exact model."""

    keep: bool = False  # the other cars keep their speed and lane
    desired_speed: float = 0.0  # m/s, added to the traffic's desired speed
    time_gap: float = 1.0  # factor of everybody's time gap T
    politeness: float = 1.0  # factor of everybody's politeness p
    drawn: int = 0  # so many kinds of drivers are drawn; each road is imagined with one kind; 0: the true one
    visible: bool = False  # only the cars that the observation shows
    noise: float = 0.0  # standard deviation of the others' places along the road, m; a fifth across, half in m/s
    others_late: bool = False  # the others as they were one decision ago, moved on at the speed that they had
    all_late: bool = False  # the whole road, the ego included, as it was one decision ago

    def __post_init__(self):
        if self.time_gap < 0 or self.politeness < 0 or self.noise < 0 or self.drawn < 0:
            raise BootcourseError(f"{self}: time_gap, politeness, noise and drawn cannot be negative.")
        if self.keep and (self.desired_speed, self.time_gap, self.politeness, self.drawn) != (0, 1, 1, 0):
            raise BootcourseError(f"{self}: cars that keep their speed and lane want nothing else. Leave out keep.")
        if self.drawn and (self.desired_speed, self.time_gap, self.politeness) != (0, 1, 1):
            raise BootcourseError(f"{self}: drawn drivers are drawn around the true ones. Leave out drawn.")

    def scenarios(self, scenario: Scenario, rng: np.random.Generator) -> list[Scenario]:
        """What the model believes of the other drivers: one scenario, or one for each kind that is drawn."""
        true = scenario.traffic
        if self.keep:
            return [replace(scenario, traffic=replace(true, braking_limit=TINY, a_threshold=NEVER))]
        speed, gap, politeness = true.desired_speed, true.time_gap, true.politeness
        believed = [(speed + self.desired_speed, gap * self.time_gap, politeness * self.politeness)]
        if self.drawn:
            ways = rng.uniform((-1, -1, 0), (1, 1, 2), (self.drawn, 3))
            believed = [(speed + SPEED_OFF * a, gap * GAP_OFF**b, politeness * c) for a, b, c in ways]
        drivers = [replace(true, desired_speed=v, time_gap=gap, politeness=polite) for v, gap, polite in believed]
        return [replace(scenario, traffic=each) for each in drivers]

    def seen(
        self, cars: np.ndarray, earlier: np.ndarray | None, scenario: Scenario, rng: np.random.Generator
    ) -> np.ndarray:
        """A copy of the cars to imagine from, (roads, vehicles, 10).

        earlier: the cars of one decision ago; None at the first decision, when nothing is late.
        """
        cars = np.array(earlier if self.all_late and earlier is not None else cars)
        others = cars[:, EGO + 1 :]
        if self.others_late and earlier is not None:
            others[:] = earlier[:, EGO + 1 :]
            metres = others[:, :, SPEED] / scenario.clock.decision_rate
            others[:, :, X] += metres * np.cos(others[:, :, HEADING])
            others[:, :, Y] += metres * np.sin(others[:, :, HEADING])
        if self.visible:
            others[~visible(cars, scenario), X] = FAR_BEHIND
        if self.noise > 0:
            for column, share in ((X, 1.0), (Y, 0.2), (SPEED, 0.5)):
                others[:, :, column] += share * self.noise * rng.standard_normal(others.shape[:2])
        if self.noise > 0 or self.others_late:
            lanes = np.rint(others[:, :, Y] / scenario.road.lane_width)
            others[:, :, LANE] = np.clip(lanes, 0, scenario.road.lanes - 1)
        if self.keep:
            others[:, :, TARGET_LANE] = others[:, :, LANE]
        return cars


def visible(cars: np.ndarray, scenario: Scenario) -> np.ndarray:
    """Whether the observation shows each of the other cars, (roads, vehicles - 1): the nearest within sight."""
    places = cars[:, :, [X, Y]]
    distances = np.hypot(*np.moveaxis(places[:, 1:] - places[:, :1], -1, 0))
    rank = distances.argsort(axis=1, kind="stable").argsort(axis=1, kind="stable")
    return (rank < scenario.sight.neighbours) & (distances < scenario.sight.distance)


EXACT = Model()
SLOWER, LONGER_GAPS, KEEPING = Model(desired_speed=-2.0), Model(time_gap=2.0), Model(keep=True)
MODELS = {  # {how the imagined road differs: its model, or several, of which the worst case counts}
    "exact": (EXACT,),
    "others keep speed and lane": (KEEPING,),
    "desired speed 2 m/s too low": (SLOWER,),
    "twice the time gap": (LONGER_GAPS,),
    "other drivers drawn anew": (Model(drawn=20),),
    "only the four visible cars": (Model(visible=True),),
    "places off by 1 m, speeds by 0.5 m/s": (Model(noise=1.0),),
    "the others a second late": (Model(others_late=True),),
    "everything a second late": (Model(all_late=True),),
    "worst case of three wrong models": (KEEPING, SLOWER, LONGER_GAPS),
}
