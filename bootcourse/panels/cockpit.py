"""What a driver sees: the road from above with the ghost, the score, the reward's terms, the return beside the ghost's.

Pure functions of a drive and the ghost's rollout.
"""

from collections.abc import Sequence

import numpy as np

from bootcourse.colours import ALARM, OTHER
from bootcourse.episodes.interactive import InteractiveEpisode
from bootcourse.episodes.rollout import Rollout
from bootcourse.episodes.words import ACCIDENTS
from bootcourse.methods import display_name, style
from bootcourse.plots.futures import LEGEND, Trail
from bootcourse.plots.road import BEHIND, road_svg
from bootcourse.plots.svg import GRID, INK, QUIET, Drawing, SvgAxes, drawing, line, number, rect, span, text
from bootcourse.road.state import EGO, LANE, SPEED, TRAP_1, Accident, X

WIDTH, SCALE, HEAD = 1000, 8.0, 24  # pixels; pixels per metre; pixels
BELOW = 150  # pixels for the score
BAR = 150  # pixels that a reward of 1 is long
ENDS = ACCIDENTS | {Accident.NONE: "time is over"}
TERMS = (("r_v, speed", "w_v"), ("r_y, lane centre", "w_y"), ("r_θ, steering", "w_theta"))


def cockpit(drive: InteractiveEpisode, ghost: Rollout, trails: Sequence[Trail] = (), words: str = "") -> Drawing:
    """The drawing of a drive where it is now, beside the ghost at the same time.

    trails: imagined drives to draw on the road; words: what they say, for those who cannot see them.
    """
    cars = drive.recorder.states[-1]
    beside = ghost.states[min(len(drive.recorder.states), len(ghost.states)) - 1, EGO]  # if it is over, as it ended
    ghosts = [(beside, style(ghost.label).colour)]
    road, height = road_svg(cars, drive.scenario, OTHER.colour, WIDTH, SCALE, ghosts, trails=trails)
    mine, other = sum(drive.rewards), float(ghost.rewards[: len(drive.actions)].sum())
    top = HEAD + height
    parts = [
        *_head(drive, ghost, bool(trails)),
        *(f'<g transform="translate(0 {HEAD})">', *road, "</g>"),
        *_numbers(drive, cars, mine, other, top + 30),
        *_terms(drive, top + 30),
        *_returns(drive, ghost, top + 40),
    ]
    ahead = cars[EGO, X] - cars[TRAP_1, X]
    alt = f"Road {drive.seed} after {drive.time:.0f} s: {cars[EGO, SPEED]:.1f} m/s in lane {int(cars[EGO, LANE])}, "
    alt += f"{abs(ahead):.0f} m {'ahead of' if ahead > 0 else 'behind'} trap 1, return {mine:.1f}."
    alt += f" The ghost, {display_name(ghost.label)}, has {other:.1f}." + (f" {words}." if words else "")
    alt += f" It is over: {ENDS[Accident(drive.accident)]}." if drive.over else ""
    return drawing(WIDTH, top + BELOW, parts, alt)


def _head(drive: InteractiveEpisode, ghost: Rollout, imagined: bool) -> list[str]:
    middle = BEHIND * WIDTH
    parts = [text(0, 16, f"road {drive.seed}", fill=QUIET)]
    parts += [rect(middle - 12, 8, 14, 7, OTHER.colour, 'rx="2"'), text(middle + 7, 16, drive.label, bold=True)]
    parts.append(rect(middle + 50, 8, 14, 7, style(ghost.label).colour, 'rx="2" opacity="0.7"'))
    parts.append(text(middle + 69, 16, f"the ghost: {display_name(ghost.label)}", fill=QUIET))
    if drive.over:
        parts.append(text(WIDTH - 4, 16, f"Over: {ENDS[Accident(drive.accident)]}", "end", ALARM, 13, bold=True))
    elif imagined:
        parts.append(text(WIDTH - 4, 16, f"imagined drives: {LEGEND}", "end", QUIET, 11))
    return parts


def _numbers(drive: InteractiveEpisode, cars: np.ndarray, mine: float, other: float, top: float) -> list[str]:
    """Six numbers, three in a row."""
    clock, ahead = drive.scenario.clock, cars[EGO, X] - cars[TRAP_1, X]
    shown = [
        ("time", f"{drive.time:.0f} s", f"of {clock.decisions / clock.decision_rate:g} s"),
        ("speed", f"{cars[EGO, SPEED]:.1f} m/s", "15 earns most"),
        ("lane", f"{int(cars[EGO, LANE])}", "0 is leftmost"),
        ("your return", f"{mine:.1f}".replace("-", "−"), "rewards so far"),
        ("ghost's", f"{other:.1f}".replace("-", "−"), "at this time"),
        ("trap 1", f"{abs(ahead):.0f} m", "behind you" if ahead > 0 else "ahead of you"),
    ]
    parts = []
    for i, (label, value, below) in enumerate(shown):
        x, y = (i % 3) * 112, top + (i // 3) * 62
        parts += [text(x, y, label, fill=QUIET, size=11), text(x, y + 20, value, size=18, bold=True)]
        parts.append(text(x, y + 35, below, fill=QUIET, size=10.5))
    return parts


def _terms(drive: InteractiveEpisode, top: float) -> list[str]:
    """What each term adds to the last reward, as bars from one line; the reward below them."""
    left, weights = 496, [getattr(drive.scenario.reward, weight) for _, weight in TERMS]
    reward, crashed = drive.rewards[-1] if drive.rewards else 0.0, bool(drive.accident)
    shares = [0.0 if crashed else w * r / sum(weights) for w, r in zip(weights, drive.terms, strict=True)]
    labels = [*(label for label, _ in TERMS), "accident" if crashed else "sum"]
    parts = [text(left - 136, top, "reward of the last decision", fill=QUIET, size=11)]
    for i, (label, value) in enumerate(zip(labels, [*shares, reward], strict=True)):
        last = i == len(TERMS)
        y, ink = top + 12 + i * 21 + 5 * last, INK if last else QUIET
        length = min(max(value, -0.13), 1.0) * BAR
        parts.append(text(left - 28, y + 10, label, "end", ink, 11, bold=last))
        colour = ALARM if value < 0 else OTHER.colour
        parts.append(rect(left + min(length, 0), y + 1, abs(length), 11, colour, 'rx="1.5"'))
        words = number(round(value, 3)) if value else "0"
        parts.append(text(left + max(length, 0) + 6, y + 10, words, fill=ink, size=11, bold=last))
    return [*parts, line(left, top + 8, left, top + 101, GRID, 1.5)]


def _returns(drive: InteractiveEpisode, ghost: Rollout, top: float) -> list[str]:
    """Both returns up to now."""
    rate, look, now = drive.scenario.clock.decision_rate, style(ghost.label), len(drive.rewards)
    mine, other = (np.concatenate([[0.0], np.cumsum(rewards[:now])]) for rewards in (drive.rewards, ghost.rewards))
    end = drive.scenario.clock.decisions / rate
    axes = SvgAxes(716, top, 270, 66, (0, end), span([*mine, *other, -1, 5], 6))
    axes.frame("return, and the ghost's", "time (s)", rows=2)
    axes.line(np.arange(len(other)) / rate, other, look.colour, 1.1, look.line, 0.75)
    axes.line(np.arange(len(mine)) / rate, mine, OTHER.colour, 1.6)
    axes.dot((len(mine) - 1) / rate, mine[-1], OTHER.colour)
    return axes.parts
