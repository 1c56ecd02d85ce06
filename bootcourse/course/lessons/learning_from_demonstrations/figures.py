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


def returns(groups: dict[str, Results], others: dict[str, Results]) -> Figure:
    """The returns of groups of ten agents in their first training episodes, and below them how often they succeed.

    A thin line for each agent, a thick one for their mean, the mean of the first group in grey in each other panel;
    dotted: of ten others. Where a bonus is paid the ground is shaded.
    """
    title = "With less bonus, or none, the return leaves the rule's sooner, and success falls sooner"
    figure, rule, means = new_figure(5.5), evaluate(rule_policy(DEFAULT), 200, seed=8).returns.value, {}
    words = f"means of {WINDOW} episodes; thin: an agent, thick: all ten; grey: as on the left; dotted: ten others"
    figure.text(0.012, 1 - 0.66 / 5.5, words, fontsize=TEXT, color=INK, va="top")
    for column, (name, agents) in enumerate(groups.items()):
        start, ends, bonus = (agents.agents[0][which] for which in ("beta_start", "beta_episodes", "bonus"))
        at, each = rolling_means(agents.curves["return"], WINDOW)
        means[name], colour = each.mean(axis=0), style("bootstrapped").colour if bonus else NO_BONUS
        above, below = (
            axes_at(figure, 0.42 + 2.2 * column, top, 2.03, tall) for top, tall in ((1.2, 2.1), (3.72, 1.2))
        )
        plain_axes(above, "" if column else "return without the bonus")
        plain_axes(below, "" if column else "succeed, %")
        for episode in range(0, ends if bonus else 0, STRIP):
            share = demonstration_share(episode, start, ends) / start
            for ax in (above, below):
                ax.axvspan(episode, episode + STRIP, color=style("demos").colour, alpha=0.4 * share, linewidth=0)
        if bonus:
            above.text(30, -17, "bonus paid", va="bottom", fontsize=SMALL, color=INK)
        above.plot(at, each.T, color=colour, linewidth=0.7, alpha=0.5)
        above.plot(at, next(iter(means.values())), color=QUIET, linewidth=1.4)
        above.plot(at, means[name], color=colour, linewidth=2.4)
        above.axhline(rule, color=QUIET, linewidth=1, linestyle=(0, (2, 2)))
        above.text(LAST, rule - 2, "rule", ha="right", va="top", fontsize=SMALL, color=QUIET)
        above.set_title(name, loc="right", fontsize=TEXT, color=INK, fontweight="bold", pad=18)
        for some, look in ((agents, "-"), (others.get(name), ":")):
            if some is not None:
                when, succeed = rolling_means(some.curves["success"], WINDOW)
                wide = 2.4 if look == "-" else 1.4
                below.plot(when, 100 * succeed.mean(axis=0), color=colour, linewidth=wide, linestyle=look)
        above.set(xlim=(0, LAST), ylim=(-20, 140), xticks=range(0, LAST, 300))
        below.set(xlim=(0, LAST), ylim=(0, 104), xticks=range(0, LAST, 300), yticks=(0, 50, 100))
        above.tick_params(labelleft=not column, labelbottom=False)
        below.tick_params(labelleft=not column)
        below.xaxis.set_major_formatter("{x:,g}")
        below.set_xlabel("training episode", fontsize=SMALL, color=INK)
    at_these = {each: int(np.argmin(np.abs(at - each))) for each in (450, 900, 1050)}
    said = [f"{name}: " + ", ".join(f"{mean[i]:.0f}" for i in at_these.values()) for name, mean in means.items()]
    words = f"Three panels. Mean return near episodes {', '.join(f'{each:,}' for each in at_these)}: {'; '.join(said)}."
    return finish(figure, title, f"{words} The rule: {rule:.0f}.")
