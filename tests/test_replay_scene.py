"""What is drawn where, against the rollout; the car; the numbers of the head-up display."""

import re
from dataclasses import replace

import numpy as np
import pytest

from bootcourse.episodes.record import record
from bootcourse.episodes.words import ACCIDENTS
from bootcourse.errors import BootcourseError
from bootcourse.methods import style
from bootcourse.policies import idle_policy, random_policy, rule_policy
from bootcourse.replay3d import hud, scene
from bootcourse.replay3d.timeline import Timeline
from bootcourse.road.state import CRASHED, EGO, HEADING, SPEED, TRAP_1, Accident, X, Y
from bootcourse.rule import stochastic_rule
from bootcourse.scenario import ACTION_NAMES, CALIBRATED, DEFAULT, Clock
from tests.replays import SHORT, thinking


@pytest.fixture(scope="module")
def rule_drive():
    return record(rule_policy(SHORT), [1], SHORT, "rule")[0]


@pytest.fixture(scope="module")
def accidents():
    """One drive of each kind that a random driver meets."""
    drives = record(random_policy(np.random.default_rng(0)), range(30), SHORT, "random")
    return {
        kind: next(d for d in drives if d.accident == kind) for kind in (Accident.COLLISION, Accident.ROAD_DEPARTURE)
    }


def test_every_car_stands_where_the_rollout_says_with_y_mirrored(rule_drive):
    timeline = Timeline(rule_drive)
    for step in (0, 7, 40):
        view = scene.view(timeline, step * 0.5)
        states = rule_drive.states[step]
        np.testing.assert_allclose(view.x + view.anchor, states[:, X], atol=1e-9)
        np.testing.assert_allclose(view.y, -states[:, Y], atol=1e-9)
        np.testing.assert_allclose(view.yaw, -states[:, HEADING], atol=1e-9)
        assert view.x[EGO] == 0.0
    for part, lamp in ((0, "brake"), (2, "power")):
        decision = np.flatnonzero(rule_drive.actions // 3 == part)[0]
        assert scene.view(timeline, decision + 0.2).lamps[EGO] == lamp


@pytest.mark.parametrize("kind", [Accident.COLLISION, Accident.ROAD_DEPARTURE])
def test_an_accident_marks_its_cars_at_its_moment_and_says_its_kind(accidents, kind):
    rollout = accidents[kind]
    timeline = Timeline(rollout)
    assert not scene.view(timeline, timeline.duration - 0.6).marked[EGO]
    view = scene.view(timeline, timeline.duration)
    crashed = set(np.flatnonzero(rollout.states[-1, :, CRASHED])) | {EGO}
    assert set(np.flatnonzero(view.marked)) == crashed and (len(crashed) > 1) == (kind == Accident.COLLISION)
    assert view.labels[EGO] == ACCIDENTS[kind] == hud.status(timeline, timeline.duration)[0]
    late = scene.view(timeline, 20.0)  # a drive that ended waits for the others
    np.testing.assert_array_equal(view.x, late.x)
    assert late.ended


def test_the_path_and_the_distance_to_a_trap_are_those_of_the_drive(rule_drive):
    crumbs = scene.crumbs(Timeline(rule_drive), 3.2)
    shown = crumbs[crumbs[:, 2] > 0]  # a dot for each step; the future is hidden
    np.testing.assert_allclose(shown[:, 0], rule_drive.states[:7, EGO, X])
    np.testing.assert_allclose(shown[:, 1], -rule_drive.states[:7, EGO, Y])
    ahead = rule_drive.states[0, TRAP_1, X] - rule_drive.states[0, EGO, X] - 5.0  # from bumper to bumper
    assert scene.view(Timeline(rule_drive), 0.0).labels[TRAP_1] == f"trap 1: {ahead:.1f} m ahead"


def test_drivers_of_your_own_get_different_colours(rule_drive):
    drives = [replace(rule_drive, label=name) for name in ("mine", "another", "rule")]
    mine, another, rule = (timeline.colour for timeline in scene.timelines_of(drives))
    assert len({mine, another, rule}) == 3 and rule == style("rule").colour
    assert mine in hud.table(scene.timelines_of(drives), 1.0)


def with_nan(rollout):
    broken = replace(rollout, states=rollout.states.copy())
    broken.states[3, 0, X] = np.nan
    return broken


REFUSED = {
    "nothing": (lambda r: [], "There are 0 drives to replay: give one to 8"),
    "something else": (lambda r: ["drive.npz"], "Cannot replay str"),
    "too many": (lambda r: [r] * 9, "There are 9 drives"),
    "another scenario": (lambda r: [r, record(rule_policy(CALIBRATED), [1], CALIBRATED)[0]], "drives of the same road"),
    "another seed": (lambda r: [r, record(rule_policy(SHORT), [2], SHORT)[0]], "drives of the same road"),
    "NaN": (lambda r: with_nan(r), "record this drive again"),
}


@pytest.mark.parametrize("case", REFUSED)
def test_drives_that_cannot_be_shown_together_get_one_sentence(case, rule_drive):
    make, sentence = REFUSED[case]
    with pytest.raises(BootcourseError, match=sentence) as refusal:
        scene.timelines_of(make(rule_drive))
    assert "\n" not in str(refusal.value)


def text(html):
    return re.sub(r"\s+", " ", re.sub(r"<[^>]*>", " ", html))


def test_the_numbers_are_those_of_the_rollout(rule_drive):
    rollout = thinking(rule_drive)
    shown = text(hud.card(Timeline(rollout), 7.5))
    timeline = Timeline(rollout)
    assert "7.5 of 20 s" in shown and f"{timeline.at(7.5)[EGO, SPEED]:.1f} m/s" in shown
    assert f"return {rollout.rewards[:7].sum():.2f}" in shown and f"reward {rollout.rewards[6]:.3f}" in shown
    policy, rule = rollout.policy[7], stochastic_rule(rollout.rule_actions[7], 0.9)
    assert f"KL(π‖π̃) = {(policy * np.log(policy / rule)).sum():.2f} nats" in shown
    assert f"{rollout.q_values[7, 3]:.2f}" in shown and "Rule:" in shown


def test_without_details_the_numbers_are_plain_words_and_only_the_rule_says_why(rule_drive):
    agent, rule = Timeline(thinking(rule_drive)), Timeline(replace(rule_drive, label="rule"))
    alone = text(hud.page([agent], 7.5, details=False))
    doing = ACTION_NAMES[rule_drive.actions[7]]
    assert f"return {rule_drive.rewards[:7].sum():.1f} · {doing}" in alone
    both = text(hud.page([rule, agent], 7.5, details=False))
    assert doing in both
    for shown in (alone, both):
        assert not any(symbol in shown for symbol in ("π", "KL", "Q", "r v")), shown
    assert "Rule:" in text(hud.page([rule], 7.5, details=False)) and "Rule:" not in alone
    short_sighted = Timeline(replace(rule_drive, label="rule, sight 20 m"))
    assert "Rule:" in text(hud.page([short_sighted], 7.5, details=False))
    assert "KL(π‖π̃)" in text(hud.page([agent, rule], 7.5, details=True))


def test_a_driver_shows_the_thoughts_that_it_has_and_says_which_are_missing(rule_drive):
    shown = text(hud.card(Timeline(replace(thinking(rule_drive, "ppo"), q_values=None)), 7.5))
    assert "No Q: this agent has none, or it was not recorded." in shown and "KL(π‖π̃) =" in shown
    shown = text(hud.card(Timeline(rule_drive), 3.0))
    assert "KL" not in shown and " Q" not in shown and "accelerate left" in shown


def test_the_end_is_said_in_words():
    rule, idle = (record(driver, [1], DEFAULT, "x")[0] for driver in (rule_policy(DEFAULT), idle_policy))
    assert hud.status(Timeline(rule), 150.0)[0] == "escaped" and hud.status(Timeline(idle), 150.0)[0] == "trapped"
    assert hud.status(Timeline(idle), 10.0)[0] == ""


def test_the_return_s_plot_is_over_seconds_whatever_the_decision_rate():
    scenario = replace(DEFAULT, clock=Clock(decisions=20, decision_rate=2))
    [drive] = record(idle_policy, [1], scenario, "idle")
    [returns] = re.findall(r'd="M([^"]+)"', hud.plots([Timeline(drive)]))[2:]
    across = [float(point.split()[0]) for point in returns.split("L")]
    np.testing.assert_allclose(across, np.arange(21) / 2 / 10.0 * 1000, atol=0.1)  # 1000 wide, 10 s long
