"""The training panel: train, look, stop, watch, and what goes wrong on the way."""

import socket
import time

import numpy as np
import pytest

from bootcourse.learn.settings import settings_for, with_seeds
from bootcourse.learn.training import Training
from bootcourse.panels import train_panel
from tests.panels import from_page, raise_in_callbacks, words  # noqa: F401
from tests.waiting import until

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
    panel.thread.join(60)
    assert not panel.thread.is_alive() and not panel.train.disabled
    return panel


def test_train_trains_with_what_the_sliders_show_and_the_best_agent_is_watched():
    panel = small()
    assert panel.stop.disabled and panel.watch.disabled
    panel.numbers["rule_p"].value = 0.5
    trained(panel)
    assert np.isfinite(panel.result.curves["return"]).all() and len(panel.result.agents) == 2
    assert panel.result.agents[0].settings.rule_p == 0.5 and "Done: 6 of 6 episodes" in words(panel)
    panel.watch.click()
    port = panel.replay.port
    assert f":{port}" in panel.stage.value and "which no agent has seen" in words(panel)
    order = panel.children
    assert order.index(panel.stage) < order.index(panel.chart), "the replay opens in sight of its button"
    panel.close()
    with socket.socket() as probe:
        assert probe.connect_ex(("127.0.0.1", port)) != 0


def test_the_curves_grow_while_it_trains_and_stop_stops_within_a_second():
    panel = small(seeds=4, episodes=20_000)
    panel.train.click()
    assert until(lambda: "decisions/s" in words(panel) and "<circle" in panel.chart.value)
    shown = panel.chart.value
    assert until(lambda: panel.chart.value != shown)
    started = time.monotonic()
    panel.stop.click()
    panel.thread.join(10)
    assert time.monotonic() - started < 1.0
    assert panel.result.interrupted and "Stopped: " in words(panel) and not panel.watch.disabled


@pytest.mark.parametrize("prepared", [True, False])
def test_close_while_it_trains_or_prepares_ends_the_thread(prepared):
    panel = small(episodes=20_000)
    panel.train.click()
    assert not prepared or until(lambda: "decisions/s" in words(panel))
    panel.close()
    assert not panel.thread.is_alive()


def test_own_drives_are_what_it_learns_from(escape, monkeypatch):
    seen = []
    monkeypatch.setattr(Training, "run", lambda training, **_: seen.append(training) or training.result())
    trained(small("bootstrapped", 1, drives=[escape]))
    assert seen[0].replay.demonstrations == len(escape.actions)


def test_a_training_that_diverges_names_the_seed():
    panel = small(seeds=1, episodes=20, actor_lr=1e30, critic_lr=1e30)
    with pytest.warns(UserWarning, match="not finite"):
        trained(panel)
    assert panel.result.stopped and "Diverged, and kept as last finite: seed 0." in words(panel)


def test_what_breaks_in_the_thread_is_a_sentence(monkeypatch):
    def breaks(training):
        raise RuntimeError("the road is closed")

    monkeypatch.setattr(Training, "step", breaks)
    assert "The training broke off. RuntimeError: the road is closed" in words(trained(small()))
