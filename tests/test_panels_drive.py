"""Driving by hand in the panel: the drawing, the buttons and keys, the ghost, the imagined drives, demonstrations."""

import numpy as np
import pytest

from bootcourse.episodes.lookahead import nine_drives
from bootcourse.panels import drive_panel
from bootcourse.policies import idle_policy
from bootcourse.scenario import ACTION_NAMES, IDLE
from tests.panels import from_page, raise_in_callbacks, words  # noqa: F401

pytestmark = pytest.mark.usefixtures("raise_in_callbacks")
CRASH = ACTION_NAMES.index("keep right")


def test_a_press_is_a_decision_the_drive_is_a_rollout_and_another_begins_after_it():
    panel = drive_panel(seed=3)
    assert panel.rollout is None and "road 3" in panel.view.value and panel.ghost.label == "rule"
    for action in (IDLE, 7, 1):
        panel.pad.buttons[action].click()
    assert panel.rollout.actions.tolist() == [IDLE, 7, 1] and panel.rollout.seed == 3 and ">3 s<" in panel.view.value
    for _ in range(40):
        panel.press(CRASH)
    assert "Over: off the road" in panel.view.value and "press Drive again" in words(panel)
    panel.again.click()
    assert panel.rollout is None and "press Drive again" not in words(panel)
    from_page(panel.road.slider, value=99)
    assert panel.drive.seed == panel.ghost.seed == 99
    for nonsense in (-1, 2.5, 2**32, float("nan")):
        from_page(panel.road.field, value=nonsense)
        assert panel.drive.seed == 99 and "road = " in words(panel.road)


def test_the_ghost_drives_each_road_that_is_chosen():
    panel = drive_panel(seed=2, ghost=idle_policy)
    from_page(panel.road.slider, value=5)
    assert panel.ghost.seed == 5 and (panel.ghost.actions == IDLE).all()


def test_drives_are_kept_as_demonstrations_each_once():
    panel = drive_panel(seed=3)
    panel.keep.click()
    assert "Nothing was driven yet" in words(panel) and not panel.demonstrations
    for decisions in (2, 3):
        for _ in range(decisions):
            panel.press(IDLE)
            panel.keep.click()
        panel.again.click()
    assert [len(drive.actions) for drive in panel.demonstrations] == [2, 3]
    panel.press(IDLE)
    panel.keep.click()
    assert "Kept 3 demonstrations, 6 decisions" in words(panel)


def test_the_nine_futures_of_the_decision_that_comes_are_drawn_and_can_be_hidden():
    panel = drive_panel(3, futures=idle_policy)
    panel.press(7)
    accidents = nine_drives(panel.drive.recorder.states[-1][None], idle_policy).accidents > 0
    assert f"{accidents.sum()} of 9 imagined drives end in an accident" in panel.svg.alt
    chosen = [trail.chosen for trail in panel.futures()[0]]
    assert np.array_equal(chosen, [False] * 8 + [True])
    panel.nine.value = False
    assert "imagined drives" not in panel.svg
