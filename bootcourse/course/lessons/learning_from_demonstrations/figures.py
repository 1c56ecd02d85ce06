"""What the lesson on demonstrations draws: batches while β falls, and returns while the bonus is paid and after."""

from collections.abc import Sequence

import numpy as np
from matplotlib.figure import Figure
from matplotlib.patches import Rectangle

from bootcourse.episodes.evaluate import evaluate
from bootcourse.learn.bootstrap import demonstration_share
from bootcourse.learn.settings import Settings
from bootcourse.methods import style
from bootcourse.plots.figure import INK, QUIET, SMALL, TEXT, axes_at, finish, new_figure, plain_axes
from bootcourse.policies import rule_policy
from bootcourse.research.results import Results
from bootcourse.scenario import DEFAULT
from bootcourse.statistics import rolling_means

WINDOW, LAST = 50, 1200  # episodes: of which the returns are means, and until which they are drawn
STRIP = 25  # episodes of one shade
NO_BONUS = "#332288"
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


def returns(groups: dict[str, Results]) -> Figure:
    """The returns of groups of ten agents in their first training episodes; where a bonus is paid the ground is shaded.

    A thin line for each agent, a thick one for their mean, the mean of the first group in grey in each other panel.
    """
    title = "With less bonus, or none, the return leaves the rule's sooner"
    figure, rule, means = new_figure(3.6), evaluate(rule_policy(DEFAULT), 200, seed=8).returns.value, {}
    words = f"return without the bonus, mean of {WINDOW} episodes; thin: an agent, thick: all ten; grey: as on the left"
    figure.text(0.012, 1 - 0.42 / 3.6, words, fontsize=TEXT, color=INK, va="top")
    for column, (name, agents) in enumerate(groups.items()):
        start, ends, bonus = (agents.agents[0][which] for which in ("beta_start", "beta_episodes", "bonus"))
        at, each = rolling_means(agents.curves["return"], WINDOW)
        means[name], colour = each.mean(axis=0), style("bootstrapped").colour if bonus else NO_BONUS
        ax = axes_at(figure, 0.42 + 2.2 * column, 0.92, 2.03, 2.28)
        plain_axes(ax, "")
        for episode in range(0, ends if bonus else 0, STRIP):
            share = demonstration_share(episode, start, ends) / start
            ax.axvspan(episode, episode + STRIP, color=style("demos").colour, alpha=0.4 * share, linewidth=0)
        if bonus:
            ax.text(30, -17, "bonus paid", va="bottom", fontsize=SMALL, color=INK)
        ax.plot(at, each.T, color=colour, linewidth=0.7, alpha=0.5)
        ax.plot(at, next(iter(means.values())), color=QUIET, linewidth=1.4)
        ax.plot(at, means[name], color=colour, linewidth=2.4)
        ax.axhline(rule, color=QUIET, linewidth=1, linestyle=(0, (2, 2)))
        ax.text(LAST, rule - 2, "rule", ha="right", va="top", fontsize=SMALL, color=QUIET)
        ax.set_title(name, loc="left", fontsize=TEXT, color=INK, fontweight="bold", pad=5)
        ax.set(xlim=(0, LAST), ylim=(-20, 140), xticks=range(0, LAST, 300))
        ax.xaxis.set_major_formatter("{x:,g}")
        ax.tick_params(labelleft=not column)
        ax.set_xlabel("training episode", fontsize=SMALL, color=INK)
    at_these = {each: int(np.argmin(np.abs(at - each))) for each in (450, 900, 1050)}
    said = [f"{name}: " + ", ".join(f"{mean[i]:.0f}" for i in at_these.values()) for name, mean in means.items()]
    words = f"Three panels. Mean return near episodes {', '.join(f'{each:,}' for each in at_these)}: {'; '.join(said)}."
    return finish(figure, title, f"{words} The rule: {rule:.0f}.")
