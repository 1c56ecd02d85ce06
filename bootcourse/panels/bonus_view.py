"""A `BonusNumbers` as a drawing: the targets along both drives, the bonus that each moment needs, how β fades it."""

import numpy as np

from bootcourse.colours import OTHER, Style
from bootcourse.learn.bootstrap import demonstration_share
from bootcourse.learn.settings import Settings
from bootcourse.panels.bonus_numbers import BonusNumbers
from bootcourse.plots.svg import INK, QUIET, SvgAxes, drawing, line, span, text

WIDTH, HEIGHT = 1052, 416
WORTH, NEEDED = (44, 92, 600, 140), (44, 290, 600, 84)  # left, top, width and height of a chart, pixels
AGAINST_C, FADING = (720, 92, 318, 140), (720, 290, 318, 84)
STEPS = (0.25, 0.5, 1.0, 2.5, 5.0)  # the axes have room for one of these bonuses: no jump at each drag


def bonus(
    seen: BonusNumbers, k: int, rate: float, settings: Settings, episode: int, own: Style, other: Style = OTHER
) -> str:
    """The drawing. k: the decision that is looked at, at `rate` a second; own, other: the two drives' looks."""
    c, room = settings.bonus, next((step for step in STEPS if step >= settings.bonus), settings.bonus)
    times = np.arange(len(seen.plain)) / rate
    highest = max(float((seen.plain + max(room, 0) * seen.weight).max()), float(seen.trapped.max()))
    everything = np.concatenate([seen.plain, seen.trapped, seen.augmented, [0.0, highest]])
    worth = SvgAxes(*WORTH, (0, max(times[-1], 1 / rate)), span(everything, 0.1))
    worth.frame("the critic's target along the drive (discounted sum of rewards)")
    worth.line(times, seen.plain, own.colour, 1.1, "--")
    worth.line(times, seen.shared, own.colour, 1, opacity=0.75)
    worth.line(times, seen.trapped, other.colour, 1.4, other.line)
    worth.line(times, seen.augmented, own.colour, 2)

    needed = SvgAxes(*NEEDED, worth.x, span(np.append(seen.crossing, 0.05), 0.1))
    needed.frame("the bonus c from which the demonstration is worth more: below 0, it is so without one", "time (s)", 3)
    base = max(needed.y[0], 0.0)
    needed.fill([*times, times[-1], times[0]], [*np.maximum(seen.crossing, base), base, base], other.colour, 0.15)
    needed.line(times, seen.crossing, INK, 1.2)
    needed.line([0, times[-1]], [0, 0], QUIET, 0.8)
    for axes, y, colour in ((worth, seen.augmented[k], own.colour), (needed, seen.crossing[k], INK)):
        axes.line([times[k]] * 2, axes.y, QUIET, 0.7, ":")
        axes.dot(times[k], y, colour)
    against = _against_c(seen, k, rate, c, max(room, 0.25), own, other)
    charts = (worth, needed, against, _fading(seen, settings, episode, own))
    head = [text(4, 16, told(seen, k, rate, c), size=14, bold=True), text(4, 36, whole(seen, c), fill=QUIET)]
    parts = [*head, *_legend(seen, c, own, other), *(part for axes in charts for part in axes.parts)]
    return drawing(WIDTH, HEIGHT, parts, alt_text(seen, k, rate, c))


def _against_c(seen: BonusNumbers, k: int, rate: float, c: float, room: float, own: Style, other: Style) -> SvgAxes:
    """Both targets at one moment against c: one rises, the other does not, and they cross once."""
    low, high = min(0.0, c), max(room, c)
    ends = np.array([low, high])
    rising = seen.plain[k] + ends * seen.weight[k]
    axes = SvgAxes(*AGAINST_C, (low, high), span([*rising, seen.trapped[k], 0.0], 0.1))
    axes.frame(f"the same at {k / rate:g} s, against c")
    axes.line(ends, np.full(2, seen.trapped[k]), other.colour, 1.4, other.line)
    axes.line(ends, rising, own.colour, 2)
    words = "the demonstration leads throughout" if seen.crossing[k] < low else "staying behind leads throughout"
    if low <= seen.crossing[k] <= high:
        axes.dot(seen.crossing[k], seen.trapped[k], INK)
        words = f"they cross at c = {seen.crossing[k]:.2g}"
    axes.parts.append(text(axes.left + 8, axes.top + 10, words.replace("-", "−"), size=11.5))
    axes.line([c, c], axes.y, QUIET, 0.7, ":")
    axes.dot(c, seen.augmented[k], own.colour)
    return axes


def _fading(seen: BonusNumbers, settings: Settings, episode: int, own: Style) -> SvgAxes:
    """β c over the training."""
    c, most = settings.bonus, max(1.5 * settings.beta_episodes, episode)
    episodes = np.linspace(0, most, 151)
    values = c * demonstration_share(episodes, settings.beta_start, settings.beta_episodes)
    axes = SvgAxes(*FADING, (0, most), span([*(1.3 * values), 0.0], 0.1))
    axes.frame("β·c, the mean bonus in a batch", "episode of the training", 2)
    axes.line(episodes, values, own.colour, 1, opacity=0.75)
    x, y = axes.dot(episode, c * seen.beta, own.colour)
    anchor, aside = ("end", -8) if episode > 0.6 * most else ("start", 8)
    words = f"β = {seen.beta:.2g}, β·c = {c * seen.beta:.2g}"
    axes.parts.append(text(x + aside, y - 6, words, anchor, bold=True))
    return axes


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
