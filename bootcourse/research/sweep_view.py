"""The sweep as drawings: one setting's training curves, and heat maps of all settings with the same c.

Pure functions of `Results`. The colours of the heat maps run from pale to dark, so that they stay apart in grey too.
"""

from collections.abc import Callable

import numpy as np

from bootcourse.colours import ALARM, rgb
from bootcourse.methods import style
from bootcourse.plots.svg import INK, QUIET, Drawing, SvgAxes, drawing, number, rect, span, text
from bootcourse.plots.training_curves import MEASURES, WINDOW, draw_band, draw_training
from bootcourse.research.results import Results
from bootcourse.research.sweep import SweepResult, nearest_setting, settings_run
from bootcourse.statistics import rolling_means

WIDTH, HEIGHT = 1000, 428
MAPS: dict[str, tuple[str, tuple[str, str], Callable[[SweepResult], float]]] = {
    "success": ("success (%)", ("#EAF2F8", "#08447A"), lambda happened: 100 * _mean(happened, "success")),
    "returns": ("return", ("#EFF5EC", "#15532D"), lambda happened: _mean(happened, "returns")),
    "accident": ("accidents (% of episodes)", ("#FBF1EE", "#7A1F1F"), lambda happened: 100 * happened.accidents),
}


def _mean(happened: SweepResult, measure: str) -> float:
    return float(happened.results.scores(measure).mean())


def choices(sweep: Results) -> tuple[list[float], list[float], list[float]]:
    """The values of p, ξ's multiplier and c that were run, each from low to high. p counts only where ξ is above 0."""
    run = settings_run(sweep)
    with_constraint = [p for p, xi, _ in run if xi > 0] or [p for p, _, _ in run]
    return tuple(sorted(set(values)) for values in (with_constraint, [xi for _, xi, _ in run], [c for *_, c in run]))


def rerun(happened: SweepResult) -> str:
    """The Python that trains these agents again."""
    seeds = sorted(agent["seed"] for agent in happened.results.agents)
    episodes = next(iter(happened.results.curves.values())).shape[1]
    first = f", first={seeds[0]}" if seeds[0] else ""
    return (
        "from bootcourse.learn.settings import settings_for, with_seeds\n"
        "from bootcourse.learn.training import Training\n\n"
        f'settings = settings_for("bootstrapped", rule_p={happened.p:g}, xi_multiplier={happened.xi_multiplier:g}, '
        f"bonus={happened.c:g})\n"
        f"result = Training(with_seeds(settings, {len(seeds)}{first}), episodes={episodes}).run()"
    )


def view(sweep: Results, happened: SweepResult) -> Drawing:
    """Both drawings, one below the other."""
    return drawing(WIDTH, HEIGHT, curves(happened, 30) + heat_maps(sweep, happened, 238), str(happened))


def curves(happened: SweepResult, top: float) -> list[str]:
    """Success and return over the episodes: thin lines are seeds, the thick one their interquartile mean, its band."""
    parts, look = [], style("bootstrapped")
    for i, name in enumerate(("success", "return")):
        measure, values = MEASURES[name], happened.results.curves[name]
        at, means = rolling_means(values.astype(np.float64) * measure.factor, WINDOW)
        episodes = (0, max(values.shape[1], 1))
        axes = SvgAxes(48 + i * 500, top, 430, 130, episodes, measure.limits or span(means.ravel(), measure.least))
        axes.frame(measure.label, f"episode (means of the last {WINDOW})")
        draw_band(axes, at, means, look.colour)
        draw_training(axes, at, means, look)
        parts += axes.parts
    return parts


def heat_maps(sweep: Results, happened: SweepResult, top: float) -> list[str]:
    """Three maps over p and ξ for the chosen c; the chosen setting is framed. Without ξ, p has one cell in common."""
    ps, xis, cs = choices(sweep)
    run = set(settings_run(sweep))
    cells = {}
    for _, xi, c in run:
        for p in ps:
            if c == happened.c and (xi == 0 or (p, xi, c) in run):
                cells[p, xi] = nearest_setting(sweep, p, xi, c)
    parts = []
    for i, (title, colours, value) in enumerate(MAPS.values()):
        values = {place: value(cell) for place, cell in cells.items()}
        left = 48 + i * 326
        parts.append(text(left, top - 8, f"{title}, c = {happened.c:g}", size=12, bold=True))
        parts += _map(ps, xis, values, colours, (happened.p, happened.xi_multiplier), left, top)
    return parts


def _map(ps, xis, values, colours, chosen, left: float, top: float) -> list[str]:
    across, down = 272 / len(xis), 132 / len(ps)
    low, high = min(values.values()), max(values.values())
    parts, frame = [], ""
    for column, xi in enumerate(xis):
        x = left + column * across
        parts.append(text(x + across / 2, top + 132 + 15, "0" if xi == 0 else f"{xi:g} α", "middle", QUIET, 11))
        for row, p in enumerate(reversed(ps)):
            y, tall = (top, 132) if xi == 0 else (top + row * down, down)
            if xi == 0 and row:
                continue
            here = (x + 1, y + 1, across - 2, tall - 2)
            if (p, xi) not in values:
                parts += empty_cell(*here, "not run")
                continue
            share = (values[p, xi] - low) / (high - low) if high > low else 0.0
            parts += cell(*here, between(*colours, share), short(values[p, xi]), "any p" * (xi == 0), share > 0.45)
            if chosen[1] == xi and (xi == 0 or chosen[0] == p):
                frame = rect(*here, "none", f'rx="2" stroke="{INK}" stroke-width="3"')
                frame += rect(*here, "none", f'rx="2" stroke="{ALARM}" stroke-width="1"')
    for row, p in enumerate(reversed(ps)):
        parts.append(text(left - 5, top + (row + 0.5) * down + 4, f"{p:g}", "end", QUIET, 11))
    parts.append(text(left - 5, top - 8, "p", "end", QUIET, 12))
    parts.append(text(left + 136, top + 132 + 32, "ξ, strength of the soft constraint", "middle", QUIET, 11))
    return [*parts, frame]


def cell(x: float, y: float, width: float, height: float, fill: str, words: str, below: str, dark: bool) -> list[str]:
    """A cell of a heat map (pixels) with its value, and smaller words below it; dark: is the fill dark?"""
    middle, ink = x + width / 2, "white" if dark else "black"
    value = text(middle, y + height / 2 + 4, words, "middle", ink, 12, bold=True)
    more = [text(middle, y + height / 2 + 19, below, "middle", ink, 10)] if below else []
    return [rect(x, y, width, height, fill, 'rx="2"'), value, *more]


def empty_cell(x: float, y: float, width: float, height: float, words: str) -> list[str]:
    """A cell without a value."""
    frame = rect(x, y, width, height, "none", f'stroke="{QUIET}" stroke-dasharray="2 3"')
    return [frame, text(x + width / 2, y + height / 2 + 4, words, "middle", QUIET, 10)]


def between(pale: str, dark: str, share: float) -> str:
    """The colour at a share (0 to 1) of the way from one colour to another, "#rrggbb"."""
    mixed = (round(a + share * (b - a)) for a, b in zip(rgb(pale), rgb(dark), strict=True))
    return "#" + "".join(f"{part:02X}" for part in mixed)


def short(value: float) -> str:
    """A number with a decimal at most."""
    return number(round(value, 1)) if abs(value) < 100 else f"{value:.0f}"
