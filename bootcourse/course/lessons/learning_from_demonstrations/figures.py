"""What the lesson on demonstrations draws: two drives' worth, critics' opinions, a margin, returns with a bonus."""

from collections.abc import Mapping, Sequence

import numpy as np
from matplotlib.figure import Figure

from bootcourse.course import charts
from bootcourse.course.lessons.learning_from_demonstrations.measures import Kinds, Opinion
from bootcourse.episodes.evaluate import evaluate
from bootcourse.episodes.rollout import Rollout
from bootcourse.learn.settings import settings_for
from bootcourse.methods import style
from bootcourse.panels.bonus import bonus_numbers
from bootcourse.plots.figure import INK, QUIET, SMALL, TEXT, finish, one_axes
from bootcourse.policies import rule_policy
from bootcourse.scenario import ACTION_NAMES, DEFAULT
from bootcourse.statistics import rolling_means


def worth(by_rule: Rollout, stays: Rollout, seconds: int = 60) -> Figure:
    """The discounted return of the rest of both drives, from each second on."""
    each = bonus_numbers(by_rule, stays, settings_for("bootstrapped"))
    named = {"rule": each.plain[:seconds], "idle, stays behind": each.trapped[:seconds]}
    title = "At first the rule's drive is worth less than staying behind, later more"
    label = "discounted return from this second on"
    return charts.lines(np.arange(seconds), named, title, "second of the drive", label)


def critics(named: Mapping[str, Opinion]) -> Figure:
    """Bars of the demonstrated action's Q, of the best other's and of the others' mean, for each critic."""
    figure, ax = one_axes(3.5, title := "The bonus raises Q, also that of the best other action", "", "mean Q")
    looks = {
        "demonstrated action": ("shown", style("demos").colour),
        "best other action": ("best", "#5F6B77"),
        "mean of the eight others": ("mean", "#B8BEC6"),
    }
    at = np.arange(len(named))
    for place, (words, (part, colour)) in enumerate(looks.items()):
        values = [getattr(each, part) for each in named.values()]
        bars = ax.bar(at + 0.27 * (place - 1), values, width=0.25, color=colour, label=words)
        ax.bar_label(bars, fmt="%.1f", fontsize=SMALL, color=INK, padding=1.5)
    ax.set_xticks(at, named, fontsize=TEXT)
    ax.legend(loc="upper right", frameon=False, fontsize=TEXT)
    parts = (f"{name}: {each.shown:.1f}, {each.best:.1f} and {each.mean:.1f}" for name, each in named.items())
    return finish(figure, title, f"Bars of the mean Q of the {', the '.join(looks)}. {'; '.join(parts)}.")


def margin_bars(q: Sequence[float], expert: int, margin: float = 1.0) -> Figure:
    """The Q of the nine actions, (9,), with the margin on all but the demonstrated one, whose bar is coloured."""
    q, others = np.asarray(q), np.arange(len(ACTION_NAMES)) != expert
    short, loss = q.max() - q[expert], (q + margin * others).max() - q[expert]
    title = f"The demonstrated action is {short:.1f} short of the largest Q: its loss is {loss:.1f}"
    figure, ax = one_axes(3.5, title, "", "Q", width=0.78)
    at, colour = np.arange(len(q)), style("demos").colour
    ax.bar(at, q, width=0.7, color=np.where(others, "#B8BEC6", colour))
    ax.bar(at[others], margin, width=0.7, bottom=q[others], color="none", edgecolor=QUIET, linestyle=(0, (2, 2)))
    for x, value in zip(at, q, strict=True):
        ax.annotate(f"{value:.1f}", (x, value + 0.03), ha="center", va="bottom", fontsize=SMALL, color=INK)
    for height, words in ((q.max(), "largest Q"), ((q + margin * others).max(), "largest Q\n+ margin")):
        ax.axhline(height, color=QUIET, linewidth=1, linestyle=(0, (1, 2)), zorder=0)
        end = (len(q) - 0.5, height)
        ax.annotate(words, end, (6, 0), textcoords="offset points", va="center", fontsize=TEXT, color=INK)
    ax.annotate("demon-\nstrated", (expert, q[expert] / 2), ha="center", va="center", fontsize=SMALL, color=INK)
    ax.set_xticks(at, [action.replace(" ", "\n") for action in ACTION_NAMES], fontsize=SMALL)
    ax.set(xlim=(-0.5, len(q) - 0.5), ylim=(0, 1.12 * (q + margin * others).max()))
    named = ", ".join(f"{action} {value:.1f}" for action, value in zip(ACTION_NAMES, q, strict=True))
    alt = f"Bars of Q: {named}. Demonstrated: {ACTION_NAMES[expert]}; all others have the margin of {margin:g} on top."
    return finish(figure, title, alt)


def returns(kinds: Kinds, episodes: int = 1000) -> Figure:
    """The mean return of the study's ten agents of three kinds with the soft constraint, while they train."""
    named = {}
    for words in ("demonstrations, c = 2", "demonstrations, c = 0", "no demonstrations"):
        at, each = rolling_means(kinds[words][0][0].curves["return"][:, :episodes], 50)
        named[words] = each.mean(axis=0)
    title = "With c = 2 the return stays near the rule's until about episode 500"
    looks = [charts.Style("#D55E00"), charts.Style("#332288", "--"), charts.Style("#56B4E9", ":")]
    rule = {"rule": evaluate(rule_policy(DEFAULT), 200, seed=8).returns.value}
    return charts.lines(at, named, title, "training episode", "mean return of ten agents", marks=rule, looks=looks)
