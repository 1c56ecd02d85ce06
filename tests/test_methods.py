"""The registry of methods: a method of one's own takes one learner and one entry, and is then like any other."""

import numpy as np
import pytest

from bootcourse.colours import Style
from bootcourse.episodes.evaluate import evaluate
from bootcourse.errors import BootcourseError
from bootcourse.learn import sac
from bootcourse.learn.learner import SACLearner
from bootcourse.learn.settings import Settings, settings_for, with_seeds
from bootcourse.learn.training import Training
from bootcourse.methods import METHODS, Method, display_name, style
from bootcourse.panels import train_panel
from bootcourse.plots.training_curves import training_curves
from bootcourse.storage.runs import load_checkpoint, load_run, save_checkpoint, save_runs

SMALL = {"hidden": (8,), "demonstration_episodes": 2, "learning_starts": 16}


class WithoutEntropy(SACLearner):
    """The critic's target has no entropy in it."""

    def soft_value(self, log_pi, q, alpha, constraint):
        return sac.soft_value(log_pi, q, 0 * alpha, constraint)


@pytest.fixture
def toy(monkeypatch):
    entry = Method("toy method", Style("#117733", ":"), {"xi_multiplier": 0.0}, WithoutEntropy, {"gamma": "is a toy"})
    monkeypatch.setitem(METHODS, "toy", entry)
    return "toy"


def test_a_method_of_one_s_own_trains_is_saved_evaluated_drawn_and_offered(toy, tmp_path):
    training = Training(with_seeds(settings_for(toy, **SMALL), 2), episodes=6)
    training.step()
    save_checkpoint(training, tmp_path / "checkpoint.npz")
    result = load_checkpoint(tmp_path / "checkpoint.npz").run(progress=False)
    run = load_run(save_runs(result, tmp_path / "runs")[0])
    assert run.agent.settings.method == toy and evaluate(run.agent.as_policy(), 5).episodes == 5
    assert (
        "Toy method (2 agents)" in training_curves({toy: result.curves}, "A toy").alt
        and style("toy, seed 1").colour == "#117733"
    )
    panel = train_panel(toy, 1, 5)
    assert panel.method.label == display_name(toy) == "toy method"
    assert panel.numbers["gamma"].slider.disabled and panel.numbers["xi_multiplier"].slider.disabled
    panel.close()


def test_its_learner_is_the_one_that_trains(toy):
    mine, usual = (Training([settings_for(method, xi_multiplier=0.0, **SMALL)], 30) for method in (toy, "demos"))
    assert type(mine.learner) is WithoutEntropy and type(usual.learner) is SACLearner
    for training in (mine, usual):
        while training.updates < 20:
            training.step()
    first, second = (training.learner.critics[0].detach().numpy() for training in (mine, usual))
    assert not np.array_equal(first, second)


def test_a_label_that_names_no_method_keeps_its_words():
    assert display_name("you, road 3") == "you, road 3" and display_name("sac, seed 3") == "plain SAC, seed 3"
    assert style("you") == style("idle") != style("sac")


def test_settings_with_the_defaults_of_another_method_say_how_to_get_its_own():
    with pytest.raises(BootcourseError, match=r"write settings_for\('sac'\)"):
        Settings(method="sac")
