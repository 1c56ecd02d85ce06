"""A drive in words, for readers who do not see the replay: "t = 4 s: changes lane, left. 8.0 m/s, middle lane, ..."."""

from collections.abc import Sequence

import numpy as np

from bootcourse.episodes.rollout import Rollout, interpolate_states
from bootcourse.errors import BootcourseError
from bootcourse.methods import display_name
from bootcourse.road.state import CRASHED, EGO, LANE, SPEED, TRAP_1, TRAP_2, Accident, X, Y

ACCIDENTS = {
    Accident.COLLISION: "collision",
    Accident.ROAD_DEPARTURE: "off the road",
    Accident.STOPPAGE: "stopped on the road",
}
LANES = {1: ("only",), 2: ("left", "right"), 3: ("left", "middle", "right")}
BESIDE = 5.0  # m between centres: two cars closer than a car's length are beside each other
PATIENCE = 3.0  # s; shorter phases are left out, apart from lane changes
PAUSE = 20.0  # s; longest time without a sentence


def sentence(words: str) -> str:
    """The words with a capital first letter."""
    return words[:1].upper() + words[1:]


def cars_at(rollout: Rollout, time: float) -> np.ndarray:
    """The state of all cars at a time (s), interpolated between simulation steps: (vehicles, 10).

    Raises BootcourseError for a time outside the drive.
    """
    end = rollout.times[-1]
    if not 0 <= time <= end + 1e-9:
        raise BootcourseError(f"time = {time} s: this drive lasts {end:g} s, choose a time from 0 to {end:g}.")
    return interpolate_states(rollout.states, time / rollout.scenario.clock.dt)


def overtaken(rollout: Rollout) -> float | None:
    """The time (s) from which the ego is ahead of trap 1 until the end; None if it ends behind trap 1."""
    behind = np.flatnonzero(rollout.states[:, EGO, X] <= rollout.states[:, TRAP_1, X])
    return float(rollout.times[behind[-1] + 1]) if behind[-1] + 1 < len(rollout.states) else None


def doing(rollout: Rollout, time: float) -> str:
    """The ego's manoeuvre at a time (s), in two or three words."""
    if rollout.accident and time > rollout.times[-1] - 1e-9:
        return ACCIDENTS[Accident(rollout.accident)]
    now, later = (cars_at(rollout, min(t, rollout.times[-1])) for t in (time, time + 1.0))
    before = cars_at(rollout, max(time - 0.5, 0.0))
    sideways = later[EGO, Y] - before[EGO, Y]
    faster = (now[EGO, SPEED] + later[EGO, SPEED]) / 2 - now[TRAP_1, SPEED]
    side = "left" if sideways < 0 else "right"
    if abs(sideways) > 1.0:
        start, end = (cars_at(rollout, min(max(t, 0.0), rollout.times[-1])) for t in (time - 1.5, time + 1.5))
        if start[EGO, LANE] != end[EGO, LANE]:
            return f"changes lane, {side}"
    if now[EGO, X] > now[TRAP_1, X]:
        return "ahead of trap 1" if now[EGO, X] - now[TRAP_1, X] >= BESIDE else "passes trap 1"
    if abs(sideways) > 1.0:
        return f"moves {side}"
    return "about as fast as trap 1" if abs(faster) < 0.3 else ("catches up" if faster > 0 else "falls back")


def outcome(rollout: Rollout) -> str:
    """The end of the drive as a clause: "ahead of trap 1 after 57.5 s"."""
    passes, end = overtaken(rollout), rollout.times[-1]
    crash = f"{ACCIDENTS[Accident(rollout.accident)]} after {end:g} s" if rollout.accident else ""
    if passes is None:
        return crash or f"still behind trap 1 after {end:g} s"
    return f"ahead of trap 1 after {passes:g} s" + (f", {crash}" if crash else "")


def transcript(rollout: Rollout) -> list[str]:
    """A drive as a list of sentences: one for each new manoeuvre, in order, then the end of the drive."""
    rate = rollout.scenario.clock.decision_rate  # decisions for each second
    moments = np.arange(0.0, rollout.times[-1], 1 / rate)
    patience = max(1, round(PATIENCE * rate))  # decisions
    phases = [doing(rollout, float(time)) for time in moments]
    lines, last, last_lane, when = [], "", _lane(rollout, 0.0), -np.inf
    for i, (time, phase) in enumerate(zip(moments, phases, strict=True)):
        changes, lane = phase.startswith("changes lane"), _lane(rollout, time)
        lasting = i == 0 or changes or phases[i : i + patience] == [phase] * patience
        if (phase != last and lasting) or time - when >= PAUSE:
            again = "still " if phase == "ahead of trap 1" and any(phase in line for line in lines) else ""
            lines.append(f"t = {time:g} s: {again}{phase}. {_state(rollout, time)}")
            last, when = phase, time
        elif lane != last_lane:
            lines.append(f"t = {time:g} s: in the next lane. {_state(rollout, time)}")
        last_lane = lane
    end = rollout.times[-1]
    lines.append(f"t = {end:g} s: {_ending(rollout)}. {_state(rollout, end)}")
    lines.append(
        f"{'In the end' if _is_over(rollout) else 'Until here'}: {outcome(rollout)}. "
        f"Return {rollout.rewards.sum():.1f} over {rollout.distance:.0f} m."
    )
    return lines


def transcripts(rollouts: Sequence[Rollout]) -> str:
    """The transcripts of some drives, each under its driver's name."""
    return "\n\n".join(
        "\n".join([f"{sentence(display_name(r.label))}, road {r.seed}", *transcript(r)]) for r in rollouts
    )


def _ending(rollout: Rollout) -> str:
    if rollout.accident == Accident.COLLISION:
        return f"collision with {names_of(np.flatnonzero(rollout.states[-1, 1:, CRASHED]) + 1)}, the drive is over"
    if rollout.accident:
        return f"{ACCIDENTS[Accident(rollout.accident)]}, the drive is over"
    return "the time is up" if _is_over(rollout) else "here the recording stops"


def _is_over(rollout: Rollout) -> bool:
    """Whether the drive ended, and not its recording alone."""
    return bool(rollout.accident) or len(rollout.rewards) >= rollout.scenario.clock.decisions


def names_of(cars: np.ndarray) -> str:
    """The names of cars, given by their rows: "trap 1", "a car of the traffic"."""
    known = [{TRAP_1: "trap 1", TRAP_2: "trap 2"}.get(int(car), "a car of the traffic") for car in cars]
    return " and ".join(dict.fromkeys(known)) or "another car"


def _state(rollout: Rollout, time: float) -> str:
    """The ego's speed and place at a time (s): "10.0 m/s, right lane; 16 m behind trap 1, beside trap 2."."""
    cars = cars_at(rollout, time)
    traps = ((TRAP_1, "trap 1"), (TRAP_2, "trap 2"))
    places = ", ".join(f"{_place(cars[trap, X] - cars[EGO, X])} {name}" for trap, name in traps)
    return f"{cars[EGO, SPEED]:.1f} m/s, {_lane(rollout, time)} lane; {places}."


def _place(ahead: float) -> str:
    """The ego's place relative to a car that is `ahead` metres ahead of it."""
    return "beside" if abs(ahead) < BESIDE else f"{abs(ahead):.0f} m {'behind' if ahead > 0 else 'ahead of'}"


def _lane(rollout: Rollout, time: float) -> str:
    """The lane of the ego's centre: "left", "middle", "right"; with more lanes: "4 of 5, from the left,"."""
    road = rollout.scenario.road
    lane = int(np.clip(round(cars_at(rollout, time)[EGO, Y] / road.lane_width), 0, road.lanes - 1))
    return LANES[road.lanes][lane] if road.lanes in LANES else f"{lane + 1} of {road.lanes}, from the left,"
