"""The scenario: impossible numbers are refused in one sentence, and a scenario survives the disk."""

import dataclasses
import json
import math
import re

import pytest

from bootcourse.errors import BootcourseError
from bootcourse.scenario import (
    CALIBRATED,
    DEFAULT,
    Car,
    Clock,
    Ego,
    Reward,
    Road,
    Rule,
    Scenario,
    Traffic,
    Traps,
    check_p,
    scenario_from,
)

IMPOSSIBLE = [
    # (what is made, words that its sentence must hold: the field and the value)
    (lambda: Road(lanes=1), "Road.lanes = 1: give a whole number of 2 or more, at most 8."),
    (lambda: Road(lanes=2.5), "Road.lanes = 2.5: give a whole number"),
    (lambda: Road(lane_width=0.0), "Road.lane_width = 0.0: give a finite number above 0, at most 100."),
    (lambda: Road(speed_limit=math.nan), "Road.speed_limit = nan: give a finite number"),
    (lambda: Clock(simulation_rate=3, decision_rate=2), "3 Hz is not a multiple of the decision rate (2 Hz)"),
    (lambda: Clock(decision_rate=True), "Clock.decision_rate = True"),
    (lambda: Car(width="2"), "Car.width = '2'"),
    (lambda: Ego(speed=0.5), "Ego.speed = 0.5 m/s must lie above min_speed (1.0)"),
    (lambda: Ego(speed=30.0), "not above max_speed (25.0)"),
    (lambda: Traps(d1=(16.44, 14.80)), "Traps.d1 = (16.44, 14.8): give (low, high), low first"),
    (lambda: Traps(d1=15.0), "Traps.d1 = 15.0: give (low, high)"),
    (lambda: Traps(d2=(4.06, 15.0)), "D2 must be the shorter distance"),
    (lambda: Traffic(spacing=(-0.5, 1.5)), "Traffic.spacing = (-0.5, 1.5): give a finite number of 0 or more"),
    (lambda: Traffic(speed=(11.0, math.inf)), "Traffic.speed = (11.0, inf): give a finite number"),
    (lambda: Reward(w_v=0.0, w_y=0.0, w_theta=0.0), "at least one weight must be above 0"),
    (lambda: Rule(v_max=6.0), "Rule.v_max = 6.0 m/s must be above v_min (6.0)"),
    (lambda: check_p(1 - 1e-9), "is 1 in single precision"),
    (lambda: check_p(1.0), "p = 1.0 is outside [1/9, 1)"),
    (lambda: check_p(0.1), "p = 0.1 is outside [1/9, 1)"),
    (lambda: check_p(math.nan), "p = nan is outside [1/9, 1)"),
    (lambda: check_p("0.9"), "p = '0.9' is outside [1/9, 1)"),
    (lambda: Scenario(road=3), "Scenario.road = 3: expected Road"),
    (lambda: Scenario(road=Road(length=1000.0)), "Road.length = 1000.0 m is shorter than"),
    (lambda: Scenario(traps=Traps(d1=(4.0, 5.0), d2=(1.0, 2.0))), "trap 1 would start inside the ego"),
    (lambda: Scenario(car=Car(width=4.0)), "Car.width = 4.0 m does not fit a lane of 4.0 m"),
    (lambda: Scenario(traffic=Traffic(lead=4.0)), "Traffic.lead (4.0 m)"),
    (lambda: Scenario(traffic=Traffic(headway=8.0)), "headway x spacing (from 4.0 m)"),
    (lambda: Scenario(traps=Traps(speed=31.0)), "Traps.speed = 31.0 m/s is above the road's speed limit (30.0 m/s)"),
    (lambda: Scenario(traffic=Traffic(speed=(20.0, 31.0))), "Traffic.speed = (20.0, 31.0) m/s is above the road's"),
]


@pytest.mark.parametrize(("make", "words"), IMPOSSIBLE)
def test_an_impossible_value_is_refused_in_one_sentence_that_names_it(make, words):
    with pytest.raises(BootcourseError) as refusal:
        make()
    sentence = str(refusal.value)
    assert words in sentence
    assert "\n" not in sentence and sentence.endswith(".")


def test_the_calibrated_scenario_differs_only_in_its_traps():
    assert CALIBRATED.traps.speed == 10.9
    assert dataclasses.replace(CALIBRATED, name="default", traps=Traps()) == DEFAULT


def test_a_scenario_cannot_be_changed_behind_ones_back():
    with pytest.raises(dataclasses.FrozenInstanceError):
        DEFAULT.traps.speed = 12.0
    assert hash(DEFAULT) == hash(Scenario())


def test_a_mistyped_scenario_is_told_the_nearest_name():
    assert scenario_from("calibrated") is CALIBRATED
    with pytest.raises(BootcourseError, match="did you mean 'calibrated'"):
        scenario_from("calibratet")


def test_a_dictionary_names_what_differs_from_the_default_and_a_whole_one_survives_json():
    dense = scenario_from({"name": "dense", "traffic": {"cars": 12, "speed": [11.0, 12.0]}})
    assert dense == Scenario("dense", traffic=Traffic(cars=12, speed=(11.0, 12.0)))
    for scenario in (DEFAULT, CALIBRATED, dense):
        assert scenario_from(json.loads(json.dumps(dataclasses.asdict(scenario)))) == scenario
    assert scenario_from(dense) is dense


@pytest.mark.parametrize(
    ("given", "words"),
    [
        ({"trafic": {}}, "Scenario: field 'trafic' is unknown: did you mean 'traffic'"),
        ({"traffic": {"car": 3}}, "Traffic: field 'car' is unknown: did you mean 'cars'"),
        ({"traffic": {"cars": -1}}, "Traffic.cars = -1: give a whole number"),
        ({"traffic": 12}, "Scenario.traffic = 12: expected Traffic"),
        ({"name": 3}, "Scenario.name = 3"),
        ({3: {}}, "field '3' is unknown"),
        (None, "scenario = None: give a Scenario, the name of one, or a dictionary"),
    ],
)
def test_a_scenario_that_is_none_is_refused_in_one_sentence(given, words):
    with pytest.raises(BootcourseError, match=re.escape(words)):
        scenario_from(given)
