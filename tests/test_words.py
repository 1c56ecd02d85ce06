"""A drive in words says what the drive does."""

import re
from dataclasses import replace

from bootcourse.course.shipped import beginning
from bootcourse.episodes.record import record
from bootcourse.episodes.words import doing, overtaken, transcript
from bootcourse.policies import plan_policy
from bootcourse.road.state import EGO, SPEED, TRAP_1, X
from bootcourse.scenario import DEFAULT, Clock


def moments(sentences: list[str]) -> list[float]:
    return [float(re.match(r"t = ([\d.]+) s:", line)[1]) for line in sentences[:-1]]


def test_the_escape_is_told_in_its_order(escape):
    sentences = transcript(escape)
    assert moments(sentences) == sorted(set(moments(sentences)))
    steps = ["falls back", "changes lane, left", "catches up", "ahead of trap 1", "the time is up"]
    places = [next(i for i, line in enumerate(sentences) if step in line) for step in steps]
    assert places == sorted(places)
    assert sentences[-1].startswith(f"In the end: ahead of trap 1 after {overtaken(escape):g} s.")


def test_every_number_is_the_drive_s_own(escape):
    for line, time in zip(transcript(escape), moments(transcript(escape)), strict=False):
        state = escape.states[round(time / escape.scenario.clock.dt)]
        assert f" {state[EGO, SPEED]:.1f} m/s" in line
        gap = state[TRAP_1, X] - state[EGO, X]
        if abs(gap) > 6:
            assert f"{abs(gap):.0f} m {'behind' if gap > 0 else 'ahead of'} trap 1" in line


def test_a_collision_names_the_other_car(crash):
    assert f"t = {crash.times[-1]:g} s: collision with trap 1, the drive is over." in transcript(crash)[-2]


def test_doing_nothing_is_told_in_a_few_lines(idle):
    sentences = transcript(idle)
    assert len(sentences) < 12 and "still behind trap 1 after 150 s" in sentences[-1]
    assert "Return 23.4 over 1500 m" in sentences[-1]


def test_of_a_recording_that_stops_the_end_is_not_told(idle):
    *_, stops, until = transcript(beginning(idle, 60))
    assert "here the recording stops" in stops and until.startswith("Until here: still behind trap 1 after 60 s.")


def test_patience_is_in_seconds_whatever_the_decision_rate():
    """Catching up for 1.5 s is three decisions at 2 Hz, and too short to be told."""
    scenario = replace(DEFAULT, clock=Clock(decisions=30, decision_rate=2))
    plan = [("brake straight", 2), ("accelerate straight", 4), ("brake straight", 2), ("keep straight", 22)]
    [drive] = record(plan_policy(plan), [3], scenario, "you")
    assert {doing(drive, time) for time in (2.0, 2.5, 3.0)} == {"catches up"}
    sentences = transcript(drive)
    assert not any("catches up" in line for line in sentences) and moments(sentences)[-1] == 15.0
    assert "t = 3.5 s: about as fast as trap 1" in "\n".join(sentences)
