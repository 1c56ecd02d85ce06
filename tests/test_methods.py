"""The registry of methods: a method of one's own takes one learner and one entry, and is then like any other."""

import numpy as np
import pytest
import torch

from bootcourse.colours import Style
from bootcourse.episodes.evaluate import evaluate
from bootcourse.errors import BootcourseError
from bootcourse.learn import sac
from bootcourse.learn.learner import SACLearner
from bootcourse.learn.settings import settings_for, with_seeds
from bootcourse.learn.training import Training
from bootcourse.methods import METHODS, Method, display_name, own_method, style
from bootcourse.panels import train_panel
from bootcourse.plots.training_curves import training_curves
from bootcourse.storage.checkpoint import load_checkpoint, save_checkpoint
from bootcourse.storage.runs import load_run, save_runs

SMALL = {"hidden": (8,), "demonstration_episodes": 2, "learning_starts": 16}


class WithoutEntropy(SACLearner):
    """The critic's target has no entropy in it."""

    def soft_value(self, log_pi, q, alpha, constraint):
        return sac.soft_value(log_pi, q, 0 * alpha, constraint)


class Follower(SACLearner):
    """Its agents do what the teacher does, whatever they have learned."""

    needs_teacher = True

    def acting_policy(self, states, rule_actions, decided):
        return self.driving_policy(self.actor, self.critics, states, rule_actions)

    @classmethod
    def driving_policy(cls, actor, critics, states, rule_actions):
        return torch.nn.functional.one_hot(rule_actions, 9).float()


def always_faster(cars, scenario):
    return 7


@pytest.fixture
def toy():
    with own_method("toy", Method("toy method", Style("#117733", ":"), {"xi_multiplier": 0.0}, WithoutEntropy)) as name:
        yield name


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
    assert style("you") == style("idle") != style("sac") and display_name("you, road 3") == "you, road 3"
    assert display_name("sac, seed 3") == "plain SAC, seed 3"
    panel = train_panel(toy, 1, 5)
    assert panel.method.label == display_name(toy) == "toy method"
    assert panel.numbers["xi_multiplier"].layout.display == "none"
    panel.close()


@pytest.fixture
def follower(tmp_path):
    """A run of a method that drives with its teacher, which was `always_faster`."""
    with own_method("follower", Method("follower", Style("#117733"), {"xi_multiplier": 0.0}, Follower)) as name:
        result = Training([settings_for(name, **SMALL)], 3, teacher=always_faster).run(progress=False)
        yield save_runs(result, tmp_path)[0]


def test_an_agent_that_drives_with_its_teacher_asks_it_in_every_state(follower):
    drive = load_run(follower, always_faster).agent.as_policy()
    assert drive(np.zeros((2, 26)), np.zeros((2, 9, 10))).actions.tolist() == [7, 7]


def test_such_an_agent_is_not_loaded_with_another_teacher_and_does_not_drive_without_one(follower):
    with pytest.raises(
        BootcourseError, match=r"drives with the teacher 'always_faster \w+', not 'rule': give the same"
    ):
        load_run(follower)
    agent = load_run(follower, always_faster).agent
    with pytest.raises(BootcourseError, match="drives with its teacher"):
        agent.taught_by(None).as_policy()
    with pytest.raises(BootcourseError, match="give them"):
        agent.probabilities(np.zeros((2, 26)))


def test_a_training_that_goes_on_without_its_method_asks_for_the_learner(tmp_path):
    with own_method("toy", Method("toy", Style("#117733"), {}, WithoutEntropy)):
        save_checkpoint(Training([settings_for("toy", **SMALL)], 5), tmp_path / "checkpoint.npz")
    with pytest.raises(BootcourseError, match="learns with 'toy': add the --learner FILE.py:CLASS"):
        load_checkpoint(tmp_path / "checkpoint.npz")


def test_the_methods_are_what_they_were_after_a_block_with_one_s_own_and_nobody_else_changes_them():
    before = dict(METHODS)
    with own_method("mine", before["sac"]):
        assert METHODS["mine"] is before["sac"]
        with (
            pytest.raises(BootcourseError, match="called 'sac' already: give yours another name"),
            own_method("sac", before["soft"]),
        ):
            pass
    assert METHODS == before
    with pytest.raises(TypeError):
        METHODS["mine"] = before["sac"]
