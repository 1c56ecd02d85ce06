"""A `BonusNumbers` as a drawing: the targets along both drives, the bonus that each moment needs, how β fades it."""

import numpy as np

from bootcourse.colours import OTHER, Style
from bootcourse.learn.bootstrap import demonstration_share
from bootcourse.learn.settings import Settings
from bootcourse.panels.axes import Axes, span
from bootcourse.panels.bonus_numbers import BonusNumbers
from bootcourse.panels.svg import INK, QUIET, drawing, line, text

WIDTH, HEIGHT = 1052, 416
LEFT, RIGHT, TOP, BOTTOM = (44, 600), (720, 318), (92, 140), (290, 84)  # (first pixel, pixels) of the 2 x 2 charts
STEPS = (0.25, 0.5, 1.0, 2.5, 5.0)  # the axes have room for one of these bonuses: no jump at each drag


def bonus(
    seen: BonusNumbers, k: int, rate: float, settings: Settings, episode: int, own: Style, other: Style = OTHER
) -> str:
    """The drawing. k: the decision that is looked at, at `rate` a second; own, other: the two drives' looks."""
    c, room = settings.bonus, next((step for step in STEPS if step >= settings.bonus), settings.bonus)
    times = np.arange(len(seen.plain)) / rate
    highest = max(float((seen.plain + max(room, 0) * seen.weight).max()), float(seen.trapped.max()))
    everything = np.concatenate([seen.plain, seen.trapped, seen.augmented, [0.0, highest]])
    thick, middle, dashed = own._replace(line="-"), own._replace(line="-"), own._replace(line="--")

    worth = Axes(LEFT[0], TOP[0], LEFT[1], TOP[1], (0, max(times[-1], 1 / rate)), span(everything, 0.1))
    parts = [
        *_head(seen, k, rate, c),
        *_legend(seen, c, own, other),
        *worth.frame("the critic's target along the drive (discounted sum of rewards)"),
    ]
    parts += worth.curve(times, seen.plain, dashed, 1.6)
    parts += worth.curve(times, seen.shared, middle, 1.4, 0.75)
    parts += worth.curve(times, seen.trapped, other, 2)
    parts += worth.curve(times, seen.augmented, thick, 3)

    needed = Axes(LEFT[0], BOTTOM[0], LEFT[1], BOTTOM[1], worth.x, span(np.append(seen.crossing, 0.05), 0.1))
    parts += needed.frame(
        "the bonus c from which the demonstration is worth more: below 0, it is so without one", "time (s)", 3
    )
    parts += needed.band(times, np.zeros(len(times)), np.maximum(seen.crossing, 0), other)
    parts += needed.curve(times, seen.crossing, Style(INK), 1.8)
    parts.append(line(*needed.at(0, 0), *needed.at(times[-1], 0), QUIET, 1.2))
    for axes, y in ((worth, seen.augmented[k]), (needed, seen.crossing[k])):
        x, down = axes.at(times[k], y)
        parts.append(line(x, axes.top, x, axes.top + axes.height, QUIET, 1, 'stroke-dasharray="2 3"'))
        parts.append(_dot(x, down, own.colour if axes is worth else INK))

    parts += _against_c(seen, k, rate, c, max(room, 0.25), own, other)
    return drawing(WIDTH, HEIGHT, [*parts, *_fading(seen, settings, episode, own)], alt_text(seen, k, rate, c))


def _against_c(seen: BonusNumbers, k: int, rate: float, c: float, room: float, own: Style, other: Style) -> list[str]:
    """Both targets at one moment against c: one rises, the other does not, and they cross once."""
    low, high = min(0.0, c), max(room, c)
    ends = np.array([low, high])
    rising = seen.plain[k] + ends * seen.weight[k]
    axes = Axes(RIGHT[0], TOP[0], RIGHT[1], TOP[1], (low, high), span([*rising, seen.trapped[k], 0.0], 0.1))
    parts = axes.frame(f"the same at {k / rate:g} s, against c")
    parts += axes.curve(ends, np.full(2, seen.trapped[k]), other, 2)
    parts += axes.curve(ends, rising, own._replace(line="-"), 3)
    words = "the demonstration leads throughout" if seen.crossing[k] < low else "staying behind leads throughout"
    if low <= seen.crossing[k] <= high:
        parts.append(_dot(*axes.at(seen.crossing[k], seen.trapped[k]), INK))
        words = f"they cross at c = {seen.crossing[k]:.2g}"
    parts.append(text(axes.left + 8, axes.top + 10, words.replace("-", "−"), size=11.5))
    x, y = axes.at(c, seen.augmented[k])
    parts.append(line(x, axes.top, x, axes.top + axes.height, QUIET, 1, 'stroke-dasharray="2 3"'))
    return [*parts, _dot(x, y, own.colour)]


def _fading(seen: BonusNumbers, settings: Settings, episode: int, own: Style) -> list[str]:
    """β c over the training."""
    c, most = settings.bonus, max(1.5 * settings.beta_episodes, episode)
    episodes = np.linspace(0, most, 151)
    values = c * demonstration_share(episodes, settings.beta_start, settings.beta_episodes)
    axes = Axes(RIGHT[0], BOTTOM[0], RIGHT[1], BOTTOM[1], (0, most), span([*(1.3 * values), 0.0], 0.1))
    parts = axes.frame("β·c, the mean bonus in a batch", "episode of the training", 2)
    parts += axes.curve(episodes, values, own._replace(line="-"), 1.4, 0.75)
    x, y = axes.at(episode, c * seen.beta)
    anchor, aside = ("end", -8) if episode > 0.6 * most else ("start", 8)
    words = text(x + aside, y - 6, f"β = {seen.beta:.2g}, β·c = {c * seen.beta:.2g}", anchor, bold=True)
    return [*parts, _dot(x, y, own.colour), words]


def _head(seen: BonusNumbers, k: int, rate: float, c: float) -> list[str]:
    return [text(4, 16, told(seen, k, rate, c), size=14, bold=True), text(4, 36, whole(seen, c), fill=QUIET)]


def told(seen: BonusNumbers, k: int, rate: float, c: float) -> str:
    """What the numbers say at one moment."""
    values = f"{seen.augmented[k]:.2f} with c = {c:g}, {seen.plain[k]:.2f} without"
    crossing = seen.crossing[k]
    leads = f"it leads from c = {crossing:.2g}" if crossing > 0 else "it leads even without a bonus"
    words = f"At {k / rate:g} s the demonstration is worth {values}; staying behind {seen.trapped[k]:.2f}: {leads}."
    return words.replace("-", "−")


def whole(seen: BonusNumbers, c: float) -> str:
    """What they say about the whole drive."""
    most = float(seen.crossing.max())
    leads = f"From c = {most:.2g} on it leads" if most > 0 else "Even without a bonus it leads"
    added = c * seen.weight[0]
    how = "c / (1 − γ)" if np.ptp(seen.weight) < 1e-9 else "less towards the accident that ends it"
    return f"{leads} at every moment. A bonus of {c:g} adds {added:.3g} to the target, {how}.".replace("-", "−")


def alt_text(seen: BonusNumbers, k: int, rate: float, c: float) -> str:
    return f"{told(seen, k, rate, c)} {whole(seen, c)} β is {seen.beta:.2g}."


def _legend(seen: BonusNumbers, c: float, own: Style, other: Style) -> list[str]:
    entries = (
        (f"demonstration, r + c, c = {c:g}", own.colour, 3, ""),
        (f"r + β·c, β = {seen.beta:.2g}: once the agent drives alike", own.colour, 1.4, ""),
        ("r alone", own.colour, 1.6, 'stroke-dasharray="6 4"'),
        ("staying behind, r", other.colour, 2, ""),
    )
    parts = []
    for x, (words, colour, width, more) in zip((4, 250, 590, 720), entries, strict=True):
        parts += [line(x, 58, x + 26, 58, colour, width, more), text(x + 32, 62, words)]
    return parts


def _dot(x: float, y: float, colour: str) -> str:
    return f'<circle cx="{x:.1f}" cy="{y:.1f}" r="4" fill="{colour}" stroke="white" stroke-width="1"/>'
