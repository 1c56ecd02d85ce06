"""Small figures of the lessons on the road: what the actions do, and when the rule changes lane."""

import numpy as np
from matplotlib.figure import Figure

from bootcourse.colours import ALARM, OTHER
from bootcourse.episodes.rollout import Rollout
from bootcourse.methods import style
from bootcourse.plots.canvas import MplAxes
from bootcourse.plots.figure import INK, QUIET, SMALL, TEXT, WIDTH, finish, label_ends, new_figure, plain_axes
from bootcourse.plots.road import draw_car, draw_road, edges_of
from bootcourse.road.formulas import bicycle_step
from bootcourse.road.state import EGO, LANE, SPEED, TRAP_1, TRAP_2, X
from bootcourse.rule import safety_distance
from bootcourse.scenario import ACTION_NAMES, DEFAULT, Scenario

SHADES = ("#0072B2", "#444444", "#D55E00")  # brake, keep, accelerate


def nine_actions(seconds: int = 2, scenario: Scenario = DEFAULT) -> Figure:
    """Where each action, held for some seconds, brings the ego from its start in the right lane."""
    left, right = -5.0, scenario.ego.speed * seconds + 14.0
    lanes, width = scenario.road.lanes, scenario.road.lane_width
    road = (lanes * width + 4.4) * (WIDTH - 0.3) / (right - left)
    figure = new_figure(road + 0.95)
    ax = figure.add_axes((0.15 / WIDTH, 0.45 / (road + 0.95), (WIDTH - 0.3) / WIDTH, road / (road + 0.95)))
    draw_road(MplAxes(ax), scenario, left, right)
    start = (lanes - 1) * width
    draw_car(MplAxes(ax), 0.0, start, 0.0, OTHER.colour, scenario.car)
    ends = []
    for action, words in enumerate(ACTION_NAMES):
        path = path_of(action, seconds, scenario)
        colour = SHADES[action // 3]
        ax.plot(path[:, 0], path[:, 1] + start, color=colour, linewidth=1.3, zorder=5, clip_on=False)
        x, y = path[-1] + [0, start]
        ax.plot(x, y, "o", color=colour, markersize=5, zorder=6, clip_on=False)
        ends.append(f"{words} {x:.1f} m on and {abs(y - start):.1f} m to the side")
    labels = (("brake", (-4, 4), "right"), ("keep", (0, 9), "center"), ("accelerate", (7, -1), "left"))
    for i, (words, offset, align) in enumerate(labels):
        x, y = path_of(3 * i, seconds, scenario)[-1] + [0, start]
        ax.annotate(words, (x, y), xytext=offset, textcoords="offset points", ha=align,
                    fontsize=TEXT, color=SHADES[i], zorder=7)  # fmt: skip
    top, bottom = edges_of(scenario.road)
    ax.set(xlim=(left, right), ylim=(bottom + 4.0, top - 0.4), aspect="equal")
    for side in ("top", "right", "left", "bottom"):
        ax.spines[side].set_visible(False)
    ax.set_yticks([])
    ax.tick_params(labelsize=SMALL, labelcolor=QUIET, length=3)
    ax.set_xlabel("distance along the road from the start (m)", fontsize=TEXT, color=INK)
    alt = f"Nine paths fan out from the ego in the right lane. After {seconds} s: {'; '.join(ends)}."
    sideways = abs(path_of(3, seconds, scenario)[-1, 1])
    return finish(figure, f"Nine actions, held for {seconds} s: steering moves the car {sideways:.1f} m sideways", alt)


def path_of(action: int, seconds: int, scenario: Scenario = DEFAULT) -> np.ndarray:
    """(x, y) of the ego from (0, 0) while it holds an action: (steps + 1, 2)."""
    acceleration = (action // 3 - 1) * scenario.ego.acceleration
    steering = (action % 3 - 1) * scenario.ego.steering
    state, places = (0.0, 0.0, 0.0, scenario.ego.speed), [(0.0, 0.0)]
    for _ in range(seconds * scenario.clock.simulation_rate):
        state = bicycle_step(*state, acceleration, steering, scenario.car.length, scenario.clock.dt)
        places.append(state[:2])
    return np.array(places)


def when_to_change(drive: Rollout) -> Figure:
    """The gap to trap 2, the safety distance, and what the printed condition compares with 0, in the first lane."""
    figure = new_figure(3.4)
    ax = figure.add_axes((0.08, 0.17, 0.66, 0.6))
    scenario = drive.scenario
    states = drive.states[: 1 + int(np.argmax(drive.states[:, EGO, LANE] != drive.states[0, EGO, LANE]))]
    seconds = np.arange(len(states)) * scenario.clock.dt
    v, slower = states[:, EGO, SPEED], np.minimum(states[:, TRAP_1, SPEED], states[:, TRAP_2, SPEED])
    ahead = states[:, TRAP_2, X] - states[:, EGO, X]
    gap, t_safe = ahead - scenario.car.length, scenario.rule.t_safe
    needed = np.array([safety_distance(a, b, b, t_safe, scenario.rule.floor) for a, b in zip(v, slower, strict=True)])
    printed = (v - slower) * t_safe - ahead
    curves = (
        (gap, "gap to trap 2, bumper to bumper", style("rule").colour, "-"),
        (needed, "safety distance", INK, "--"),
        (printed, "printed condition: change when above 0", ALARM, "-."),
    )
    for values, _, colour, line in curves:
        ax.plot(seconds, values, color=colour, linestyle=line, linewidth=1.8)
    ax.axhline(0, color=QUIET, linewidth=1)
    first = int(np.argmax(gap > needed))
    ax.plot(seconds[first], gap[first], "o", color=style("rule").colour, markersize=7)
    ax.annotate("room: change", (seconds[first], gap[first]), xytext=(-8, 10), textcoords="offset points",
                ha="right", fontsize=TEXT, color=style("rule").colour)  # fmt: skip
    plain_axes(ax, "metres")
    ax.set_xlim(0, seconds[-1])
    ax.set_xlabel("time (s)", fontsize=TEXT, color=INK)
    label_ends(ax, [(float(values[-1]), words, colour) for values, words, colour, _ in curves])
    alt = (
        f"Over {seconds[-1]:g} s the gap grows from {gap[0]:.1f} to {gap[-1]:.1f} m and exceeds the safety distance of "
        f"{needed[first]:.1f} m at {seconds[first]:g} s. The printed condition falls from {printed[0]:.1f} to "
        f"{printed[-1]:.1f} m: it never rises above 0."
    )
    return finish(figure, "The gap grows past the safety distance; the printed condition only falls", alt)
