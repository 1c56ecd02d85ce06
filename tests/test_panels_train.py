"""The training panel: train, look, stop, watch, and what goes wrong on the way."""

import time
from types import SimpleNamespace

import numpy as np
import pytest

from bootcourse import one_per_cell
from bootcourse.errors import BootcourseError
from bootcourse.learn.settings import settings_for, with_seeds
from bootcourse.learn.training import Training
from bootcourse.panels import train_panel
from bootcourse.panels.watch import Watch
from bootcourse.web.packing import EXACT, packed_network
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


def test_train_trains_with_what_the_sliders_show_and_the_present_agent_is_on_the_road():
    panel = small()
    assert panel.stop.disabled
    panel.numbers["rule_p"].value = 0.5
    trained(panel)
    assert np.isfinite(panel.result.curves["return"]).all() and len(panel.result.agents) == 2
    assert panel.result.agents[0].settings.rule_p == 0.5 and "Done: 6 of 6 episodes" in words(panel)
    [now] = panel.watch.drivers
    assert now["id"] == "now" and now["network"]["sizes"] == [26, 16, 16, 9] and now["updates"] > 0
    assert panel.watch in panel.stage.children and not panel.watch.running


def test_the_curves_grow_while_it_trains_and_stop_stops_within_a_second():
    panel = small(seeds=4, episodes=20_000)
    panel.train.click()
    assert until(lambda: "episodes in" in words(panel) and panel.watch and "<circle" in panel.watch.chart)
    shown, driving = panel.watch.chart, panel.watch.drivers
    assert until(lambda: panel.watch.chart != shown and panel.watch.drivers != driving)
    started = time.monotonic()
    panel.stop.click()
    panel.thread.join(10)
    assert time.monotonic() - started < 1.0
    assert panel.result.interrupted and "Stopped: " in words(panel) and panel.watch.words.startswith("You stopped it")


def test_only_numbers_that_the_method_uses_are_shown_and_taken():
    panel = small("bootstrapped", xi_multiplier=70.0)
    shown = lambda: {name for name, number in panel.numbers.items() if number.layout.display != "none"}  # noqa: E731
    assert shown() == {"rule_p", "xi_multiplier", "bonus", "beta_start"} and panel.settings().xi_multiplier == 70
    panel.method.value = "soft"
    assert shown() == {"rule_p", "xi_multiplier"} and panel.settings().xi_multiplier == 70
    panel.method.value = "sac"
    assert shown() == set() and panel.settings().xi_multiplier == 0
    panel.method.value = "bootstrapped"
    assert shown() == {"rule_p", "xi_multiplier", "bonus", "beta_start"} and panel.settings().xi_multiplier == 70


def test_a_slider_acts_on_the_running_training_and_is_marked_in_its_curves():
    panel = small("bootstrapped", seeds=2, episodes=20_000)
    panel.train.click()
    assert until(lambda: panel.watch and panel.watch.training.updates > 5)
    training = panel.watch.training
    panel.numbers["rule_p"].value = 0.6
    panel.numbers["xi_multiplier"].value = 50.0
    panel.numbers["beta_start"].value = 0.25
    done = training.updates
    assert until(lambda: training.updates > done + 3)
    panel.stop.click()
    panel.thread.join(10)
    learner = training.learner
    assert learner.rule_p.tolist() == [[pytest.approx(0.6)]] * 2 and (training.beta == 0.25).all()
    assert np.allclose(learner.coefficients()["xi"], 50 * learner.coefficients()["alpha"])
    assert {settings.xi_multiplier for settings in training.settings} == {50.0}
    assert [words for _, words in panel.watch.marks] == ["p 0.6", "ξ 50 × α", "β 0.25"]
    assert all(f">{words}<" in panel.watch.chart for _, words in panel.watch.marks)
    assert panel.result.agents[0].settings.rule_p == 0.6, "what is saved says how it was trained"


def test_what_cannot_change_while_it_trains_is_refused_in_one_sentence():
    training = Training(with_seeds(settings_for("soft", **SMALL), 1), 1)
    for values, sentence in (
        ({"gamma": 0.9}, "the setting 'gamma' is unknown"),
        ({"rule_p": 1.5}, "p = 1.5 is outside"),
    ):
        with pytest.raises(BootcourseError, match=sentence):
            training.change(**values)
    cloning = Training(with_seeds(settings_for("bc", **SMALL), 1), 1)
    with pytest.raises(BootcourseError, match="'bc' does not use rule_p"):
        cloning.change(rule_p=0.5)
    with pytest.raises(BootcourseError, match="bonus = 1.0, but method 'bc' is defined by doing without"):
        cloning.change(bonus=1.0)


def test_the_page_gets_the_weights_of_the_watched_agent_and_its_age():
    training = Training(with_seeds(settings_for("soft", **SMALL), 2), 40)
    shown = Watch(training)
    training.run(progress=False, callback=shown.look, updates=20)
    shown.show_now("")
    [now] = shown.drivers
    assert now["network"] == packed_network(training.agent(0).actor, 0, EXACT)
    assert (now["updates"], now["episodes"]) == (20, training.curves.finished[0])
    shown._heard(None, {"kind": "stop"}, [])
    assert shown.stopping
    shown.close()


def test_watching_takes_at_most_a_twentieth_of_the_trainings_time():
    training = Training(with_seeds(settings_for("bootstrapped"), 2), 1000)
    shown = Watch(training)
    started = time.monotonic()
    training.run(progress=False, callback=shown.look, updates=400)
    assert training.updates == 400 and shown.spent < 0.05 * (time.monotonic() - started)
    shown.close()


def test_a_notebooks_cell_shows_its_training_and_closes_what_it_showed_when_it_last_ran(monkeypatch):
    displayed, pictures, cell = [], [], SimpleNamespace(execution_count=1)
    updated = SimpleNamespace(update=lambda shown: pictures.append(shown._repr_mimebundle_()[0]))
    monkeypatch.setattr(one_per_cell, "this_cell", lambda: "cell")
    monkeypatch.setattr("bootcourse.learn.training.this_cell", lambda: "cell")
    monkeypatch.setattr("IPython.get_ipython", lambda: cell)
    monkeypatch.setattr("IPython.display.display", lambda shown, display_id: displayed.append(shown) or updated)

    def train():
        return Training(with_seeds(settings_for("soft", **SMALL), 1), 2).run()

    first, second = train(), train()
    assert not first.interrupted and not second.interrupted
    assert [watch.closed for watch in displayed] == [False, False] and not displayed[0].running
    assert len(pictures) == 2 and "at most 2 episodes" in pictures[0]["text/plain"].lower()
    assert "Done after" in displayed[1].words
    cell.execution_count = 2
    train()
    assert [watch.closed for watch in displayed] == [True, True, False]


@pytest.mark.parametrize("prepared", [True, False])
def test_close_while_it_trains_or_prepares_ends_the_thread(prepared):
    panel = small(episodes=20_000)
    panel.train.click()
    assert not prepared or until(lambda: "episodes in" in words(panel))
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
