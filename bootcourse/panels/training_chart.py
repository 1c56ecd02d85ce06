"""A training's curves as one drawing: eight small charts that grow, an earlier training faint behind a later one.

A pure function of `Result.curves` (or of the curves of a training that still runs): nothing here knows a widget.
"""

import textwrap
from collections.abc import Sequence
from dataclasses import dataclass, fields

import numpy as np

from bootcourse.learn.settings import Settings, settings_for, shared_fields
from bootcourse.methods import display_name, style
from bootcourse.plots.svg import INK, QUIET, SvgAxes, drawing, line, number, span, text
from bootcourse.plots.training_curves import MEASURES, WINDOW, draw_training, finished, window_of
from bootcourse.statistics import rolling_means

SHOWN = ("success", "return", "speed", "distance", "alpha", "xi", "beta", "entropy")  # of the measures
WIDTH, HEIGHT, HEAD = 1040, 400, 42
COLUMNS, CHART, GAP = 4, (196, 108), (60, 66)  # charts in a row; a chart's size; between two charts
EARLIER = 7  # trainings that stay behind the last
SYMBOLS = {"rule_p": "p", "gamma": "γ", "xi_multiplier": "ξ/α", "bonus": "c", "beta_start": "β"}


@dataclass(frozen=True)
class Drawn:
    """A training as it is drawn."""

    label: str  # such as "1 bootstrapped SAC, p = 0.5"
    method: str
    curves: dict[str, np.ndarray]  # each (agents, episodes), NaN where still to come
    episodes: int  # that each agent was to drive


def label_of(settings: Settings) -> str:
    """The method's name, and the settings in which it differs from what the method usually has."""
    usual = settings_for(settings.method)
    own = [f.name for f in fields(settings) if f.name not in ("method", "seed", *shared_fields(type(settings)))]
    changed = [each for each in own if getattr(settings, each) != getattr(usual, each)]
    numbers = [f"{SYMBOLS.get(each, each)} = {getattr(settings, each):g}" for each in changed]
    return ", ".join([display_name(settings.method), *numbers])


def training_chart(trainings: Sequence[Drawn]) -> str:
    """The drawing, always of the same size: the last training in full, those before it faint."""
    trainings = list(trainings)[-EARLIER - 1 :]
    curves = [each.curves for each in trainings]
    episodes, window = max((each.episodes for each in trainings), default=1000), window_of(curves)
    parts = _head(trainings, window if any(map(finished, curves)) else 0)
    for i, name in enumerate(SHOWN):
        measure = MEASURES[name]
        rolled = [rolling_means(each[name] * measure.factor, window) for each in curves]
        left = 50 + (i % COLUMNS) * (CHART[0] + GAP[0])
        top = HEAD + 26 + (i // COLUMNS) * (CHART[1] + GAP[1])
        seen = [mean for _, means in rolled for mean in means.ravel()]
        axes = SvgAxes(left, top, *CHART, (0, max(episodes, 1)), measure.limits or span(seen, measure.least))
        axes.frame(measure.label, "episode" if i >= COLUMNS else "")
        for each, (at, means) in zip(trainings, rolled, strict=True):
            last = each is trainings[-1]
            end = draw_training(axes, at, means, style(each.method), seeds=last)
            if last and np.isfinite(end):
                _end(axes, at[np.isfinite(means).all(axis=0)][-1], end, style(each.method).colour)
        parts += axes.parts
    return drawing(WIDTH, HEIGHT, parts, alt_text(trainings))


def _end(axes: SvgAxes, episode: int, value: float, colour: str) -> None:
    """A dot where the last training is now, and its value."""
    x, y = axes.dot(episode, value, colour)
    anchor, aside = ("end", -5) if x > axes.left + 0.75 * axes.width else ("start", 6)
    above = y - 6 if y > axes.top + 14 else y + 15
    words = text(x + aside, above, _rounded(value), anchor, INK, 11, bold=True)
    halo = 'paint-order="stroke" stroke="#FFFFFF" stroke-width="3"'
    axes.parts.append(words.replace("<text ", f"<text {halo} ", 1))


def _rounded(value: float) -> str:
    return number(float(f"{value:.3g}")) if abs(value) < 100 else f"{value:.0f}"


def _head(trainings: Sequence[Drawn], window: int) -> list[str]:
    """Who is drawn, four in a row; how the curves were smoothed."""
    if not window:
        words = "No agent has finished an episode yet." if trainings else "Nothing has been trained yet: press Train."
        return [text(WIDTH / 2, 20, words, "middle", QUIET, 13)]
    parts = []
    for i, each in enumerate(trainings):
        x, y, last = 12 + (i % COLUMNS) * 250, 14 + (i // COLUMNS) * 18, each is trainings[-1]
        look = style(each.method)
        faint = "" if last else 'opacity="0.45"'
        parts.append(line(x, y - 4, x + 22, y - 4, look.colour, 3 if last else 2, faint))
        parts.append(
            text(x + 28, y, textwrap.shorten(each.label, 36, placeholder=" …"), fill=INK if last else QUIET, bold=last)
        )
    each = "each episode" if window == 1 else f"means of the last {window} episodes"
    if len(trainings) <= COLUMNS:
        words = f"Thin: one seed. Thick: their interquartile mean. All are {each}."
        parts.append(text(12, 32, words, fill=QUIET, size=11))
    return parts


def alt_text(trainings: Sequence[Drawn]) -> str:
    """How far each training got, for those who cannot see it."""
    sentences = ["Training curves."]
    for each in trainings:
        count = finished(each.curves)
        if count:
            success, returns = (np.nanmean(rolling_means(each.curves[name], WINDOW)[1][:, -1]) for name in SHOWN[:2])
            sentences.append(
                f"{each.label}, after {count} episodes: success {100 * success:.0f} %, return {returns:.1f}."
            )
    return " ".join(sentences) if len(sentences) > 1 else "Training curves: empty until agents have finished episodes."
