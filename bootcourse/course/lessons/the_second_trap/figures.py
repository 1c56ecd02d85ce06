"""PPO's clipped loss, return against success, who gets ahead in training."""

from collections.abc import Mapping

import numpy as np
import torch
from matplotlib.figure import Figure

from bootcourse.course.lessons.the_second_trap.ppo_kinds import ROADS, agent_of, compared, settings_of
from bootcourse.course.lessons.the_second_trap.second_trap import speeds
from bootcourse.episodes.record import record
from bootcourse.episodes.rollout import Rollout, series
from bootcourse.learn.ppo import clipped_loss
from bootcourse.methods import style
from bootcourse.plots.figure import (
    INK,
    QUIET,
    SMALL,
    TEXT,
    axes_at,
    finish,
    new_figure,
    one_axes,
    plain_axes,
)
from bootcourse.plots.traces import traces
from bootcourse.statistics import ESCAPES

RATIOS = np.linspace(0.3, 1.7, 141)
POINTS = (0.5, 1.5)  # where a dot says what the gradient does


def plane(clone: tuple[float, float], trained: tuple[float, float]) -> Figure:
    """Where the return of each agent that ships, and its share of roads ahead, put it: a dot for each.

    clone, trained: (return, share ahead) of your agent before and after its training, joined by an arrow.
    """
    title = "After cloning, PPO gets out and earns far more than the rule"
    roads = f"mean return of an agent on {len(ROADS)} roads"
    figure, ax = one_axes(3.5, title, roads, "roads on which it ends ahead of trap 1, %")
    ax.set(xlim=(0, 125), ylim=(-8, 108))
    methods, alt = {"the rule": "rule", "keeping straight": "idle", "PPO after cloning": "ppo_cloned"}, []
    for name, (returns, ahead) in compared({"PPO alone": "alone", "PPO after cloning": "cloned"}).items():
        colour = style(methods.get(name, "ppo")).colour
        ax.scatter(returns, 100 * ahead, s=34, color=colour, edgecolors="white", linewidths=0.6, zorder=3)
        x, y = float(np.mean(returns)), 100 * float(np.mean(ahead))
        look = {"textcoords": "offset points", "ha": "center", "fontsize": TEXT, "color": INK}
        ax.annotate(name, (x, y), (0, 9 if y < 50 else -17), **look)
        alt.append(f"{name} ({len(returns)}): return {x:.0f}, ahead on {y:.0f} %")
    (x, y), (to_x, to_y) = ((returns, 100 * ahead) for returns, ahead in (clone, trained))
    ax.annotate("", (to_x, to_y), (x, y), arrowprops={"arrowstyle": "->", "color": INK, "linewidth": 1.2})
    ax.plot(x, y, "o", color="white", markeredgecolor=INK, ms=6, zorder=3)
    ax.plot(to_x, to_y, "o", color=INK, ms=6, zorder=4)
    ax.annotate("your clone", (x, y), (0, -15), textcoords="offset points", ha="center", fontsize=TEXT, color=INK)
    alt.append(f"your clone: return {x:.0f}, ahead on {y:.0f} %, then {to_x:.0f}, {to_y:.0f} %")
    return finish(figure, title, f"A dot for each agent. {'; '.join(alt)}.")


def speed_and_distance(drive: Rollout) -> Figure:
    """Its speed and how far it is ahead of trap 1 over time; named is where it is the furthest behind."""
    title = "This agent sprints and falls back, again and again, and does not pass trap 1"
    figure = traces(drive, title=title, what=("speed", "distance"))
    times, ahead = series(drive, "distance")
    lowest, ax = int(np.argmin(ahead)), figure.axes[1]
    words = f"{-ahead[lowest]:.0f} m behind"
    look = {"textcoords": "offset points", "ha": "right", "va": "center", "fontsize": SMALL, "color": INK}
    ax.annotate(words, (times[lowest], ahead[lowest]), (-24, 4), **look)
    ax.plot(times[lowest], ahead[lowest], "o", color=INK, ms=4, zorder=5)
    figure.alt += f" At {times[lowest]:.0f} s it is {words}."
    return figure


def hinges(clip: float) -> Figure:
    """PPO's loss in two panels, for a decision that turned out well (A = 2) and one that turned out badly (A = −2)."""
    title = "A good decision pushes until its action is 20 % likelier, a bad one until it is 20 % rarer"
    figure, colour, alt_parts = new_figure(3.4), style("ppo").colour, []
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
            alt_parts.append(f"A = {advantage:g}, ρ = {ratio:g}: {words}")
        plain_axes(ax, f"loss of a decision, A = {advantage:g}".replace("-", "−"))
        ax.set_xlabel("ratio ρ", fontsize=TEXT, color=INK)
        ax.margins(y=0.2)
    return finish(figure, title, f"The loss against the ratio. {'; '.join(alt_parts)}.")


def on_the_way(kinds: Mapping[str, Mapping[str, np.ndarray]]) -> Figure:
    """How many of the last 300 training drives got ahead of trap 1, while PPO learned: a line for each agent.

    kinds: the agents of PPO alone and after cloning, as `ppo_kinds.reference` returns them.
    """
    title = "Alone, few training drives get ahead and then none; after cloning, many from the start"
    below = "decisions in training (thousands); a line for each agent"
    figure, alt = new_figure(3.3), []
    look = {"textcoords": "offset points", "va": "center", "fontsize": TEXT}
    ax, close = (axes_at(figure, left, 0.95, width, 1.8) for left, width in ((0.5, 3.4), (4.35, 2.4)))
    for name, kind in {"PPO after cloning": "cloned", "PPO alone": "alone"}.items():
        at, shares = kinds[kind]["at"].T / 1000, 100 * kinds[kind]["escapes"].T
        colour = style("ppo_cloned" if kind == "cloned" else "ppo").colour
        for panel in (ax, close) if kind == "alone" else (ax,):
            panel.plot(at, shares, color=colour, linewidth=0.8, marker="o", ms=2.5, clip_on=False)
        at_end = float(at[-1].mean()), float(shares[-1].mean())
        ax.annotate(name, at_end, (8, 0) if kind == "cloned" else (-50, 12), color=colour, **look)
        spans = ", ".join(
            f"{shares[place].min():.0f} to {shares[place].max():.0f} % at {1000 * at[place].mean():,.0f}"
            for place in (0, 3, len(at) - 1)
        )
        alt.append(f"{name}: {spans}")
    for panel, what, most in (
        (ax, "ahead of trap 1, % of the last 300 drives", 100),
        (close, "PPO alone, to 10 %", 10),
    ):
        plain_axes(panel, what)
        panel.set(xlim=(0, 800), ylim=(0, most))
    ax.set_xlabel(below, fontsize=TEXT, color=INK)
    close.set_xlabel("decisions (thousands)", fontsize=TEXT, color=INK)
    return finish(figure, title, f"{below}. {'; '.join(alt)}.")


def by_lambda(kinds: Mapping[str, Mapping[str, np.ndarray]], road: int) -> Figure:
    """How far each agent of PPO alone swings its speed on a road, and what it earns: a panel for each λ.

    kinds: see `on_the_way`; the return is the mean on `ROADS`.
    """
    title = "With λ = 0.5 all ten keep straight; with 0.8 two sprint, and one gets out"
    figure, alt = new_figure(3.1), []
    straight = compared({})["keeping straight"][0].item()
    for place, kind in enumerate(("alone", "lambda-0.8", "lambda-0.5")):
        ax = axes_at(figure, 0.5 + 2.2 * place, 0.85, 1.85, 1.7)
        returns, out = kinds[kind]["returns"], kinds[kind]["success"] >= ESCAPES
        swings = [np.std(speeds(record(agent_of(kind, seed).as_policy(), [road])[0])) for seed in range(len(returns))]
        ax.axhline(straight, color=style("idle").colour, linewidth=1, linestyle=(0, (2, 2)), zorder=1)
        ax.scatter(swings, returns, s=30, color=style("ppo").colour, edgecolors="white", linewidths=0.6, zorder=3)
        lam = f"λ = {settings_of(kind).gae_lambda:g}"
        plain_axes(ax, f"return, {lam}")
        ax.set(xlim=(-0.3, 6), ylim=(0, 120))
        ax.set_xlabel("swing of the speed (SD), m/s", fontsize=TEXT, color=INK)
        look = {"textcoords": "offset points", "fontsize": SMALL, "color": INK}
        for swing, earned in zip(np.array(swings)[out], returns[out], strict=True):
            ax.annotate("gets out", (swing, earned), (6, -3), **look)
        if place == 0:
            ax.annotate("keeping straight", (5.9, straight), (0, -11), ha="right", **look)
        each = ", ".join(f"{swing:.1f}: {earned:.0f}" for swing, earned in sorted(zip(swings, returns, strict=True)))
        alt.append(f"{lam}: {each}, {int(out.sum())} gets out" if out.any() else f"{lam}: {each}")
    return finish(figure, title, f"A dot for each agent, SD of its speed and return. {'; '.join(alt)}.")
