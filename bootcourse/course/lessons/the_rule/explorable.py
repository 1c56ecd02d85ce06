"""To drag in this lesson: the time that a gap must last, against the distance in which the car can brake."""

import numpy as np

from bootcourse.colours import ALARM
from bootcourse.methods import style
from bootcourse.panels.explorable import Axes, Curve, Explorable, curves
from bootcourse.panels.number import Number
from bootcourse.plots.svg import Drawing
from bootcourse.rule import safety_distance
from bootcourse.scenario import DEFAULT

SPEEDS = np.linspace(0, 4, 81)  # m/s by which the ego is faster than the car ahead
AXES = Axes("faster than the slower of the two cars ahead by (m/s)", "gap (m)", (0.0, 10.0))


def braking_distance(faster):
    """The room (m) in which the car brakes to another's speed, from so many m/s more: a number or an array."""
    step = DEFAULT.clock.dt  # s; in each the car moves at its old speed
    return faster**2 / (2 * DEFAULT.ego.acceleration) + faster * step / 2


def long_enough(t_safe: float) -> tuple[np.ndarray, np.ndarray, float]:
    """At each of the `SPEEDS`, the gap that the rule wants and the distance in which the car brakes (m); and up to
    which of them (m/s) the gap is long enough.
    """
    brakes = braking_distance(SPEEDS)
    wanted = np.array([safety_distance(speed, 0.0, 0.0, t_safe, DEFAULT.rule.floor) for speed in SPEEDS])
    return wanted, brakes, float(SPEEDS[np.maximum.accumulate(brakes > wanted) == 0][-1])


def needed() -> Explorable:
    """The gap that the rule wants over the closing speed, also where the ego is slower, while both its numbers move."""
    speeds = np.linspace(-4, 4, 161)
    axes = Axes(
        "faster than the slower of the two cars ahead by (m/s)", "gap that a lane change needs (m)", (0.0, 10.0)
    )

    def draw(t_safe: float, floor: float) -> Drawing:
        wanted = np.array([safety_distance(speed, 0.0, 0.0, t_safe, floor) for speed in speeds])
        behind = safety_distance(-2.0, 0.0, 0.0, t_safe, floor)
        most = safety_distance(speeds[-1], 0.0, 0.0, t_safe, floor)
        says = f"t_safe = {t_safe:g} s, floor {floor:g} m: at 2 m/s slower {behind:g} m, at 4 m/s faster {most:.1f} m."
        return curves(says, axes, speeds, {"the gap that the rule wants": Curve(wanted, style("rule").colour)}, mark=-2)

    t_safe = Number("t_safe", DEFAULT.rule.t_safe, 0.5, 2, 0.1, "The time for which the gap must last.", "s")
    floor = Number("floor", DEFAULT.rule.floor, 0, 5, 0.5, "The least gap, however slow the car is.", "m")
    return Explorable("How large a gap does a lane change need?", draw, t_safe=t_safe, floor=floor)


def gap() -> Explorable:
    """The gap that the rule wants over the closing speed, and the way in which the car brakes, while t_safe moves."""
    brakes_in = f"the distance in which it brakes, at {DEFAULT.ego.acceleration:g} m/s² "
    brakes_in += f"in steps of {DEFAULT.clock.dt:g} s"

    def draw(t_safe: float) -> Drawing:
        wanted, brakes, safe = long_enough(t_safe)
        named = {
            "the gap that the rule wants": Curve(wanted, style("rule").colour),
            brakes_in: Curve(brakes, ALARM, "--"),
        }
        says = f"t_safe = {t_safe:g} s: up to {safe:.1f} m/s the gap is long enough to brake in it."
        return curves(says, AXES, SPEEDS, named, mark=safe)

    t_safe = Number("t_safe", DEFAULT.rule.t_safe, 0.5, 2, 0.1, "The time for which the gap must last.", "s")
    return Explorable("How large a gap is large enough?", draw, t_safe=t_safe)
