"""A training's curves as one drawing: eight small charts that grow, an earlier training faint behind a later one.

A pure function of `Result.curves` (or of the curves of a training that still runs): nothing here knows a widget.
"""

from collections.abc import Sequence
from dataclasses import dataclass, fields

import numpy as np

from bootcourse.colours import Style
from bootcourse.learn.settings import SHARED, Settings, settings_for
from bootcourse.methods import display_name, style
from bootcourse.panels.axes import Axes, number, rolling, span
from bootcourse.panels.svg import INK, QUIET, drawing, line, text
from bootcourse.statistics import iqm

WINDOW = 50  # episodes in a rolling mean, fewer in a short training
CHARTS = {  # curve: (title, factor, least width of its axis)
    "success": ("success (% of episodes)", 100.0, 100.0),
    "return": ("return of an episode", 1.0, 4.0),
    "speed": ("speed (m/s)", 1.0, 1.0),
    "distance": ("distance (m)", 1.0, 200.0),
    "alpha": ("α, weight of the entropy", 1.0, 0.002),
    "xi": ("ξ, weight of the soft constraint", 1.0, 0.2),
    "beta": ("β, share of demonstrations", 1.0, 0.1),
    "entropy": ("entropy of π (nats)", 1.0, 0.5),
}
WIDTH, HEIGHT, HEAD = 1040, 400, 42
COLUMNS, CHART, GAP = 4, (196, 108), (60, 66)  # charts in a row; a chart's size; between two charts
EARLIER = 7  # trainings that stay behind the last


@dataclass(frozen=True)
class Drawn:
    """A training as it is drawn."""

    label: str  # such as "1 bootstrapped SAC, p = 0.5"
    method: str
    curves: dict[str, np.ndarray]  # each (agents, episodes), NaN where still to come
    episodes: int  # that each agent was to drive


def label_of(settings: Settings) -> str:
    """The method's name, and the settings in which it differs from what the method usually has."""
    usual, symbols = settings_for(settings.method), {"rule_p": "p", "gamma": "γ", "xi_multiplier": "ξ/α", "bonus": "c"}
    symbols |= {"beta_start": "β"}
    own = [f.name for f in fields(Settings) if f.name not in ("method", "seed", *SHARED)]
    changed = [each for each in own if getattr(settings, each) != getattr(usual, each)]
    told = [f"{symbols.get(each, each)} = {getattr(settings, each):g}" for each in changed]
    return ", ".join([display_name(settings.method), *told])


def training_chart(trainings: Sequence[Drawn]) -> str:
    """The drawing, always of the same size: the last training in full, those before it faint."""
    trainings = list(trainings)[-EARLIER - 1 :]
    episodes = max((each.episodes for each in trainings), default=1000)
    finished = max((_finished(each) for each in trainings), default=0)
    window = max(1, min(WINDOW, finished // 4))
    parts = _head(trainings, window if finished else 0)
    for i, (curve, (title, factor, least)) in enumerate(CHARTS.items()):
        rolled = [rolling(each.curves[curve] * factor, window) for each in trainings]
        seen = np.concatenate([means.ravel() for _, means in rolled]) if rolled else np.zeros(0)
        left = 50 + (i % COLUMNS) * (CHART[0] + GAP[0])
        top = HEAD + 26 + (i // COLUMNS) * (CHART[1] + GAP[1])
        y = (0.0, 100.0) if curve == "success" else span(seen, least)
        axes = Axes(left, top, *CHART, (0, max(episodes, 1)), y)
        parts += axes.frame(title, "episode" if i >= COLUMNS else "")
        for each, (at, means) in zip(trainings, rolled, strict=True):
            parts += _training(axes, at, means, style(each.method), each is trainings[-1])
    return drawing(WIDTH, HEIGHT, parts, alt_text(trainings))


def _training(axes: Axes, at: np.ndarray, means: np.ndarray, look: Style, last: bool) -> list[str]:
    """Thin lines for the seeds, their interquartile mean as far as all of them got; faint if it is not the last."""
    whole = np.isfinite(means).all(axis=0)
    parts = []
    if last:
        for seed in means:
            parts += axes.curve(at, seed, look._replace(line="-"), 0.9, 0.6)
    if whole.any():
        middle = iqm(means[:, whole], axis=0)
        parts += axes.curve(at[whole], middle, look, 2.4 if last else 1.6, 1.0 if last else 0.5)
        if last:
            x, y = axes.at(at[whole][-1], middle[-1])
            parts.append(f'<circle cx="{x:.1f}" cy="{y:.1f}" r="3" fill="{look.colour}"/>')
            anchor, aside = ("end", -5) if x > axes.left + 0.75 * axes.width else ("start", 6)
            above = y - 6 if y > axes.top + 14 else y + 15
            halo = 'paint-order="stroke" stroke="var(--jp-layout-color0, #FFFFFF)" stroke-width="3"'
            words = text(x + aside, above, _rounded(middle[-1]), anchor, INK, 11, bold=True)
            parts.append(words.replace("<text ", f"<text {halo} ", 1))
    return parts


def _rounded(value: float) -> str:
    return number(float(f"{value:.3g}")) if abs(value) < 100 else f"{value:.0f}"


def _head(trainings: Sequence[Drawn], window: int) -> list[str]:
    """Who is drawn, four in a row; how the curves were smoothed."""
    if not window:
        words = (
            "Nothing has been trained yet: press Train." if not trainings else "The first episodes are on their way."
        )
        return [text(WIDTH / 2, 20, words, "middle", QUIET, 13)]
    parts = []
    for i, each in enumerate(trainings):
        x, y, last = 12 + (i % COLUMNS) * 250, 14 + (i // COLUMNS) * 18, each is trainings[-1]
        look = style(each.method)
        faint = "" if last else 'opacity="0.45"'
        parts.append(line(x, y - 4, x + 22, y - 4, look.colour, 3 if last else 2, faint))
        parts.append(text(x + 28, y, _short(each.label), fill=INK if last else QUIET, bold=last))
    each = "each episode" if window == 1 else f"means of the last {window} episodes"
    if len(trainings) <= COLUMNS:
        parts.append(
            text(12, 32, f"Thin: one seed. Thick: their interquartile mean. All are {each}.", fill=QUIET, size=11)
        )
    return parts


def _short(label: str, longest: int = 36) -> str:
    return label if len(label) <= longest else label[: longest - 1] + "…"


def _finished(training: Drawn) -> int:
    return int(np.isfinite(np.atleast_2d(training.curves["return"])).sum(axis=1).max(initial=0))


EMPTY = (
    "Training curves, still empty: after Train, success, return, speed, distance and what steers the learner "
    "grow here by episode."
)


def alt_text(trainings: Sequence[Drawn]) -> str:
    """What a reader who sees nothing should know."""
    told = []
    for each in trainings:
        count = _finished(each)
        if count:
            last = {curve: np.nanmean(rolling(each.curves[curve], WINDOW)[1][:, -1]) for curve in ("success", "return")}
            told.append(
                f"{each.label}, after {count} episodes: success {100 * last['success']:.0f} %, "
                f"return {last['return']:.1f}."
            )
    return " ".join(["Training curves.", *told]) if told else EMPTY
