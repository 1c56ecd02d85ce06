"""Figures of the barrier, and a table: what attempts to leave are worth, and how each learner drives in the end."""

from collections.abc import Mapping, Sequence

import numpy as np
from matplotlib.figure import Figure

from bootcourse.colours import TRAP
from bootcourse.course import table
from bootcourse.course.lessons.the_barrier import estimates
from bootcourse.course.lessons.the_barrier.attempts import Outcome
from bootcourse.course.lessons.the_barrier.explorable import NOW, SPEEDS
from bootcourse.course.lessons.values import chain
from bootcourse.methods import style
from bootcourse.plots.figure import INK, QUIET, SMALL, TEXT, axes_at, finish, new_figure, plain_axes, wrapped
from bootcourse.research.results import Results
from bootcourse.statistics import ESCAPES


def worth(outcomes: Mapping[str, Outcome]) -> Figure:
    """What each kind of attempt is worth at two discounts, beside the line of the one that "stays"; its accidents."""
    title = "At γ = 0.8 none of these pays as much as staying; at γ = 0.95 the plan and the rule's way pay more"
    kinds = [name for name in outcomes if name != "stays"]
    height, top = 0.3 * len(kinds), 1.0
    figure, listed = new_figure(top + height + 0.62), []
    for k, gamma in enumerate((0.8, 0.95)):
        ax = axes_at(figure, 2.2 + 2.05 * k, top, 1.85, height)
        plain_axes(ax, "", grid="x")
        values = [outcomes[name].values(gamma).mean() for name in kinds]
        stays = outcomes["stays"].values(gamma).mean()
        ax.axvline(stays, color=INK, linewidth=1.2, linestyle=(0, (4, 2)))
        ax.text(stays, -0.75, f"stays: {stays:.2f}", fontsize=TEXT, color=INK, ha="center", va="bottom")
        for row, (name, value) in enumerate(zip(kinds, values, strict=True)):
            ax.plot(value, row, "o", color=style("rule").colour if "rule" in name else QUIET, markersize=6)
            side, align = (-7, "right") if value < stays else (7, "left")
            look = {"ha": align, "va": "center", "fontsize": TEXT, "color": INK, "textcoords": "offset points"}
            ax.annotate(f"{value:.2f}".replace("-", "−"), (value, row), xytext=(side, 0), **look)
        ax.set_yticks(range(len(kinds)), kinds if k == 0 else [""] * len(kinds))
        ax.tick_params(axis="y", labelcolor=INK, labelsize=TEXT)
        ax.set_ylim(len(kinds) - 0.5, -0.6)
        room = np.ptp([stays, *values])
        ax.set_xlim(min(stays, *values) - 0.5 * room, max(stays, *values) + 0.4 * room)
        ax.set_xlabel(f"worth at γ = {gamma}", fontsize=TEXT, color=INK)
        listed.append(f"At γ = {gamma} staying is worth {stays:.2f}")
        listed += [f"{name}: {value:.2f}" for name, value in zip(kinds, values, strict=True)]
    shares = [f"{100 * outcomes[name].accident.mean():.0f} %" for name in kinds]
    for row, words in enumerate(["accidents", *shares]):
        high = 1 - (top + 0.3 * (row - 0.45) - 0.02 * (row == 0)) / figure.get_figheight()
        figure.text(0.985, high, words, fontsize=TEXT, color=INK, ha="right", va="center")
    words = f"Worth: the discounted sum of the rewards from the start, mean of {len(outcomes['stays'].ahead)} roads."
    figure.text(0.012, 0.06 / figure.get_figheight(), words, fontsize=SMALL, color=QUIET)
    return finish(figure, title, f"{'; '.join(listed)}. Accidents, in this order: {', '.join(shares)}.")


FAR, SOME, NOT = 2, 1, 0  # how far a learner got: its square is dark, light or empty
AGENTS = ("escapes: ends ahead on 95 % of the roads or more", "ends ahead on 10 % or more", "ends ahead on fewer")
LEARNERS = ("learned to leave", "was on the free road, and did not learn to leave", "was not on the free road")
SHADES = {FAR: style("sac").colour, SOME: "#A9CFE6", NOT: "white"}


def ends(results: Results, gamma: float) -> list[tuple[int, bool]]:
    """How the agents with this γ drive, for `squares`: how far they get, and whether they crash on most roads."""
    chosen = np.array([agent["gamma"] == gamma for agent in results.agents])
    success, accident = (results.scores(name)[chosen] for name in ("success", "accident"))
    far = np.where(success >= ESCAPES, FAR, np.where(success >= 0.1, SOME, NOT))
    return list(zip(far.tolist(), (accident > 0.5).tolist(), strict=True))


def escapes(trained: Mapping[str, Results], kinds: Sequence[str]) -> Figure:
    """How the agents of each of these kinds of road end, at each discount."""
    title = "From each of the easier roads few agents escape"
    panels = {}
    for kind in kinds:
        for gamma in sorted({agent["gamma"] for agent in trained[kind].agents}):
            panel = panels.setdefault(f"γ = {gamma}", {})
            name = "the road as it is" if kind == "as it is" else kind.split(", ")[-1]
            panel[name] = ends(trained[kind], gamma)
    return squares(panels, title, AGENTS, "has an accident on most roads")


def how_they_drive(agents: Sequence, tests: Sequence):
    """A table of how the lesson's agents drive, tests[i] of agents[i], and how many of them escape."""
    rows = []
    for settings, test in zip((agent.settings for agent in agents), tests, strict=True):
        accidents = test.collision.value + test.road_departure.value + test.stoppage.value
        shares = [f"{100 * share:.0f}" for share in (test.success.value, accidents)]
        rows.append([settings.gamma, settings.seed, *shares, f"{test.returns.value:.1f}"])
    won = sum(test.success.value >= ESCAPES for test in tests)
    below = f"{won} of {len(agents)} agents escape. "
    below += "In training they draw their actions; here they take the most probable ones."
    return table(["γ", "seed", "ends ahead, %", "accidents, %", "return"], rows, below=below)


def once_ahead(results: Results) -> np.ndarray:
    """Which agents ended a drive ahead while they learned, (agents,)."""
    return (results.curves["success"] > 0).any(axis=1)


def once_unhurt(results: Results) -> np.ndarray:
    """Which of them ended one ahead and without an accident, (agents,)."""
    return ((results.curves["success"] > 0) & (results.curves["accident"] == 0)).any(axis=1)


def while_they_learned(short: Results, long: Results, chance: float):
    """A table: how many agents, trained for as long as the lesson's or longer, ended ahead while they learned.

    chance: that an agent as short-lived as the lesson's would, if all its actions were random.
    """
    rows = []
    for name, agents in (("as long as in Round 1", short), ("longer, in the study", long)):
        unhurt = once_unhurt(agents).sum() if "accident" in agents.curves else "not recorded"
        rows.append([name, len(agents), once_ahead(agents).sum(), unhurt, agents.escapers("sac")])
    below = f"If each action were random, {len(short) * chance:.0f} of twenty would end ahead in 400 drives."
    return table(["trained", "agents", "ended ahead once or more", "unhurt", "escape in the end"], rows, below)


def expectations(agents: Sequence) -> Figure:
    """For each agent what it expects from each speed mid-lane, by its own Q, and what its drives are then worth."""
    expected, found = (np.array([of(agent) for agent in agents]) for of in (estimates.expected, estimates.found))
    less = expected[:, NOW + 2] < expected[:, NOW]
    more = less & (found[:, NOW + 2] > found[:, NOW])
    title = f"{less.sum()} of {len(agents)} agents expect less from {SPEEDS[NOW + 2]:g} m/s than from {SPEEDS[NOW]:g}; "
    title += f"for {more.sum()} of these it would be worth more"
    figure, alt, everything = new_figure(3.1), [], [*expected.ravel(), *found.ravel()]
    looks = {"its own Q": (SHADES[FAR], "-"), "what its drive is worth": (INK, (0, (4, 2)))}
    for k, lines in enumerate(zip(expected, found, strict=True)):
        ax = axes_at(figure, 0.45 + 1.65 * k, 1.0, 1.45, 1.35)
        plain_axes(ax, "")
        ax.set_xlabel("speed mid-lane, m/s", fontsize=SMALL, color=QUIET, loc="left")
        for (name, (colour, dash)), values in zip(looks.items(), lines, strict=True):
            ax.plot(SPEEDS, values, color=colour, linestyle=dash, linewidth=1.8, label=name)
            alt.append(f"agent {k}, {name}: {', '.join(f'{value:.1f}' for value in values)}")
        ax.set(xlim=SPEEDS[[0, -1]], ylim=(min(everything) - 0.5, max(everything) + 0.5), xticks=SPEEDS[::2])
        ahead = estimates.ahead(agents[k])
        ends = f"{'escapes' if ahead >= ESCAPES else 'does not escape'} ({100 * ahead:.0f} %)"
        ax.set_title(ends, fontsize=TEXT, color=INK, loc="left")
        alt.append(ends)
        if k:
            ax.set_yticklabels([])
    figure.axes[0].legend(fontsize=SMALL, frameon=False, loc="upper left", bbox_to_anchor=(-0.08, -0.32), ncols=2)
    figure.text(0.012, 0.79, f"worth at γ = {agents[0].settings.gamma:g}", fontsize=TEXT, color=QUIET)
    return finish(figure, title, f"At {SPEEDS[0]:g} to {SPEEDS[-1]:g} m/s. {'; '.join(alt)}.")


def learners(all_q: Sequence[np.ndarray]) -> list[tuple[int, bool]]:
    """How far the chain's learners got, for `squares`."""
    return [(FAR if chain.leaves(q) else SOME if chain.has_been_free(q) else NOT, False) for q in all_q]


def squares(
    panels: Mapping[str, Mapping[str, Sequence[tuple[int, bool]]]],
    title: str,
    meaning: Sequence[str],
    crossed: str = "",
) -> Figure:
    """A square for each learner, a row for each kind; the panels stand side by side and have the same kinds.

    panels: {name: {kind: (FAR, SOME or NOT, whether it is crossed out) of each learner}}, drawn in this order.
    meaning: of FAR, SOME and NOT; crossed: of the cross.
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
            ax.text(most - 0.1, row, f"{dark} of {len(learners)}", fontsize=TEXT, color=INK, va="center")
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
