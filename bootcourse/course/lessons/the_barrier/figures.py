"""Figures of the barrier, and a table: when agents ended ahead while they learned, and how they drive in the end."""

from collections.abc import Mapping, Sequence

import numpy as np
from matplotlib.figure import Figure

from bootcourse.colours import TRAP
from bootcourse.course import table
from bootcourse.course.lessons.the_barrier import easier
from bootcourse.course.lessons.values import chain
from bootcourse.methods import style
from bootcourse.plots.figure import INK, QUIET, SMALL, TEXT, axes_at, finish, new_figure, plain_axes, wrapped
from bootcourse.research.results import Results
from bootcourse.statistics import ESCAPES

FAR, SOME, NOT = 2, 1, 0  # how far a learner got: its square is dark, light or empty
AGENTS = ("escapes, and earns more than a car that stays", "escapes, and earns less", "does not escape")
LEARNERS = ("learned to leave", "was on the free road, and did not learn to leave", "was not on the free road")
SHADES = {FAR: style("sac").colour, SOME: "#A9CFE6", NOT: "white"}


def escapes(trained: Mapping[str, Results], kinds: Mapping[str, str]) -> Figure:
    """How the agents of each kind of road end. kinds: {the row's name: the kind}."""
    title = "Cheap accidents free most agents with a start mid-lane, and none with a lane keeper"
    rows = {name: ends(trained[kind], easier.staying(kind)) for name, kind in kinds.items()}
    return squares({"": rows}, title, AGENTS, "has an accident on most roads", counted=(FAR, SOME))


def ends(results: Results, staying: float) -> list[tuple[int, bool]]:
    """Each agent for `squares`: whether it escapes and earns more than `staying`, and if it crashes on most roads."""
    success, earned, accident = (results.scores(name) for name in ("success", "returns", "accident"))
    far = np.where(success < ESCAPES, NOT, np.where(earned > staying, FAR, SOME))
    return list(zip(far.tolist(), (accident > 0.5).tolist(), strict=True))


def how_they_drive(agents: Sequence, tests: Sequence):
    """A table of how the lesson's agents drive, tests[i] of agents[i], and how many of them escape."""
    rows = []
    for settings, test in zip((agent.settings for agent in agents), tests, strict=True):
        accidents = test.collision.value + test.road_departure.value + test.stoppage.value
        shares = [f"{100 * share:.0f}" for share in (test.success.value, accidents)]
        rows.append([settings.gamma, *shares, f"{test.returns.value:.1f}"])
    won = sum(test.success.value >= ESCAPES for test in tests)
    below = f"{won} of {len(agents)} agents escape. "
    below += "In training they draw their actions; here they take the most probable ones."
    return table(["γ", "ends ahead, %", "accidents, %", "return"], rows, below=below)


def times_ahead(results: Results) -> np.ndarray:
    """How many drives each agent ended ahead while it learned, (agents,)."""
    return (results.curves["success"] > 0).sum(axis=1)


def while_they_learned(results: Results, chance: float) -> Figure:
    """When each agent ended a drive ahead while it learned: a row for each agent, a mark for each such drive.

    chance: that an agent would at least once, if all its actions were random.
    """
    times, ahead = times_ahead(results), results.scores("success")
    escaping = ahead >= ESCAPES
    title = f"{(times > 0).sum()} of {len(times)} agents ended ahead while they learned, "
    title += f"{(times == 1).sum()} of them once; {escaping.sum()} escapes"
    figure = new_figure(4.4)
    ax = axes_at(figure, 0.2, 0.75, 6.5, 2.85)
    plain_axes(ax, "agents", grid="")
    ax.set_xlabel("drives of an agent while it learned", fontsize=TEXT, color=INK)
    listed = []
    for row, k in enumerate(np.argsort(-times, kind="stable")):
        drives = results.curves["success"][k]
        ax.plot([0, np.isfinite(drives).sum()], [row, row], color=SHADES[SOME], linewidth=1.0)
        ax.plot(1 + np.flatnonzero(drives > 0), np.full(times[k], row), "|", color=SHADES[FAR], markersize=9)
        listed.append(f"{times[k]}")
        if ahead[k] >= 0.1:
            label = f"{100 * ahead[k]:.0f} %{': escapes' if escaping[k] else ''}"
            ax.text(np.isfinite(drives).sum() + 12, row, label, fontsize=TEXT, color=INK, va="center")
            listed[-1] += f" ({label})"
    ax.set(ylim=(len(times) - 0.3, -0.8), yticks=[])
    ax.set_xlim(left=0)
    words = f"A mark: a drive that ended ahead. If all actions were random, {len(times) * chance:.0f} of {len(times)} "
    words += "agents would have one in 400 drives.\n"
    words += "At a row's end: the share of the test roads on which the agent then ends ahead, where it is 10 % or more."
    figure.text(0.012, 0.015, words, fontsize=SMALL, color=QUIET)
    return finish(figure, title, f"{words}\nThe agents' drives that ended ahead: {', '.join(listed)}.")


def learners(all_q: Sequence[np.ndarray]) -> list[tuple[int, bool]]:
    """How far the chain's learners got, for `squares`."""
    return [(FAR if chain.leaves(q) else SOME if chain.has_been_free(q) else NOT, False) for q in all_q]


def squares(
    panels: Mapping[str, Mapping[str, Sequence[tuple[int, bool]]]],
    title: str,
    meaning: Sequence[str],
    crossed: str = "",
    counted: Sequence[int] = (FAR,),
) -> Figure:
    """A square for each learner, a row for each kind; the panels stand side by side and have the same kinds.

    panels: {name: {kind: (FAR, SOME or NOT, whether it is crossed out) of each learner}}, drawn in this order.
    meaning: of FAR, SOME and NOT; crossed: of the cross; counted: which of them the number beside a row counts.
    """
    first = next(iter(panels.values()))
    most, keys = max(map(len, first.values())), [*meaning, *([crossed] if crossed else [])]
    size, height = min(0.19, (4.4 - 0.8 * (len(panels) - 1)) / len(panels) / most), 0.29 * len(first)
    top = 0.34 + 0.2 * len(wrapped(title).splitlines()) + 0.16 * any(panels)
    figure, left, listed = new_figure(top + height + 0.2 + 0.19 * len(keys)), 1.75, []
    for name, rows in panels.items():
        ax = axes_at(figure, left, top, size * most, height)
        ax.set(xlim=(-0.5, most - 0.5), ylim=(len(rows) - 0.5, -0.5))
        ax.axis("off")
        ax.text(-0.5, -0.75, name, fontsize=TEXT, color=INK, va="bottom")
        for row, (kind, learners) in enumerate(rows.items()):
            for column, (far, cross) in enumerate(sorted(learners, key=lambda each: (-each[0], each[1]))):
                _square(ax, column, row, far, cross, 47 * size)
            dark, light = (sum(far == shade for far, _ in learners) for shade in (FAR, SOME))
            number = sum(far in counted for far, _ in learners)
            ax.text(most - 0.1, row, f"{number} of {len(learners)}", fontsize=TEXT, color=INK, va="center")
            if ax is figure.axes[0]:
                ax.text(-0.9, row, kind, fontsize=TEXT, color=INK, va="center", ha="right")
            listed.append(f"{name} {kind}: {dark} dark, {light} light, {len(learners) - dark - light} empty".strip())
            listed[-1] += f", {sum(cross for _, cross in learners)} crossed out" * bool(crossed)
        left += size * most + 0.75
    key = axes_at(figure, 1.75, top + height + 0.08, 0.19, 0.19 * len(keys))
    key.set(xlim=(-0.5, 0.5), ylim=(len(keys) - 0.5, -0.5))
    key.axis("off")
    marks = ((FAR, False), (SOME, False), (NOT, False), (NOT, True))
    for row, (mark, words) in enumerate(zip(marks, keys, strict=False)):
        _square(key, 0, row, *mark, 6.5)
        key.text(0.9, row, words, fontsize=SMALL, color=QUIET, va="center")
    legend = zip(("Dark", "Light", "Empty", "Crossed out"), keys, strict=False)
    legend = " ".join(f"{look}: {words}." for look, words in legend)
    return finish(figure, title, f"A square for each learner. {legend} {'; '.join(listed)}.")


def _square(ax, x: float, y: float, far: int, crossed: bool, size: float) -> None:
    ax.plot(x, y, "s", markersize=size, color=SHADES[far], markeredgecolor=QUIET, markeredgewidth=0.7, clip_on=False)
    if crossed:
        ink = "white" if far == FAR else TRAP
        ax.plot(x, y, "x", markersize=0.6 * size, color=ink, markeredgewidth=1.3, clip_on=False)
