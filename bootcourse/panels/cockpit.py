"""What a driver sees: the road from above with the ghost, the score, the reward's terms, the return beside the ghost's.

A pure function of a drive, a rollout and a time.
"""

import numpy as np

from bootcourse.colours import ALARM, OTHER
from bootcourse.episodes.interactive import InteractiveEpisode, interpolate_states
from bootcourse.episodes.rollout import Rollout
from bootcourse.episodes.words import ACCIDENTS
from bootcourse.methods import display_name, style
from bootcourse.plots.road import BEHIND, road_svg
from bootcourse.plots.svg import GRID, INK, QUIET, SvgAxes, drawing, line, number, rect, span, text
from bootcourse.road.state import EGO, LANE, SPEED, TRAP_1, Accident, X

WIDTH, SCALE, HEAD = 1000, 8.0, 24  # pixels; pixels per metre; pixels
BELOW = 150  # pixels for the score
BAR = 150  # pixels that a reward of 1 is long
ENDS = ACCIDENTS | {Accident.NONE: "time is over"}
TERMS = (("r_v, speed", "w_v"), ("r_y, lane centre", "w_y"), ("r_θ, steering", "w_theta"))


def finished(drive: InteractiveEpisode, time: float) -> int:
    """Decisions that are over at a time of this drive."""
    if time >= drive.time:
        return len(drive.rewards)
    return int(time * drive.scenario.clock.decision_rate + 1e-9)


def ghost_at(ghost: Rollout, time: float) -> tuple[np.ndarray, float]:
    """(every car's state in the ghost's drive, its return so far); after its end, as it ended."""
    decisions = int(time * ghost.scenario.clock.decision_rate + 1e-9)
    return interpolate_states(ghost.states, time / ghost.scenario.clock.dt), float(ghost.rewards[:decisions].sum())


def cockpit(drive: InteractiveEpisode, ghost: Rollout | None, time: float, coming: str = "") -> str:
    """The drawing at a time of the drive (s); coming: the action that was chosen for the next decision, in words."""
    cars, scenario = drive.cars_at(time), drive.scenario
    ghosts = [(ghost_at(ghost, time)[0][EGO], style(ghost.label).colour)] if ghost else []
    parts, height = road_svg(cars, scenario, OTHER.colour, WIDTH, SCALE, ghosts)
    parts = [*_head(drive, ghost, time, coming), f'<g transform="translate(0 {HEAD})">', *parts, "</g>"]
    top = HEAD + height
    parts += _score(drive, ghost, time, cars, top + 30)
    parts += _terms(drive, finished(drive, time), top + 30)
    parts += _returns(drive, ghost, time, top + 40)
    return drawing(WIDTH, top + BELOW, parts, alt_text(drive, ghost, time))


def _head(drive: InteractiveEpisode, ghost: Rollout | None, time: float, coming: str) -> list[str]:
    middle = BEHIND * WIDTH
    parts = [rect(middle - 12, 8, 14, 7, OTHER.colour, 'rx="2"'), text(middle + 7, 16, drive.label, bold=True)]
    if ghost:
        parts.append(rect(middle + 50, 8, 14, 7, style(ghost.label).colour, 'rx="2" opacity="0.7"'))
        parts.append(text(middle + 69, 16, f"the ghost: {display_name(ghost.label)}", fill=QUIET))
    if drive.over and time >= drive.time:
        parts.append(text(WIDTH - 4, 16, f"Over: {ENDS[Accident(drive.accident)]}", "end", ALARM, 13, bold=True))
    elif coming:
        parts.append(text(WIDTH - 4, 16, f"next: {coming}", "end", INK, 12))
    parts.append(text(0, 16, f"road {drive.seed}", fill=QUIET))
    return parts


def _score(drive: InteractiveEpisode, ghost: Rollout | None, time: float, cars: np.ndarray, top: float) -> list[str]:
    """Six numbers."""
    mine = sum(drive.rewards[: finished(drive, time)])
    ahead = float(cars[EGO, X] - cars[TRAP_1, X])
    end = drive.scenario.clock.decisions / drive.scenario.clock.decision_rate
    shown = [
        ("time", f"{time:.0f} s", f"of {end:g} s"),
        ("speed", f"{cars[EGO, SPEED]:.1f} m/s", "15 earns most"),
        ("lane", f"{int(cars[EGO, LANE])}", "0 is leftmost"),
        ("your return", f"{mine:.1f}".replace("-", "−"), "rewards so far"),
        ("ghost's", f"{ghost_at(ghost, time)[1]:.1f}".replace("-", "−") if ghost else "none", "at this time"),
        ("trap 1", f"{abs(ahead):.0f} m", "behind you" if ahead > 0 else "ahead of you"),
    ]
    parts = []
    for i, (label, value, below) in enumerate(shown):
        x, y = (i % 3) * 112, top + (i // 3) * 62
        parts += [text(x, y, label, fill=QUIET, size=11), text(x, y + 20, value, size=18, bold=True)]
        parts.append(text(x, y + 35, below, fill=QUIET, size=10.5))
    return parts


def _terms(drive: InteractiveEpisode, decisions: int, top: float) -> list[str]:
    """What each term adds to the last reward, as bars from one line; the reward below them."""
    left, weights = 496, [getattr(drive.scenario.reward, weight) for _, weight in TERMS]
    terms = drive.recorder.terms[decisions - 1] if decisions else (0.0, 0.0, 0.0)
    crashed = drive.accident and decisions == len(drive.rewards)
    shares = [0.0 if crashed else w * r / sum(weights) for w, r in zip(weights, terms, strict=True)]
    reward = drive.rewards[decisions - 1] if decisions else 0.0
    parts = [text(left - 136, top, "reward of the last decision", fill=QUIET, size=11)]
    labels = [*(label for label, _ in TERMS), "accident" if crashed else "sum"]
    rows = zip(labels, [*shares, reward], strict=True)
    for i, (label, value) in enumerate(rows):
        y, last = top + 12 + i * 21 + (5 if i == 3 else 0), i == 3
        length = min(max(value, -0.13), 1.0) * BAR
        parts.append(text(left - 28, y + 10, label, "end", INK if last else QUIET, 11, bold=last))
        colour = ALARM if value < 0 else OTHER.colour
        parts.append(rect(left + min(length, 0), y + 1, abs(length), 11, colour, 'rx="1.5"'))
        words = number(round(value, 3)) if value else "0"
        parts.append(text(left + max(length, 0) + 6, y + 10, words, fill=INK if last else QUIET, size=11, bold=last))
    return [*parts, line(left, top + 8, left, top + 101, GRID, 1.5)]


def _returns(drive: InteractiveEpisode, ghost: Rollout | None, time: float, top: float) -> list[str]:
    """Both returns over the time."""
    mine = np.concatenate([[0.0], np.cumsum(drive.rewards[: finished(drive, time)])])
    other = np.concatenate([[0.0], np.cumsum(ghost.rewards)]) if ghost else np.zeros(1)
    rate = drive.scenario.clock.decision_rate
    end = drive.scenario.clock.decisions / rate
    axes = SvgAxes(716, top, 270, 66, (0, end), span(np.concatenate([mine, other, [-1, 5]]), 6))
    axes.frame("return, and the ghost's", "time (s)", rows=2)
    if ghost:
        look = style(ghost.label)
        axes.line(np.arange(len(other)) / rate, other, look.colour, 1.1, look.line, 0.75)
    axes.line(np.arange(len(mine)) / rate, mine, OTHER.colour, 1.6)
    axes.dot(min(time, end), mine[-1], OTHER.colour)
    return axes.parts


def alt_text(drive: InteractiveEpisode, ghost: Rollout | None, time: float) -> str:
    cars, mine = drive.cars_at(time), sum(drive.rewards[: finished(drive, time)])
    ahead = float(cars[EGO, X] - cars[TRAP_1, X])
    told = f"Road {drive.seed} after {time:.0f} s: {cars[EGO, SPEED]:.1f} m/s in lane {int(cars[EGO, LANE])}, "
    told += f"{abs(ahead):.0f} m {'ahead of' if ahead > 0 else 'behind'} trap 1, return {mine:.1f}."
    if ghost:
        told += f" The ghost, {display_name(ghost.label)}, has {ghost_at(ghost, time)[1]:.1f}."
    if drive.over and time >= drive.time:
        told += f" It is over: {ENDS[Accident(drive.accident)]}."
    return told
