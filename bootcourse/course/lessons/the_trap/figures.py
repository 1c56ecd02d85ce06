"""Figures and tables of the trap: where each action leads, what pays, what an agent sees, how drives end."""

import numpy as np
from matplotlib.figure import Figure

from bootcourse.colours import OTHER
from bootcourse.course import table
from bootcourse.episodes.evaluate import Episodes
from bootcourse.episodes.rollout import Rollout
from bootcourse.episodes.words import overtaken
from bootcourse.methods import METHODS, style
from bootcourse.plots.canvas import MplAxes
from bootcourse.plots.figure import INK, QUIET, SMALL, TEXT, WIDTH, finish, new_figure, one_axes
from bootcourse.plots.road import draw_car, draw_road, edges_of
from bootcourse.plots.top_view import top_view_over_time
from bootcourse.research import report, tables
from bootcourse.research.results import Results
from bootcourse.road import observation
from bootcourse.road.formulas import bicycle_step, speed_reward
from bootcourse.scenario import ACTION_NAMES, DEFAULT, Scenario

RIGHT_FIRST = ("keep right", ("keep left", 4), ("keep right", 3))  # the quick way out on road 10, then accelerate
MEANS = {  # an observation's numbers, of the ego and of another car
    "presence": "1 for a car that is there",
    "x": "place along the road",
    "y": "place across the road, to the right; 0 is the middle of the left lane",
    "v_lon": "speed along the road",
    "v_lat": "speed to the right",
    "d_e": "how far it is off the middle of its lane",
    "dx": "how far it is ahead of the ego",
    "dy": "how far it is to the right of the ego",
    "dv_lon": "how much faster it is than the ego",
    "dv_lat": "the same to the right",
}
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


def nine_actions(decoded: np.ndarray, seconds: int = 2, scenario: Scenario = DEFAULT) -> Figure:
    """Where each action, held for some seconds, brings the ego from its start in the right lane.

    decoded: the acceleration (m/s²) and the steering (rad) of each action, (9, 2).
    """
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
        path = path_of(decoded[action], seconds, scenario)
        colour = SHADES[action // 3]
        ax.plot(path[:, 0], path[:, 1] + start, color=colour, linewidth=1.3, zorder=5, clip_on=False)
        x, y = path[-1] + [0, start]
        ax.plot(x, y, "o", color=colour, markersize=5, zorder=6, clip_on=False)
        ends.append(f"{words} {x:.1f} m on and {abs(y - start):.1f} m to the side")
    labels = (("brake", (-4, 4), "right"), ("keep", (0, 9), "center"), ("accelerate", (7, -1), "left"))
    for i, (words, offset, align) in enumerate(labels):
        x, y = path_of(decoded[3 * i], seconds, scenario)[-1] + [0, start]
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
    least, most = (abs(path_of(decoded[action], seconds, scenario)[-1, 1]) for action in (0, 6))
    return finish(figure, f"In {seconds} s steering moves the car {least:.1f} to {most:.1f} m sideways", alt)


def running_lead(lead: np.ndarray, behind: int) -> Figure:
    """What the escape has earned so far, less what doing nothing has: (seconds,). behind: its last second below 0."""
    seconds, best = np.arange(1, len(lead) + 1), lead[-1]
    title = f"The rule's way out is behind for {behind} s, and {best:.0f} ahead in the end"
    figure, ax = one_axes(3.4, title, "time (s)", "lead of the rule's way out (reward so far)")
    look = style("rule")
    ax.axhline(0, color=QUIET, linewidth=1)
    ax.plot(seconds, lead, color=look.colour, linewidth=2)
    ax.plot(behind, lead[behind - 1], "o", color=INK)
    ax.annotate(f"still behind after {behind} s", (behind, 0), xytext=(-2, 6), textcoords="offset points",
                ha="right", fontsize=TEXT, color=INK)  # fmt: skip
    ax.text(92, 6, "it rises where the rule drives at 13 to 15 m/s", fontsize=SMALL, color=QUIET)
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
        "The reward so far of the rule's way out, less that of doing nothing, over 150 s: below zero until second "
        f"{behind}, at least {lead.min():.1f}, then rising in steps to {best:.1f}."
    )
    return finish(figure, title, alt)


def path_of(decoded: np.ndarray, seconds: int, scenario: Scenario = DEFAULT) -> np.ndarray:
    """(x, y) of the ego from (0, 0) while it holds an acceleration (m/s²) and a steering (rad): (steps + 1, 2)."""
    acceleration, steering = map(float, decoded)
    state, places = (0.0, 0.0, 0.0, scenario.ego.speed), [(0.0, 0.0)]
    for _ in range(seconds * scenario.clock.simulation_rate):
        state = bicycle_step(*state, acceleration, steering, scenario.car.length, scenario.clock.dt)
        places.append(state[:2])
    return np.array(places)


def ending(drive: Rollout, who: str) -> Figure:
    """A drive from above, at its start, after 3 s and where it passes trap 1 or ends; its title says how it ends."""
    passed, crash = overtaken(drive), f"crashes after {drive.times[-1]:.0f} s"
    end = f"is ahead of trap 1 after {passed:.0f} s" if passed else "stays behind"
    end = (f"{end} and {crash}" if passed else crash) if drive.accident else end
    return top_view_over_time(drive, times=[0, 3, passed or drive.times[-1]], title=f"{who}, it {end}")


def observed(seen: np.ndarray, first: int):
    """A table of the first numbers of an observation, and what they are."""
    each = zip(observation.names(DEFAULT)[:first], seen, observation.scales(DEFAULT), strict=False)
    rows = [
        [f"`{name}`", f"{number:.3f}", f"{number * scale:.2f}", MEANS[name.removeprefix("car 1 ")]]
        for name, number, scale in each
    ]
    return table(["number", "observed", "in m, m/s", "what it is"], rows, f"(the first {first} of {len(seen)})")


def who_escapes(study: Results, plan: Episodes):
    """A table of the study's agents without and with help, of the rule, and of a plan, on the same roads."""
    rows = []
    for method in ("sac", "bootstrapped"):
        of = study.of(method)
        each = " ".join(f"{earned:.0f}" for earned in sorted(of.scores("returns")))
        rows.append([METHODS[method].name, f"{tables.escaped(study, method)} escape", each, share(of, "accident")])
    rule = report.rule_results(DEFAULT, study.sizes[0])
    ahead = f"success on {share(rule, 'success')}"
    rows.append(["the rule", ahead, f"{rule.episodes('returns').mean():.0f}", share(rule, "accident")])
    crashes = f"{100 * (plan.accident > 0).mean():.0f} %"
    ahead = f"success on {100 * plan.success.mean():.0f} %"
    rows.append(["the plan of Round 1", ahead, f"{plan.returns.mean():.0f}", crashes])
    return table(["", "who gets out", "return, of each agent", "drives with an accident"], rows)


def share(of: Results, measure: str) -> str:
    """In per cent, of all drives."""
    return f"{100 * (of.episodes(measure) > 0).mean():.0f} %"
