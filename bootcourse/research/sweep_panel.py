"""Explore the sweep over p, ξ and c: the result at each setting that was run, and the command to run it again.

    sweep_panel()

Nothing is trained here. The drawing has the training curves of one setting, and heat maps of all settings with the same
c, whose colours run from pale to dark, so that they stay apart in grey too.
"""

from collections.abc import Callable, Sequence
from pathlib import Path

import ipywidgets as widgets
import numpy as np

from bootcourse.colours import ALARM, rgb
from bootcourse.errors import BootcourseError
from bootcourse.markup import html
from bootcourse.methods import style
from bootcourse.panels.panel import Panel
from bootcourse.plots.svg import INK, QUIET, Drawing, SvgAxes, drawing, number, rect, span, text
from bootcourse.plots.training_curves import MEASURES, WINDOW, draw_band, draw_training
from bootcourse.research.results import Results
from bootcourse.research.sweep import SHIPPED, SweepResult, load_sweep, nearest_setting, settings_run
from bootcourse.statistics import rolling_means

WIDTH, HEIGHT = 1000, 428
ACROSS, DOWN = 272, 132  # pixels of a heat map
MAPS: dict[str, tuple[str, tuple[str, str], Callable[[SweepResult], float]]] = {
    "success": ("success (%)", ("#EAF2F8", "#08447A"), lambda setting: 100 * _mean(setting, "success")),
    "returns": ("return", ("#EFF5EC", "#15532D"), lambda setting: _mean(setting, "returns")),
    "accident": ("accidents (% of episodes)", ("#FBF1EE", "#7A1F1F"), lambda setting: 100 * setting.accidents),
}


def _mean(happened: SweepResult, measure: str) -> float:
    return float(happened.results.scores(measure).mean())


class SweepPanel(Panel):
    """`.happened` is the result that is shown, None if the sweep could not be read."""

    def __init__(self, path: Path):
        self.happened: SweepResult | None = None
        self._drawings: dict[tuple, Drawing] = {}
        title = "The sweep over p, ξ and c"
        try:
            self.sweep = load_sweep(path)
            values = choices(self.sweep)
        except BootcourseError as error:
            super().__init__(title)
            self.say(str(error), wrong=True)
            words = "The sweep could not be read."
            self.svg = drawing(600, 40, [text(10, 25, words)], words)
            return
        self.p, self.xi, self.c = (slider(name, of) for name, of in zip(("p", "ξ / α", "c"), values, strict=True))
        self.sentence, self.chart, self.code = widgets.HTML(), widgets.HTML(), widgets.HTML()
        row = widgets.HBox([self.p, self.xi, self.c], layout={"flex_flow": "row wrap"})
        super().__init__(title, row, self.sentence, self.chart, self.code)
        self.update_with(self.p, self.xi, self.c)

    def update(self, change=None) -> None:
        """Show the chosen setting."""
        self.happened = happened = nearest_setting(self.sweep, self.p.value, self.xi.value, self.c.value)
        missing = "" if happened.exact else "This setting was not run. The nearest that was: "
        self.sentence.value = html('<div class="bc-says" role="status">{}</div>', f"{missing}{happened}")
        setting = (happened.p, happened.xi_multiplier, happened.c)
        if setting not in self._drawings:
            parts = curves(happened, 30) + heat_maps(self.sweep, happened, 238)
            self._drawings[setting] = drawing(WIDTH, HEIGHT, parts, str(happened))
        self.svg = self.chart.value = self._drawings[setting]
        page = (
            '<div class="bc-quiet">To train these agents again:</div>'
            '<pre style="margin:2px 0 0;font-size:12px;line-height:1.4;user-select:all;overflow-x:auto">{}</pre>'
        )
        self.code.value = html(page, rerun(happened))


def slider(name: str, values: Sequence[float]) -> widgets.SelectionSlider:
    """A slider over the values that were run."""
    options = [(f"{value:g}", value) for value in values]
    return widgets.SelectionSlider(options=options, value=values[len(values) // 2], description=name)


def sweep_panel(path: Path = SHIPPED) -> SweepPanel:
    """The results at every setting of p, ξ and c that was run; by default those that ship with the course.

    path: a file that `bootcourse study sweep` wrote. If it is missing or damaged, the panel says so.
    """
    return SweepPanel(Path(path))


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
    """One heat map. values: {(p, ξ): value} of what was run; chosen: the (p, ξ) with the frame."""
    across, down = ACROSS / len(xis), DOWN / len(ps)
    low, high = min(values.values()), max(values.values())
    parts, frame = [], ""
    for column, xi in enumerate(xis):
        x = left + column * across
        parts.append(text(x + across / 2, top + DOWN + 15, "0" if xi == 0 else f"{xi:g} α", "middle", QUIET, 11))
        for row, p in enumerate(reversed(ps[:1] if xi == 0 else ps)):
            y, tall = (top, DOWN) if xi == 0 else (top + row * down, down)
            here, middle = (x + 1, y + 1, across - 2, tall - 2), (x + across / 2, y + tall / 2 + 4)
            if (p, xi) not in values:
                parts.append(rect(*here, "none", f'stroke="{QUIET}" stroke-dasharray="2 3"'))
                parts.append(text(*middle, "not run", "middle", QUIET, 10))
                continue
            share = (values[p, xi] - low) / (high - low) if high > low else 0.0
            ink = "white" if share > 0.45 else "black"
            parts.append(rect(*here, between(*colours, share), 'rx="2"'))
            parts.append(text(*middle, short(values[p, xi]), "middle", ink, 12, bold=True))
            if xi == 0:
                parts.append(text(middle[0], middle[1] + 15, "any p", "middle", ink, 10))
            if chosen[1] == xi and (xi == 0 or chosen[0] == p):
                frame = rect(*here, "none", f'rx="2" stroke="{INK}" stroke-width="3"')
                frame += rect(*here, "none", f'rx="2" stroke="{ALARM}" stroke-width="1"')
    for row, p in enumerate(reversed(ps)):
        parts.append(text(left - 5, top + (row + 0.5) * down + 4, f"{p:g}", "end", QUIET, 11))
    parts.append(text(left - 5, top - 8, "p", "end", QUIET, 12))
    parts.append(text(left + ACROSS / 2, top + DOWN + 32, "ξ, strength of the soft constraint", "middle", QUIET, 11))
    return [*parts, frame]


def between(pale: str, dark: str, share: float) -> str:
    """The colour at a share (0 to 1) of the way from one colour to another, "#rrggbb"."""
    mixed = (round(a + share * (b - a)) for a, b in zip(rgb(pale), rgb(dark), strict=True))
    return "#" + "".join(f"{part:02X}" for part in mixed)


def short(value: float) -> str:
    """A number with a decimal at most."""
    return number(round(value, 1)) if abs(value) < 100 else f"{value:.0f}"
