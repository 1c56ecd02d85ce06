"""Figures of discrete SAC: a pole as it is balanced, and soft values against the temperature."""

from collections.abc import Mapping, Sequence

import numpy as np
import torch
from matplotlib.figure import Figure
from matplotlib.patches import Rectangle

from bootcourse.course import charts
from bootcourse.episodes.words import sentence
from bootcourse.learn import sac
from bootcourse.methods import style
from bootcourse.plots.figure import INK, QUIET, SMALL, TEXT, finish, new_figure
from bootcourse.research.experiments.checks import CARTPOLE_SCALES

TRACK, POLE = 2.4, 1.8  # m: half the track; the pole as it is drawn
PICTURES, STEP, ROW = 8, 5.4, 0.85  # in a strip; from one to the next (m); a strip's height (inches)


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
        states = np.asarray(observations) * CARTPOLE_SCALES
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


def against_temperature(q: Sequence[float]) -> Figure:
    """Soft values of the sure, the even and the best policy over α, of a state whose actions have these Q."""
    title = f"Above α = {1 / np.log(2):.2f} the even policy is worth more than the sure one"
    values, temperatures = torch.tensor([q], dtype=torch.float64), np.linspace(0, 3, 31)
    worth = {name: [] for name in ("the sure policy", "the even policy", "the best policy")}
    for alpha in torch.tensor(temperatures):
        for name, logits in zip(worth, (1e9 * values, 0 * values, values / alpha.clamp(min=1e-9)), strict=True):
            worth[name].append(sac.soft_value(sac.log_policy(logits), values, alpha).item())
    return charts.lines(temperatures, worth, title, "temperature α", "soft value V")
