"""A drive in words, for those who do not see the replay: "t = 4 s: changes lane, left. 8.0 m/s, middle lane, ..."."""

from collections.abc import Sequence

import numpy as np

from bootcourse.episodes.rollout import Rollout
from bootcourse.methods import display_name
from bootcourse.plots.figure import sentence
from bootcourse.plots.top_view import ACCIDENTS, cars_at, doing, outcome
from bootcourse.road.state import CRASHED, EGO, SPEED, TRAP_1, TRAP_2, Accident, X, Y

LANES = {1: ("only",), 2: ("left", "right"), 3: ("left", "middle", "right")}
BESIDE = 5.0  # m between centres: closer than a car's length is neither ahead nor behind
PATIENCE = 3.0  # s: what lasts for less is told only if it is a change of lane, an overtaking or the end
PAUSE = 20.0  # s after which something is told even if the car does the same all the time


def transcript(rollout: Rollout) -> list[str]:
    """A drive as sentences in the order of time, one for each thing that the car begins to do, and how it ends."""
    moments = np.arange(0.0, rollout.times[-1], 1 / rollout.scenario.clock.decision_rate)
    phases = [doing(rollout, float(time)) for time in moments]
    told, last, last_lane, when = [], "", _lane(rollout, 0.0), -np.inf
    for i, (time, phase) in enumerate(zip(moments, phases, strict=True)):
        changes, lane = phase.startswith("changes lane"), _lane(rollout, time)
        lasting = i == 0 or changes or phases[i : i + int(PATIENCE)] == [phase] * int(PATIENCE)
        if (phase != last and lasting) or time - when >= PAUSE:
            told.append(f"t = {time:g} s: {phase}. {_state(rollout, time)}")
            last, when = phase, time
        elif lane != last_lane:
            told.append(f"t = {time:g} s: in the next lane. {_state(rollout, time)}")
        last_lane = lane
    end = rollout.times[-1]
    told.append(f"t = {end:g} s: {_ending(rollout)}. {_state(rollout, end)}")
    told.append(f"In the end: {outcome(rollout)}. Return {rollout.rewards.sum():.1f} over {rollout.distance:.0f} m.")
    return told


def in_words(rollouts: Sequence[Rollout]) -> str:
    """The transcripts of some drives below each other, each under its driver's name."""
    return "\n\n".join(
        "\n".join([f"{sentence(display_name(r.label))}, road {r.seed}", *transcript(r)]) for r in rollouts
    )


def _ending(rollout: Rollout) -> str:
    if rollout.accident == Accident.COLLISION:
        return f"collision with {names_of(np.flatnonzero(rollout.states[-1, 1:, CRASHED]) + 1)}, the drive is over"
    return f"{ACCIDENTS[Accident(rollout.accident)]}, the drive is over" if rollout.accident else "the time is up"


def names_of(cars: np.ndarray) -> str:
    """Cars by their rows: "trap 1", "a car of the traffic"."""
    known = [{TRAP_1: "trap 1", TRAP_2: "trap 2"}.get(int(car), "a car of the traffic") for car in cars]
    return " and ".join(dict.fromkeys(known)) or "another car"


def _state(rollout: Rollout, time: float) -> str:
    """Where the ego is at a time: "10.0 m/s, right lane; 16 m behind trap 1, beside trap 2"."""
    cars = cars_at(rollout, time)
    traps = ((TRAP_1, "trap 1"), (TRAP_2, "trap 2"))
    places = ", ".join(f"{_place(cars[trap, X] - cars[EGO, X])} {its_name}" for trap, its_name in traps)
    return f"{cars[EGO, SPEED]:.1f} m/s, {_lane(rollout, time)} lane; {places}."


def _place(ahead: float) -> str:
    """Where the ego is as seen from a car that is so many metres ahead of it."""
    return "beside" if abs(ahead) < BESIDE else f"{abs(ahead):.0f} m {'behind' if ahead > 0 else 'ahead of'}"


def _lane(rollout: Rollout, time: float) -> str:
    """The lane that the ego's centre is in: "left", "middle", "right"; with more: "4 of 5, from the left,"."""
    road = rollout.scenario.road
    lane = int(np.clip(round(cars_at(rollout, time)[EGO, Y] / road.lane_width), 0, road.lanes - 1))
    return LANES[road.lanes][lane] if road.lanes in LANES else f"{lane + 1} of {road.lanes}, from the left,"
