"""What a driver sees: the road from above with the ghost, the score, the reward's terms, the return beside the ghost's.

Pure functions of a drive, the ghost's rollout and a time.
"""

from typing import NamedTuple

import numpy as np

from bootcourse.colours import ALARM, OTHER
from bootcourse.episodes.interactive import InteractiveEpisode, interpolate_states
from bootcourse.episodes.rollout import Rollout
from bootcourse.episodes.words import ACCIDENTS
from bootcourse.methods import display_name, style
from bootcourse.plots.futures import LEGEND, Trail
from bootcourse.plots.road import BEHIND, road_svg
from bootcourse.plots.svg import GRID, INK, QUIET, SvgAxes, drawing, line, number, rect, span, text
from bootcourse.road.state import EGO, LANE, SPEED, TRAP_1, Accident, X

WIDTH, SCALE, HEAD = 1000, 8.0, 24  # pixels; pixels per metre; pixels
BELOW = 150  # pixels for the score
BAR = 150  # pixels that a reward of 1 is long
ENDS = ACCIDENTS | {Accident.NONE: "time is over"}
TERMS = (("r_v, speed", "w_v"), ("r_y, lane centre", "w_y"), ("r_θ, steering", "w_theta"))


class Futures(NamedTuple):
    """Imagined drives."""

    trails: list[Trail]
    words: str


class Score(NamedTuple):
    """Where a drive stands at a time."""

    cars: np.ndarray  # (vehicles, 10)
    decisions: int  # that are over: their rewards count
    earned: float  # the sum of these rewards
    ahead: float  # m, of trap 1; below 0: behind it
    ghost: np.ndarray | None  # the ghost's ego, (10,); after the end of the ghost's drive, as it ended
    ghost_earned: float
    end: str  # how the drive ended, in words; "" before


def score(drive: InteractiveEpisode, ghost: Rollout | None, time: float) -> Score:
    """The score at a time of the drive (s)."""
    cars, clock, over = drive.cars_at(time), drive.scenario.clock, time >= drive.time
    decisions = int(time * clock.decision_rate + 1e-9)
    ego, ghost_earned = None, 0.0
    if ghost:
        ego = interpolate_states(ghost.states, time / clock.dt)[EGO]
        ghost_earned = float(ghost.rewards[:decisions].sum())
    decisions = len(drive.rewards) if over else decisions
    end = ENDS[Accident(drive.accident)] if drive.over and over else ""
    ahead = float(cars[EGO, X] - cars[TRAP_1, X])
    return Score(cars, decisions, sum(drive.rewards[:decisions]), ahead, ego, ghost_earned, end)


def cockpit(
    drive: InteractiveEpisode, ghost: Rollout | None, time: float, coming: str = "", futures: Futures | None = None
) -> str:
    """The drawing at a time of the drive (s).

    coming: the action that was chosen for the next decision, in words. futures: imagined drives to draw on the road.
    """
    now = score(drive, ghost, time)
    ghosts = [(now.ghost, style(ghost.label).colour)] if ghost else []
    road, height = road_svg(
        now.cars, drive.scenario, OTHER.colour, WIDTH, SCALE, ghosts, trails=futures.trails if futures else ()
    )
    top = HEAD + height
    parts = [
        *_head(drive, ghost, now, coming, futures),
        *(f'<g transform="translate(0 {HEAD})">', *road, "</g>"),
        *_numbers(drive, ghost, now, time, top + 30),
        *_terms(drive, now, top + 30),
        *_returns(drive, ghost, now, time, top + 40),
    ]
    alt = f"Road {drive.seed} after {time:.0f} s: {now.cars[EGO, SPEED]:.1f} m/s in lane {int(now.cars[EGO, LANE])}, "
    alt += f"{abs(now.ahead):.0f} m {'ahead of' if now.ahead > 0 else 'behind'} trap 1, return {now.earned:.1f}."
    alt += f" The ghost, {display_name(ghost.label)}, has {now.ghost_earned:.1f}." if ghost else ""
    alt += f" {futures.words}." if futures else ""
    alt += f" It is over: {now.end}." if now.end else ""
    return drawing(WIDTH, top + BELOW, parts, alt)


def _head(
    drive: InteractiveEpisode, ghost: Rollout | None, now: Score, coming: str, futures: Futures | None
) -> list[str]:
    middle = BEHIND * WIDTH
    parts = [text(0, 16, f"road {drive.seed}", fill=QUIET)]
    parts += [rect(middle - 12, 8, 14, 7, OTHER.colour, 'rx="2"'), text(middle + 7, 16, drive.label, bold=True)]
    if ghost:
        parts.append(rect(middle + 50, 8, 14, 7, style(ghost.label).colour, 'rx="2" opacity="0.7"'))
        parts.append(text(middle + 69, 16, f"the ghost: {display_name(ghost.label)}", fill=QUIET))
    if now.end:
        parts.append(text(WIDTH - 4, 16, f"Over: {now.end}", "end", ALARM, 13, bold=True))
    elif coming:
        parts.append(text(WIDTH - 4, 16, f"next: {coming}", "end", INK, 12))
    elif futures:
        parts.append(text(WIDTH - 4, 16, f"imagined drives: {LEGEND}", "end", QUIET, 11))
    return parts


def _numbers(drive: InteractiveEpisode, ghost: Rollout | None, now: Score, time: float, top: float) -> list[str]:
    """Six numbers, three in a row."""
    clock = drive.scenario.clock
    shown = [
        ("time", f"{time:.0f} s", f"of {clock.decisions / clock.decision_rate:g} s"),
        ("speed", f"{now.cars[EGO, SPEED]:.1f} m/s", "15 earns most"),
        ("lane", f"{int(now.cars[EGO, LANE])}", "0 is leftmost"),
        ("your return", f"{now.earned:.1f}".replace("-", "−"), "rewards so far"),
        ("ghost's", f"{now.ghost_earned:.1f}".replace("-", "−") if ghost else "none", "at this time"),
        ("trap 1", f"{abs(now.ahead):.0f} m", "behind you" if now.ahead > 0 else "ahead of you"),
    ]
    parts = []
    for i, (label, value, below) in enumerate(shown):
        x, y = (i % 3) * 112, top + (i // 3) * 62
        parts += [text(x, y, label, fill=QUIET, size=11), text(x, y + 20, value, size=18, bold=True)]
        parts.append(text(x, y + 35, below, fill=QUIET, size=10.5))
    return parts


def _terms(drive: InteractiveEpisode, now: Score, top: float) -> list[str]:
    """What each term adds to the last reward, as bars from one line; the reward below them."""
    left, weights = 496, [getattr(drive.scenario.reward, weight) for _, weight in TERMS]
    terms = drive.recorder.terms[now.decisions - 1] if now.decisions else (0.0, 0.0, 0.0)
    reward = drive.rewards[now.decisions - 1] if now.decisions else 0.0
    crashed = drive.accident and now.decisions == len(drive.rewards)
    shares = [0.0 if crashed else w * r / sum(weights) for w, r in zip(weights, terms, strict=True)]
    labels = [*(label for label, _ in TERMS), "accident" if crashed else "sum"]
    parts = [text(left - 136, top, "reward of the last decision", fill=QUIET, size=11)]
    for i, (label, value) in enumerate(zip(labels, [*shares, reward], strict=True)):
        last = i == len(TERMS)
        y = top + 12 + i * 21 + 5 * last
        length = min(max(value, -0.13), 1.0) * BAR
        ink = INK if last else QUIET
        parts.append(text(left - 28, y + 10, label, "end", ink, 11, bold=last))
        colour = ALARM if value < 0 else OTHER.colour
        parts.append(rect(left + min(length, 0), y + 1, abs(length), 11, colour, 'rx="1.5"'))
        words = number(round(value, 3)) if value else "0"
        parts.append(text(left + max(length, 0) + 6, y + 10, words, fill=ink, size=11, bold=last))
    return [*parts, line(left, top + 8, left, top + 101, GRID, 1.5)]


def _returns(drive: InteractiveEpisode, ghost: Rollout | None, now: Score, time: float, top: float) -> list[str]:
    """Both returns over the time."""
    rate = drive.scenario.clock.decision_rate
    end = drive.scenario.clock.decisions / rate
    mine = np.concatenate([[0.0], np.cumsum(drive.rewards[: now.decisions])])
    other = np.concatenate([[0.0], np.cumsum(ghost.rewards)]) if ghost else np.zeros(1)
    axes = SvgAxes(716, top, 270, 66, (0, end), span(np.concatenate([mine, other, [-1, 5]]), 6))
    axes.frame("return, and the ghost's", "time (s)", rows=2)
    if ghost:
        look = style(ghost.label)
        axes.line(np.arange(len(other)) / rate, other, look.colour, 1.1, look.line, 0.75)
    axes.line(np.arange(len(mine)) / rate, mine, OTHER.colour, 1.6)
    axes.dot(min(time, end), mine[-1], OTHER.colour)
    return axes.parts
