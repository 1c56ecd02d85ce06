"""Small figures that only a lesson needs; each shows one formula or one list of numbers."""

from collections.abc import Sequence

import numpy as np
from matplotlib.figure import Figure

from bootcourse.episodes.rollout import Rollout
from bootcourse.episodes.words import sentence
from bootcourse.learn.bootstrap import demonstration_share
from bootcourse.learn.settings import Settings
from bootcourse.methods import style
from bootcourse.plots.figure import INK, QUIET, TEXT, finish, new_figure, plain_axes
from bootcourse.road.formulas import speed_reward
from bootcourse.rule import SENTENCES, Reason
from bootcourse.scenario import ACTION_NAMES


def reward_curve(traps: float = 10.0, best: float = 15.0) -> Figure:
    """r_v against speed (m/s), with the traps' speed and the best one marked."""
    figure = new_figure(3.2)
    ax = figure.add_axes((0.08, 0.17, 0.88, 0.62))
    speeds = np.linspace(0, 20, 801)
    ax.plot(speeds, [speed_reward(v) for v in speeds], color=INK, linewidth=2)
    for v, words in ((traps, "behind the traps"), (best, "a free road")):
        ax.plot(v, speed_reward(v), "o", color=INK)
        text = f"{words}: {v:g} m/s pays {speed_reward(v):.2f}"
        ax.annotate(
            text,
            (v, speed_reward(v)),
            xytext=(-10, 8),
            textcoords="offset points",
            ha="right",
            fontsize=TEXT,
            color=INK,
        )
    plain_axes(ax, "speed term $r_v$ (no unit)")
    ax.set_xlabel("speed along the road (m/s)", fontsize=TEXT, color=INK)
    ax.set_xlim(0, 20)
    alt = (
        f"The speed term against speed: zero up to 5 m/s, rising slowly to 12.5 m/s, steeply to 1 at {best:g} m/s, and "
        f"almost zero from 17 m/s on. At {traps:g} m/s it is {speed_reward(traps):.2f}."
    )
    return finish(figure, "Most of the money lies between 12.5 and 15 m/s", alt)


def bars(probabilities: Sequence[float], title: str, label: str = "probability") -> Figure:
    """The nine actions' probabilities, or another share of each, (9,)."""
    figure = new_figure(3.0)
    ax = figure.add_axes((0.08, 0.3, 0.9, 0.48))
    drawn = ax.bar(range(len(ACTION_NAMES)), probabilities, color=style("rule").colour, width=0.7)
    ax.bar_label(drawn, [f"{p:.3f}" for p in probabilities], fontsize=TEXT, color=INK, padding=2)
    plain_axes(ax, label)
    ax.set_ylim(0, 1.1)
    ax.set_xticks(range(len(ACTION_NAMES)), [name.replace(" ", "\n") for name in ACTION_NAMES], fontsize=TEXT)
    ax.set_xlabel("action", fontsize=TEXT, color=INK)
    listed = ", ".join(f"{name} {p:.3f}" for name, p in zip(ACTION_NAMES, probabilities, strict=True))
    return finish(figure, title, f"Bars: {listed}.")


def histogram(values: np.ndarray, label: str, title: str) -> Figure:
    """How often each value occurs among the episodes, (n,)."""
    figure = new_figure(3.0)
    ax = figure.add_axes((0.08, 0.19, 0.88, 0.58))
    counts, _, _ = ax.hist(values, bins=40, color=style("rule").colour)
    ax.set_ylim(0, 1.2 * counts.max())
    ax.axvline(np.mean(values), color=INK, linestyle="--", linewidth=1)
    ax.annotate(f"mean {np.mean(values):.1f}", (np.mean(values), 0.91), xycoords=("data", "axes fraction"),
                xytext=(6, 0), textcoords="offset points", fontsize=TEXT, color=INK)  # fmt: skip
    plain_axes(ax, "episodes")
    ax.set_xlabel(label, fontsize=TEXT, color=INK)
    low, middle, high = np.percentile(values, [5, 50, 95])
    alt = f"A histogram of {len(values)} episodes: median {middle:.1f}, nine in ten between {low:.1f} and {high:.1f}."
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
    figure = new_figure(2.8)
    ax = figure.add_axes((0.08, 0.2, 0.6, 0.58))
    episodes = np.arange(most + 1)
    beta = demonstration_share(episodes, settings.beta_start, settings.beta_episodes)
    ax.plot(episodes, beta, color=style("demos").colour, linewidth=2)
    plain_axes(ax, "share of demonstrations in a batch, β")
    ax.set_xlabel("training episode", fontsize=TEXT, color=INK)
    ax.set_xlim(0, most)
    ax.set_ylim(0, 1)
    start, multiplier = settings.xi_multiplier * settings.alpha_init, settings.xi_multiplier
    words = f"ξ starts at {start:g}\nand shrinks with α:\nξ = {multiplier:g} α"
    figure.text(0.72, 0.62, words, fontsize=TEXT, color=QUIET, va="center")
    alt = f"β falls in a straight line from {settings.beta_start:g} to 0 at episode {settings.beta_episodes}."
    return finish(figure, "The teacher's share fades", alt)
