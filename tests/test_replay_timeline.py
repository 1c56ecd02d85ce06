"""The replay's clock and the places between two recorded states, against arcs worked out by hand."""

import math
import threading
import time

import numpy as np
import pytest

from bootcourse.episodes.record import record
from bootcourse.policies import random_policy, rule_policy
from bootcourse.replay3d.player import Player
from bootcourse.replay3d.timeline import Timeline, arc, between
from bootcourse.road.formulas import bicycle_step
from bootcourse.road.state import ACCELERATION, COLUMNS, EGO, HEADING, SPEED, STEERING, X, Y
from tests.replays import SHORT


@pytest.fixture(scope="module")
def drive():
    return Timeline(record(rule_policy(SHORT), [1], SHORT, "rule")[0])


def row(x=0.0, y=0.0, heading=0.0, v=10.0, acceleration=0.0, steering=0.0):
    car = np.zeros((1, COLUMNS))
    car[0, [X, Y, HEADING, SPEED, ACCELERATION, STEERING]] = x, y, heading, v, acceleration, steering
    return car


def test_a_straight_a_quarter_of_a_circle_and_half_a_turn_end_where_geometry_says():
    assert arc(0.0, 10.0, 1.0, 0.0, 5.0, 0.5) == pytest.approx((10 * 0.5 + 1 * 0.25 / 2, 0.0, 0.0))
    before, after = row(heading=math.pi - 0.05), row(x=-5.0, heading=-math.pi + 0.05)
    headings = [between(before, after, tau, 0.5, 5.0).heading[0] for tau in np.linspace(0, 0.5, 11)]
    assert np.ptp(headings) == pytest.approx(0.1), "a heading turns the short way round"
    radius, slip = 25.0, math.asin(2.5 / 25.0)  # κ = sin β / 2.5 = 1 / 25
    steering = math.atan(2 * math.tan(slip))
    seconds = math.pi / 2 * radius / 10.0
    dx, dy, turn = arc(-slip, 10.0, 0.0, steering, 5.0, seconds)  # the course, heading + slip, starts along x
    assert (dx, dy, turn) == pytest.approx((radius, radius, math.pi / 2))


def test_every_recorded_state_is_hit_exactly(drive):
    for i, states in enumerate(drive.rollout.states):
        moment = drive.at(i * drive.dt)
        np.testing.assert_allclose(moment.x, states[:, X], atol=1e-9)
        np.testing.assert_allclose(moment.y, states[:, Y], atol=1e-9)
        np.testing.assert_allclose(moment.heading, states[:, HEADING], atol=1e-9)
        np.testing.assert_allclose(moment.speed, states[:, SPEED], atol=1e-9)
    np.testing.assert_array_equal(drive.at(-3.0).x, drive.at(0.0).x)
    np.testing.assert_array_equal(drive.at(1e6).x, drive.at(drive.duration).x)


def test_nothing_jumps_and_no_car_is_faster_than_it_drives(drive):
    h = 0.01
    moments = [drive.at(t) for t in np.arange(0.0, drive.duration, h)]
    x, y = np.array([m.x for m in moments]), np.array([m.y for m in moments])
    speed = np.hypot(np.diff(x, axis=0), np.diff(y, axis=0)) / h
    recorded = np.array([m.speed for m in moments])[1:]
    assert np.abs(speed - recorded).max() < 0.6  # the Euler step's own error is half of a · 0.5 s
    assert np.abs(np.diff([m.heading for m in moments], axis=0)).max() < 0.01


def test_under_a_constant_command_the_direction_of_travel_does_not_kink():
    v, steering = 12.0, math.pi / 50
    states = [row(v=v)]
    for _ in range(4):
        x, y, heading, _ = bicycle_step(*states[-1][0, [X, Y, HEADING]], v, 0.0, steering, 5.0, 0.5)
        states.append(row(x, y, heading, v, 0.0, steering))
    path = []
    for before, after in zip(states[:-1], states[1:], strict=True):
        for tau in np.linspace(0, 0.5, 51)[:-1]:
            moment = between(before, after, tau, 0.5, 5.0)
            path.append((moment.x[0], moment.y[0]))
    course = np.unwrap(np.arctan2(*np.diff(np.array(path), axis=0).T[::-1]))
    turned = np.diff(course)
    assert turned.std() < 1e-4 and turned.mean() == pytest.approx(
        v * math.sin(math.atan(math.tan(steering) / 2)) / 2.5 * 0.01, rel=0.02
    )


def test_rewards_are_earned_when_a_decision_is_over(drive):
    assert [drive.earned(t) for t in (0.0, 0.99, 1.0, 19.9, 20.0)] == [0, 0, 1, 19, 20]
    assert [drive.decision(t) for t in (0.0, 0.99, 1.0, 19.9, 20.0)] == [0, 0, 1, 19, 19]
    assert drive.returns[-1] == pytest.approx(drive.rollout.rewards.sum())


def test_an_accident_in_the_middle_of_a_decision_ends_the_time_line_there():
    drives = [Timeline(r) for r in record(random_policy(np.random.default_rng(0)), range(12), SHORT, "random")]
    cut = next(d for d in drives if d.duration % 1.0 == 0.5)
    assert cut.duration == (len(cut.rollout.states) - 1) * 0.5 < cut.decisions
    assert cut.earned(cut.duration) == cut.decisions and cut.at(cut.duration).x[EGO] == cut.rollout.states[-1, EGO, X]


def player(duration=10.0, **settings):
    made = Player(duration, 0.5, lambda t: None)
    for name, value in settings.items():
        setattr(made, name, value)
    return made


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


def test_a_pause_from_another_thread_is_not_lost_while_the_time_goes_on():
    class Paused(Player):
        """Another thread presses Pause just when the end of a loop is reached."""

        @property
        def loop(self):
            if self.playing and presser.ident is None:
                presser.start()
                presser.join(0.2)
            return True

        @loop.setter
        def loop(self, value):
            pass

    clock = Paused(10.0, 0.5, lambda t: None)
    presser = threading.Thread(target=clock.pause)
    clock.t, clock.playing = 9.5, True
    clock.advance(1.0)
    presser.join(5.0)
    assert not clock.playing


@pytest.mark.parametrize(
    ("t", "count", "lands"), [(1.0, 1, 1.5), (1.2, 1, 1.5), (1.2, -1, 1.0), (1.0, -1, 0.5), (0.0, -1, 0.0)]
)
def test_a_step_lands_on_a_simulation_step_and_pauses(t, count, lands):
    clock = player(playing=True, t=t)
    clock.step(count)
    assert clock.t == pytest.approx(lands) and not clock.playing


def test_the_thread_sends_frames_while_playing_and_none_while_paused():
    times = []
    clock = Player(10.0, 0.5, times.append)
    clock.start()
    try:
        clock.play()
        time.sleep(0.5)
        clock.pause()
        time.sleep(0.1)
        count = len(times)
        assert 5 < count < 25 and times == sorted(times)  # 30 a second, on a machine that may be busy
        time.sleep(0.3)
        assert len(times) == count
    finally:
        clock.stop()
