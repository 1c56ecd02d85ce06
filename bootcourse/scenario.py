"""Every number of the scenario, with its unit and its source. For another scenario use `dataclasses.replace`.

† printed in the paper; ‡ inferred from the paper, with the reason; § our choice. `DEFAULT` is the scenario of the
course; in `CALIBRATED` the traps drive at the speed that the paper's results suggest.
"""

import json
import math
import sys
from dataclasses import asdict, dataclass, field, fields, is_dataclass

from bootcourse.errors import BootcourseError, check_known

N_ACTIONS = 9  # 3 accelerations x 3 steering angles † (Equation 8)
ACTION_NAMES = tuple(f"{a} {s}" for a in ("brake", "keep", "accelerate") for s in ("left", "straight", "right"))
IDLE = 4  # "0 m/s², 0 rad"


def _check(holds: bool, sentence: str) -> None:
    if not holds:
        raise BootcourseError(sentence)


def _check_numbers(part) -> None:
    """Check that every number of a part is finite and that every pair is a range (low, high)."""
    for f in fields(part):
        value = getattr(part, f.name)
        name = f"{type(part).__name__}.{f.name}"
        numbers = value if isinstance(value, tuple) else (value,)
        for number in numbers:
            is_number = isinstance(number, (int, float)) and not isinstance(number, bool)
            _check(is_number and abs(number) <= sys.float_info.max, f"{name} = {value!r}: give a finite number.")
        if f.type in ("int", int):
            _check(isinstance(value, int), f"{name} = {value!r}: give a whole number.")
        if f.metadata.get("range"):
            _check(len(numbers) == 2 and numbers[0] <= numbers[1], f"{name} = {value!r}: give (low, high), low first.")


def _positive(part, *names) -> None:
    for name in names:
        value = getattr(part, name)
        _check(value > 0, f"{type(part).__name__}.{name} = {value!r}: it must be above 0.")


def _not_negative(part, *names) -> None:
    for name in names:
        value = getattr(part, name)
        low = value[0] if isinstance(value, tuple) else value
        _check(low >= 0, f"{type(part).__name__}.{name} = {value!r}: it cannot be negative.")


def _range(low: float, high: float):
    return field(default=(low, high), metadata={"range": True})


@dataclass(frozen=True)
class Road:
    """A straight road. Lane 0 is the leftmost lane; y increases to the right, as in highway-env."""

    lanes: int = 3  # §
    lane_width: float = 4.0  # m †
    length: float = 5000.0  # m § longer than the fastest ego drives in an episode
    speed_limit: float = 30.0  # m/s § highway-env clips every IDM target speed to it

    def __post_init__(self):
        _check_numbers(self)
        _check(2 <= self.lanes <= 8, f"Road.lanes = {self.lanes}: the trap needs 2 to 8 lanes.")
        _positive(self, "lane_width", "length", "speed_limit")
        _check(self.lane_width <= 100, f"Road.lane_width = {self.lane_width!r}: at most 100 m.")


@dataclass(frozen=True)
class Clock:
    """Time: one decision per second for 150 seconds, simulation at 2 Hz."""

    decisions: int = 150  # ‡ 1500 m at 10 m/s
    decision_rate: int = 1  # Hz ‡ with it 150 decisions are 1500 m at 10 m/s
    simulation_rate: int = 2  # Hz †

    def __post_init__(self):
        _check_numbers(self)
        _positive(self, "decisions", "decision_rate", "simulation_rate")
        _check(
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
class Car:
    """The size of every car, a rectangle."""

    length: float = 5.0  # m †
    width: float = 2.0  # m †

    def __post_init__(self):
        _check_numbers(self)
        _positive(self, "length", "width")


@dataclass(frozen=True)
class Ego:
    """The learning car. It starts in the rightmost lane at x = 0 with heading 0."""

    speed: float = 10.0  # m/s ‡ CQL's row: 10 ± 0 m/s over 1500 ± 0 m
    max_speed: float = 25.0  # m/s § low enough that no 0.5 s step passes through a car
    min_speed: float = 1.0  # m/s § a lower speed is the accident "dangerous stoppage"
    acceleration: float = 1.0  # m/s² † the actions are -1, 0 and +1 times this
    steering: float = math.pi / 50  # rad † the actions are -1, 0 and +1 times this

    def __post_init__(self):
        _check_numbers(self)
        _positive(self, "acceleration", "steering")
        _not_negative(self, "min_speed")
        _check(
            self.min_speed < self.speed <= self.max_speed,
            f"Ego.speed = {self.speed} m/s must lie above min_speed ({self.min_speed}) and not above "
            f"max_speed ({self.max_speed}).",
        )
        _check(self.steering < math.pi / 3, f"Ego.steering = {self.steering} rad: stay below π/3.")


@dataclass(frozen=True)
class Traps:
    """The two slow cars (Table 1). Trap 1 drives in the ego's lane, trap 2 in the next lane to its left.

    The table does not say between which points it measures D1 and D2; we take the cars' centres ‡.
    """

    speed: float = 10.0  # m/s § the ego's initial speed, so that an idle ego stays at the same distance
    d1: tuple = _range(14.80, 16.44)  # m † D1, ego to trap 1
    d2: tuple = _range(4.06, 7.43)  # m † D2, ego to trap 2

    def __post_init__(self):
        _check_numbers(self)
        _positive(self, "speed")
        _not_negative(self, "d1", "d2")
        _check(
            self.d2[1] <= self.d1[0],
            f"Traps.d2 = {self.d2} m reaches beyond d1 = {self.d1} m: D2 must be the shorter distance.",
        )


@dataclass(frozen=True)
class Traffic:
    """The cars ahead of trap 1 (Table 2): IDM, MOBIL and a lane-keeping controller that is stable at 2 Hz."""

    cars: int = 6  # §
    lead: float = 40.0  # m § trap 1 to the first car; at 20 m a traffic jam reaches the traps
    headway: float = 40.0  # m § mean distance from one car to the next; at 20 m a traffic jam reaches the traps
    spacing: tuple = _range(0.5, 1.5)  # § each distance is headway x U[spacing]
    speed: tuple = _range(11.0, 12.5)  # m/s § at the start
    desired_speed: float = 12.5  # m/s † v_desired (the table prints "12.5m")
    a_max: float = 0.5  # m/s² † maximum acceleration
    b: float = 0.5  # m/s² † comfortable deceleration
    s0: float = 10.0  # m † desired gap; highway-env measures gaps centre to centre
    time_gap: float = 1.5  # s † T
    delta: float = 4.0  # † exponent of the free-road term
    politeness: float = 0.5  # † p of MOBIL (not the p of the stochastic rule)
    a_threshold: float = 0.2  # m/s² † smallest incentive for a lane change
    safe_braking: float = 2.0  # m/s² § highway-env's default: hardest braking of the new follower
    lane_change_delay: float = 1.0  # s § highway-env's default
    braking_limit: float = 6.0  # m/s² § highway-env's clip of every IDM acceleration
    tau_heading: float = 0.6  # s § highway-env's 0.2 s is unstable at 2 Hz: 0.5 / 0.2 > 2
    tau_lateral: float = 1.8  # s § three times tau_heading, as in highway-env (0.6 s and 0.2 s)

    def __post_init__(self):
        _check_numbers(self)
        _check(0 <= self.cars <= 40, f"Traffic.cars = {self.cars}: between 0 and 40.")
        _positive(self, "lead", "headway", "desired_speed", "a_max", "b", "delta", "tau_heading", "tau_lateral")
        _positive(self, "braking_limit")
        _check(self.a_max <= 10, f"Traffic.a_max = {self.a_max!r}: at most 10 m/s².")
        _not_negative(self, "spacing", "speed", "s0", "time_gap", "politeness", "safe_braking", "lane_change_delay")


@dataclass(frozen=True)
class Reward:
    """Weights of the three terms (Equation 9), and the reward of an accident (Section III-C, "Reward")."""

    w_v: float = 1.5  # † speed
    w_y: float = 0.05  # † lane centring
    w_theta: float = 0.05  # † steering
    accident: float = -10.0  # †

    def __post_init__(self):
        _check_numbers(self)
        _not_negative(self, "w_v", "w_y", "w_theta")
        _check(self.w_v + self.w_y + self.w_theta > 0, "Reward: at least one weight must be above 0.")


@dataclass(frozen=True)
class Sight:
    """The observation: the ego and its nearest neighbours."""

    neighbours: int = 4  # † cars
    distance: float = 200.0  # m § range of the observation and of the rule

    def __post_init__(self):
        _check_numbers(self)
        _positive(self, "neighbours", "distance")

    @property
    def numbers(self) -> int:
        """Numbers of one decision: 6 of the ego, 5 of each neighbour (26 by default)."""
        return 6 + 5 * self.neighbours


@dataclass(frozen=True)
class Rule:
    """The rule controller (Section III-D)."""

    v_min: float = 6.0  # m/s † slowest target speed
    v_max: float = 15.0  # m/s † fastest target speed
    n: int = 5  # † target speeds between the two, evenly spaced
    t_safe: float = 1.5  # s § the traffic's time gap; the paper gives no value
    floor: float = 3.0  # m § smallest bumper-to-bumper gap for a lane change

    def __post_init__(self):
        _check_numbers(self)
        _positive(self, "v_min", "t_safe", "floor")
        _check(self.v_min < self.v_max, f"Rule.v_max = {self.v_max} m/s must be above v_min ({self.v_min}).")
        _check(2 <= self.n <= 1000, f"Rule.n = {self.n}: the grid of target speeds needs 2 to 1000 values.")


RULE_P = 0.9  # † p, the stochastic rule's probability of the rule's action (Equation 16)


LARGEST_P = 1 - 2**-24  # the largest number below 1 in float32, in which the networks compute


def check_p(p: float, name: str = "p", n_actions: int = N_ACTIONS) -> None:
    """Raise BootcourseError for a p outside [1/9, LARGEST_P]: at 1/9 π̃ is uniform, at 1 the KL is infinite."""
    low = f"1/{n_actions}"
    _check(
        isinstance(p, (int, float)) and 1 / n_actions <= p < 1,
        f"{name} = {p!r} is outside [{low}, 1): at {low} the rule is uniform, at 1 the KL is infinite.",
    )
    _check(p <= LARGEST_P, f"{name} = {p!r} is 1 in single precision, and the KL infinite: give at most 0.9999999.")


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
            part = getattr(self, f.name)
            _check(
                isinstance(part, f.type), f"Scenario.{f.name} = {part!r}: expected {f.type.__name__}, see its fields."
            )
        limit = self.road.speed_limit
        for part, fastest in ((self.traps, self.traps.speed), (self.traffic, self.traffic.speed[1])):
            _check(
                fastest <= limit,
                f"{type(part).__name__}.speed = {part.speed} m/s is above the road's speed limit ({limit} m/s).",
            )
        seconds = self.clock.decisions / self.clock.decision_rate
        t = self.traffic
        head_start = self.traps.d1[1] + t.lead + t.cars * t.headway * t.spacing[1]
        wanted = max(t.desired_speed, self.traps.speed, t.speed[1])
        reach = max(seconds * self.ego.max_speed, head_start + seconds * min(wanted, limit))
        _check(
            self.road.length >= reach,
            f"Road.length = {self.road.length} m is shorter than the {reach:.0f} m that a car can drive "
            f"in {seconds:.0f} s.",
        )
        _check(
            self.traps.d1[0] > self.car.length,
            f"Traps.d1 = {self.traps.d1} m: trap 1 would start inside the ego ({self.car.length} m long).",
        )
        _check(
            self.car.width < self.road.lane_width,
            f"Car.width = {self.car.width} m does not fit a lane of {self.road.lane_width} m.",
        )
        _check(
            min(self.traffic.lead, self.traffic.headway * self.traffic.spacing[0]) > self.car.length,
            f"Traffic.lead ({self.traffic.lead} m) and headway x spacing (from "
            f"{self.traffic.headway * self.traffic.spacing[0]} m) must be longer than a car ({self.car.length} m).",
        )

    @property
    def vehicles(self) -> int:
        """Cars on the road: the ego (0), trap 1 (1), trap 2 (2), then the traffic."""
        return 3 + self.traffic.cars

    @property
    def observation_size(self) -> int:
        """Numbers in an observation (26 by default)."""
        return self.sight.numbers

    def to_json(self) -> str:
        """The scenario as JSON text, for `from_json`."""
        return json.dumps(asdict(self), sort_keys=True)

    @classmethod
    def from_json(cls, text: str) -> "Scenario":
        """A scenario from `to_json`'s text. Raises BootcourseError for other text or an invalid number."""
        try:
            return _build(cls, json.loads(text))
        except (json.JSONDecodeError, TypeError, AttributeError) as error:
            raise BootcourseError(f"This is not a scenario that bootcourse wrote ({error}).") from None


def _build(cls, data: dict):
    if not isinstance(data, dict):
        raise TypeError(f"{cls.__name__} is {data!r}")
    known = {f.name: f for f in fields(cls)}
    unknown, missing = sorted(set(data) - set(known)), sorted(set(known) - set(data))
    _check(not unknown, f"{cls.__name__} has no field {', '.join(unknown)}: it was written by another version.")
    _check(not missing, f"{cls.__name__} has no {', '.join(missing)}: it was written by another version.")
    values = {}
    for name, value in data.items():
        part = known[name].type
        if is_dataclass(part):
            value = _build(part, value)
        values[name] = tuple(value) if isinstance(value, list) else value
    return cls(**values)


DEFAULT = Scenario()
CALIBRATED = Scenario(name="calibrated", traps=Traps(speed=10.9))  # ‡ the soft-constraint row: 10.87 m/s, 1631 m
SCENARIOS = {scenario.name: scenario for scenario in (DEFAULT, CALIBRATED)}


def named(name: str) -> Scenario:
    """The scenario of that name. Raises BootcourseError for an unknown name."""
    check_known("Scenario", name, SCENARIOS)
    return SCENARIOS[name]
