"""What is drawn where, against the rollout; the car; the numbers of the head-up display."""

import math
import re
from dataclasses import replace

import numpy as np
import pytest

from bootcourse import colours
from bootcourse.episodes.record import record
from bootcourse.episodes.words import ACCIDENTS
from bootcourse.errors import BootcourseError
from bootcourse.policies import idle_policy, random_policy, rule_policy
from bootcourse.replay3d import hud, scene
from bootcourse.replay3d.camera import CAMERAS, pose
from bootcourse.replay3d.car import car_parts
from bootcourse.replay3d.timeline import Timeline
from bootcourse.road.state import CRASHED, EGO, HEADING, SPEED, TRAP_1, Accident, X, Y
from bootcourse.rule import stochastic_rule
from bootcourse.scenario import CALIBRATED, DEFAULT, Clock
from tests.replays import SHORT, thinking


@pytest.fixture(scope="module")
def rule_drive():
    return record(rule_policy(SHORT), [1], SHORT, "rule")[0]


@pytest.fixture(scope="module")
def idle_drive():
    return record(idle_policy, [1], SHORT, "sac")[0]


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


def test_a_car_points_where_it_goes(rule_drive):
    timeline, h = Timeline(rule_drive), 0.05
    for t in np.arange(0.2, 18, 0.37):
        a, b = scene.view(timeline, t), scene.view(timeline, t + h)
        course = np.arctan2(b.y - a.y, b.x + b.anchor - a.x - a.anchor)
        assert np.abs(course - a.yaw).max() < 0.08  # the slip angle, and what one step turns


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


def test_two_roads_lie_side_by_side_around_the_middle():
    first, second = scene.offsets(2, DEFAULT.road)
    assert first - second > 3 * 4.0 and (first + second) / 2 == 4.0, "the leftmost lane is a lane left of the middle"
    assert scene.span(2, DEFAULT.road) == first - second + 3 * 4.0 + 2 * 1.0


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


@pytest.mark.parametrize("part", ["paint", "dark", "light", "lamps"])
def test_the_car_is_closed_faces_outward_and_fits_its_rectangle(part):
    mesh = car_parts()[part]
    a, b, c = (mesh.vertices[mesh.faces[:, i]] for i in range(3))
    assert np.einsum("ij,ij->", a, np.cross(b, c)) > 0
    edges_of = [tuple(edge) for face in mesh.faces for edge in zip(face, np.roll(face, -1), strict=True)]
    assert len(edges_of) == len(set(edges_of)) and {(j, i) for i, j in edges_of} == set(edges_of)
    assert np.abs(mesh.vertices[:, 0]).max() < 2.55 and np.abs(mesh.vertices[:, 1]).max() < 1.05
    assert mesh.vertices[:, 2].min() > -0.01
    assert np.ptp(car_parts(4.0, 1.8)["paint"].vertices[:, 0]) == pytest.approx(4.0), "it has the scenario's size"


def test_a_camera_stands_apart_from_what_it_looks_at():
    for name in CAMERAS:
        place = pose(name, 14.0)
        assert math.dist(place.position, place.look_at) > 10 and place.position[2] > 3
        assert pose(name, 90.0).position[2] > place.position[2]


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


def test_a_driver_without_thoughts_has_none_shown(rule_drive):
    shown = text(hud.card(Timeline(rule_drive), 3.0))
    assert "KL" not in shown and " Q" not in shown and "accelerate left" in shown


def test_an_agent_without_q_has_its_kl_and_a_sentence_instead_of_numbers(rule_drive):
    shown = text(hud.card(Timeline(replace(thinking(rule_drive, "ppo"), q_values=None)), 7.5))
    assert "No Q: this agent has none, or it was not recorded." in shown and "KL(π‖π̃) =" in shown
    assert "action π π̃ brake left" in shown, "two columns, none of them Q"


def test_a_label_from_a_file_cannot_write_into_the_page(rule_drive):
    nasty = replace(rule_drive, label="<script>alert(1)</script>")
    for html in (hud.card(Timeline(nasty), 1.0), hud.table([Timeline(nasty)], 1.0), hud.plots([Timeline(nasty)])):
        assert "<script" not in html


def test_the_plots_mark_an_accident_and_the_end_is_said_in_words(accidents, idle_drive):
    assert hud.plots([Timeline(accidents[Accident.COLLISION])]).count(colours.ALARM) == 3
    assert colours.ALARM not in hud.plots([Timeline(idle_drive)])
    assert hud.cursor(0.25) == "<style>:root{--bc-t:0.2500}</style>"
    rule, idle = (record(driver, [1], DEFAULT, "x")[0] for driver in (rule_policy(DEFAULT), idle_policy))
    assert hud.status(Timeline(rule), 150.0)[0] == "escaped" and hud.status(Timeline(idle), 150.0)[0] == "trapped"
    assert hud.status(Timeline(idle), 10.0)[0] == ""


def test_the_return_s_plot_is_over_seconds_whatever_the_decision_rate():
    scenario = replace(DEFAULT, clock=Clock(decisions=20, decision_rate=2))
    [drive] = record(idle_policy, [1], scenario, "idle")
    [returns] = re.findall(r'd="M([^"]+)"', hud.plots([Timeline(drive)]))[2:]
    across = [float(point.split()[0]) for point in returns.split("L")]
    np.testing.assert_allclose(across, np.arange(21) / 2 / 10.0 * 1000, atol=0.1)  # 1000 wide, 10 s long
