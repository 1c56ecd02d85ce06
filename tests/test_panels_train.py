"""The training panel: train, look, stop, compare, watch, save, and what goes wrong on the way."""

import contextlib
import os
import signal
import socket
import time
from html import unescape

import numpy as np
import pytest
import torch

from bootcourse import one_per_cell
from bootcourse.learn.settings import settings_for, with_seeds
from bootcourse.learn.training import Training
from bootcourse.methods import METHODS
from bootcourse.panels import background as background_module
from bootcourse.panels import train as train_module
from bootcourse.panels.background import Background
from bootcourse.panels.train import train_panel
from bootcourse.panels.train_controls import CONTROLLED, without
from bootcourse.panels.training_chart import SHOWN, Drawn, label_of, training_chart
from bootcourse.storage.runs import find_runs, load_run
from tests.panels import UNWRITABLE, from_page, raise_in_callbacks, threads, wait_for, words  # noqa: F401

pytestmark = pytest.mark.usefixtures("raise_in_callbacks")
SMALL = {"hidden": (16, 16), "demonstration_episodes": 2, "learning_starts": 8}


@pytest.fixture(scope="module", autouse=True)
def compiled():
    """The road is compiled once before the tests, which wait for a few seconds each."""
    Training(with_seeds(settings_for("bootstrapped", **SMALL), 1), 1).step()


def small(method="soft", seeds=2, episodes=3, **more):
    return train_panel(method, seeds, episodes, **(SMALL | more))


def trained(panel):
    panel.train.click()
    assert panel.background.wait(60) and not panel.training
    return panel


@contextlib.contextmanager
def running(**more):
    """A panel whose training goes on until the block ends."""
    panel = small(episodes=20_000, **more)
    panel.train.click()
    wait_for(lambda: panel.background.training is not None)
    yield panel
    panel.background.stop()
    assert panel.background.wait(10)


def choose(panel, method):
    from_page(panel.method, index=list(METHODS).index(method))


def breaks(*arguments):
    raise RuntimeError("the road is closed")


# ---- the drawing


def test_the_drawing_keeps_its_size_names_every_training_and_makes_the_last_stand_out():
    curves = {name: np.random.default_rng(0).random((2, 20)) for name in SHOWN}
    halves = {name: np.where(np.arange(20) < 9, values, np.nan) for name, values in curves.items()}
    none = {name: np.full((2, 20), np.nan) for name in SHOWN}
    two = [Drawn("1 plain SAC", "sac", curves, 20), Drawn("2 bootstrapped SAC", "bootstrapped", halves, 20)]
    drawings = [training_chart(trainings) for trainings in ([], [Drawn("1 a", "sac", none, 20)], two)]
    assert len({svg[: svg.index("role")] for svg in drawings}) == 1 and all("nan" not in svg for svg in drawings)
    assert "press Train" in drawings[0] and "No agent has finished" in drawings[1]
    assert "1 plain SAC" in drawings[2] and "2 bootstrapped SAC, after 9 episodes" in drawings[2].alt
    assert drawings[2].count("<circle") == len(SHOWN), "the last training has a dot and its number in each chart"
    assert label_of(settings_for("bootstrapped", rule_p=0.5, bonus=0.0)) == "bootstrapped SAC, p = 0.5, c = 0"


# ---- the background


def test_looking_takes_a_small_share_of_the_time_and_one_torch_thread():
    looked, threads_of_torch = [], torch.get_num_threads()

    def look(training):
        looked.append((time.monotonic(), torch.get_num_threads()))
        time.sleep(0.06)

    torch.set_num_threads(2)
    try:
        background = Background(lambda: Training([settings_for("sac", **SMALL)], 20_000), look)
        background.start()
        wait_for(lambda: len(looked) > 3)
        assert len(background.peek().agents) == 1 and background.running and torch.get_num_threads() == 2
        background.stop()
        assert background.wait(10) and background.result.interrupted
    finally:
        torch.set_num_threads(threads_of_torch)
    times, counts = zip(*looked, strict=True)
    assert np.diff(times).min() > 0.06 / background_module.SHARE * 0.9 and set(counts) == {1}


def test_an_error_in_the_ending_is_a_sentence_after_what_went_wrong_before():
    said = []
    background = Background(breaks, ended=breaks, say=said.append)
    background.start()
    assert background.wait(10) and not background.running and background.result is None
    assert "The training broke off: RuntimeError" in said[0] and said[1].startswith(said[0])
    assert "could not be shown: RuntimeError" in said[1] and background.traceback.count("in breaks") == 2


# ---- the panel


def test_train_trains_and_a_second_training_is_drawn_over_the_first():
    panel = trained(small())
    assert np.isfinite(panel.result.curves["return"]).all() and len(panel.result.agents) == 2
    assert "Done after 6 of 6 episodes" in words(panel) and panel.train.disabled is False and not threads()
    panel.numbers["rule_p"].value = 0.5
    trained(panel)
    assert [drawn.label for drawn in panel.drawn] == ["1 soft constraint only", "2 soft constraint only, p = 0.5"]
    assert panel.drawn[1].label in panel.chart.value and panel.drawn[0].label in panel.picture().alt


def test_the_curves_grow_while_it_trains_and_stop_stops_within_a_second():
    with running(seeds=4) as panel:
        wait_for(lambda: "decisions/s" in words(panel) and "<circle" in panel.chart.value)
        shown = panel.chart.value
        wait_for(lambda: panel.chart.value != shown and panel.background.training.curves.finished.min() > 2)
        started = time.monotonic()
        panel.stop.click()
        assert panel.background.wait(10) and time.monotonic() - started < 1.0
    assert panel.result.interrupted and np.isfinite(panel.result.curves["return"][:, :3]).all()
    assert "Stopped after" in words(panel) and not panel.save.disabled


@pytest.mark.parametrize("prepared", [True, False])
def test_close_while_it_trains_or_prepares_ends_the_thread(prepared):
    panel = small(episodes=20_000)
    panel.train.click()
    wait_for(lambda: not prepared or panel.background.training is not None)
    panel.close()
    assert not threads() and panel not in one_per_cell.running()


def test_an_interrupt_of_the_kernel_and_a_second_training_leave_the_first_alone():
    with running() as panel:
        other = small()
        other.train.click()
        assert "A training is running already" in words(other) and other.background is None
        with pytest.raises(KeyboardInterrupt):
            os.kill(os.getpid(), signal.SIGINT)
            time.sleep(5)
        assert panel.training


def test_the_best_agent_is_watched_while_it_trains_and_afterwards_and_close_frees_the_port():
    with running() as panel:
        panel.watch.click()
        assert panel.training and "<iframe" in panel.stage.value
    panel.watch.click()
    port = panel.replay.port
    assert f":{port}" in panel.stage.value and "which no agent has seen" in words(panel)
    panel.close()
    with socket.socket() as probe:
        assert probe.connect_ex(("127.0.0.1", port)) != 0
    assert not threads()


def test_save_writes_runs_and_never_writes_over_them(tmp_path):
    panel = small()
    for button, sentence in ((panel.stop, "No training"), (panel.watch, "press Train"), (panel.save, "nothing to")):
        assert button.disabled
        button.click()
        assert sentence in words(panel)
    trained(panel)
    paths = {str(tmp_path / "mine"): "Saved 2 runs", f"{tmp_path / 'mine'} ": "exists already", "  ": "Name a folder"}
    paths |= dict.fromkeys(UNWRITABLE, "Cannot write")
    for path, sentence in paths.items():
        panel.path.value = path
        panel.save.click()
        assert sentence in words(panel), path
    assert len(find_runs(tmp_path / "mine")) == 2
    assert load_run(tmp_path / "mine" / "soft-0").agent.settings == panel.result.agents[0].settings


def test_a_training_that_diverges_names_the_agent():
    panel = small(seeds=1, episodes=20, actor_lr=1e30, critic_lr=1e30)
    with pytest.warns(UserWarning, match="not finite"):
        trained(panel)
    assert panel.result.stopped and "soft constraint only, seed 0, diverged" in words(panel)
    assert "Its last finite snapshot is kept" in words(panel) and not panel.save.disabled


def test_what_breaks_in_the_thread_is_a_sentence_and_keeps_what_was_learned(monkeypatch):
    panel, step = small(episodes=500), Training.step
    monkeypatch.setattr(Training, "step", lambda training: step(training) if training.decisions < 200 else breaks())
    trained(panel)
    assert "The training broke off: RuntimeError: the road is closed" in words(panel)
    assert "breaks" in panel.background.traceback and panel.result.interrupted and not panel.train.disabled


def test_a_curve_that_cannot_be_drawn_is_a_sentence_and_the_training_goes_on(monkeypatch):
    panel = small()
    monkeypatch.setattr(train_module, "training_chart", breaks)
    trained(panel)
    assert "RuntimeError: the road is closed" in words(panel) and "in breaks" in panel.background.traceback
    assert not panel.result.interrupted and not panel.train.disabled and not panel.save.disabled


def test_the_training_s_thread_writes_nothing_while_a_button_is_handled():
    with running() as panel:
        wait_for(lambda: "decisions/s" in words(panel))
        with panel._lock:
            before, decisions = (words(panel), panel.chart.value), panel.background.training.decisions
            wait_for(lambda: panel.background.training.decisions > decisions + 500)
            assert (words(panel), panel.chart.value) == before
        wait_for(lambda: panel.chart.value != before[1])


def test_every_number_takes_both_ends_and_refuses_nonsense_in_a_sentence():
    panel = small("bootstrapped")
    for setting, control in panel.numbers.items():
        for value in (control.slider.min, control.slider.max):
            from_page(control.slider, value=value)
            assert getattr(panel.settings(), setting) == value
    for control in (*panel.numbers.values(), panel.seeds, panel.episodes):
        from_page(control.slider, value=control.slider.max)
        for wrong in (float("nan"), float("inf"), float("-inf")):
            from_page(control.field, value=wrong)
            assert control.value == control.slider.max and control.refused is not None


def test_what_is_untouched_is_the_chosen_method_s_and_what_was_chosen_stays():
    panel = small(episodes=3)
    for method, gamma, episodes in (("sac", 0.8, 3), ("ppo", 0.99, METHODS["ppo"].episodes), ("soft", 0.8, 1000)):
        choose(panel, method)
        assert (panel.settings().gamma, panel.episodes.value) == (gamma, episodes)
    from_page(panel.numbers["gamma"].slider, value=0.5)
    choose(panel, "ppo")
    assert panel.settings().gamma == 0.5
    assert train_panel("ppo_cloned").episodes.value == METHODS["ppo_cloned"].episodes


def test_a_method_s_settings_can_be_chosen_and_what_it_lacks_says_why():
    panel = small(xi_multiplier=100.0)
    for method in METHODS:
        choose(panel, method)
        assert set(without(method)) <= set(CONTROLLED) and panel.settings().method == method
        for setting, control in panel.numbers.items():
            assert control.slider.disabled == control.field.disabled == (setting in without(method)), (method, setting)
            assert without(method).get(setting, control.sentence) in unescape(words(control))
