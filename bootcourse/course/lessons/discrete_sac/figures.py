"""Figures of discrete SAC: what the temperature does in the chain's trap; a pole on its cart, for the next lesson."""

from collections.abc import Mapping, Sequence

import numpy as np
from matplotlib.figure import Figure
from matplotlib.patches import Rectangle

from bootcourse.course import charts
from bootcourse.episodes.words import sentence
from bootcourse.methods import style
from bootcourse.plots.figure import INK, QUIET, SMALL, TEXT, finish, new_figure
from bootcourse.research.experiments import checks

TRACK, POLE = 2.4, 1.8  # m: half the track; the pole as it is drawn
PICTURES, STEP, ROW = 8, 5.4, 0.85  # in a strip; from one to the next (m); a strip's height (inches)


def leaving(alphas: Sequence[float], leave: Sequence[float]) -> Figure:
    """How probable leaving the chain's trap is by the soft equation, over the temperature."""
    title = "With a small α the agent leaves the trap, with a large one its choice is nearly even"
    named, looks = {"π(leave | trap)": np.array(leave)}, [style("sac")]
    marks = {"both actions alike": 0.5}
    return charts.lines(alphas, named, title, "temperature α", "probability of leaving", "x", marks, (0, 1.05), looks)


def cartpole_strip(drives: Mapping[str, np.ndarray], title: str) -> Figure:
    """Each drive as pictures: {name: observations (T, 4)}, scaled, as the learner sees them.

    All are drawn at the pushes of the shortest drive; the last picture of a longer one is its end.
    """
    shortest = min(len(observations) for observations in drives.values())
    figure = new_figure(0.45 + ROW * len(drives))
    alt_parts = []
    for row, (label, observations) in enumerate(drives.items()):
        height = ROW / figure.get_figheight()
        ax = figure.add_axes((0.012, 0.01 + (len(drives) - 1 - row) * height, 0.976, height))
        ax.set(xlim=(-2.5, PICTURES * STEP - 2.9), ylim=(-1.4, 3.6), aspect="equal", anchor="W")
        ax.axis("off")
        ax.text(-2.5, 2.6, sentence(label), fontsize=TEXT, color=INK)
        states = np.asarray(observations) * checks.CARTPOLE_SCALES
        pushes = np.linspace(0, shortest - 1, PICTURES - 1).round().astype(int).tolist()
        for picture, t in enumerate(pushes + [len(states) - 1] * (len(states) > shortest)):
            _draw_cart(ax, states[t], STEP * picture, style(label).colour)
            ax.text(STEP * picture, -1.25, f"push {t + 1}", ha="center", fontsize=SMALL, color=QUIET)
        alt_parts.append(f"{label}: the episode lasts {len(states)} pushes")
    alt = f"A cart on a track and the pole on it, {PICTURES} pictures from the first push to the last"
    return finish(figure, title, f"{alt}. {'; '.join(alt_parts)}.")


def _draw_cart(ax, state: np.ndarray, x: float, colour: str) -> None:
    cart, angle = x + np.clip(state[0], -TRACK, TRACK), state[2]
    ax.plot([x - TRACK, x + TRACK], [-0.35, -0.35], color=QUIET, linewidth=1)
    ax.add_patch(Rectangle((cart - 0.6, -0.35), 1.2, 0.5, facecolor=INK))
    tip = (cart + POLE * np.sin(angle), 0.15 + POLE * np.cos(angle))
    ax.plot([cart, tip[0]], [0.15, tip[1]], color=colour, linewidth=3.5, solid_capstyle="round")
