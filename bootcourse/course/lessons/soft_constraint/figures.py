"""The pictures of the lesson on the soft constraint: trainings, and how they ended."""

from collections.abc import Sequence
from functools import cache

import numpy as np
from matplotlib.figure import Figure

from bootcourse.colours import INK, QUIET
from bootcourse.course import shipped
from bootcourse.course.dots import beside, dots, name_rows
from bootcourse.course.live_curves import LiveCurves
from bootcourse.learn.training import Training
from bootcourse.methods import style
from bootcourse.plots.figure import SMALL, axes_at, finish, label_ends, new_figure, one_axes, plain_axes
from bootcourse.research.report import rule_results
from bootcourse.scenario import DEFAULT
from bootcourse.statistics import IN_A_ROW, found_after, rolling_means

PENALTY = "with the value penalty", "without it"


@cache
def ways_out() -> list[np.ndarray]:
    """The episodes after which the study's agents found the way out, (10,): those with the value penalty, and without.

    Each of them found it.
    """
    without = shipped.shipped_experiment("ablations")["KL in the actor only"]
    return [found_after(each.of("soft").curves["success"]) for each in (shipped.shipped_results(), without)]


class LivePenalty(LiveCurves):
    """Of the last 50 episodes, how many two agents end ahead, while they learn; below, when the study's found the way.

    The first agent has the value penalty, the second has not.
    """

    def show(self, training: Training) -> None:
        if training.curves.finished.min() >= 2:  # a line has two points
            super().show(training)

    def draw(self, training: Training) -> Figure:
        done = min(int(training.curves.finished.min()), training.episodes)
        ahead = np.cumsum(training.curves.values["success"][:, :done], axis=1)
        ahead[:, IN_A_ROW:] -= ahead[:, :-IN_A_ROW].copy()
        title = f"Ahead in the last {min(done, IN_A_ROW)} episodes: {ahead[0, -1]:.0f} {PENALTY[0]}, "
        title += f"{ahead[1, -1]:.0f} {PENALTY[1]}"
        figure, looks = new_figure(4.0), (style("soft").colour, INK)
        ax, below = axes_at(figure, 1.6, 0.9, 3.7, 1.4), axes_at(figure, 1.6, 2.65, 3.7, 0.7)
        plain_axes(ax, f"of the last {IN_A_ROW} training episodes, ended ahead: one agent each")
        for line, colour in zip(ahead, looks, strict=True):
            ax.plot(np.arange(1, done + 1), line, color=colour, linewidth=2)
        ax.axhline(IN_A_ROW / 2, color=QUIET, linewidth=1, linestyle=(0, (2, 2)), zorder=1)
        ax.set(xlim=(0, 400), ylim=(0, IN_A_ROW))
        ends = [(line[-1], words, colour) for line, words, colour in zip(ahead, PENALTY, looks, strict=True)]
        label_ends(ax, [*ends, (IN_A_ROW / 2, "above: it finds the way out", QUIET)])
        for place, (episodes, colour) in enumerate(zip(ways_out(), looks, strict=True)):
            dots(below, episodes, place, colour)
        name_rows(below, PENALTY, "episode; a dot: one of the study's ten agents finds the way out")
        below.set_xlim(0, 400)
        found = (f"{words} after {each.min()} to {each.max()} episodes"
                 for words, each in zip(PENALTY, ways_out(), strict=True))  # fmt: skip
        alt = f"Two lines over {done} episodes. The study's ten agents find the way out {', '.join(found)}."
        return finish(figure, title, alt)


FADING = "ξ falls towards 0"  # the study's own agents with the soft constraint; the other kinds have one change


FLOOR = "ξ falls to 0.1"


FAULTS = "slow", "not found by all", "lost again"  # of the kinds of `courses`


def courses(kinds: Sequence[str]) -> Figure:
    """For each kind above ξ, below the success in training of its ten agents. kinds: as in `twenty`.

    An agent of `FADING` is that of `FLOOR` until ξ reaches 0.1; from there on its ξ is not kept.
    """
    changed = shipped.shipped_experiment("ablations") | {FADING: shipped.shipped_results().of("soft")}
    figure, looks, alt = new_figure(4.5), (QUIET, INK, style("soft").colour), []
    for column, (kind, fault, colour) in enumerate(zip(kinds, FAULTS, looks, strict=True)):
        success = changed[kind].of("soft").curves["success"]
        left = 0.5 + 2.1 * column
        above, below = axes_at(figure, left, 0.95, 1.9, 0.75), axes_at(figure, left, 2.15, 1.9, 1.7)
        earned = changed[kind].of("soft").scores("returns").mean()
        plain_axes(above, f"{kind}:\n{fault} (return {earned:.0f})")
        xi = changed[FLOOR if kind == FADING else kind].of("soft").curves["xi"].mean(0)
        until = np.argmax(xi <= 0.101) if kind == FADING else len(xi)
        above.plot(np.arange(until), xi[:until], color=colour, linewidth=2)
        if kind == FADING:
            arrow = {"arrowstyle": "->", "color": colour, "linewidth": 2, "shrinkB": 0}
            above.annotate("", (until + 190, 0.03), (until, 0.1), arrowprops=arrow)
            above.text(until + 240, 0.03, "towards 0", va="center", fontsize=SMALL, color=colour)
        above.set(yscale="log", ylim=(0.02, 3))
        above.set_yticks((0.1, 1, 2), ("0.1", "1", "2"))
        above.minorticks_off()
        episodes, share = rolling_means(success, IN_A_ROW, success.shape[1])
        plain_axes(below, "" if column else f"of the last {IN_A_ROW} training episodes (actions drawn), ended ahead")
        below.plot(episodes, IN_A_ROW * share.T, color=colour, linewidth=0.8, alpha=0.7)
        below.axhline(IN_A_ROW / 2, color=QUIET, linewidth=1, linestyle=(0, (2, 2)), zorder=1)
        below.set(ylim=(0, IN_A_ROW + 1))
        below.set_xlabel("training episode", fontsize=SMALL, color=INK)
        for ax in (above, below):
            ax.set(xlim=(0, success.shape[1]), xticks=(500, 1000, 1500))
            ax.tick_params(labelleft=not column, labelbottom=ax is below)
        ahead = f"at last {IN_A_ROW * share[:, -1].mean():.0f} on average"
        alt.append(f"{kind}: {fault}, {ahead}, return in the test {earned:.0f}")
    rule = rule_results(DEFAULT, changed[kinds[0]].sizes[0]).scores("returns").mean()
    words = f"above: mean ξ of ten agents; below: a line for each; return: mean in the test (the rule: {rule:.0f})"
    figure.text(0.012, 0.1 / figure.get_figheight(), words, fontsize=SMALL, color=INK)
    title = f"Each kind has a fault: {', '.join(FAULTS[:-1])}, or {FAULTS[-1]}"
    return finish(figure, title, f"Of {IN_A_ROW} training episodes in a row, ended ahead. {'; '.join(alt)}.")


def twenty(kinds: Sequence[str]) -> Figure:
    """The return of each agent as a dot, a row for each kind of agents with the soft constraint, filled: it escapes.

    kinds: `FADING`, or names of ablations. Ten agents are the study's; ten others have other seeds, another
    implementation of the learner and twice the episodes.
    """
    changed = shipped.shipped_experiment("ablations") | {FADING: shipped.shipped_results().of("soft")}
    others = shipped.shipped_experiment("stress")
    title = "Where ξ falls to 0.1 and stays there, all twenty escape, fast"
    figure, ax = one_axes(3.6, title, "", "")
    ax.set_position((0.17, 0.16, 0.62, 0.66))
    colour, alt = style("soft").colour, []
    for place, kind in enumerate(kinds):
        studies = changed[kind], others["soft" if kind == FADING else f"soft, {kind}"]
        returns = np.concatenate([each.scores("returns") for each in studies])
        kept = np.concatenate([each.found_and_kept("soft")[1] for each in studies])
        dots(ax, returns, place, colour, kept, bar=returns.mean())
        counts = f"{kept.sum()} of {len(kept)} escape"
        beside(ax, place, counts)
        alt.append(f"{kind}: {counts}, mean return {returns.mean():.0f}, {returns.min():.0f} to {returns.max():.0f}")
    name_rows(ax, kinds, "return of an agent on 1,000 roads; filled: it escapes; bar: mean of twenty")
    rule, green = rule_results(DEFAULT, changed[kinds[0]].sizes[0]).scores("returns").mean(), style("rule").colour
    for times, words in ((1, "the rule"), (2, "twice: fast")):
        ax.axvline(times * rule, color=green, linewidth=1.2, linestyle=(0, (4, 3)), zorder=1)
        ax.text(times * rule, -0.55, words, color=green, fontsize=SMALL, ha="center", va="bottom")
    words = f"A dot for each agent. {'; '.join(alt)}. The rule: {rule:.0f}."
    return finish(figure, title, words)
