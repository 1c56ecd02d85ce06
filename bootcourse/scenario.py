"""Every number of the scenario, with its unit and its source. For another scenario use `dataclasses.replace`.

† printed in the paper; ‡ inferred from the paper, with the reason; § our choice. `DEFAULT` is the scenario of the
course; in `CALIBRATED` the traps drive at the speed that the paper's results suggest.
"""

import math
from collections.abc import Mapping
from dataclasses import dataclass, field, fields, is_dataclass
from typing import Any

from bootcourse.errors import check_known, require
from bootcourse.limits import Range, check_limits, limited

N_ACTIONS = 9  # 3 accelerations x 3 steering angles † (Equation 8)
ACTION_NAMES = tuple(f"{a} {s}" for a in ("brake", "keep", "accelerate") for s in ("left", "straight", "right"))
IDLE = 4  # "0 m/s², 0 rad"


class Part:
    """A part of the scenario, whose numbers are checked when it is made."""

    def __post_init__(self):
        check_limits(self, f"{type(self).__name__}.")


@dataclass(frozen=True)
class Road(Part):
    """A straight road. Lane 0 is the leftmost lane; y increases to the right, as in highway-env."""

    lanes: int = limited(3, low=2, high=8)  # §
    lane_width: float = limited(4.0, above=0, high=100)  # m †
    length: float = limited(5000.0, above=0)  # m § longer than the fastest ego drives in an episode
    speed_limit: float = limited(30.0, above=0)  # m/s § highway-env clips every IDM target speed to it


@dataclass(frozen=True)
class Clock(Part):
    """Time: one decision per second for 150 seconds, simulation at 2 Hz."""

    decisions: int = limited(150, low=1)  # ‡ 1500 m at 10 m/s
    decision_rate: int = limited(1, low=1)  # Hz ‡ with it 150 decisions are 1500 m at 10 m/s
    simulation_rate: int = limited(2, low=1)  # Hz †

    def __post_init__(self):
        super().__post_init__()
        require(
            self.simulation_rate % self.decision_rate == 0,
            f"Clock.simulation_rate = {self.simulation_rate} Hz is not a multiple of the decision rate "
            f"({self.decision_rate} Hz): choose a multiple, so that every decision has whole steps.",
        )

    @property
    def steps(self) -> int:
        """Simulation steps in one decision."""
        return self.simulation_rate // self.decision_rate

    @property
    def dt(self) -> float:
        """Length of a simulation step in seconds."""
        return 1.0 / self.simulation_rate


@dataclass(frozen=True)
class Car(Part):
    """The size of every car, a rectangle."""

    length: float = limited(5.0, above=0)  # m †
    width: float = limited(2.0, above=0)  # m †


@dataclass(frozen=True)
class Ego(Part):
    """The learning car. It starts in the rightmost lane at x = 0 with heading 0."""

    speed: float = 10.0  # m/s ‡ CQL's row: 10 ± 0 m/s over 1500 ± 0 m
    max_speed: float = 25.0  # m/s § low enough that no 0.5 s step passes through a car
    min_speed: float = limited(1.0, low=0)  # m/s § a lower speed is the accident "dangerous stoppage"
    acceleration: float = limited(1.0, above=0)  # m/s² † the actions are -1, 0 and +1 times this
    steering: float = limited(math.pi / 50, above=0, high=1.0)  # rad † the actions are -1, 0 and +1 times this

    def __post_init__(self):
        super().__post_init__()
        require(
            self.min_speed < self.speed <= self.max_speed,
            f"Ego.speed = {self.speed} m/s must lie above min_speed ({self.min_speed}) and not above "
            f"max_speed ({self.max_speed}).",
        )


@dataclass(frozen=True)
class Traps(Part):
    """The two slow cars (Table 1). Trap 1 drives in the ego's lane, trap 2 in the next lane to its left.

    The table does not say between which points it measures D1 and D2; we take the cars' centres ‡.
    """

    speed: float = limited(10.0, above=0)  # m/s § the ego's initial speed, so that an idle ego stays at its distance
    d1: Range = limited((14.80, 16.44), low=0)  # m † D1, ego to trap 1
    d2: Range = limited((4.06, 7.43), low=0)  # m † D2, ego to trap 2

    def __post_init__(self):
        super().__post_init__()
        require(
            self.d2[1] <= self.d1[0],
            f"Traps.d2 = {self.d2} m reaches beyond d1 = {self.d1} m: D2 must be the shorter distance.",
        )


@dataclass(frozen=True)
class Traffic(Part):
    """The cars ahead of trap 1 (Table 2): IDM, MOBIL and a lane-keeping controller that is stable at 2 Hz."""

    cars: int = limited(6, low=0, high=40)  # §
    lead: float = limited(40.0, above=0)  # m § trap 1 to the first car; at 20 m a traffic jam reaches the traps
    headway: float = limited(40.0, above=0)  # m § mean distance between cars; at 20 m a traffic jam reaches the traps
    spacing: Range = limited((0.5, 1.5), low=0)  # § each distance is headway x U[spacing]
    speed: Range = limited((11.0, 12.5), low=0)  # m/s § at the start
    desired_speed: float = limited(12.5, above=0)  # m/s † v_desired (the table prints "12.5m")
    a_max: float = limited(0.5, above=0, high=10)  # m/s² † maximum acceleration
    b: float = limited(0.5, above=0)  # m/s² † comfortable deceleration
    s0: float = limited(10.0, low=0)  # m † desired gap; highway-env measures gaps centre to centre
    time_gap: float = limited(1.5, low=0)  # s † T
    delta: float = limited(4.0, above=0)  # † exponent of the free-road term
    politeness: float = limited(0.5, low=0)  # † p of MOBIL (not the p of the stochastic rule)
    a_threshold: float = 0.2  # m/s² † smallest incentive for a lane change
    safe_braking: float = limited(2.0, low=0)  # m/s² § highway-env's default: hardest braking of the new follower
    lane_change_delay: float = limited(1.0, low=0)  # s § highway-env's default
    braking_limit: float = limited(6.0, above=0)  # m/s² § highway-env's clip of every IDM acceleration
    tau_heading: float = limited(0.6, above=0)  # s § highway-env's 0.2 s is unstable at 2 Hz: 0.5 / 0.2 > 2
    tau_lateral: float = limited(1.8, above=0)  # s § three times tau_heading, as in highway-env (0.6 s and 0.2 s)


@dataclass(frozen=True)
class Reward(Part):
    """Weights of the three terms (Equation 9), and the reward of an accident (Section III-C, "Reward")."""

    w_v: float = limited(1.5, low=0)  # † speed
    w_y: float = limited(0.05, low=0)  # † lane centring
    w_theta: float = limited(0.05, low=0)  # † steering
    accident: float = -10.0  # †

    def __post_init__(self):
        super().__post_init__()
        require(self.w_v + self.w_y + self.w_theta > 0, "Reward: at least one weight must be above 0.")


@dataclass(frozen=True)
class Sight(Part):
    """The observation: the ego and its nearest neighbours."""

    neighbours: int = limited(4, low=1)  # † cars
    distance: float = limited(200.0, above=0)  # m § range of the observation and of the rule


@dataclass(frozen=True)
class Rule(Part):
    """The rule controller (Section III-D)."""

    v_min: float = limited(6.0, above=0)  # m/s † slowest target speed
    v_max: float = 15.0  # m/s † fastest target speed
    n: int = limited(5, low=2, high=1000)  # † target speeds between the two, evenly spaced
    t_safe: float = limited(1.5, above=0)  # s § the traffic's time gap; the paper gives no value
    floor: float = limited(3.0, above=0)  # m § smallest bumper-to-bumper gap for a lane change

    def __post_init__(self):
        super().__post_init__()
        require(self.v_min < self.v_max, f"Rule.v_max = {self.v_max} m/s must be above v_min ({self.v_min}).")


RULE_P = 0.9  # † p, the stochastic rule's probability of the rule's action (Equation 16)


LARGEST_P = 1 - 2**-24  # the largest number below 1 in float32, in which the networks compute


def check_p(p: float, name: str = "p", n_actions: int = N_ACTIONS) -> None:
    """Raise BootcourseError for a p outside [1/9, LARGEST_P]: at 1/9 π̃ is uniform, at 1 the KL is infinite."""
    low = f"1/{n_actions}"
    require(
        isinstance(p, (int, float)) and 1 / n_actions <= p < 1,
        f"{name} = {p!r} is outside [{low}, 1): at {low} the rule is uniform, at 1 the KL is infinite.",
    )
    require(p <= LARGEST_P, f"{name} = {p!r} is 1 in single precision, and the KL infinite: give at most 0.9999999.")


@dataclass(frozen=True)
class Scenario:
    """The whole scenario, `Scenario()` is `DEFAULT`. Raises BootcourseError for parts that do not fit together."""

    name: str = "default"
    road: Road = field(default_factory=Road)
    clock: Clock = field(default_factory=Clock)
    car: Car = field(default_factory=Car)
    ego: Ego = field(default_factory=Ego)
    traps: Traps = field(default_factory=Traps)
    traffic: Traffic = field(default_factory=Traffic)
    reward: Reward = field(default_factory=Reward)
    sight: Sight = field(default_factory=Sight)
    rule: Rule = field(default_factory=Rule)

    def __post_init__(self):
        for f in fields(self):
            part, kind = getattr(self, f.name), f.type.__name__
            require(isinstance(part, f.type), f"Scenario.{f.name} = {part!r}: expected {kind}, see its fields.")
        road, car, traps, t, seconds = self.road, self.car, self.traps, self.traffic, self.seconds
        for name, speed, fastest in (("Traps", traps.speed, traps.speed), ("Traffic", t.speed, t.speed[1])):
            limit = f"the road's speed limit ({road.speed_limit} m/s)"
            require(fastest <= road.speed_limit, f"{name}.speed = {speed} m/s is above {limit}.")
        head_start = traps.d1[1] + t.lead + t.cars * t.headway * t.spacing[1]
        wanted = min(max(t.desired_speed, traps.speed, t.speed[1]), road.speed_limit)
        reach = max(seconds * self.ego.max_speed, head_start + seconds * wanted)
        drives = f"the {reach:.0f} m that a car can drive in {seconds:.0f} s"
        require(road.length >= reach, f"Road.length = {road.length} m is shorter than {drives}.")
        inside = f"trap 1 would start inside the ego ({car.length} m long)"
        require(traps.d1[0] > car.length, f"Traps.d1 = {traps.d1} m: {inside}.")
        require(car.width < road.lane_width, f"Car.width = {car.width} m does not fit a lane of {road.lane_width} m.")
        nearest = t.headway * t.spacing[0]
        require(
            min(t.lead, nearest) > car.length,
            f"Traffic.lead ({t.lead} m) and headway x spacing (from {nearest} m) must be longer than a car "
            f"({car.length} m).",
        )

    def __deepcopy__(self, memo: dict) -> "Scenario":
        """Itself: nothing in it changes."""
        return self

    @property
    def seconds(self) -> float:
        """The time of an episode."""
        return self.clock.decisions / self.clock.decision_rate

    @property
    def vehicles(self) -> int:
        """Cars on the road: the ego (0), trap 1 (1), trap 2 (2), then the traffic."""
        return 3 + self.traffic.cars

    @property
    def observation_size(self) -> int:
        """Numbers in an observation: 6 of the ego, 5 of each neighbour (26 by default)."""
        return 6 + 5 * self.sight.neighbours


DEFAULT = Scenario()
CALIBRATED = Scenario(name="calibrated", traps=Traps(speed=10.9))  # ‡ the soft-constraint row: 10.87 m/s, 1631 m
SCENARIOS = {scenario.name: scenario for scenario in (DEFAULT, CALIBRATED)}


def scenario_from(given: Scenario | str | Mapping) -> Scenario:
    """A scenario: itself, by its name, or from a dictionary such as {"name": "dense", "traffic": {"cars": 12}}.

    What a dictionary leaves out is as in `DEFAULT`. `dataclasses.asdict` makes a whole one, which JSON may carry.
    Raises BootcourseError for an unknown name, and for what is none of the three.
    """
    if isinstance(given, str):
        check_known("Scenario", given, SCENARIOS)
        return SCENARIOS[given]
    is_one = isinstance(given, (Scenario, Mapping))
    require(is_one, f"scenario = {given!r:.80}: give a Scenario, the name of one, or a dictionary.")
    return _built(Scenario, given) if isinstance(given, Mapping) else given


def _built(kind: type, given: Mapping):
    """A part of the scenario from a dictionary; JSON has lists for its ranges."""
    types: dict[str, Any] = {f.name: f.type for f in fields(kind)}
    values = {}
    for name, value in given.items():
        check_known(f"{kind.__name__}: field", name, types)
        is_part = is_dataclass(types[name]) and isinstance(value, Mapping)
        values[name] = _built(types[name], value) if is_part else tuple(value) if isinstance(value, list) else value
    return kind(**values)
