"""To drag in this lesson: at which of a drive's decisions another action keeps the car unhurt for a while."""

from dataclasses import replace
from functools import cache

import numpy as np

from bootcourse.course.shipped import shipped_agents
from bootcourse.episodes.evaluate import held_out_seeds
from bootcourse.episodes.lookahead import HORIZON, nine_drives
from bootcourse.episodes.record import Rollout, record
from bootcourse.methods import style
from bootcourse.panels.explorable import WIDTH, Explorable
from bootcourse.panels.number import Number
from bootcourse.plots.futures import LEGEND, trails
from bootcourse.plots.road import draw_cars, draw_road, edges_of
from bootcourse.plots.svg import QUIET, Drawing, SvgAxes, drawing, text, ticks
from bootcourse.policies import Policy
from bootcourse.road.state import EGO, HEADING, Accident, X
from bootcourse.scenario import ACTION_NAMES

SHOWN = 12  # decisions, the last of the drive
BEHIND, AHEAD, ASIDE = 14.0, 24.0, 1.6  # m behind the ego, beyond the longest imagined drive, beside the road
STRETCH = 4.0  # metres across are drawn so much larger than metres along
CAR = 1.5  # a car is drawn so much longer than it is, to be seen
HEAD, FOOT = 32, 82  # pixels above and below the road


def ways_out(drive: Rollout, policy: Policy, seconds: int = HORIZON) -> np.ndarray:
    """For each decision, how many of its nine imagined drives have no accident for so long, (decisions,)."""
    return (nine_drives(drive.cars, policy, drive.scenario, seconds).accidents == 0).sum(axis=1)


def last_chance(drive: Rollout, policy: Policy, seconds: int = HORIZON) -> int:
    """The last decision, counted from 1, at which an action leads to a drive without an accident for so long."""
    return int(np.flatnonzero(ways_out(drive, policy, seconds))[-1]) + 1


@cache
def first_collision() -> tuple[Rollout, Policy]:
    """The first collision of the lesson's agent on the lesson's roads, and this agent."""
    policy = shipped_agents("bootstrapped")[0].as_policy()
    drives = (record(policy, [seed], label="bootstrapped")[0] for seed in held_out_seeds(15, 40))
    return next(drive for drive in drives if drive.accident == Accident.COLLISION), policy


def futures() -> Explorable:
    """The nine futures at each decision of the drive that the lesson shows."""
    return futures_of(*first_collision())


def futures_of(drive: Rollout, policy: Policy) -> Explorable:
    """The nine imagined drives from above, while the decision at which they begin moves. x is metres from the ego."""
    scenario, decisions = drive.scenario, len(drive.actions)
    imagined = nine_drives(drive.cars, policy, scenario)
    farthest = (imagined.paths[-SHOWN:, ..., 0].max(axis=(1, 2)) - drive.cars[-SHOWN:, EGO, X]).max()
    left, right, (top, bottom) = -BEHIND, float(farthest) + AHEAD, edges_of(scenario.road)
    high = STRETCH * (bottom - top + 2 * ASIDE) * WIDTH / (right - left)
    car = replace(scenario.car, length=CAR * scenario.car.length, width=CAR * scenario.car.width / STRETCH)
    under = (
        f"{LEGEND[0].upper()}{LEGEND[1:]}; bold: worth most, if it has no accident.",
        f"The other cars stand where they are now, but drive on, too. The road is drawn {STRETCH:g} times as wide.",
    )

    def draw(decision: float) -> Drawing:
        now = round(decision) - 1
        safe, best = imagined.accidents[now] == 0, int(imagined.values[now].argmax())
        cars = drive.cars[now].copy()
        cars[:, HEADING], origin = 0, cars[EGO, X]
        canvas = SvgAxes(0, HEAD, WIDTH, high, (left, right), (bottom + ASIDE, top - ASIDE))
        draw_road(canvas, scenario, left, right, origin)
        draw_cars(canvas, cars, replace(scenario, car=car), style("bootstrapped").colour, left, right, origin)
        for one in trails(imagined, best, now):
            canvas.line(one.x - origin, one.y, one.colour, 2.6 if one.chosen and not one.hurt else 1.1)
            if one.hurt:
                canvas.words(one.x[-1] - origin, one.y[-1], "✕", one.colour, "middle", 11)
        for x in ticks(left, right, 8):
            canvas.parts.append(text(canvas.at(x, 0)[0], HEAD + high + 12, f"{x:g}".replace("-", "−"), "middle", QUIET))
        canvas.parts.append(text(WIDTH / 2, HEAD + high + 30, "distance from the ego (m)", "middle", QUIET))
        says = f"Decision {now + 1}: {safe.sum()} of nine futures have no accident"
        says += f"; the best begins with {ACTION_NAMES[best]}." if safe.any() else ": it is too late."
        words = [text(4, HEAD + high + 54 + 17 * row, line, fill=QUIET) for row, line in enumerate(under)]
        return drawing(WIDTH, HEAD + high + FOOT, [text(4, 20, says, size=14, bold=True), *canvas.parts, *words], says)

    first, help = max(decisions - SHOWN + 1, 1), "Each of the nine actions is tried here; then the agent drives on."
    number = Number("decision", max(decisions - 5, first), first, decisions, 1, help)
    return Explorable("How late can another action keep the car unhurt for ten seconds?", draw, decision=number)
