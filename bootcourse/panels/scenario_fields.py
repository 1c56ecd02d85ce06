"""The numbers of a scenario that the panel can move, and how to make a scenario from them.

A slider covers the values that are interesting; `Scenario` itself decides which values are allowed.
"""

import math
from collections.abc import Mapping
from dataclasses import dataclass, fields, replace

from bootcourse.errors import BootcourseError
from bootcourse.scenario import SCENARIOS, Scenario


@dataclass(frozen=True)
class Field:
    """One number: scenario.<part>.<name>, or one end of it where it is a range; its slider and its meaning."""

    part: str
    name: str
    symbol: str
    unit: str
    low: float
    high: float
    step: float
    help: str
    end: int | None = None  # 0 or 1: the low or the high end of a range
    most: float = math.inf  # the largest value that the panel tries, for counts that cost memory

    def of(self, scenario: Scenario) -> float:
        """The number's value in a scenario."""
        value = getattr(getattr(scenario, self.part), self.name)
        return value if self.end is None else value[self.end]


GROUPS = {
    "Traps": (
        Field("traps", "speed", "v trap", "m/s", 6, 20, 0.1, "Speed of the two traps."),
        Field("ego", "speed", "v ego", "m/s", 2, 25, 0.5, "Speed at which the ego starts."),
        Field("traps", "d1", "D1 from", "m", 6, 40, 0.01, "Trap 1, in the ego's lane, starts at least here.", 0),
        Field("traps", "d1", "D1 to", "m", 6, 40, 0.01, "And at most here: metres ahead, centre to centre.", 1),
        Field("traps", "d2", "D2 from", "m", 0, 30, 0.01, "Trap 2, one lane to the left, starts at least here.", 0),
        Field("traps", "d2", "D2 to", "m", 0, 30, 0.01, "And at most here, never beyond D1.", 1),
    ),
    "Traffic": (
        Field("traffic", "cars", "cars", "", 0, 20, 1, "Cars ahead of trap 1."),
        Field("traffic", "desired_speed", "v desired", "m/s", 5, 30, 0.1, "Speed that a free car would drive."),
        Field("traffic", "lead", "lead", "m", 6, 120, 1, "From trap 1 to the first car."),
        Field("traffic", "headway", "headway", "m", 12, 120, 1, "Mean distance between one car and the next."),
        Field("traffic", "time_gap", "T", "s", 0, 4, 0.1, "Time gap that a car keeps to the one ahead."),
        Field("traffic", "politeness", "politeness", "", 0, 1, 0.05, "Weight of other cars' gain in a lane change."),
    ),
    "Rule": (
        Field("rule", "t_safe", "t safe", "s", 0.1, 4, 0.1, "Safety time of a lane change."),
        Field("rule", "v_min", "v min", "m/s", 1, 20, 0.5, "Slowest target speed."),
        Field("rule", "v_max", "v max", "m/s", 1, 30, 0.5, "Fastest target speed."),
        Field("rule", "n", "n", "", 2, 20, 1, "Target speeds, evenly spaced from v min to v max.", most=1000),
        Field("rule", "floor", "floor", "m", 0.5, 20, 0.5, "Smallest gap for a lane change, bumper to bumper."),
    ),
    "Reward": (
        Field("reward", "w_v", "w v", "", 0, 3, 0.05, "Weight of the speed term."),
        Field("reward", "w_y", "w y", "", 0, 1, 0.01, "Weight of keeping to the lane's centre."),
        Field("reward", "w_theta", "w θ", "", 0, 1, 0.01, "Weight of the steering term."),
        Field("reward", "accident", "accident", "", -50, 0, 0.5, "Reward of an accident, which ends the drive."),
    ),
    "Road and clock": (
        Field("clock", "decisions", "decisions", "", 10, 300, 10, "Decisions of an episode."),
        Field("clock", "simulation_rate", "physics", "Hz", 1, 20, 1, "Simulation steps a second."),
        Field("clock", "decision_rate", "decide", "Hz", 1, 5, 1, "Decisions a second."),
        Field("sight", "neighbours", "sees", "cars", 1, 10, 1, "Nearest cars in the ego's observation.", most=100),
        Field("road", "lanes", "lanes", "", 2, 8, 1, "Lanes; the traps take the two on the right."),
        Field("road", "length", "length", "m", 1000, 10000, 100, "Length of the road: no car may reach its end."),
    ),
}
FIELDS = tuple(field for group in GROUPS.values() for field in group)


def changed(start: Scenario, values: Mapping[Field, float]) -> Scenario:
    """`start` with other numbers. Raises BootcourseError (by `Scenario`) if they do not fit together."""
    changes: dict[str, dict] = {}
    for field, value in values.items():
        part = getattr(start, field.part)
        if value == field.of(start):
            continue
        if value > field.most:
            raise BootcourseError(f"{field.symbol} = {value:g}: this panel goes up to {field.most:g}.")
        whole = next(f for f in fields(part) if f.name == field.name).type in ("int", int)
        value = int(value) if whole and float(value).is_integer() else value
        own = changes.setdefault(field.part, {})
        if field.end is None:
            own[field.name] = value
        else:
            pair = list(own.get(field.name, getattr(part, field.name)))
            pair[field.end] = value
            own[field.name] = tuple(pair)
    if not changes:
        return start
    parts = {name: replace(getattr(start, name), **own) for name, own in changes.items()}
    return replace(start, name=f"{start.name}, changed", **parts)


def as_code(scenario: Scenario, start: Scenario) -> str:
    """Python code that makes the scenario from `start`."""
    base = start.name.upper() if SCENARIOS.get(start.name) == start else "scenario"
    told = []
    for part in fields(Scenario):
        before, after = getattr(start, part.name), getattr(scenario, part.name)
        if part.name == "name" or before == after:
            continue
        own = [f.name for f in fields(after) if getattr(after, f.name) != getattr(before, f.name)]
        numbers = ", ".join(f"{name}={getattr(after, name)!r}" for name in own)
        told.append(f"{part.name}=replace({base}.{part.name}, {numbers})")
    return f"replace({base}, {', '.join(told)})" if told else base
