"""CartPole as strips of pictures, for the lesson that meets it before the road."""

from collections.abc import Mapping

import numpy as np
from matplotlib.figure import Figure
from matplotlib.patches import Rectangle

from bootcourse.episodes.words import sentence
from bootcourse.methods import style
from bootcourse.plots.figure import INK, QUIET, SMALL, TEXT, finish, new_figure
from bootcourse.study.checks import CARTPOLE_SCALES

TRACK, POLE = 2.4, 1.8  # m: half the track; the pole as it is drawn
PICTURES, STEP, ROW = 8, 5.4, 0.85  # in a strip; from one to the next (m); a strip's height (inches)


def cartpole_strip(drives: Mapping[str, np.ndarray], title: str, every: int = 10) -> Figure:
    """Each drive as pictures from left to right, one every `every` decisions: {name: observations (T, 4)}.

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
        for picture, t in enumerate(range(0, PICTURES * every, every)):
            over = t >= len(states)
            _draw(ax, states[min(t, len(states) - 1)], STEP * picture, style(label).colour, over)
            ax.text(STEP * picture, -1.25, f"{t}" if not over else "over", ha="center", fontsize=SMALL, color=QUIET)
            if over:
                break
        told.append(f"{label}: the episode lasts {len(states)} decisions")
    return finish(figure, title, f"A cart on a track and the pole on it, every {every} decisions. {'; '.join(told)}.")


def _draw(ax, state: np.ndarray, x: float, colour: str, over: bool) -> None:
    cart, angle = x + np.clip(state[0], -TRACK, TRACK), state[2]
    ax.plot([x - TRACK, x + TRACK], [-0.35, -0.35], color=QUIET, linewidth=1)
    alpha = 0.35 if over else 1.0
    ax.add_patch(Rectangle((cart - 0.6, -0.35), 1.2, 0.5, facecolor=INK, alpha=alpha))
    tip = (cart + POLE * np.sin(angle), 0.15 + POLE * np.cos(angle))
    ax.plot([cart, tip[0]], [0.15, tip[1]], color=colour, linewidth=3.5, alpha=alpha, solid_capstyle="round")
