"""What the lesson on demonstrations draws: batches while β falls, and returns with and without the bonus."""

from collections.abc import Sequence

from matplotlib.figure import Figure
from matplotlib.patches import Rectangle

from bootcourse.course import charts
from bootcourse.course.lessons.learning_from_demonstrations.measures import Kinds
from bootcourse.episodes.evaluate import evaluate
from bootcourse.learn.bootstrap import demonstration_share
from bootcourse.learn.settings import Settings
from bootcourse.methods import style
from bootcourse.plots.figure import INK, TEXT, finish, new_figure
from bootcourse.policies import rule_policy
from bootcourse.scenario import DEFAULT
from bootcourse.statistics import rolling_means

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


def returns(kinds: Kinds, episodes: int = 1000) -> Figure:
    """The mean return of the study's ten agents of three kinds with the soft constraint, while they train."""
    named = {}
    for words in ("demonstrations, c = 2", "demonstrations, c = 0", "no demonstrations"):
        at, each = rolling_means(kinds[words][0][0].curves["return"][:, :episodes], 50)
        named[words] = each.mean(axis=0)
    title = "With c = 2 the return stays near the rule's until about episode 500"
    looks = [charts.Style("#D55E00"), charts.Style("#332288", "--"), charts.Style("#56B4E9", ":")]
    marks = {"rule": evaluate(rule_policy(DEFAULT), 200, seed=8).returns.value}
    label = "mean return of ten agents, without the bonus"
    return charts.lines(at, named, title, "training episode", label, marks=marks, looks=looks)
