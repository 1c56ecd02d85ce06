"""Figures of the barrier, and a table: when agents ended ahead while they learned, and how they drive in the end."""

from collections.abc import Mapping, Sequence

import numpy as np
from matplotlib.figure import Figure

from bootcourse.colours import PALE, TRAP
from bootcourse.course import table
from bootcourse.course.lessons.the_barrier import easier
from bootcourse.methods import style
from bootcourse.plots.figure import INK, QUIET, SMALL, TEXT, axes_at, finish, new_figure, plain_axes
from bootcourse.research.results import Results
from bootcourse.statistics import ESCAPES

DARK = style("sac").colour


def escapes(trained: Mapping[str, Results], shown: Mapping[str, Mapping[str, str]]) -> Figure:
    """Each agent's return over how often it ends ahead, a panel for each kind. shown: {row: {column: the kind}}."""
    figure, listed, ends = new_figure(4.95), [], {}
    for row, (price, kinds) in enumerate(shown.items()):
        for column, (road, kind) in enumerate(kinds.items()):
            ax = axes_at(figure, 0.95 + 3.0 * column, 0.95 + 1.68 * row, 2.8, 1.45)
            ends[kind] = counts = _dots(ax, trained[kind], easier.staying(kind))
            listed.append(f"{price}: " * (not column) + f"{road} {', '.join(map(str, counts))}")
            ax.set(xticklabels=ax.get_xticks() if row else [], yticklabels=[] if column else ax.get_yticks())
            ax.text(3, 97, f"escape: {counts[0]}, earn more: {counts[1]}", fontsize=SMALL, color=INK, fontweight="bold")
            if not row:
                ax.set_title(road, fontsize=TEXT, color=INK)
            if not column:
                left = {"rotation": 90, "ha": "center", "va": "center", "color": INK}
                ax.text(-26, 48, f"return if\n{price}", fontsize=TEXT, linespacing=1.4, **left)
            if not row + column:
                ax.text(45, 27, "staying", fontsize=SMALL, color=style("idle").colour)
            if row:
                ax.set_xlabel("ends ahead, % of the test roads", fontsize=TEXT, color=INK)
    escaping, earning, _ = ends[easier.BOTH]
    title = f"Cheap accidents and the free lane together: {escaping} of {len(trained[easier.BOTH])} escape, "
    title += f"{earning} earn more than by staying"
    words = f"Cross: an accident on most roads. Shaded, from {100 * ESCAPES:.0f} % on: escapes.\n"
    words += "Equal ones stand side by side. Earn more: ahead on some road, and more than by staying."
    figure.text(0.012, 0.015, words, fontsize=SMALL, color=QUIET)
    what = "Escape, earn more than by staying, crash on most roads:"
    return finish(figure, title, f"{words}\n{what} {'; '.join(listed)}.")


def _dots(ax, agents: Results, staying: float) -> tuple[int, int, int]:
    """Draw a kind's agents; how many escape, how many earn more than `staying` and are ahead somewhere, crash."""
    success, earned, accident = (agents.scores(name) for name in ("success", "returns", "accident"))
    out, crashing = success >= ESCAPES, accident > 0.5
    plain_axes(ax, "", grid="")
    ax.set(xlim=(-6, 106), ylim=(-16, 112), xticks=[0, 50, 100], yticks=[0, 50, 100])
    ax.axvspan(100 * ESCAPES, 106, color=PALE, alpha=0.45, linewidth=0)
    ax.axhline(staying, color=style("idle").colour, linestyle="--", linewidth=1.0)
    look = {"markersize": 5.5, "alpha": 0.75, "clip_on": False, "linestyle": ""}
    across = 100 * success + 1.2 * (earned.argsort().argsort() % 5 - 2)
    ax.plot(across[~crashing], earned[~crashing], "o", color=DARK, markeredgecolor="white", **look)
    ax.plot(across[crashing], earned[crashing], "x", color=TRAP, markeredgewidth=1.4, **look)
    return int(out.sum()), int(earning(agents, staying).sum()), int(crashing.sum())


def earning(agents: Results, staying: float) -> np.ndarray:
    """Which agents end ahead on some roads, and earn more than by staying."""
    return (agents.scores("success") > 0.01) & (agents.scores("returns") > staying)


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
        ax.plot([0, np.isfinite(drives).sum()], [row, row], color=PALE, linewidth=1.0)
        ax.plot(1 + np.flatnonzero(drives > 0), np.full(times[k], row), "|", color=DARK, markersize=9)
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
