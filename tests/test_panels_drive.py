"""Driving by hand in the panel: buttons, both clocks, the ghost, and what is kept of a drive."""

import time

import numpy as np
import pytest

from bootcourse import one_per_cell
from bootcourse.episodes.interactive import InteractiveEpisode
from bootcourse.episodes.record import record
from bootcourse.episodes.rollout import Rollout
from bootcourse.errors import BootcourseError
from bootcourse.learn.demonstrations import demonstration_rows
from bootcourse.panels.cockpit import alt_text, cockpit, finished, ghost_at
from bootcourse.panels.drive import REAL, STEPS, drive_panel
from bootcourse.panels.pad import ROWS, SCRIPT, SIGNS, Pad
from bootcourse.panels.ticker import Ticker
from bootcourse.panels.train import train_panel
from bootcourse.policies import idle_policy, plan_policy, rule_policy
from bootcourse.road.state import EGO, X
from bootcourse.scenario import ACTION_NAMES, CALIBRATED, DEFAULT, IDLE
from tests.panels import from_page, raise_in_callbacks, threads, wait_for, words  # noqa: F401

pytestmark = pytest.mark.usefixtures("raise_in_callbacks")
CRASH = ACTION_NAMES.index("keep right")


def real_time(panel, pace=0.1):
    from_page(panel.mode, index=1)
    from_page(panel.pace.field, value=pace)
    return panel


# ---- the drawing


def test_the_drawing_keeps_its_size_at_every_moment():
    drive, ghost = InteractiveEpisode(3), record(rule_policy(DEFAULT), [3], label="rule")[0]
    shown = [cockpit(drive, ghost, 0.0), cockpit(drive, None, 0.0)]
    while not drive.over:
        drive.decide(CRASH)
        shown += [cockpit(drive, ghost, drive.time - 0.3), cockpit(drive, ghost, drive.time, "keep left")]
    assert len({svg[: svg.index("role")] for svg in shown}) == 1
    assert "Over: off the road" in shown[-1] and "accident" in shown[-1]


def test_a_decision_counts_when_its_second_is_over():
    drive = InteractiveEpisode(3)
    drive.decide(IDLE)
    drive.decide(IDLE)
    assert [finished(drive, time) for time in (0.0, 0.9, 1.0, 1.9, 2.0)] == [0, 0, 1, 1, 2]


def test_the_ghost_moves_between_its_steps_and_stays_where_it_ended():
    ghost = record(plan_policy([("keep right", 30)]), [3])[0]
    cars, _ = ghost_at(ghost, 0.25)
    assert ghost.states[0, EGO, X] < cars[EGO, X] < ghost.states[1, EGO, X]
    cars, total = ghost_at(ghost, 1e6)
    assert np.array_equal(cars, ghost.states[-1]) and total == pytest.approx(ghost.rewards.sum())


def test_the_sentence_for_those_who_see_nothing_says_where_you_are():
    told = alt_text(InteractiveEpisode(3), record(idle_policy, [3], label="idle")[0], 0.0)
    assert told.startswith("Road 3 after 0 s: 10.0 m/s in lane 2, ") and "idle driver" in told


# ---- the pad


def test_each_of_the_nine_buttons_presses_its_own_action():
    pressed = []
    pad = Pad(pressed.append)
    for action, button in enumerate(pad.buttons):
        button.click()
        assert f"bc-pad-{action}" in button._dom_classes and button.tooltip == ACTION_NAMES[action]
    assert pressed == list(range(9))


def test_the_pad_lies_as_the_car_moves():
    names = [[ACTION_NAMES[action] for action in row] for row in ROWS]
    assert [row[0].split()[0] for row in names] == ["accelerate", "keep", "brake"]
    assert all([name.split()[1] for name in row] == ["left", "straight", "right"] for row in names)
    assert SIGNS[7] == "↑" and SIGNS[3] == "←"


def test_the_script_of_the_keys_reaches_the_page_whole():
    pad = Pad(lambda action: None)
    html = pad.children[-1].value
    assert 'onerror="' in html and "&quot;" not in SCRIPT and '"' not in SCRIPT and 'tabindex="0"' in html


# ---- the panel, step by step


def test_a_press_is_a_decision_and_the_drive_is_a_rollout():
    panel = drive_panel(seed=3)
    assert panel.rollout is None and "road 3" in panel.view.value
    for action in (IDLE, 7, 1):
        panel.pad.buttons[action].click()
    assert panel.rollout.actions.tolist() == [IDLE, 7, 1] and panel.rollout.seed == 3
    assert panel.rollout.label == "you" and ">3 s<" in panel.view.value


def test_the_drive_s_end_is_said_and_another_can_begin():
    panel = drive_panel(seed=3)
    for _ in range(40):
        panel.press(CRASH)
    assert "Over: off the road" in panel.view.value and "press Drive again" in words(panel)
    crash = panel.rollout
    panel.again.click()
    assert panel.rollout is None and panel.drives[0].accident == crash.accident != 0
    panel.press(IDLE)
    assert len(panel.rollout.actions) == 1


def test_another_road_begins_a_new_drive_with_its_own_ghost():
    panel = drive_panel(seed=3)
    panel.press(IDLE)
    for seed in (0, 99):
        from_page(panel.road.slider, value=seed)
        assert panel.drive.seed == panel.ghost.seed == seed and panel.rollout is None
    assert len(panel.drives) == 1


@pytest.mark.parametrize("nonsense", [-1, 2.5, 2**32, float("nan"), float("inf")])
def test_a_road_or_a_pace_that_is_none_is_refused_in_a_sentence(nonsense):
    panel = real_time(drive_panel(), 1.0)
    panel.press(IDLE)
    panel.ticker.stop()
    from_page(panel.road.field, value=nonsense)
    assert panel.drive.seed == 0 and "road = " in words(panel.road)
    from_page(panel.pace.field, value=nonsense if nonsense != 2.5 else 11)
    assert panel.pace.value == 1.0 and "pace = " in words(panel.pace)


def test_a_control_that_has_no_use_is_off_and_says_why():
    panel = drive_panel()
    assert panel.go.disabled and panel.pace.slider.disabled and "waits for you" in words(panel.pace)
    panel.go.click()
    assert "choose real time" in words(panel)
    from_page(panel.mode, index=1)
    assert not panel.go.disabled and not panel.pace.slider.disabled


def test_the_ghost_is_the_rule_a_driver_or_a_drive_of_this_road():
    assert drive_panel(seed=2).ghost.label == "rule"
    panel = drive_panel(seed=2, ghost=idle_policy)
    from_page(panel.road.slider, value=5)
    assert panel.ghost.seed == 5 and (panel.ghost.actions == IDLE).all()
    given = record(idle_policy, [2], label="sac, seed 1")[0]
    panel = drive_panel(seed=2, ghost=given)
    assert panel.ghost is given and panel.road.slider.disabled and "plain SAC, seed 1" in panel.view.value


def test_a_ghost_of_another_road_is_refused():
    given = record(idle_policy, [2])[0]
    with pytest.raises(BootcourseError, match="drove road 2"):
        drive_panel(seed=3, ghost=given)
    with pytest.raises(BootcourseError, match="same road"):
        drive_panel(seed=2, ghost=given, scenario=CALIBRATED)


# ---- what is kept


def test_a_drive_is_saved_and_never_over_another(tmp_path):
    panel = drive_panel(seed=3)
    panel.save.click()
    assert "Nothing was driven yet" in words(panel)
    panel.press(IDLE)
    panel.path.value = str(tmp_path / "mine")
    panel.save.click()
    assert Rollout.load(tmp_path / "mine.npz").actions.tolist() == [IDLE]
    panel.save.click()
    assert "exists already" in words(panel)
    for none in (" ", ".", "..", "/"):
        panel.path.value = none
        panel.save.click()
        assert "Name a file" in words(panel), none
    for impossible in ("with\0null", "x" * 300, "~nobody-of-that-name/\0"):
        panel.path.value = impossible
        panel.save.click()
        assert "Cannot write" in words(panel)
    assert len(list(tmp_path.iterdir())) == 1


def test_drives_that_are_kept_bootstrap_an_agent():
    panel = drive_panel(seed=3)
    panel.keep.click()
    assert "Nothing was driven yet" in words(panel) and not panel.demonstrations
    trainer = train_panel("bootstrapped", 1, 2, drives=panel.demonstrations, hidden=(16, 16), learning_starts=8)
    for decisions in (2, 3):
        for _ in range(decisions):
            panel.press(IDLE)
        panel.keep.click()
        panel.again.click()
    assert "2 demonstrations, 5 decisions" in words(panel) or len(demonstration_rows(panel.demonstrations)) == 5
    trainer.train.click()
    assert trainer.background.wait(60) and trainer.background.training.replay.demonstrations == 5
    assert "2 own drives" in trainer.drawn[0].label


def test_the_same_drive_is_one_demonstration_however_often_it_is_kept():
    panel = drive_panel()
    for _ in range(2):
        panel.press(IDLE)
        panel.keep.click()
    assert len(panel.demonstrations) == 1 and len(panel.demonstrations[0].actions) == 2


# ---- real time


def test_in_real_time_the_clock_decides_and_a_press_counts_for_its_next_decision():
    panel = real_time(drive_panel(seed=3))
    panel.press(7)
    assert panel.go.description == "Pause"
    wait_for(lambda: len(panel.drive.actions) >= 3)
    panel.go.click()
    actions = panel.rollout.actions.tolist()
    assert actions[0] == 7 and set(actions[1:]) == {IDLE} and panel.go.description == "Start" and not threads()


def test_between_two_decisions_the_cars_move():
    panel = real_time(drive_panel(seed=3), pace=1.0)
    panel.press(IDLE)
    seen = set()
    wait_for(lambda: seen.add(panel.view.value) or len(seen) >= 4)
    assert len(panel.drive.actions) == 1
    panel.close()


def test_a_pause_and_a_start_lose_nothing():
    panel = real_time(drive_panel(seed=3))
    panel.go.click()
    wait_for(lambda: len(panel.drive.actions) >= 2)
    panel.go.click()
    before = panel.shown
    time.sleep(0.25)
    assert panel.shown == before
    panel.go.click()
    wait_for(lambda: panel.shown > before)
    panel.close()


def test_the_clock_stands_when_the_drive_is_over():
    panel = real_time(drive_panel(seed=3))
    for _ in range(30):
        if panel.drive.over:
            break
        done = len(panel.drive.actions)
        panel.press(CRASH)
        wait_for(lambda done=done: len(panel.drive.actions) > done or panel.drive.over)
    wait_for(lambda: not panel.ticker.running)
    assert panel.drive.over and panel.go.description == "Start"
    wait_for(lambda: not threads())
    panel.go.click()
    assert "This drive is over" in words(panel)


def test_step_by_step_stops_the_clock():
    panel = real_time(drive_panel())
    panel.press(IDLE)
    from_page(panel.mode, index=0)
    assert panel.mode.value == STEPS != REAL and not threads() and panel.shown == panel.drive.time


def test_close_while_it_drives_ends_the_clock():
    panel = real_time(drive_panel())
    panel.press(IDLE)
    panel.close()
    panel.close()
    assert not threads() and panel not in one_per_cell.running()


def test_what_breaks_in_the_clock_s_thread_is_a_sentence(monkeypatch):
    panel = real_time(drive_panel())

    def breaks(action):
        raise RuntimeError("the road is closed")

    monkeypatch.setattr(panel.drive, "decide", breaks)
    panel.go.click()
    wait_for(lambda: not panel.ticker.running)
    assert "The drive broke off: RuntimeError: the road is closed" in words(panel)


def test_a_clock_that_breaks_at_once_does_not_leave_a_button_that_says_pause(monkeypatch):
    panel = real_time(drive_panel())
    start = panel.ticker.start

    def breaks(action):
        raise RuntimeError("the road is closed")

    monkeypatch.setattr(panel.drive, "decide", breaks)
    monkeypatch.setattr(panel.ticker, "start", lambda: start() or time.sleep(0.4))
    panel.go.click()
    wait_for(lambda: not panel.ticker.running)
    assert panel.go.description == "Start" and "broke off" in words(panel)


def test_the_clock_s_thread_writes_nothing_while_a_press_is_handled():
    panel = real_time(drive_panel())
    panel.go.click()
    wait_for(lambda: panel.drive.actions)
    with panel._lock:
        before = panel.shown, panel.view.value
        time.sleep(0.4)
        assert (panel.shown, panel.view.value) == before
    wait_for(lambda: panel.shown > before[0])
    panel.close()


def test_a_clock_starts_and_stops_as_often_as_asked():
    ticks = []
    ticker = Ticker(lambda passed: ticks.append(passed) or True, 50.0)
    for _ in range(2):
        ticker.start()
        ticker.start()
        wait_for(lambda: len(ticks) > 3)
        assert len(threads()) == 1
        ticker.stop()
        ticker.stop()
        assert not threads()
        ticks.clear()


def test_a_reader_without_a_kernel_sees_the_road():
    panel = drive_panel(seed=3)
    bundle = panel._repr_mimebundle_()
    assert "data:image/svg+xml" in bundle["text/html"] and bundle["text/plain"].startswith("Road 3")
