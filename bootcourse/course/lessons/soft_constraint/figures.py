"""The pictures of the lesson on the soft constraint: ξ in a training, how twenty agents ended."""

from collections.abc import Sequence

import numpy as np
from matplotlib.figure import Figure

from bootcourse.colours import INK, Style
from bootcourse.course import shipped
from bootcourse.course.charts import lines
from bootcourse.course.dots import beside, dots, name_rows
from bootcourse.course.live_curves import LiveCurves
from bootcourse.learn.training import Training
from bootcourse.methods import style
from bootcourse.plots.figure import finish, one_axes
from bootcourse.statistics import lost


class LivePull(LiveCurves):
    """ξ over the episodes of each agent of a training, named by its target entropy η, while they learn."""

    def show(self, training: Training) -> None:
        if training.curves.finished.min() >= 2:  # a line has two points
            super().show(training)

    def draw(self, training: Training) -> Figure:
        done = min(int(training.curves.finished.min()), training.episodes)
        xi = training.curves.values["xi"][:, :done]
        targets = [f"η = {settings.target_entropy:g}".replace("-", "−") for settings in training.settings]
        now = " and ".join(f"{last:.2g} with {eta}" for eta, last in zip(targets, xi[:, -1], strict=True))
        looks = [Style(style("soft").colour), Style(INK)]
        named, title = dict(zip(targets, xi, strict=True)), f"After {done} episodes ξ is {now}"
        return lines(np.arange(1, done + 1), named, title, "episode", "ξ", logarithmic="y", looks=looks)


FADING = "ξ falls towards 0"  # the study's own agents with the soft constraint; the other kinds have one change


def twenty(kinds: Sequence[str]) -> Figure:
    """The return of each agent as a dot, a row for each kind of agents with the soft constraint, filled: it escapes.

    kinds: `FADING`, or names of ablations. Ten agents are the study's; ten others have other seeds, another
    implementation of the learner and twice the episodes.
    """
    changed = shipped.shipped_experiment("ablations") | {FADING: shipped.shipped_results().of("soft")}
    others = shipped.shipped_experiment("stress")
    title = "Where ξ falls to 0.1 and stays there, all twenty agents escape"
    figure, ax = one_axes(3.6, title, "", "")
    ax.set_position((0.17, 0.16, 0.62, 0.66))
    colour, alt = style("soft").colour, []
    for place, kind in enumerate(kinds):
        studies = changed[kind], others["soft" if kind == FADING else f"soft, {kind}"]
        returns = np.concatenate([each.scores("returns") for each in studies])
        found, kept = np.concatenate([each.found_and_kept("soft") for each in studies], axis=1)
        dots(ax, returns, place, colour, kept, bar=returns.mean())
        losing = np.concatenate([lost(each.of("soft").curves["success"]) for each in studies])
        counts = f"{found.sum()} find the way out,\n{losing.sum()} lose it in training,\n{kept.sum()} escape"
        beside(ax, place, counts)
        alt.append(f"{kind}: {counts}, mean return {returns.mean():.0f}, {returns.min():.0f} to {returns.max():.0f}")
    name_rows(ax, kinds, "return of an agent on 1,000 roads; filled: it escapes; bar: mean of twenty")
    return finish(figure, title, f"A dot for each agent. {'; '.join(alt)}.".replace("\n", " "))
