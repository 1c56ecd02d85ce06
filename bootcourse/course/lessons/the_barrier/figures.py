"""Figures of the barrier: how the teacher's share fades."""

import numpy as np
from matplotlib.figure import Figure

from bootcourse.learn.bootstrap import demonstration_share
from bootcourse.learn.settings import Settings
from bootcourse.methods import style
from bootcourse.plots.figure import QUIET, TEXT, finish, one_axes


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
