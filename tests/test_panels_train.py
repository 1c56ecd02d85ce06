"""The training panel: train, look, stop, compare, watch, save, and what goes wrong on the way."""

import contextlib
import os
import signal
import socket
import threading
import time
from html import unescape

import numpy as np
import pytest
import torch

from bootcourse import one_per_cell
from bootcourse.episodes.record import record
from bootcourse.errors import BootcourseError
from bootcourse.learn.settings import settings_for, with_seeds
from bootcourse.learn.training import Training
from bootcourse.methods import METHODS
from bootcourse.panels import background as background_module
from bootcourse.panels import train as train_module
from bootcourse.panels.background import Background
from bootcourse.panels.train import train_panel
from bootcourse.panels.train_controls import CONTROLLED, without
from bootcourse.panels.training_chart import Drawn, label_of, training_chart
from bootcourse.plots.svg import ticks
from bootcourse.policies import rule_policy
from bootcourse.scenario import DEFAULT
from bootcourse.storage.runs import find_runs, load_run
from tests.panels import from_page, raise_in_callbacks, threads, wait_for, words  # noqa: F401

pytestmark = pytest.mark.usefixtures("raise_in_callbacks")
SMALL = {"hidden": (16, 16), "demonstration_episodes": 2, "learning_starts": 8}


@pytest.fixture(scope="module", autouse=True)
def compiled():
    """The road is compiled once before the tests, which wait for a few seconds each."""
    Training(with_seeds(settings_for("bootstrapped", **SMALL), 1), 1).step()


def small(method="soft", seeds=2, episodes=3, **more):
    return train_panel(method, seeds, episodes, **(SMALL | more))


def endless(**more):
    return small(episodes=20_000, **more)


def trained(panel):
    panel.train.click()
    assert panel.background.wait(60) and not panel.training
    return panel


def curves(agents=2, episodes=20):
    rng = np.random.default_rng(0)
    names = ("success", "return", "speed", "distance", "alpha", "xi", "beta", "entropy")
    return {name: rng.random((agents, episodes)) for name in names}


# ---- the drawing


def test_the_drawing_keeps_its_size_whatever_was_trained():
    halves = {name: np.where(np.arange(20) < 9, values, np.nan) for name, values in curves().items()}
    none = {name: np.full_like(values, np.nan) for name, values in curves().items()}
    sets = ([], [Drawn("1 a", "sac", none, 20)], [Drawn("1 a", "sac", curves(), 20), Drawn("2 b", "demos", halves, 20)])
    drawings = [training_chart(drawn) for drawn in sets]
    assert len({svg[: svg.index("role")] for svg in drawings}) == 1
    assert all("nan" not in svg for svg in drawings) and "press Train" in drawings[0]


def test_every_training_that_was_drawn_is_named_and_the_last_stands_out():
    svg = training_chart(
        [Drawn("1 plain SAC", "sac", curves(), 20), Drawn("2 bootstrapped SAC", "bootstrapped", curves(), 20)]
    )
    assert "1 plain SAC" in svg and "2 bootstrapped SAC" in svg
    assert svg.count("<circle") == 8 and svg.count('stroke="#D55E00"') > svg.count('stroke="#0072B2"')


def test_a_label_says_what_differs_from_the_method_s_own_settings():
    assert label_of(settings_for("sac")) == "plain SAC"
    assert label_of(settings_for("bootstrapped", rule_p=0.5, bonus=0.0)) == "bootstrapped SAC, p = 0.5, c = 0"


def test_an_axis_has_a_few_round_numbers():
    assert ticks(0, 100) == [0, 50, 100] and ticks(-10.4, 1.2) == [-10, -5, 0] and ticks(0, 150, 4) == [0, 50, 100, 150]
    for low, high in ((0, 1e-6), (-3, 1e7), (9.1, 9.3)):
        assert 2 <= len(ticks(low, high)) <= 5


# ---- the background


def test_a_second_training_is_refused_while_one_runs():
    first, second = endless(), small()
    first.train.click()
    second.train.click()
    assert "A training is running already" in words(second) and second.background is None
    first.stop.click()
    assert first.background.wait(10)
    assert trained(second).result is not None


def test_what_is_learned_while_it_runs_can_be_had():
    background = Background(lambda: Training(with_seeds(settings_for("sac", **SMALL), 2), 20_000))
    background.start()
    wait_for(lambda: background.training is not None)
    assert len(background.peek().agents) == 2 and background.running
    background.stop()
    assert background.wait(10) and background.result.interrupted


def test_nothing_learned_yet_is_said_so():
    with pytest.raises(BootcourseError, match="Nothing was learned yet"):
        Background(lambda: None).peek()


def test_looking_takes_a_small_share_of_the_time():
    looked = []

    def look(training):
        looked.append(time.monotonic())
        time.sleep(0.06)

    background = Background(lambda: Training([settings_for("sac", **SMALL)], 20_000), look)
    background.start()
    wait_for(lambda: len(looked) > 3)
    background.stop()
    assert background.wait(10) and np.diff(looked).min() > 0.06 / background_module.SHARE * 0.9


@contextlib.contextmanager
def torch_threads(count):
    """So many torch threads in the main thread, and in the threads that it starts."""
    before = torch.get_num_threads()
    torch.set_num_threads(count)
    try:
        yield
    finally:
        torch.set_num_threads(before)


@contextlib.contextmanager
def in_the_background(look=lambda training: None):
    """A background training without an end of its own, which is stopped at the end of the block."""
    background = Background(lambda: Training([settings_for("sac", **SMALL)], 20_000), look)
    background.start()
    try:
        yield background
    finally:
        background.stop()
        assert background.wait(60)


def test_a_background_training_has_one_torch_thread_and_the_main_thread_keeps_its_own():
    looked = []
    with torch_threads(2):
        with in_the_background(lambda training: looked.append(torch.get_num_threads())):
            assert torch.get_num_threads() == 2
            wait_for(lambda: looked, 60)
        assert looked[0] == 1 and torch.get_num_threads() == 2


def torch_threads_of_a_new_thread():
    seen = []
    thread = threading.Thread(target=lambda: seen.append(torch.get_num_threads()))
    thread.start()
    thread.join()
    return seen[0]


def test_trainings_that_overlap_leave_the_number_of_torch_threads_as_it_was():
    training = Training([settings_for("sac", **SMALL)], 20_000)
    with torch_threads(2):
        background = Background(lambda: Training([settings_for("sac", **SMALL)], 20_000))
        training.run(
            progress=False,
            callback=lambda _: background.running or background.start(),
            stop=lambda: background.training is not None,
        )
        assert background.running and torch_threads_of_a_new_thread() == 2
        background.stop()
        assert background.wait(60) and torch.get_num_threads() == torch_threads_of_a_new_thread() == 2


def breaks(*arguments):
    raise RuntimeError("the road is closed")


def test_an_error_in_a_look_is_a_sentence_and_the_training_goes_on():
    said = []
    background = Background(lambda: Training([settings_for("sac", **SMALL)], 3), breaks, say=said.append)
    background.start()
    assert background.wait(60) and not background.result.interrupted
    assert len(said) == 1 and said[0].endswith("RuntimeError: the road is closed") and "goes on" in said[0]
    assert background.error == said[0] and "in breaks" in background.traceback


def test_an_error_in_the_ending_is_a_sentence_after_what_went_wrong_before():
    said = []
    background = Background(breaks, ended=breaks, say=said.append)
    background.start()
    assert background.wait(10) and not background.running and background.result is None
    assert "The training broke off: RuntimeError" in said[0] and said[1].startswith(said[0])
    assert "could not be shown: RuntimeError" in said[1] and background.traceback.count("in breaks") == 2


def test_no_training_begins_before_the_last_one_has_reported_its_end():
    reporting, report = threading.Event(), threading.Event()
    first = Background(breaks, ended=lambda background: reporting.set() or report.wait(10))
    first.start()
    assert reporting.wait(10) and first.running
    with pytest.raises(BootcourseError, match="running already"):
        Background(breaks).start()
    report.set()
    assert first.wait(10)


# ---- the panel


def test_train_trains_and_leaves_its_result():
    panel = trained(small())
    assert np.isfinite(panel.result.curves["return"]).all() and len(panel.result.agents) == 2
    assert "Done after 6 of 6 episodes" in words(panel) and panel.train.disabled is False and not threads()


@pytest.mark.parametrize("method", METHODS)
def test_every_method_trains(method):
    panel = small(seeds=1, episodes=2, envs_per_agent=4, batch=8)
    from_page(panel.method, index=list(METHODS).index(method))
    from_page(panel.episodes.field, value=2)  # some methods have brought a number of their own
    assert trained(panel).result.agents[0].settings.method == method and not panel.background.error


def test_the_page_shows_the_curves_while_it_trains():
    panel = endless()
    panel.train.click()
    wait_for(lambda: "decisions/s" in words(panel) and "<circle" in panel.chart.value)
    shown = panel.chart.value
    wait_for(lambda: panel.chart.value != shown)
    panel.stop.click()
    assert panel.background.wait(10)


def test_stop_stops_within_a_second_and_keeps_what_was_learned():
    panel = endless(seeds=4)
    panel.train.click()
    wait_for(lambda: panel.background.training is not None and panel.background.training.curves.finished.min() > 2)
    started = time.monotonic()
    panel.stop.click()
    assert panel.background.wait(10) and time.monotonic() - started < 1.0
    assert panel.result.interrupted and np.isfinite(panel.result.curves["return"][:, :3]).all()
    assert "Stopped after" in words(panel) and not panel.save.disabled


def test_a_second_training_is_drawn_over_the_first():
    panel = trained(small())
    panel.numbers["rule_p"].value = 0.5
    trained(panel)
    assert len(panel.drawn) == 2 and "1 soft constraint only" in panel.chart.value
    assert "2 soft constraint only, p = 0.5" in panel.chart.value


def test_close_while_it_trains_ends_the_thread():
    panel = endless()
    panel.train.click()
    wait_for(lambda: panel.background.training is not None)
    panel.close()
    panel.close()
    assert not threads() and panel not in one_per_cell.running()


def test_close_while_it_prepares_ends_the_thread():
    panel = endless()
    panel.train.click()
    panel.close()
    assert not threads()


def test_an_interrupt_of_the_kernel_leaves_the_training_alone():
    panel = endless()
    panel.train.click()
    wait_for(lambda: panel.background.training is not None)
    with pytest.raises(KeyboardInterrupt):
        os.kill(os.getpid(), signal.SIGINT)
        time.sleep(5)
    assert panel.training
    panel.stop.click()
    assert panel.background.wait(10) and panel.result is not None


def test_the_best_agent_is_watched_on_a_road_that_none_has_seen_and_close_frees_the_port():
    panel = trained(small())
    panel.watch.click()
    port = panel.replay.port
    assert f":{port}" in panel.stage.value and "which no agent has seen" in words(panel)
    panel.watch.click()
    panel.close()
    for each in {port}:
        with socket.socket() as probe:
            assert probe.connect_ex(("127.0.0.1", each)) != 0
    assert not threads()


def test_it_can_be_watched_while_it_trains():
    panel = endless()
    panel.train.click()
    wait_for(lambda: panel.background.training is not None)
    panel.watch.click()
    assert panel.training and "<iframe" in panel.stage.value


def test_save_writes_runs_and_never_writes_over_them(tmp_path):
    panel = trained(small())
    panel.path.value = str(tmp_path / "mine")
    panel.save.click()
    assert len(find_runs(tmp_path / "mine")) == 2 and "Saved 2 runs" in words(panel)
    assert load_run(tmp_path / "mine" / "soft-0").agent.settings == panel.result.agents[0].settings
    panel.save.click()
    assert "exists already" in words(panel)
    panel.path.value = "  "
    panel.save.click()
    assert "Name a folder" in words(panel)
    for impossible in ("with\0null", "x" * 300, "~nobody-of-that-name/\0"):
        panel.path.value = impossible
        panel.save.click()
        assert "Cannot write" in words(panel)


def test_what_has_no_sense_yet_is_said_in_a_sentence():
    panel = small()
    for button, sentence in (
        (panel.stop, "No training"),
        (panel.watch, "press Train"),
        (panel.save, "nothing to save"),
    ):
        assert button.disabled
        button.click()
        assert sentence in words(panel)


def test_a_training_that_diverges_names_the_agent():
    panel = small(seeds=1, episodes=20, actor_lr=1e30, critic_lr=1e30)
    with pytest.warns(UserWarning, match="not finite"):
        trained(panel)
    assert panel.result.stopped and "soft constraint only, seed 0, diverged" in words(panel)
    assert "Its last finite snapshot is kept" in words(panel) and not panel.save.disabled


def test_what_breaks_in_the_thread_is_a_sentence_and_keeps_what_was_learned(monkeypatch):
    panel = small(episodes=500)
    step = Training.step

    def breaks(training):
        step(training)
        if training.decisions > 200:
            raise RuntimeError("the road is closed")

    monkeypatch.setattr(Training, "step", breaks)
    trained(panel)
    assert "The training broke off: RuntimeError: the road is closed" in words(panel)
    assert "breaks" in panel.background.traceback and panel.result.interrupted and not panel.train.disabled


def test_a_curve_that_cannot_be_drawn_is_a_sentence_and_keeps_what_was_learned(monkeypatch):
    panel = small()
    monkeypatch.setattr(train_module, "training_chart", breaks)
    trained(panel)
    assert "RuntimeError: the road is closed" in words(panel) and "in breaks" in panel.background.traceback
    assert not panel.result.interrupted and not panel.train.disabled and not panel.save.disabled


def test_a_training_that_ends_while_train_is_pressed_again_reports_its_own_end():
    panel = small()
    ended, reporting, report = panel._ended, threading.Event(), threading.Event()

    def late(*arguments):
        reporting.set()
        assert report.wait(10)
        ended(*arguments)

    panel._ended = late
    panel.train.click()
    assert reporting.wait(60)
    panel.numbers["rule_p"].value = 0.5
    panel.train.click()
    assert "running already" in words(panel)
    report.set()
    assert panel.background.wait(10)
    assert "Done after 6 of 6 episodes" in words(panel) and [drawn.label for drawn in panel.drawn] == [
        "1 soft constraint only"
    ]


def test_the_training_s_thread_writes_nothing_while_a_button_is_handled():
    panel = endless()
    panel.train.click()
    wait_for(lambda: "decisions/s" in words(panel))
    with panel._lock:
        before = words(panel), panel.chart.value
        decisions = panel.background.training.decisions
        wait_for(lambda: panel.background.training.decisions > decisions + 500)
        assert (words(panel), panel.chart.value) == before
    wait_for(lambda: panel.chart.value != before[1])
    panel.stop.click()
    assert panel.background.wait(10)


def test_a_training_that_cannot_begin_is_a_sentence():
    panel = train_panel("bootstrapped", 2, 2, drives=record(rule_policy(DEFAULT), [1]), **SMALL)
    panel.drives = [*panel.drives, "not a drive"]
    trained(panel)
    assert "broke off" in words(panel) and panel.result is None and not panel.train.disabled


def test_own_drives_take_the_place_of_the_rule_s():
    mine = record(rule_policy(DEFAULT), [1])
    panel = trained(train_panel("bootstrapped", 1, 2, drives=mine, **SMALL))
    assert panel.background.training.replay.demonstrations == len(mine[0].actions)
    assert "1 own drives" in panel.drawn[0].label


def test_every_number_takes_both_ends_and_refuses_nonsense_in_a_sentence():
    panel = small()
    ends = {
        "rule_p": (0.12, 0.999),
        "xi_multiplier": (0, 2000),
        "bonus": (0, 10),
        "beta_start": (0, 1),
        "gamma": (0, 1),
    }
    from_page(panel.method, index=list(METHODS).index("bootstrapped"))
    for setting, (low, high) in ends.items():
        control = panel.numbers[setting]
        for value in (low, high):
            from_page(control.slider, value=value)
            assert getattr(panel.settings(), setting) == value
        for wrong in (float("nan"), float("inf"), -5.0 if setting != "bonus" else -float("inf")):
            from_page(control.field, value=wrong)
            assert control.value == high and ("give a" in words(control) or "outside" in words(control))
    for control in (panel.seeds, panel.episodes):
        for value in (control.slider.max, control.slider.min, control.slider.max):
            from_page(control.slider, value=value)
            assert control.value == value
        for wrong in (0, 2.5, 1e9, float("nan")):
            from_page(control.field, value=wrong)
            assert control.value == control.slider.max and "number" in words(control)


def test_an_untouched_discount_is_the_chosen_method_s_and_a_chosen_one_stays():
    panel = small()
    from_page(panel.method, index=list(METHODS).index("ppo"))
    assert panel.settings().gamma == settings_for("ppo").gamma == 0.99
    from_page(panel.method, index=list(METHODS).index("sac"))
    assert panel.settings().gamma == 0.8
    from_page(panel.numbers["gamma"].slider, value=0.5)
    from_page(panel.method, index=list(METHODS).index("ppo"))
    assert panel.settings().gamma == 0.5


def test_a_method_with_its_own_number_of_episodes_sets_it_when_it_is_chosen():
    panel = small(episodes=3)

    def chosen(method):
        from_page(panel.method, index=list(METHODS).index(method))
        return panel.episodes.value, panel.episodes.slider.value

    assert chosen("sac") == (3, 50)  # the slider begins at 50
    assert chosen("ppo") == (METHODS["ppo"].episodes,) * 2 == (20_000,) * 2
    from_page(panel.episodes.field, value=15_000)
    assert chosen("ppo_cloned") == (15_000, 15_000)
    assert chosen("soft") == (1000, 1000)


@pytest.mark.parametrize(("method", "episodes"), [("soft", 1000), ("ppo_cloned", 20_000)])
def test_a_panel_opens_with_the_method_s_own_number_of_episodes_or_with_the_given_one(method, episodes):
    assert train_panel(method).episodes.value == episodes and train_panel(method, episodes=7).episodes.value == 7


@pytest.mark.parametrize("method", METHODS)
def test_what_a_method_lacks_cannot_be_set_and_says_why(method):
    panel = small(xi_multiplier=100.0)
    from_page(panel.method, index=list(METHODS).index(method))
    assert set(without(method)) <= set(CONTROLLED)
    for setting, control in panel.numbers.items():
        assert control.slider.disabled == control.field.disabled == (setting in without(method))
        assert without(method).get(setting, control.sentence) in unescape(words(control))
    assert panel.settings().method == method


@pytest.mark.parametrize(
    "wrong", [{"method": "magic"}, {"rule_p": 1.0}, {"gama": 0.5}, {"seeds": 0}, {"episodes": 1.5}]
)
def test_a_panel_that_cannot_be_is_refused(wrong):
    with pytest.raises(BootcourseError):
        train_panel(**wrong)


def test_a_reader_without_a_kernel_sees_the_curves():
    panel = trained(small())
    bundle = panel._repr_mimebundle_()
    assert "data:image/svg+xml" in bundle["text/html"] and "1 soft constraint only, after 3" in bundle["text/plain"]
