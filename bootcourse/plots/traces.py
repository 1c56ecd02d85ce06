"""A drive over time: speed, place, reward and actions below each other, for one drive or several."""

from collections.abc import Sequence

import numpy as np
from matplotlib.figure import Figure
from matplotlib.patheffects import withStroke
from matplotlib.ticker import MaxNLocator

from bootcourse.colours import ALARM, GRID, INK, QUIET, TRAP, Style
from bootcourse.episodes.rollout import Rollout, series
from bootcourse.episodes.words import ACCIDENTS, outcome, overtaken, sentence
from bootcourse.errors import BootcourseError, check_known
from bootcourse.methods import display_name
from bootcourse.plots.figure import (
    SMALL,
    TEXT,
    WIDTH,
    axes_at,
    finish,
    in_front,
    label_ends,
    new_figure,
    plain_axes,
    styles,
    wrapped,
)
from bootcourse.plots.svg import number
from bootcourse.road.state import SPEED, TRAP_1, Accident

# What can be drawn: the label above the panel, and the panel's height in inches.
PANELS = {
    "speed": ("speed (m/s)", 1.15),
    "distance": ("distance ahead of trap 1 (m)", 1.15),
    "lane": ("lane (0 is the leftmost)", 0.75),
    "reward": ("reward of each decision", 0.95),
    "return": ("return so far (sum of the rewards)", 1.15),
    "action": ("actions", 0.56),
}
LEFT, RIGHT, HEAD, LINE, FOOT, GAP = 0.75, 1.3, 0.36, 0.2, 0.5, 0.34  # inches; LINE for each line of the title
HALO = [withStroke(linewidth=2.5, foreground="white")]  # around words on a line
FARTHEST = 100.0  # m; beyond it the overtaking would become a dot at the bottom


def traces(
    rollouts: Rollout | Sequence[Rollout], title: str | None = None, what: Sequence[str] = tuple(PANELS)
) -> Figure:
    """Speed, distance ahead of trap 1, lane, reward, return and actions over time, in the drivers' colours.

    what: the panels, from `PANELS`. An accident is a red cross. Raises BootcourseError if there is no drive, or no
    panel.
    """
    drives = [rollouts] if isinstance(rollouts, Rollout) else list(rollouts)
    panels = _panels(drives, what)
    names, looks = _names(drives), _looks(drives)
    title = title or _title(drives, names)
    figure, axes = _stacked([PANELS[panel][1] for panel, _ in panels], HEAD + LINE * len(wrapped(title).splitlines()))
    end = max(drive.times[-1] for drive in drives)
    for ax, (panel, i) in zip(axes, panels, strict=True):
        plain_axes(ax, PANELS[panel][0] if i is None else f"actions: {names[i]}")
        ax.set_xlim(0, end)
        if i is None:
            _draw_panel(ax, panel, drives, looks)
        else:
            _draw_actions(ax, drives[i], looks[i].colour)
            ax.yaxis.label.set_color(looks[i].colour)
        ax.tick_params(axis="x", labelbottom=ax is axes[-1])
    if panels[0][1] is None:
        _write_names(axes[0], panels[0][0], drives, names, looks)
    axes[-1].set_xlabel("time (s)", fontsize=TEXT, color=INK)
    drawn = ", ".join(panel for panel in PANELS if panel in what)
    return finish(figure, title, f"Over {end:g} s, below each other: {drawn}. {_stories(drives, names, title)}")


def _panels(drives: list[Rollout], what: Sequence[str]) -> list[tuple[str, int | None]]:
    """The panels from above: (name, the drive whose actions it has, None for all drives)."""
    if not drives:
        raise BootcourseError("There is no drive to draw: give a rollout, or a list of them.")
    for panel in what:
        check_known("Panel", panel, PANELS)
    panels = [(panel, None) for panel in PANELS if panel in what and panel != "action"]
    panels += [("action", i) for i in range(len(drives)) if "action" in what]
    if not panels:
        raise BootcourseError(f"There is nothing to draw: name one or more of {', '.join(PANELS)}.")
    return panels


def _stacked(heights: Sequence[float], head: float) -> tuple[Figure, list]:
    """A figure of axes of these heights below each other, under a title of height `head` (inches)."""
    figure = new_figure(head + sum(heights) + GAP * (len(heights) - 1) + FOOT)
    tops = [head + sum(heights[:k]) + GAP * k for k in range(len(heights))]
    return figure, [axes_at(figure, LEFT, top, WIDTH - LEFT - RIGHT, h) for top, h in zip(tops, heights, strict=True)]


def _stories(drives: list[Rollout], names: list[str], title: str) -> str:
    """What came of each drive, and how it ended where the title does not say so."""
    stories = []
    for each, drive in zip(names, drives, strict=True):
        ending = outcome(drive)
        stories.append(f"{each}: {_numbers(drive)}" if ending in title else f"{each}: {ending}, {_numbers(drive)}")
    return f"Whole drives: {'; '.join(stories)}."


def _names(drives: list[Rollout]) -> list[str]:
    """What to call each drive; several of one driver are told apart by their road."""
    names = [display_name(drive.label) for drive in drives]
    return [
        f"{name}, road {drive.seed}" if names.count(name) > 1 else name
        for name, drive in zip(names, drives, strict=True)
    ]


def _looks(drives: list[Rollout]) -> list[Style]:
    """Solid lines, since a speed that changes each second cannot be read in dashes; of one colour, different lines."""
    looks = styles([drive.label for drive in drives])
    colours = [look.colour for look in looks]
    return [look._replace(line="-") if colours.count(look.colour) == 1 else look for look in looks]


def _title(drives: list[Rollout], names: list[str]) -> str:
    if len(drives) < 3:
        return "\n".join(sentence(f"{each}: {outcome(drive)}") for each, drive in zip(names, drives, strict=True))
    passed = sum(overtaken(drive) is not None for drive in drives)
    return f"{passed} of {len(drives)} drives leave the trap"


def _numbers(drive: Rollout) -> str:
    speed = drive.distance / drive.times[-1]
    return f"return {drive.rewards.sum():.1f}, {drive.distance:.0f} m at {speed:.1f} m/s"


def _draw_panel(ax, panel: str, drives: list[Rollout], looks: list) -> None:
    for drive, look in zip(drives, looks, strict=True):
        seconds, values = series(drive, panel)
        how = {"color": look.colour, "linestyle": look.line, "zorder": in_front(drive.label)}
        how |= {"linewidth": 1.1, "drawstyle": "steps-pre"} if panel == "reward" else {"linewidth": 1.8}
        ax.plot(seconds, values, gid=f"{panel} of {drive.label}", **how)
        if drive.accident:
            _cross(ax, seconds[-1], values[-1], ACCIDENTS[Accident(drive.accident)] if panel == "speed" else "")
    if panel == "speed":
        longest = max(drives, key=lambda drive: drive.times[-1])
        traps = longest.states[:, TRAP_1, SPEED]
        ax.plot(longest.times, traps, color=TRAP, linewidth=1, linestyle=(0, (4, 3)), zorder=4)
        ax.margins(y=0.15)
    elif panel == "distance":
        low, high = ax.get_ylim()
        if high > FARTHEST:
            ax.yaxis.label.set_text(f"{PANELS[panel][0]}, drawn up to {FARTHEST:g} m")
        ax.set_ylim(low, min(max(high, -low / 3), FARTHEST))
        ax.axhline(0, color=QUIET, linewidth=1, zorder=2)
        ax.text(
            0.994 * ax.get_xlim()[1],
            0,
            "overtaken",
            ha="right",
            fontsize=SMALL,
            color=QUIET,
            va="bottom",
            zorder=4,
            path_effects=HALO,
        )
    elif panel == "lane":
        lanes = drives[0].scenario.road.lanes
        ax.set_ylim(lanes - 0.5, -0.5)
        ax.set_yticks(range(lanes))
    if panel != "lane":
        ax.yaxis.set_major_locator(MaxNLocator(4, steps=[1, 2, 5, 10]))
    ax.yaxis.set_major_formatter(lambda value, _: number(value))


def _cross(ax, x: float, y: float, words: str) -> None:
    look = {"color": ALARM, "zorder": 5}
    ax.plot(x, y, "X", markersize=8, markeredgecolor="white", clip_on=False, gid="accident", **look)
    side, align = (-7, "right") if x > 0.75 * ax.get_xlim()[1] else (7, "left")
    look |= {"ha": align, "fontsize": SMALL, "path_effects": HALO}
    ax.annotate(words, (x, y), (side, 5), textcoords="offset points", **look)


def _write_names(ax, panel: str, drives: list[Rollout], names: list[str], looks: list) -> None:
    ends = [(float(drives[0].states[0, TRAP_1, SPEED]), "the traps", TRAP)] if panel == "speed" else []
    for drive, each, look in zip(drives, names, looks, strict=True):
        ends.append((float(series(drive, panel)[1][-1]), each, look.colour))
    label_ends(ax, ends)


def _draw_actions(ax, drive: Rollout, colour: str) -> None:
    """Bars from two base lines: accelerate up and brake down; left up and right down."""
    edges = np.arange(len(drive.actions) + 1) / drive.scenario.clock.decision_rate
    acceleration, steering = drive.actions // 3 - 1, 1 - drive.actions % 3
    for base, bars in ((1.15, acceleration), (-1.15, steering)):
        ax.axhline(base, color=GRID, linewidth=0.8, zorder=1)
        ax.stairs(base + bars, edges, baseline=base, fill=True, color=colour, linewidth=0, zorder=2)
    ax.grid(False)
    ego = drive.scenario.ego
    ax.set(ylim=(-2.3, 2.3))
    ax.set_yticks([1.7, 0.6, -0.6, -1.7], ["accelerate", "brake", "left", "right"])
    ax.tick_params(axis="y", labelsize=6.5)
    much = f"±{ego.acceleration:g} m/s²", f"±{np.degrees(ego.steering):.1f}° of steering"
    for base, text in zip((1.15, -1.15), much, strict=True):
        ax.text(1.015, base, text, transform=ax.get_yaxis_transform(), fontsize=SMALL, color=QUIET, va="center")
