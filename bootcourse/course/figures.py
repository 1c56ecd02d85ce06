"""Figures that only a lesson needs: the road and the rule, demonstrations, CartPole, a training while it runs."""

import time
from collections.abc import Mapping, Sequence

import numpy as np
from matplotlib.figure import Figure
from matplotlib.patches import Rectangle

from bootcourse.colours import ALARM, OTHER, Style
from bootcourse.course.charts import lines
from bootcourse.course.lessons.the_rule.plans import direct_plan
from bootcourse.episodes.evaluate import held_out_seeds
from bootcourse.episodes.record import record
from bootcourse.episodes.rollout import Rollout
from bootcourse.episodes.words import sentence
from bootcourse.learn.bootstrap import demonstration_share
from bootcourse.learn.curves import by_label
from bootcourse.learn.settings import Settings
from bootcourse.learn.training import Training
from bootcourse.methods import style
from bootcourse.plots.canvas import MplAxes
from bootcourse.plots.diagrams import agent_loop as agent_loop
from bootcourse.plots.diagrams import sac_diagram as sac_diagram
from bootcourse.plots.figure import INK, QUIET, SMALL, TEXT, WIDTH, Picture, finish, new_figure, one_axes, plain_axes
from bootcourse.plots.road import draw_car, draw_road, edges_of
from bootcourse.plots.training_curves import training_curves
from bootcourse.policies import plan_policy
from bootcourse.research.checks import CARTPOLE_SCALES
from bootcourse.road.formulas import bicycle_step, speed_reward
from bootcourse.road.state import EGO, LANE, SPEED, TRAP_1, TRAP_2, X, Y
from bootcourse.rule import SENTENCES, Reason, safety_distance
from bootcourse.scenario import ACTION_NAMES, DEFAULT, Scenario

SHADES = ("#0072B2", "#444444", "#D55E00")  # brake, keep, accelerate
NOISY = "#D55E00"
TRACK, POLE = 2.4, 1.8  # m: half the track; the pole as it is drawn
PICTURES, STEP, ROW = 8, 5.4, 0.85  # in a strip; from one to the next (m); a strip's height (inches)


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
    top, bottom = edges_of(scenario.road)
    ax.set(xlim=(left, right), ylim=(bottom + 4.0, top - 0.4), aspect="equal")
    for side in ("top", "right", "left", "bottom"):
        ax.spines[side].set_visible(False)
    sideways = np.arange(0, start + width / 2 + 0.1, 2)
    ax.set_yticks(start - sideways, [f"{metres:g}" for metres in sideways])
    ax.tick_params(labelsize=SMALL, labelcolor=QUIET, length=3)
    ax.set_xlabel("distance along the road from the start (m)", fontsize=TEXT, color=INK)
    ax.set_ylabel("to the left (m)", fontsize=TEXT, color=INK)
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
    scenario = drive.scenario
    states = drive.states[: 1 + int(np.argmax(drive.states[:, EGO, LANE] != drive.states[0, EGO, LANE]))]
    seconds = np.arange(len(states)) * scenario.clock.dt
    v, slower = states[:, EGO, SPEED], np.minimum(states[:, TRAP_1, SPEED], states[:, TRAP_2, SPEED])
    ahead = states[:, TRAP_2, X] - states[:, EGO, X]
    gap, t_safe = ahead - scenario.car.length, scenario.rule.t_safe
    needed = np.array([safety_distance(a, b, b, t_safe, scenario.rule.floor) for a, b in zip(v, slower, strict=True)])
    printed = (v - slower) * t_safe - ahead
    named = {
        "gap to trap 2, bumper to bumper": gap,
        "safety distance": needed,
        "printed condition: change when above 0": printed,
    }
    first = int(np.argmax(gap > needed))
    alt = (
        f"Over {seconds[-1]:g} s the gap grows from {gap[0]:.1f} to {gap[-1]:.1f} m and exceeds the safety distance of "
        f"{needed[first]:.1f} m at {seconds[first]:g} s. The printed condition falls from {printed[0]:.1f} to "
        f"{printed[-1]:.1f} m: it never rises above 0."
    )
    title = "The gap grows past the safety distance; the printed condition only falls"
    rule, looks = style("rule").colour, (style("rule")._replace(line="-"), Style(INK, "--"), Style(ALARM, "-."))
    figure = lines(seconds, named, title, "time (s)", "metres", marks={"": 0.0}, looks=looks, alt=alt)
    figure.axes[0].plot(seconds[first], gap[first], "o", color=rule, markersize=7)
    place = {"textcoords": "offset points", "ha": "right", "fontsize": TEXT, "color": rule}
    figure.axes[0].annotate("room: change", (seconds[first], gap[first]), xytext=(-8, 10), **place)
    return figure


def escape_against_d2(plan: Sequence | None, roads: int = 400) -> Figure:
    """Whether a plan gets out, against D2, where trap 2 starts: a dot for each held-out road.

    plan: as for `plan_policy`; None for the kit's own.
    """
    drives = record(plan_policy(plan or direct_plan()), held_out_seeds(1, roads))
    d2 = np.array([drive.states[0, TRAP_2, X] - drive.states[0, EGO, X] for drive in drives])
    out = np.array([drive.success for drive in drives])
    title = "Where trap 2 starts decides whether one plan gets out"
    figure, ax = one_axes(2.4, title, "D2: trap 2 starts so far ahead (m, centre to centre)", "")
    spread = np.random.default_rng(0).uniform(-0.25, 0.25, roads)
    ax.scatter(d2, out + spread, s=7, c=np.where(out, style("rule").colour, ALARM), linewidths=0)
    ax.set_yticks([0, 1], ["does not", "gets out"])
    ax.set_position((0.13, *ax.get_position().bounds[1:2], 0.845, ax.get_position().height))
    ax.set_ylim(-0.5, 1.5)
    alt = f"The plan gets out on {out.mean():.0%} of {roads} roads."
    if out.any() and not out.all():
        alt += f" Where it gets out D2 is {np.min(d2[out]):.2f} to {np.max(d2[out]):.2f} m, and where it does not "
        alt += f"{np.min(d2[~out]):.2f} to {np.max(d2[~out]):.2f} m."
    return finish(figure, title, alt)


def reasons_over_time(rollout: Rollout, title: str) -> Figure:
    """What the rule gives as its reason at each decision of a drive."""
    figure = new_figure(2.6)
    ax = figure.add_axes((0.34, 0.2, 0.63, 0.6))
    rate = rollout.scenario.clock.decision_rate
    used = [reason for reason in Reason if (rollout.rule_reasons == reason).any()]
    for row, reason in enumerate(used):
        decisions = np.flatnonzero(rollout.rule_reasons == reason)
        ax.broken_barh([(k / rate, 1 / rate) for k in decisions], (row - 0.35, 0.7), color=style("rule").colour)
    ax.set_yticks(range(len(used)), [sentence(SENTENCES[reason]) for reason in used])
    ax.invert_yaxis()
    plain_axes(ax, "", grid="x")
    ax.tick_params(axis="y", labelcolor=INK)
    ax.set_xlabel("time (s)", fontsize=TEXT, color=INK)
    shares = ", ".join(f"{SENTENCES[r]} {np.mean(rollout.rule_reasons == r):.0%}" for r in used)
    return finish(figure, title, f"Share of the decisions: {shares}.")


def fading(settings: Settings, most: int = 1500) -> Figure:
    """β against the episode, and the fastest that ξ can fall."""
    title, y_label = "The teacher's share fades", "share of demonstrations in a batch, β"
    figure, ax = one_axes(2.8, title, "training episode", y_label, width=0.6)
    episodes = np.arange(most + 1)
    beta = demonstration_share(episodes, settings.beta_start, settings.beta_episodes)
    ax.plot(episodes, beta, color=style("demos").colour, linewidth=2)
    ax.set(xlim=(0, most), ylim=(0, 1))
    start, multiplier = settings.xi_multiplier * settings.alpha_init, settings.xi_multiplier
    words = f"ξ starts at {start:g}\nand shrinks with α:\nξ = {multiplier:g} α"
    figure.text(0.72, 0.62, words, fontsize=TEXT, color=QUIET, va="center")
    alt = f"β falls in a straight line from {settings.beta_start:g} to 0 at episode {settings.beta_episodes}."
    return finish(figure, title, alt)


def where_they_were(drives: dict[str, Sequence[Rollout]], seconds: float, title: str) -> Figure:
    """The ego's paths, seen from trap 1, for some seconds; one panel for each named demonstrator."""
    figure = new_figure(1.0 + 1.35 * len(drives))
    total, told = figure.get_figheight(), []
    for k, (name, some) in enumerate(drives.items()):
        ax = figure.add_axes((0.08, (total - 1.75 - 1.35 * k) / total, 0.88, 0.95 / total))
        places, scenario = [], some[0].scenario
        draw_road(MplAxes(ax), scenario, -60, 15)
        for drive in some:
            states = drive.states[: int(seconds / drive.scenario.clock.dt) + 1]
            path = np.column_stack([states[:, EGO, X] - states[:, TRAP_1, X], states[:, EGO, Y]])
            ax.plot(*path.T, color=style("rule").colour if k == 0 else NOISY, linewidth=0.7, alpha=0.35)
            places.append(path)
        plain_axes(ax, f"lane: {name}", grid="")
        lanes, (top, edge) = range(scenario.road.lanes), edges_of(scenario.road)
        ax.set_yticks(np.array(lanes) * scenario.road.lane_width, lanes)
        ax.set(xlim=(-60, 15), ylim=(edge + 0.6, top - 0.6))
        last = k == len(drives) - 1
        ax.tick_params(axis="x", labelbottom=last)
        if last:
            ax.set_xlabel("distance ahead of trap 1 (m)", fontsize=TEXT, color=INK)
        all_places = np.concatenate(places)
        cells = len(np.unique(np.round(all_places / [2.0, 0.5]), axis=0))
        told.append(f"{name}: {len(some)} drives pass through {cells} squares of 2 by 0.5 m")
    return finish(figure, title, f"The ego's paths seen from trap 1 in the first {seconds:g} s. {'; '.join(told)}.")


def clones(measured: dict[str, np.ndarray], title: str) -> Figure:
    """How clones drive: name -> (seeds, 3) shares of agreement, success and accidents; a dot for each seed."""
    figure = new_figure(0.95 + 0.42 * len(measured))
    told = {name: [] for name in measured}
    height = figure.get_figheight()
    for k, label in enumerate(("agree with their data (%)", "escape (%)", "have an accident (%)")):
        ax = figure.add_axes((0.25 + 0.255 * k, 0.45 / height, 0.215, 1 - 1.15 / height))
        for row, (name, values) in enumerate(measured.items()):
            shares = 100 * values[:, k]
            ax.plot(shares, np.full(len(shares), row), "o", color=style("bc").colour, markersize=5, alpha=0.55)
            ax.plot(shares.mean(), row, "|", color=NOISY, markersize=15, markeredgewidth=2)
            told[name].append(f"{shares.mean():.0f} % {label.split('(')[0].strip()}")
        plain_axes(ax, label, grid="x")
        ax.set_yticks(range(len(measured)), list(measured) if k == 0 else [""] * len(measured))
        ax.tick_params(axis="y", labelcolor=INK, labelsize=SMALL)
        ax.set_ylim(len(measured) - 0.5, -0.5)
        ax.set_xlim(-4, 104)
    words = "; ".join(f"{name}: on average {', '.join(parts)}" for name, parts in told.items())
    return finish(figure, title, f"A dot for each clone, a bar for their mean. {words}.")


def cartpole_strip(drives: Mapping[str, np.ndarray], title: str) -> Figure:
    """Each drive as pictures from its first to its last state: {name: observations (T, 4)}.

    The observations are scaled, as the learner sees them.
    """
    figure = new_figure(0.45 + ROW * len(drives))
    told = []
    for row, (label, observations) in enumerate(drives.items()):
        height = ROW / figure.get_figheight()
        ax = figure.add_axes((0.012, 0.01 + (len(drives) - 1 - row) * height, 0.976, height))
        ax.set(xlim=(-2.5, PICTURES * STEP - 2.9), ylim=(-1.4, 3.6), aspect="equal", anchor="W")
        ax.axis("off")
        ax.text(-2.5, 2.6, sentence(label), fontsize=TEXT, color=INK)
        states = np.asarray(observations) * CARTPOLE_SCALES
        for picture, t in enumerate(np.linspace(0, len(states) - 1, PICTURES).round().astype(int)):
            _draw_cart(ax, states[t], STEP * picture, style(label).colour)
            ax.text(STEP * picture, -1.25, f"push {t + 1}", ha="center", fontsize=SMALL, color=QUIET)
        told.append(f"{label}: the episode lasts {len(states)} pushes")
    alt = f"A cart on a track and the pole on it, {PICTURES} pictures from the first push to the last"
    return finish(figure, title, f"{alt}. {'; '.join(told)}.")


def _draw_cart(ax, state: np.ndarray, x: float, colour: str) -> None:
    cart, angle = x + np.clip(state[0], -TRACK, TRACK), state[2]
    ax.plot([x - TRACK, x + TRACK], [-0.35, -0.35], color=QUIET, linewidth=1)
    ax.add_patch(Rectangle((cart - 0.6, -0.35), 1.2, 0.5, facecolor=INK))
    tip = (cart + POLE * np.sin(angle), 0.15 + POLE * np.cos(angle))
    ax.plot([cart, tip[0]], [0.15, tip[1]], color=colour, linewidth=3.5, solid_capstyle="round")


class LiveCurves:
    """A training's callback: redraws the agents' success and return, at most every `every` seconds.

    labels: one for each agent, those of a label are drawn together; without them, each agent's method. The picture is
    replaced in place, so that the page does not jump. On a busy machine that happens less often, so that the training
    gets most of the time.
    """

    def __init__(self, labels: Sequence[str] = (), every: float = 3.0):
        self.labels, self.every, self.pause = labels, every, every
        self.last, self.output = time.monotonic(), None

    def __call__(self, training: Training) -> None:
        now = time.monotonic()
        if now - self.last < self.pause or training.curves.finished.min() < 2:
            return
        from IPython.display import display

        picture = Picture(self.draw(training))
        if self.output is None:
            self.output = display(picture, display_id=True)
        else:
            self.output.update(picture)
        self.last = time.monotonic()
        self.pause = max(self.every, 5 * (self.last - now))

    def draw(self, training: Training):
        labels = self.labels or [settings.method for settings in training.settings]
        return training_curves(by_label(labels, training.curves.values), title="Training, as it happens")
