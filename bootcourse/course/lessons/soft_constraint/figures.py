"""The pictures of the lesson on the soft constraint: trainings, and how they ended."""

from collections.abc import Sequence
from functools import cache

import numpy as np
from matplotlib.figure import Figure

from bootcourse.colours import ALARM, INK, QUIET
from bootcourse.course import shipped
from bootcourse.course.dots import beside, dots, name_rows
from bootcourse.course.live_curves import LiveWayOut
from bootcourse.learn.training import Training
from bootcourse.methods import style
from bootcourse.plots.figure import SMALL, axes_at, finish, new_figure, one_axes, plain_axes
from bootcourse.research.report import rule_results
from bootcourse.scenario import DEFAULT
from bootcourse.statistics import IN_A_ROW, found_after, lost, rolling_means

PENALTY = "with penalty", "without"


@cache
def ways_out() -> list[np.ndarray]:
    """The episodes after which the study's agents found the way out, (10,): those with the value penalty, and without.

    Each of them found it.
    """
    without = shipped.shipped_experiment("ablations")["KL in the actor only"]
    return [found_after(each.of("soft").curves["success"]) for each in (shipped.shipped_results(), without)]


class LivePenalty(LiveWayOut):
    """Two agents while they learn, the first with the value penalty; below, when the study's found the way out."""

    def __init__(self):
        looks = dict(zip(PENALTY, (style("soft").colour, INK), strict=True))
        trained = dict(zip(PENALTY, zip(looks.values(), ways_out(), strict=True), strict=True))
        super().__init__(looks, trained, "one of the study's ten agents")

    def draw(self, training: Training) -> Figure:
        """The title says what the dots show: one agent of each kind learns, and ten have learned."""
        figure, (then, first) = super().draw(training), ways_out()
        if first.max() >= then.min():
            return figure
        return finish(figure, "Without the value penalty all ten find the way out earlier", figure.alt)


FADING = "ξ falls towards 0"  # the study's own agents with the soft constraint; the other kinds have one change


FLOOR = "ξ falls to 0.1"

# of those of `twenty`
PULLS = "strong throughout", "weak throughout", "strong, then none", "strong, then weak"


def courses(kinds: Sequence[str]) -> Figure:
    """For each kind above ξ, below the success in training of its ten agents. kinds: `FADING` and `FLOOR`.

    An agent of `FADING` is that of `FLOOR` until ξ reaches 0.1; from there on its ξ is not kept.
    """
    changed = shipped.shipped_experiment("ablations") | {FADING: shipped.shipped_results().of("soft")}
    figure, blue, alt = new_figure(4.1), style("soft").colour, []
    xi = changed[FLOOR].of("soft").curves["xi"].mean(0)
    until = np.argmax(xi <= 0.101)
    for column, kind in enumerate(kinds):
        success = changed[kind].of("soft").curves["success"]
        losers = f"{lost(success).sum()} of {len(success)} lose the way out"
        left = 0.6 + 3.25 * column
        above, below = axes_at(figure, left, 0.72, 2.95, 0.6), axes_at(figure, left, 1.72, 2.95, 1.75)
        plain_axes(above, f"{kind}: {losers}")
        shown = xi[:until] if kind == FADING else xi
        above.plot(np.arange(len(shown)), shown, color=blue, linewidth=2)
        if kind == FADING:
            arrow = {"arrowstyle": "->", "color": blue, "linewidth": 2, "shrinkB": 0}
            above.annotate("", (until + 190, 0.03), (until, 0.1), arrowprops=arrow)
        above.set(yscale="log", ylim=(0.02, 3))
        above.set_yticks((0.1, 2), ("0.1", "2"))
        if not column:
            above.text(success.shape[1], 0.5, "ξ (logarithmic)", fontsize=SMALL, color=INK, ha="right")
        above.minorticks_off()
        episodes, share = rolling_means(success, IN_A_ROW, success.shape[1])
        plain_axes(below, "" if column else f"of the last {IN_A_ROW} training episodes, ended ahead")
        for line, losing in zip(IN_A_ROW * share, lost(success), strict=True):
            look = {"color": ALARM, "zorder": 3} if losing else {"color": blue}
            below.plot(episodes, line, linewidth=0.9, alpha=0.7, **look)
        below.set(ylim=(0, IN_A_ROW + 1))
        words = "training episode" + "; an agent is red if it loses the way out" * (not column)
        below.set_xlabel(words, fontsize=SMALL, color=INK)
        for ax in (above, below):
            ax.set(xlim=(0, success.shape[1]), xticks=(500, 1000, 1500))
            ax.tick_params(labelleft=not column, labelbottom=ax is below)
        alt.append(f"{kind}: {losers}, at last {IN_A_ROW * share[:, -1].mean():.0f} are ahead on average")
    title = "With a floor under ξ no agent loses the way out"
    return finish(figure, title, f"Of {IN_A_ROW} training episodes in a row, ended ahead. {'; '.join(alt)}.")


def twenty(kinds: Sequence[str]) -> Figure:
    """The return of each agent as a dot, a row for each kind of pull, filled: it escapes. The last kind stands out.

    kinds: `FADING`, or names of ablations. Ten agents are the study's; ten others have other seeds, another
    implementation of the learner and twice the episodes.
    """
    changed = shipped.shipped_experiment("ablations") | {FADING: shipped.shipped_results().of("soft")}
    others = shipped.shipped_experiment("stress")
    title = "With a pull that is strong, then weak, all twenty escape, fast"
    figure, ax = one_axes(3.6, title, "", "")
    ax.set_position((0.2, 0.16, 0.62, 0.66))
    rule, green = rule_results(DEFAULT, changed[kinds[0]].sizes[0]).scores("returns").mean(), style("rule").colour
    alt = []
    for place, (kind, pull) in enumerate(zip(kinds, PULLS, strict=True)):
        colour = style("soft").colour if kind == FLOOR else QUIET
        studies = changed[kind], others["soft" if kind == FADING else f"soft, {kind}"]
        returns = np.concatenate([each.scores("returns") for each in studies])
        kept = np.concatenate([each.found_and_kept("soft")[1] for each in studies])
        dots(ax, returns, place, colour, kept)
        fast = f"{(kept & (returns > 2 * rule)).sum()} of {len(kept)}"
        beside(ax, place, fast)
        alt.append(f"{pull} ({kind}): {fast}")
    names = [f"{pull}:\n{kind}" for pull, kind in zip(PULLS, kinds, strict=True)]
    name_rows(ax, names, "return of an agent on 1,000 roads; filled: it escapes")
    beside(ax, -0.62, "escape, fast")
    for times, words in ((1, "the rule"), (2, "twice: fast")):
        ax.axvline(times * rule, color=green, linewidth=1.2, linestyle=(0, (4, 3)), zorder=1)
        ax.text(times * rule, -0.55, words, color=green, fontsize=SMALL, ha="center", va="bottom")
    words = f"Agents that escape and return more than twice the rule's {rule:.0f}: {'; '.join(alt)}."
    return finish(figure, title, words)
