"""How fast the replay is, with generous bounds, measured in time of the processor: other tests run beside these."""

import time
from dataclasses import replace

from bootcourse.episodes.record import record
from bootcourse.policies import rule_policy
from bootcourse.replay3d import replay
from tests.replays import TEN_CARS, thinking


def test_ten_cars_are_ready_in_two_seconds_and_a_frame_of_five_drives_in_half_of_a_thirtieth():
    drive = thinking(record(rule_policy(TEN_CARS), [1], TEN_CARS, "rule")[0])
    started = time.process_time()
    with replay(drive):
        assert time.process_time() - started < 2.0
    five = [replace(drive, label=label) for label in ("sac", "rule", "bootstrapped", "planner", "my own")]
    with replay(five) as live:
        started = time.process_time()
        for k in range(60):
            live._frame(3.0 + k / 30)
        assert (time.process_time() - started) / 60 < 1 / 30 / 2
