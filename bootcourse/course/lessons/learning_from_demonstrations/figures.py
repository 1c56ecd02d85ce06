"""What the lesson on demonstrations draws: batches while β falls, and returns with and without the bonus."""

from collections.abc import Sequence

import numpy as np
from matplotlib.figure import Figure
from matplotlib.patches import Rectangle

from bootcourse.course.lessons.learning_from_demonstrations.measures import Kinds
from bootcourse.episodes.evaluate import evaluate
from bootcourse.learn.bootstrap import demonstration_share
from bootcourse.learn.settings import Settings
from bootcourse.methods import style
from bootcourse.plots.figure import INK, QUIET, SMALL, TEXT, axes_at, finish, new_figure, plain_axes
from bootcourse.policies import rule_policy
from bootcourse.scenario import DEFAULT
from bootcourse.statistics import rolling_means

WINDOW = 50  # episodes, of which the returns are means
SIDE = 0.82  # of a row's box; the boxes stand 1 apart


def batches(settings: Settings, episodes: Sequence[int]) -> Figure:
    """The rows of one batch as boxes, after these training episodes: the demonstrated ones are coloured."""
    shares = [demonstration_share(each, settings.beta_start, settings.beta_episodes) for each in episodes]
    counts = [round(settings.batch * share) for share in shares]
    title = f"The rule's part of a batch falls from {counts[0]} of {settings.batch} rows to none"
    figure = new_figure(2.0)
    ax = figure.add_axes((0.17, 0.02, 0.81, 0.76))
    for row, (episode, share, count) in enumerate(zip(episodes, shares, counts, strict=True)):
        for i in range(settings.batch):
            colour = style("demos").colour if i < count else "#DDE1E6"
            ax.add_patch(Rectangle((i, -4 * row), SIDE, 2.2, color=colour, linewidth=0))
        words = f"episode {episode:,}\nβ = {share:.1f}"
        ax.text(-1, 1.1 - 4 * row, words, ha="right", va="center", fontsize=TEXT, color=INK)
    ax.set(xlim=(0, settings.batch), ylim=(-4 * len(episodes) + 3, 3))
    ax.axis("off")
    words = ", ".join(f"{count} at episode {episode:,}" for episode, count in zip(episodes, counts, strict=True))
    return finish(figure, title, f"A batch of {settings.batch} boxes, of which these are demonstrated: {words}.")


def returns(kinds: Kinds) -> Figure:
    """The returns of the study's ten agents of three kinds with the soft constraint, over their whole training.

    A thin line for each agent, a thick one for their mean; a vertical line where β reaches 0, if there is a β.
    """
    title = "With c = 2 the return stays near the rule's until about episode 500, and falls as β reaches 0"
    figure, rule = new_figure(3.6), evaluate(rule_policy(DEFAULT), 200, seed=8).returns.value
    words, means = f"return without the bonus, mean of {WINDOW} episodes; thin: an agent, thick: all ten", {}
    figure.text(0.012, 1 - 0.62 / 3.6, words, fontsize=TEXT, color=INK, va="top")
    for column, (name, colour) in enumerate(zip(kinds, ("#D55E00", "#332288", "#56B4E9"), strict=True)):
        agents = kinds[name][0][0]
        at, each = rolling_means(agents.curves["return"], WINDOW)
        means[name] = each.mean(axis=0)
        ax = axes_at(figure, 0.42 + 2.2 * column, 1.05, 2.03, 2.05)
        plain_axes(ax, "")
        ax.plot(at, each.T, color=colour, linewidth=0.7, alpha=0.5)
        ax.plot(at, means[name], color=colour, linewidth=2.4)
        ax.axhline(rule, color=QUIET, linewidth=1, linestyle=(0, (2, 2)))
        ax.text(at[-1], rule + 2, "rule", ha="right", va="bottom", fontsize=SMALL, color=QUIET)
        if agents.agents[0]["beta_start"]:
            ax.axvline(ends := agents.agents[0]["beta_episodes"], color=INK, linewidth=1)
            ax.text(ends + 30, -18, "β is 0", va="bottom", fontsize=SMALL, color=INK)
        ax.set_title(name, loc="left", fontsize=TEXT, color=INK, fontweight="bold", pad=5)
        ax.set(xlim=(0, at[-1]), ylim=(-20, 140), xticks=range(0, at[-1], 500))
        ax.xaxis.set_major_formatter("{x:,g}")
        ax.tick_params(labelleft=not column)
        ax.set_xlabel("training episode", fontsize=SMALL, color=INK)
    at_these = {each: int(np.argmin(np.abs(at - each))) for each in (420, 910, 1040, 2000)}
    said = [
        f"{name}: " + ", ".join(f"{mean[i]:.0f} at episode {each:,}" for each, i in at_these.items())
        for name, mean in means.items()
    ]
    return finish(figure, title, f"Three panels. Mean return of ten agents, {'; '.join(said)}. The rule: {rule:.0f}.")
