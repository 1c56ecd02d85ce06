"""A slice of `python -m tests.agreement`: the two roads drive the same, whatever the ego does."""

import pytest

from tests.agreement import DRIVERS, SCENARIOS, TOLERANCE, run


@pytest.fixture(scope="module")
def report():
    return run(episodes=56, seed=300_000, roads=4)  # every scenario


def test_the_two_roads_agree_in_every_number_of_every_car(report):
    assert report.worst <= TOLERANCE, f"\n{report}"
    assert len(report.largest) == 17, "ten columns, the observation, the reward and its terms, and the end"


def test_the_agreement_was_tested_on_every_ending_on_crashes_and_on_lane_changes(report):
    endings = {ending for endings in report.endings.values() for ending in endings}
    assert endings == {"in time", "collision", "road departure", "stoppage"}
    assert set(report.endings) == {driver.__name__ for driver in DRIVERS}
    events = report.events
    assert events["lane changes that traffic began"] > 100 and events["lane changes that traffic gave up"] > 5
    assert {name for name in SCENARIOS if events[f"episodes of '{name}'"]} == set(SCENARIOS)
    assert events["episodes in which traffic crashed"] > 0 and events["episodes with a success"] > 10
