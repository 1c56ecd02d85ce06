"""The rule controller: its equations by hand, its corrections to the paper, and a thousand escapes."""

import gymnasium as gym
import numpy as np
import pytest
from gymnasium.vector import AutoresetMode

import bootcourse  # noqa: F401  registers the road
from bootcourse.episodes.evaluate import drive_episodes, held_out_seeds
from bootcourse.errors import BootcourseError
from bootcourse.policies import rule_policy
from bootcourse.road.state import EGO, HEADING, LANE, SPEED, TARGET_LANE, Accident, X, Y
from bootcourse.rule import (
    SENTENCES,
    Reason,
    rule,
    safety_distance,
    sample_stochastic_rule,
    stochastic_rule,
    target_speed,
)
from bootcourse.scenario import CALIBRATED, DEFAULT, IDLE, Road, Scenario

GRID = (6.0, 15.0, 5)  # v_min, v_max, n: 6, 8.25, 10.5, 12.75, 15
INFINITE = float("inf")


def road(ego: tuple, **others: tuple) -> np.ndarray:
    """One road, (1, 9, 10); ego and others are (x, lane, speed), cars not named are far behind and slow."""
    cars = np.zeros((1, 9, 10))
    cars[0, :, X] = -1000.0 - 100.0 * np.arange(9)
    cars[0, :, Y], cars[0, :, LANE], cars[0, :, TARGET_LANE] = 8.0, 2, 2
    for row, (x, lane, speed) in {EGO: ego, **{int(name[1:]): place for name, place in others.items()}}.items():
        cars[0, row, [X, Y, LANE, TARGET_LANE, SPEED]] = [x, 4.0 * lane, lane, lane, speed]
    return cars


# The target speed


@pytest.mark.parametrize(
    ("v_current", "v_target", "chosen"),
    [
        (10.0, 10.0, 8.25),  # the fastest grid speed below 10
        (10.9, 10.9, 10.5),  # the calibrated traps
        (12.0, 10.0, 8.25),  # the slower of the two counts
        (10.0, INFINITE, 8.25),  # nobody in the new lane
        (INFINITE, INFINITE, 15.0),  # nobody at all
        (15.1, 20.0, 15.0),
        (15.0, 20.0, 12.75),  # slower than both, not as fast
        (6.5, 9.0, 6.0),
        (6.0, 9.0, 6.0),  # erratum: no grid speed is slower, so v_min
        (2.0, 0.0, 6.0),
    ],
)
def test_the_target_speed_is_the_fastest_grid_speed_slower_than_both_cars_ahead(v_current, v_target, chosen):
    assert target_speed(v_current, v_target, *GRID) == chosen


# The safety distance, and the sign in the paper


def test_the_safety_distance_worked_by_hand():
    assert safety_distance(15.0, 10.0, 12.0, 1.5, 3.0) == (15 - 10) * 1.5
    assert safety_distance(15.0, 12.0, 10.0, 1.5, 3.0) == 7.5, "the slower of the two cars counts"
    assert safety_distance(11.0, 10.0, 10.0, 1.5, 3.0) == 3.0, "never less than the floor"
    assert safety_distance(8.25, 10.0, 10.0, 1.5, 3.0) == 3.0, "nor when the ego falls back"


def printed_condition(v_ego, v_current, v_target, dx_current, dx_target, t_safe=1.5) -> bool:
    """Algorithm 1 as it is printed: d_s = (v_e - min v) t_safe + Δx_current - Δx_target; change if d_s > Δx_current."""
    d_s = (v_ego - min(v_current, v_target)) * t_safe + dx_current - dx_target
    return d_s - dx_current > 0


def test_the_printed_condition_never_fires_once_the_ego_is_slower_than_the_traps():
    for gap in np.linspace(0.0, 200.0, 401):
        assert not printed_condition(8.25, 10.0, 10.0, dx_current=15.0, dx_target=gap)
    assert printed_condition(15.0, 10.0, 10.0, dx_current=15.0, dx_target=5.0), "but it does when the gap is short"
    assert not printed_condition(15.0, 10.0, 10.0, dx_current=15.0, dx_target=50.0), "and not when it is long"


def test_ours_changes_lane_once_the_gap_is_longer_than_the_safety_distance():
    # ego at 8.25, trap 2 at 10: the distance is the floor, 3 m bumper to bumper, 8 m centre to centre
    near = rule(road((0.0, 2, 8.25), c1=(15.0, 2, 10.0), c2=(7.9, 1, 10.0)), DEFAULT)
    far = rule(road((0.0, 2, 8.25), c1=(15.0, 2, 10.0), c2=(8.1, 1, 10.0)), DEFAULT)
    assert (near.reasons[0], near.lanes[0], near.distances[0]) == (Reason.FALL_BACK, 2, 3.0)
    assert (far.reasons[0], far.lanes[0], far.speeds[0]) == (Reason.CHANGE, 1, 8.25)


# Each reason

BEHIND, TRAPPED = {"c1": (30.0, 2, 10.0)}, {"c1": (15.0, 2, 10.0), "c2": (5.0, 1, 10.0)}
REASONS = [  # the ego and the others: (x, lane, speed); what the rule decides: (reason, lane, speed, action)
    ((0.0, 2, 10.0), TRAPPED, (Reason.FALL_BACK, 2, 8.25, 1)),  # brake, straight
    ((0.0, 1, 10.0), {}, (Reason.FREE, 1, 15.0, 7)),
    ((0.0, 1, 15.0), {}, (Reason.FREE, 1, 15.0, IDLE)),
    ((0.0, 1, 10.0), {"c3": (201.0, 1, 8.0)}, (Reason.FREE, 1, 15.0, 7)),  # beyond sight
    ((0.0, 1, 10.0), {"c3": (199.0, 1, 8.0)}, (Reason.CHANGE, 0, None, None)),
    ((0.0, 0, 10.0), {"c3": (40.0, 0, 12.0)}, (Reason.LEFTMOST, 0, 10.5, None)),
    # a car comes up on the left, 12 m/s against 10: (12 - 10) 1.5 = 3 m bumper to bumper
    ((0.0, 2, 10.0), BEHIND | {"c3": (-7.9, 1, 12.0)}, (Reason.WAIT_FOR_FOLLOWER, 2, None, None)),
    ((0.0, 2, 10.0), BEHIND | {"c3": (-8.1, 1, 12.0)}, (Reason.CHANGE, 1, None, None)),
    ((0.0, 2, 10.0), BEHIND | {"c3": (-9.4, 1, 13.0)}, (Reason.WAIT_FOR_FOLLOWER, 2, None, None)),  # 4.5 m
    ((0.0, 2, 10.0), BEHIND | {"c3": (-9.6, 1, 13.0)}, (Reason.CHANGE, 1, None, None)),
]


@pytest.mark.parametrize(("ego", "others", "decided"), REASONS)
def test_the_rule_decides_as_its_algorithm_says(ego, others, decided):
    decision = rule(road(ego, **others), DEFAULT)
    actual = (decision.reasons[0], decision.lanes[0], decision.speeds[0], decision.actions[0])
    assert all(wanted is None or wanted == got for wanted, got in zip(decided, actual, strict=True)), actual
    assert set(SENTENCES) == set(Reason)


def test_it_finishes_one_lane_change_before_it_begins_the_next():
    cars = road((0.0, 1, 10.0), c1=(30.0, 1, 10.0))
    cars[0, EGO, Y] += 0.6
    assert rule(cars, DEFAULT).reasons[0] == Reason.SETTLE
    cars[0, EGO, Y] -= 0.2
    assert rule(cars, DEFAULT).reasons[0] == Reason.CHANGE


def test_cars_of_another_road_and_a_p_outside_its_range_are_refused_in_one_sentence():
    cars, rng = road((0.0, 2, 10.0)), np.random.default_rng(0)
    nowhere = cars.copy()
    nowhere[0, EGO, LANE] = np.nan
    refused = [
        (lambda: rule(cars, Scenario(road=Road(lanes=2))), r"lane 2\.0: this scenario has lanes 0\.\.1"),
        (lambda: rule(cars[0], DEFAULT), r"shape \(9, 10\)"),
        (lambda: rule(nowhere, DEFAULT), "lane nan"),
    ]
    for p in (0.0, 1.0, 0.1, float("nan"), "0.9"):
        refused += [(lambda p=p: stochastic_rule(np.array([4]), p), "outside")]
        refused += [(lambda p=p: sample_stochastic_rule(np.array([4]), p, rng), "outside")]
    for call, sentence in refused:
        with pytest.raises(BootcourseError, match=sentence):
            call()
    assert rule(cars[:0], DEFAULT).actions.shape == (0,), "no roads is no mistake"


# The tracker


@pytest.mark.parametrize("speed", [6.0, 8.25, 10.0, 12.5, 15.0, 20.0])
@pytest.mark.parametrize("offset", [-1.9, 0.3, 1.9])
def test_from_anywhere_in_a_lane_it_comes_to_its_middle_and_stays_there(speed, offset):
    env = gym.make_vec("bootcourse:Trap-v0", num_envs=1, autoreset_mode=AutoresetMode.DISABLED).unwrapped
    env.reset(seed=0)
    lane = 0 if offset < 0 else 2
    env.cars[0] = road((0.0, lane, speed))[0]
    env.cars[0, EGO, Y] += offset
    for decision in range(60):
        env.step(rule(env.cars, DEFAULT).actions)
        if decision >= 2 and env.cars[0, EGO, SPEED] <= DEFAULT.rule.v_max:  # faster than that it never wants to be
            assert abs(env.cars[0, EGO, Y] - 4.0 * lane) < 1.6, "a jog is 2.6 m: it cannot always come closer"
            assert abs(env.cars[0, EGO, HEADING]) < 0.25
    assert not env.asleep[0]


# A thousand episodes


def test_over_1000_held_out_episodes_the_rule_always_escapes_and_never_has_an_accident():
    episodes = drive_episodes(rule_policy(DEFAULT), held_out_seeds(1, 1000))
    assert episodes.success.all() and (episodes.accident == Accident.NONE).all()
    assert 1600 <= episodes.distance.mean() <= 1850, "the paper: 1727 m"


def test_it_has_no_accident_behind_the_calibrated_traps_or_on_four_lanes():
    for scenario in (CALIBRATED, Scenario(road=Road(lanes=4)), Scenario(road=Road(lanes=2))):
        episodes = drive_episodes(rule_policy(scenario), held_out_seeds(2, 200), scenario)
        assert (episodes.accident == Accident.NONE).all()


# The stochastic form


def test_the_stochastic_rule_gives_p_to_the_rules_action_and_shares_the_rest():
    probabilities = stochastic_rule(np.array([4, 0]), 0.9)
    assert probabilities.shape == (2, 9)
    assert probabilities[0, 4] == probabilities[1, 0] == 0.9
    assert np.delete(probabilities[0], 4) == pytest.approx(np.full(8, 0.1 / 8))
    assert probabilities.sum(axis=1) == pytest.approx([1.0, 1.0])
    assert stochastic_rule(np.array([[1, 2], [3, 4]]), 0.5).shape == (2, 2, 9)
    assert stochastic_rule(np.array([7]), 1 / 9) == pytest.approx(np.full((1, 9), 1 / 9)), "uniform at 1/9"


def test_its_samples_have_its_probabilities():
    n = 200_000
    actions = sample_stochastic_rule(np.full(n, 6), 0.7, np.random.default_rng(0))
    frequencies = np.bincount(actions, minlength=9) / n
    expected = stochastic_rule(np.array(6), 0.7)
    spread = np.sqrt(expected * (1 - expected) / n)
    assert (np.abs(frequencies - expected) < 5 * spread).all()
