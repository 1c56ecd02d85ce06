"""Small figures of the lessons on the road: what the actions do, how traffic follows, and how it steers."""

import numpy as np
from matplotlib.figure import Figure

from bootcourse.colours import OTHER
from bootcourse.road.formulas import bicycle_step
from bootcourse.scenario import ACTION_NAMES, DEFAULT, Scenario
from bootcourse.study.drawing import INK, QUIET, SMALL, TEXT, WIDTH, finish, new_figure
from bootcourse.study.top_view import draw_car, draw_road

SHADES = ("#0072B2", "#444444", "#D55E00")  # brake, keep, accelerate


def nine_actions(seconds: int = 2, scenario: Scenario = DEFAULT) -> Figure:
    """Where each action, held for some seconds, brings the ego from its start in the right lane."""
    left, right = -5.0, scenario.ego.speed * seconds + 14.0
    lanes, width = scenario.road.lanes, scenario.road.lane_width
    road = (lanes * width + 4.4) * (WIDTH - 0.3) / (right - left)
    figure = new_figure(road + 0.95)
    ax = figure.add_axes((0.15 / WIDTH, 0.45 / (road + 0.95), (WIDTH - 0.3) / WIDTH, road / (road + 0.95)))
    draw_road(ax, scenario, left, right, 0.0)
    start = (lanes - 1) * width
    draw_car(ax, 0.0, start, 0.0, OTHER.colour, "ego", scenario)
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
    ax.set_ylim((lanes - 0.5) * width + 4.0, -width / 2 - 0.4)
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
