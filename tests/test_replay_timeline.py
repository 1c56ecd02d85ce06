"""The replay's clock, and the places between two recorded states."""

import numpy as np
import pytest

from bootcourse.episodes.record import record
from bootcourse.policies import random_policy, rule_policy
from bootcourse.replay3d.player import Player
from bootcourse.replay3d.timeline import Timeline
from bootcourse.road.state import EGO, HEADING, SPEED, X, Y
from tests.replays import SHORT


@pytest.fixture(scope="module")
def drive():
    return Timeline(record(rule_policy(SHORT), [1], SHORT, "rule")[0])


def test_every_recorded_state_is_hit_exactly_and_nothing_jumps_in_between(drive):
    for i, states in enumerate(drive.rollout.states):
        np.testing.assert_allclose(drive.at(i * drive.dt)[:, [X, Y, HEADING, SPEED]], states[:, [X, Y, HEADING, SPEED]])
    np.testing.assert_array_equal(drive.at(-3.0), drive.at(0.0))
    np.testing.assert_array_equal(drive.at(1e6), drive.at(drive.duration))
    path = np.array([drive.at(t) for t in np.arange(0.0, drive.duration, 0.01)])
    speed = np.hypot(*np.diff(path[:, :, [X, Y]], axis=0).transpose(2, 0, 1)) / 0.01
    assert np.abs(speed - path[1:, :, SPEED]).max() < 0.6  # the Euler step's own error is half of a · 0.5 s
    assert np.abs(np.diff(path[:, :, HEADING], axis=0)).max() < 0.01


def test_an_accident_in_the_middle_of_a_decision_ends_the_time_line_there():
    drives = [Timeline(r) for r in record(random_policy(np.random.default_rng(0)), range(12), SHORT, "random")]
    cut = next(d for d in drives if d.duration % 1.0 == 0.5)
    assert cut.duration == (len(cut.rollout.states) - 1) * 0.5 < len(cut.rollout.actions) == cut.earned(cut.duration)
    assert cut.at(cut.duration)[EGO, X] == cut.rollout.states[-1, EGO, X]


def player(**settings):
    clock = Player(10.0, 0.5, lambda t: None)
    vars(clock).update(settings)
    return clock


def test_time_runs_at_the_chosen_speed_and_stops_at_the_end():
    clock = player(speed=2.0, playing=True)
    assert clock.advance(1.5) and clock.t == 3.0
    clock.advance(100.0)
    assert clock.t == 10.0 and not clock.playing and not clock.advance(1.0)
    clock.play()
    assert clock.t == 0.0 and clock.playing
    clock.seek(4.0, hold=True)  # a hand on the slider
    assert not clock.advance(1.0) and clock.t == 4.0
    clock.seek(99.0)
    assert clock.t == 10.0
    loop = player(loop=True, playing=True, t=9.5)
    loop.advance(1.0)
    assert loop.t == pytest.approx(0.5) and loop.playing


@pytest.mark.parametrize(
    ("t", "count", "lands"), [(1.0, 1, 1.5), (1.2, 1, 1.5), (1.2, -1, 1.0), (1.0, -1, 0.5), (0.0, -1, 0.0)]
)
def test_a_step_lands_on_a_simulation_step_and_pauses(t, count, lands):
    clock = player(playing=True, t=t)
    clock.step(count)
    assert clock.t == pytest.approx(lands) and not clock.playing
