"""Figures of the trap: the speed term of the reward, where each of the nine actions leads; where a plan gets out."""

from collections.abc import Sequence

import numpy as np
from matplotlib.figure import Figure

from bootcourse.colours import OTHER
from bootcourse.episodes.evaluate import held_out_seeds
from bootcourse.episodes.record import record
from bootcourse.methods import style
from bootcourse.plots.canvas import MplAxes
from bootcourse.plots.figure import INK, QUIET, SMALL, TEXT, WIDTH, finish, new_figure, one_axes
from bootcourse.plots.road import draw_car, draw_road, edges_of
from bootcourse.policies import plan_policy
from bootcourse.road.formulas import bicycle_step, speed_reward
from bootcourse.road.state import EGO, TRAP_2, X
from bootcourse.scenario import ACTION_NAMES, DEFAULT, Scenario

RIGHT_FIRST = ("keep right", ("keep left", 4), ("keep right", 3))  # the quick way out on road 10, then accelerate
SHADES = ("#8A939B", INK, "#5F6B77")  # brake, keep, accelerate


def reward_curve(traps: float = 10.0, best: float = 15.0) -> Figure:
    """r_v against speed (m/s), with the traps' speed and the best one marked."""
    title = "The speed term is small up to 12.5 m/s and largest at 15 m/s"
    figure, ax = one_axes(3.2, title, "speed along the road (m/s)", "speed term $r_v$ (no unit)")
    speeds = np.linspace(0, 20, 801)
    ax.plot(speeds, [speed_reward(v) for v in speeds], color=INK, linewidth=2)
    for v, words in ((traps, "behind the traps"), (best, "a free road")):
        ax.plot(v, speed_reward(v), "o", color=INK)
        text = f"{words}: {v:g} m/s pays {speed_reward(v):.2f}"
        look = {"textcoords": "offset points", "ha": "right", "fontsize": TEXT, "color": INK}
        ax.annotate(text, (v, speed_reward(v)), xytext=(-10, 8), **look)
    ax.set_xlim(0, 20)
    alt = (
        f"The speed term against speed: zero up to 5 m/s, rising slowly to 12.5 m/s, steeply to 1 at {best:g} m/s, and "
        f"almost zero from 17 m/s on. At {traps:g} m/s it is {speed_reward(traps):.2f}."
    )
    return finish(figure, title, alt)


def nine_actions(seconds: int = 2, scenario: Scenario = DEFAULT) -> Figure:
    """Where each action, held for some seconds, brings the ego from its start in the right lane."""
    left, right = -5.0, scenario.ego.speed * seconds + 14.0
    lanes, width = scenario.road.lanes, scenario.road.lane_width
    road = (lanes * width + 4.4) * (WIDTH - 0.7) / (right - left)
    figure = new_figure(road + 0.95)
    ax = figure.add_axes((0.55 / WIDTH, 0.45 / (road + 0.95), (WIDTH - 0.7) / WIDTH, road / (road + 0.95)))
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
    for lane, words in enumerate(("left lane: 0", "middle lane: 1", "right lane: 2")):
        ax.text(right - 0.5, lane * width, words, ha="right", va="center", fontsize=SMALL, color=QUIET)
    top, bottom = edges_of(scenario.road)
    ax.set(xlim=(left, right), ylim=(bottom + 4.0, top - 0.4), aspect="equal")
    for side in ("top", "right", "left", "bottom"):
        ax.spines[side].set_visible(False)
    ax.set_yticks(np.arange(0, start + 0.1, 2))
    ax.tick_params(labelsize=SMALL, labelcolor=QUIET, length=3)
    ax.set_xlabel("distance along the road from the start (m)", fontsize=TEXT, color=INK)
    ax.set_ylabel("y, to the right (m)", fontsize=TEXT, color=INK)
    alt = f"Nine paths fan out from the ego in the right lane. After {seconds} s: {'; '.join(ends)}."
    sideways = abs(path_of(3, seconds, scenario)[-1, 1])
    return finish(figure, f"Nine actions, held for {seconds} s: steering moves the car {sideways:.1f} m sideways", alt)


def running_lead(lead: np.ndarray, behind: int) -> Figure:
    """What the escape has earned so far, less what doing nothing has: (seconds,). behind: its last second below 0."""
    seconds, best = np.arange(1, len(lead) + 1), lead[-1]
    title = f"The escape is behind for {behind} s, and {best:.0f} ahead in the end"
    figure, ax = one_axes(3.4, title, "time (s)", "lead of the escape (reward so far)")
    look = style("rule")
    ax.axhline(0, color=QUIET, linewidth=1)
    ax.plot(seconds, lead, color=look.colour, linewidth=2)
    ax.plot(behind, lead[behind - 1], "o", color=INK)
    ax.annotate(f"still behind after {behind} s", (behind, 0), xytext=(-2, 6), textcoords="offset points",
                ha="right", fontsize=TEXT, color=INK)  # fmt: skip
    ax.text(148, 0.3, "doing nothing", ha="right", va="bottom", fontsize=SMALL, color=QUIET)
    ax.set_xlim(0, len(lead))
    near = ax.inset_axes((0.08, 0.5, 0.4, 0.42))
    near.axhline(0, color=QUIET, linewidth=1)
    near.plot(seconds[:50], lead[:50], color=look.colour, linewidth=2)
    near.fill_between(seconds[:50], np.minimum(lead[:50], 0), 0, color=look.colour, alpha=0.25)
    near.set_title("the first 50 s", fontsize=SMALL, color=INK)
    near.set(xlim=(0, 50))
    near.tick_params(labelsize=SMALL, labelcolor=QUIET, length=3)
    alt = (
        f"The escape's reward so far, less that of doing nothing, over 150 s: below zero until second {behind}, at "
        f"least {lead.min():.1f}, then rising in steps to {best:.1f}."
    )
    return finish(figure, title, alt)


def path_of(action: int, seconds: int, scenario: Scenario = DEFAULT) -> np.ndarray:
    """(x, y) of the ego from (0, 0) while it holds an action: (steps + 1, 2)."""
    acceleration = (action // 3 - 1) * scenario.ego.acceleration
    steering = (action % 3 - 1) * scenario.ego.steering
    state, places = (0.0, 0.0, 0.0, scenario.ego.speed), [(0.0, 0.0)]
    for _ in range(seconds * scenario.clock.simulation_rate):
        state = bicycle_step(*state, acceleration, steering, scenario.car.length, scenario.clock.dt)
        places.append(state[:2])
    return np.array(places)


def d2_and_unhurt(plan: Sequence, roads: int = 400) -> tuple[np.ndarray, np.ndarray]:
    """Where trap 2 starts (m ahead, centre to centre), and whether a plan gets out without an accident: each (roads,).

    On held-out roads.
    """
    drives = record(plan_policy(plan), held_out_seeds(1, roads))
    d2 = np.array([drive.states[0, TRAP_2, X] - drive.states[0, EGO, X] for drive in drives])
    return d2, np.array([drive.success and not drive.accident for drive in drives])
