"""What two speeds in turn earn, PPO's clipped loss of one decision against its ratio, and the speeds of two drives."""

from collections.abc import Callable, Mapping

import numpy as np
import torch
from matplotlib.figure import Figure
from torch import Tensor

from bootcourse.colours import Style
from bootcourse.course.charts import lines
from bootcourse.course.lessons.the_second_trap.second_trap import speeds
from bootcourse.episodes.record import Rollout
from bootcourse.methods import style
from bootcourse.plots.figure import GRID, INK, QUIET, SMALL, TEXT, axes_at, finish, new_figure, one_axes, plain_axes
from bootcourse.scenario import DEFAULT

RATIOS = np.linspace(0.3, 1.7, 141)
POINTS = (0.5, 1.5)  # where a dot says what the gradient does


def convex(speed_reward: Callable[[float], float], title: str) -> Figure:
    """The speed reward of a steady speed, and of 5 and 15 m/s in turn with the same mean; dots at 10 m/s."""
    slow, mean, fast = 5.0, 10.0, 15.0
    v = np.linspace(slow, fast, 101)
    steady, turns = [speed_reward(each) for each in v], (v - slow) / (fast - slow)
    figure, ax = one_axes(3.6, title, "mean speed (m/s)", "speed reward of a second")
    ax.plot(v, turns, color=QUIET, linewidth=2, linestyle="--")
    ax.plot(v, steady, color=INK, linewidth=2)
    ax.set(xlim=(slow, fast), ylim=(-0.03, 1.03))
    values = speed_reward(mean), 0.5 * (speed_reward(slow) + speed_reward(fast))
    ax.plot([mean, mean], values, color=GRID, linewidth=1.5, zorder=1)
    for value, colour, side in zip(values, (INK, QUIET), ("left", "right"), strict=True):
        ax.plot(mean, value, "o", color=colour, ms=7, zorder=3)
        away = (7 if side == "left" else -7, -10 if side == "left" else 6)
        ax.annotate(f"{value:.2f}", (mean, value), away, textcoords="offset points", ha=side, color=colour)
    ax.text(7.6, 0.34, "5 and 15 m/s in turn", ha="right", fontsize=TEXT, color=QUIET)
    ax.text(11.6, 0.1, "a steady speed", fontsize=TEXT, color=INK)
    alt = f"At a mean of {mean:g} m/s a steady speed earns {values[0]:.2f}, {slow:g} and {fast:g} m/s {values[1]:.2f}"
    return finish(figure, title, f"The speed reward against the mean speed, from {slow:g} to {fast:g} m/s. {alt}.")


def hinges(clipped_loss: Callable[[Tensor, Tensor, float], Tensor], clip: float, title: str) -> Figure:
    """Two panels, for a decision that turned out well (A = 2) and one that turned out badly (A = −2)."""
    figure, colour, alt_parts = new_figure(3.7), style("ppo").colour, []
    for left, advantage in zip((0.5, 4.0), (2.0, -2.0), strict=True):
        ax = axes_at(figure, left, 1.0, 2.85, 1.9)
        losses = [clipped_loss(torch.tensor([r]), torch.tensor([advantage]), clip).item() for r in RATIOS]
        ax.plot(RATIOS, losses, color=colour, linewidth=2.2)
        for edge in (1 - clip, 1 + clip):
            ax.axvline(edge, color=QUIET, linewidth=1, linestyle=(0, (2, 2)), zorder=1)
        for ratio in POINTS:
            leaf = torch.tensor([ratio], requires_grad=True)
            loss = clipped_loss(leaf, torch.tensor([advantage]), clip)
            slope, height = torch.autograd.grad(loss.sum(), leaf)[0].item(), loss.item()
            words = "stays" if slope == 0 else "gets rarer" if slope > 0 else "gets likelier"
            ax.scatter([ratio], [height], color=colour, s=40, zorder=3)
            side = {"stays": "center", "gets likelier": "right", "gets rarer": "left"}[words]
            away = {"center": (0, 9), "right": (-7, -18), "left": (7, -18)}[side]
            look = {"textcoords": "offset points", "ha": side, "fontsize": SMALL, "color": INK}
            ax.annotate(words.replace(" ", "\n"), (ratio, height), away, **look)
            alt_parts.append(f"A = {advantage:g}, ρ = {ratio:g}: the action {words}")
        plain_axes(ax, f"loss of a decision, A = {advantage:g}".replace("-", "−"))
        ax.set_xlabel("ratio ρ", fontsize=TEXT, color=INK)
        ax.margins(y=0.2)
    words = "The ratio is above 1 where the action is likelier now than when it was taken."
    figure.text(0.012, 0.1 / figure.get_figheight(), words, fontsize=SMALL, color=INK)
    return finish(figure, title, f"The loss against the ratio. {'; '.join(alt_parts)}.")


def two_speeds(drives: Mapping[str, Rollout], title: str) -> Figure:
    """The speeds of a drive of PPO alone and of another one over time, and that of the traps."""
    named = {words: speeds(drive) for words, drive in drives.items()}
    seconds, looks = np.arange(1, 1 + max(map(len, named.values()))), (Style(style("ppo").colour), Style(QUIET))
    marks = {"the traps": DEFAULT.traps.speed}
    return lines(seconds, named, title, "time (s)", "speed (m/s)", marks=marks, looks=looks)
