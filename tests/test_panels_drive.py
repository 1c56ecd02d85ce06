"""Driving by hand in the panel: the numbers, buttons, both clocks, the ghost, and what is saved of a drive."""

import time

import numpy as np
import pytest

from bootcourse import one_per_cell
from bootcourse.episodes.interactive import InteractiveEpisode
from bootcourse.episodes.record import record
from bootcourse.episodes.rollout import Rollout
from bootcourse.errors import BootcourseError
from bootcourse.panels.cockpit import cockpit, score
from bootcourse.panels.drive import drive_panel
from bootcourse.panels.pad import ROWS, SCRIPT, Pad
from bootcourse.panels.train import train_panel
from bootcourse.policies import idle_policy, plan_policy
from bootcourse.road.state import EGO, TRAP_1, X
from bootcourse.scenario import ACTION_NAMES, CALIBRATED, IDLE
from tests.panels import UNWRITABLE, from_page, raise_in_callbacks, threads, wait_for, words  # noqa: F401

pytestmark = pytest.mark.usefixtures("raise_in_callbacks")
CRASH = ACTION_NAMES.index("keep right")


def real_time(panel, pace=0.1):
    from_page(panel.mode, index=1)
    from_page(panel.pace.field, value=pace)
    return panel


def breaks(action):
    raise RuntimeError("the road is closed")


def test_a_decision_counts_when_its_second_is_over_and_the_ghost_moves_between_its_steps():
    drive, ghost = InteractiveEpisode(3), record(plan_policy([("keep right", 30)]), [3])[0]
    drive.decide(IDLE)
    drive.decide(IDLE)
    assert [score(drive, ghost, t).decisions for t in (0.0, 0.9, 1.0, 1.9, 2.0)] == [0, 0, 1, 1, 2]
    assert score(drive, ghost, 2.0).earned == sum(drive.rewards)
    assert score(drive, ghost, 1.0).ghost_earned == pytest.approx(ghost.rewards[0])
    assert score(drive, ghost, 0.0).ahead == drive.cars_at(0.0)[EGO, X] - drive.cars_at(0.0)[TRAP_1, X] < 0
    assert ghost.states[0, EGO, X] < score(drive, ghost, 0.25).ghost[X] < ghost.states[1, EGO, X]
    late = score(drive, ghost, 1e6)
    assert np.array_equal(late.ghost, ghost.states[-1, EGO]) and late.ghost_earned == pytest.approx(ghost.rewards.sum())


def test_the_drawing_keeps_its_size_at_every_moment_and_says_how_it_ended(escape):
    drive = InteractiveEpisode(3)
    shown = [cockpit(drive, escape, 0.0), cockpit(drive, None, 0.0)]
    while not drive.over:
        drive.decide(CRASH)
        shown += [cockpit(drive, escape, drive.time - 0.3), cockpit(drive, escape, drive.time, "keep left")]
    assert len({svg[: svg.index("role")] for svg in shown}) == 1
    assert shown[0].alt.startswith("Road 3 after 0 s: 10.0 m/s in lane 2, ") and "rule controller" in shown[0].alt
    assert "Over: off the road" in shown[-1] and shown[-1].alt.endswith("It is over: off the road.")


def test_the_pad_has_a_button_for_each_action_where_the_car_would_go_and_a_script_for_the_keys():
    pressed = []
    pad = Pad(pressed.append)
    for action, button in enumerate(pad.buttons):
        button.click()
        assert f"bc-pad-{action}" in button._dom_classes and button.tooltip == ACTION_NAMES[action]
    assert pressed == list(range(9))
    names = [[ACTION_NAMES[action] for action in row] for row in ROWS]
    directions = ("left", "straight", "right")
    assert names == [[f"{speed} {to}" for to in directions] for speed in ("accelerate", "keep", "brake")]
    assert 'onerror="' in pad.children[-1].value and '"' not in SCRIPT


def test_a_press_is_a_decision_the_drive_is_a_rollout_and_another_begins_after_it():
    panel = drive_panel(seed=3)
    assert panel.rollout is None and "road 3" in panel.view.value
    assert panel.go.disabled and panel.pace.slider.disabled and "waits for you" in words(panel.pace)
    panel.go.click()
    assert "choose real time" in words(panel)
    for action in (IDLE, 7, 1):
        panel.pad.buttons[action].click()
    assert panel.rollout.actions.tolist() == [IDLE, 7, 1] and panel.rollout.seed == 3 and ">3 s<" in panel.view.value
    for _ in range(40):
        panel.press(CRASH)
    assert "Over: off the road" in panel.view.value and "press Drive again" in words(panel)
    crash = panel.rollout
    panel.again.click()
    assert panel.rollout is None and panel.drives[0].accident == crash.accident != 0
    for seed in (0, 99):
        from_page(panel.road.slider, value=seed)
        assert panel.drive.seed == panel.ghost.seed == seed
    real_time(panel, 1.0)
    for nonsense in (-1, 2.5, 2**32, float("nan"), float("inf")):
        from_page(panel.road.field, value=nonsense)
        assert panel.drive.seed == 99 and "road = " in words(panel.road)
        from_page(panel.pace.field, value=nonsense if nonsense != 2.5 else 11)
        assert panel.pace.value == 1.0 and "pace = " in words(panel.pace)


def test_the_ghost_is_the_rule_a_driver_or_a_drive_of_this_road():
    assert drive_panel(seed=2).ghost.label == "rule"
    panel = drive_panel(seed=2, ghost=idle_policy)
    from_page(panel.road.slider, value=5)
    assert panel.ghost.seed == 5 and (panel.ghost.actions == IDLE).all()
    given = record(idle_policy, [2], label="sac, seed 1")[0]
    panel = drive_panel(seed=2, ghost=given)
    assert panel.ghost is given and panel.road.slider.disabled and "plain SAC, seed 1" in panel.view.value
    for other in ({"seed": 3}, {"seed": 2, "scenario": CALIBRATED}):
        with pytest.raises(BootcourseError, match="drove road 2 .*give a drive of the same road"):
            drive_panel(ghost=given, **other)


def test_a_drive_is_saved_and_never_over_another(tmp_path):
    panel = drive_panel(seed=3)
    panel.save.click()
    assert "Nothing was driven yet" in words(panel)
    panel.press(IDLE)
    said = {str(tmp_path / "mine"): "Saved to", str(tmp_path / "mine.npz"): "exists"}
    said |= dict.fromkeys((" ", ".", "..", "/"), "Name a file") | dict.fromkeys(UNWRITABLE, "Cannot write")
    for path, sentence in said.items():
        panel.path.value = path
        panel.save.click()
        assert sentence in words(panel), path
    assert Rollout.load(tmp_path / "mine.npz").actions.tolist() == [IDLE] and len(list(tmp_path.iterdir())) == 1


def test_drives_that_are_demonstrations_bootstrap_an_agent_each_once():
    panel = drive_panel(seed=3)
    panel.keep.click()
    assert "Nothing was driven yet" in words(panel) and not panel.demonstrations
    trainer = train_panel("bootstrapped", 1, 2, drives=panel.demonstrations, hidden=(16, 16), learning_starts=8)
    for decisions in (2, 3):
        for _ in range(decisions):
            panel.press(IDLE)
            panel.keep.click()
        assert f"{sum(len(drive.actions) for drive in panel.demonstrations)} decisions" in words(panel)
        panel.again.click()
    assert [len(drive.actions) for drive in panel.demonstrations] == [2, 3]
    trainer.train.click()
    assert trainer.background.wait(60) and trainer.background.training.replay.demonstrations == 5
    assert "2 own drives" in trainer.drawn[0].label


def test_in_real_time_the_clock_decides_and_a_press_counts_for_its_next_decision():
    panel = real_time(drive_panel(seed=3))
    assert not panel.go.disabled and not panel.pace.slider.disabled
    panel.press(7)
    assert panel.go.description == "Pause"
    wait_for(lambda: len(panel.drive.actions) >= 3)
    panel.go.click()
    assert panel.rollout.actions[0] == 7 and set(panel.rollout.actions[1:]) == {IDLE}
    assert panel.go.description == "Start" and not threads()
    before = panel.shown
    time.sleep(0.25)
    assert panel.shown == before
    panel.go.click()
    wait_for(lambda: panel.shown > before)
    from_page(panel.mode, index=0)  # step by step: no clock
    assert not threads() and panel.shown == panel.drive.time


def test_the_clock_stands_when_the_drive_is_over():
    panel = real_time(drive_panel(seed=3))
    while not panel.drive.over:
        done = len(panel.drive.actions)
        panel.press(CRASH)
        wait_for(lambda done=done: len(panel.drive.actions) > done or panel.drive.over)
    wait_for(lambda: not threads())
    assert panel.go.description == "Start"
    panel.go.click()
    assert "This drive is over" in words(panel)


def test_what_breaks_in_the_clock_s_thread_is_a_sentence_even_if_it_breaks_at_once(monkeypatch):
    panel = real_time(drive_panel())
    start = panel.ticker.start
    monkeypatch.setattr(panel.drive, "decide", breaks)
    monkeypatch.setattr(panel.ticker, "start", lambda: start() or time.sleep(0.4))
    panel.go.click()
    wait_for(lambda: not panel.ticker.running)
    assert "The drive broke off: RuntimeError: the road is closed" in words(panel) and panel.go.description == "Start"


def test_between_two_decisions_the_cars_move_but_not_while_a_press_is_handled_and_close_ends_the_clock():
    panel, seen = real_time(drive_panel(seed=3), pace=1.0), set()
    panel.press(IDLE)
    wait_for(lambda: seen.add(panel.view.value) or len(seen) >= 4)
    with panel._lock:
        before = panel.shown, panel.view.value
        time.sleep(0.3)
        assert (panel.shown, panel.view.value) == before
    wait_for(lambda: panel.shown > before[0])
    panel.close()
    assert len(panel.drive.actions) <= 2 and not threads() and panel not in one_per_cell.running()
