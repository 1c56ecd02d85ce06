"""The compiled update and training, against the torch learner and against what a training must do."""

import numpy as np
import pytest
import torch

from bootcourse.episodes.record import record
from bootcourse.errors import BootcourseError
from bootcourse.learn import records, vectorised
from bootcourse.learn.compiled_learner import CompiledLearner
from bootcourse.learn.compiled_training import train
from bootcourse.learn.learner import SACLearner
from bootcourse.learn.settings import settings_for, with_seeds
from bootcourse.learn.training import Training
from bootcourse.learn.vectorised import learner_sources
from bootcourse.road.compiled import PACKAGE, sources
from bootcourse.scenario import Road, Scenario
from bootcourse.storage.checkpoint import load_checkpoint, save_checkpoint
from bootcourse.storage.runs import load_run, save_runs
from tests.test_learn_learner import EVERY_METHOD, INPUTS, VARIANTS, batches, gradients_of

LARGE_ALPHA = [settings_for("bootstrapped", alpha_init=0.5, xi_multiplier=1.0, bonus=0.7, rule_p=0.99)]
ACCEPTED = {"methods": EVERY_METHOD, "variants": VARIANTS, "large alpha": LARGE_ALPHA}


def slopes_of(learner: CompiledLearner, i: int) -> list[torch.Tensor]:
    networks = [records.parameters(learner.work[f"{name}_slopes"]) for name in ("actor", "critic_1", "critic_2")]
    temperature = torch.tensor(learner.work["temperature_loss"][i])
    return [parameter[i] for network in networks for parameter in network] + [temperature]


def agree(ours: torch.Tensor, theirs: torch.Tensor) -> bool:
    """Equal within 1e-4 of the largest. Rounding may take a ReLU's input, or a difference of two critics, through 0."""
    return (ours - theirs).abs().max() <= 1e-4 * max(float(theirs.abs().max()), 1e-6)


@pytest.mark.parametrize("name", ACCEPTED)
def test_an_update_has_the_slopes_the_losses_and_the_steps_of_the_torch_learner(name):
    settings = ACCEPTED[name]
    ours, theirs = CompiledLearner(settings, INPUTS), SACLearner(settings, INPUTS)
    for batch in batches(settings, 3):
        now, then = ours.update(batch), theirs.update(batch)
        for i in range(len(settings)):
            pairs = zip(slopes_of(ours, i), gradients_of(theirs, i), strict=True)
            assert all(agree(*pair) for pair in pairs)
        for loss, values in then.items():
            torch.testing.assert_close(now[loss], values, atol=1e-5, rtol=1e-4, msg=loss)
    for i in range(len(settings)):  # a step of Adam is as large as the rate, however small and uncertain a slope is
        for one, other in zip(ours.agent(i).actor, theirs.agent(i).actor, strict=True):
            assert (one - other).abs().mean() < 1e-3 * 3 * settings[0].actor_lr
        for one, other in zip(ours.agent(i).critics, theirs.agent(i).critics, strict=True):
            assert (one - other).abs().mean() < 1e-3 * 3 * settings[0].critic_lr
    targets = [records.parameters(ours.records[name]) for name in ("target_1", "target_2")]
    for pair, other in zip(zip(*targets, strict=True), theirs.target_critics, strict=True):
        assert (torch.cat(pair) - other).abs().max() < 1e-6


REFUSED = {
    "The compiled learner has no method 'cql'": settings_for("cql"),
    "The compiled learner has no method 'ppo'": settings_for("ppo"),
    r"has hidden = \(64, 64\) only, not \(32, 32\)": settings_for("sac", hidden=(32, 32)),
    "has batch = 64 only, not 128": settings_for("sac", batch=128),
    "has cql_weight = 0.0 only, not 1.0": settings_for("cql_sac"),
}


@pytest.mark.parametrize("words", REFUSED)
def test_what_it_does_not_have_it_refuses_with_a_sentence(words):
    for learner in (lambda settings: CompiledLearner([settings]), train):
        with pytest.raises(BootcourseError, match=words):
            learner(REFUSED[words])


def test_environments_of_another_size_are_refused_with_a_sentence():
    with pytest.raises(BootcourseError, match="has 26 numbers seen only, not 4"):
        CompiledLearner([settings_for("sac")], 4, 2)
    with pytest.raises(BootcourseError, match="has 9 actions only, not 5"):
        CompiledLearner([settings_for("sac")], INPUTS, 5)
    with pytest.raises(BootcourseError, match=r"the compiled training has \(9, 3, 26, 150\)"):
        train(settings_for("sac"), scenario=Scenario(name="wide", road=Road(lanes=5)))
    with pytest.raises(BootcourseError, match="envs_per_agent = 8: give at most 4 here"):
        train(settings_for("sac", envs_per_agent=8))
    with pytest.raises(BootcourseError, match="episodes"):
        train(settings_for("sac"), episodes=5001)


def trained(learner: str, decisions: int, checkpoint=None) -> Training:
    training = Training(with_seeds(settings_for("margin_soft", demonstration_episodes=3), 2), 50, learner=learner)
    for decision in range(decisions):
        if decision == decisions // 2 and checkpoint:
            save_checkpoint(training, checkpoint)
        training.step()
    return training


def test_a_training_with_it_begins_as_with_torch():
    """Sixteen updates after the first 64 decisions: later, rounding alone makes them drive apart."""
    ours, theirs = trained("compiled", 80), trained("torch", 80)
    assert ours.updates == theirs.updates == 17
    np.testing.assert_array_equal(ours.states, theirs.states)
    states = torch.from_numpy(np.random.default_rng(0).normal(size=(50, INPUTS)).astype(np.float32))
    for i in range(2):
        one, other = (training.agent(i) for training in (ours, theirs))
        np.testing.assert_allclose(one.probabilities(states), other.probabilities(states), atol=1e-4)
        np.testing.assert_allclose(one.q_values(states), other.q_values(states), atol=1e-3)
        assert one.alpha == pytest.approx(other.alpha)


def test_a_training_with_it_that_was_stopped_goes_on_as_if_it_never_was(tmp_path):
    whole = trained("compiled", 160, tmp_path / "checkpoint.npz")
    resumed = load_checkpoint(tmp_path / "checkpoint.npz")
    for _ in range(80):
        resumed.step()
    assert resumed.learner_name == "compiled" and resumed.updates == whole.updates > 90
    for i in range(2):
        one, other = (training.agent(i) for training in (whole, resumed))
        assert all(map(torch.equal, [*one.actor, *one.critics], [*other.actor, *other.critics]))
    for name, values in whole.curves.values.items():
        np.testing.assert_array_equal(values, resumed.curves.values[name], err_msg=name)


def test_an_agent_of_it_is_saved_and_read_back(tmp_path):
    result = trained("compiled", 80).result()
    back = load_run(save_runs(result, tmp_path)[1]).agent
    assert all(map(torch.equal, [*back.actor, *back.critics], [*result.agents[1].actor, *result.agents[1].critics]))
    assert record(back.as_policy(with_q=True), [3])[0].q_values.shape[1] == 9


def test_an_agent_is_a_snapshot_and_its_alpha_and_xi_are_those_of_the_curves():
    training = trained("compiled", 80)
    before = training.agent(0)
    weight, alpha = before.actor[0].clone(), before.alpha
    training.step()
    assert torch.equal(before.actor[0], weight) and not torch.equal(training.agent(0).actor[0], weight)
    now = training.learner.coefficients()
    assert now["alpha"][0] < alpha and np.allclose(now["xi"], 200 * now["alpha"])
    others = CompiledLearner([settings_for("soft", xi_fixed=0.3), settings_for("soft", xi_min=5.0)])
    assert np.allclose(others.coefficients()["xi"], [0.3, 5.0])


def test_a_setting_that_is_changed_meanwhile_acts_as_with_torch():
    ours, theirs = trained("compiled", 70), trained("torch", 70)
    for training in (ours, theirs):
        training.change(rule_p=0.5, xi_multiplier=20.0, beta_start=0.3)
        training.update()
    assert ours.learner.coefficients()["xi"][0] < 0.25 and ours.agent(1).settings.rule_p == 0.5
    for name in ("xi", "kl", "actor_loss", "critic_loss"):
        torch.testing.assert_close(ours.losses[name], theirs.losses[name], atol=1e-3, rtol=1e-3)


def test_one_agent_s_loss_that_is_not_finite_stops_that_agent_alone():
    settings = with_seeds(settings_for("sac"), 2)
    training = Training(settings, 50, learner="compiled")
    training.learner.records["log_alpha"][0] = np.nan
    with pytest.warns(UserWarning, match="sac, seed 0: its loss was not finite"):
        for _ in range(70):
            training.step()
    assert set(training.stopped) == {0} and training.agent(1).actor[0].isfinite().all()


def test_a_wrong_learner_is_answered_with_a_sentence():
    settings = [settings_for("sac")]
    for words, given in {
        "Learner 'numba' is unknown": {"learner": "numba"},
        'compiled learner has device="cpu" only': {"learner": "compiled", "device": "cuda"},
        "A learner of your own is not compiled": {"learner": "compiled", "make_learner": SACLearner},
    }.items():
        with pytest.raises(BootcourseError, match=words):
            Training(settings, 5, **given)


def test_the_faster_learner_is_the_compiled_one_where_it_has_the_settings_and_no_other_is_given():
    for name, settings, given in (
        ("compiled", settings_for("soft"), {}),
        ("torch", settings_for("cql"), {}),
        ("torch", settings_for("sac", batch=32), {}),
        (None, settings_for("sac"), {"make_learner": SACLearner}),
    ):
        assert Training([settings], 5, learner="faster", **given).learner_name == name


def test_a_change_of_the_learner_compiles_the_learner_again_and_leaves_the_road_s_cache_alone():
    road, learner = set(sources(PACKAGE)), set(learner_sources(PACKAGE))
    names = {f"{name}.py" for name in ("records", "vectorised", "compiled", "compiled_training")}
    assert {file.name for file in learner - road} == names and road < learner
    assert {file.parent.name for file in road} == {"road", "bootcourse"}


def test_a_learner_that_is_not_compiled_yet_says_how_long_that_takes(tmp_path, monkeypatch, capsys):
    settings = [settings_for("sac")]
    CompiledLearner(settings).update(batches(settings)[0])
    capsys.readouterr()
    CompiledLearner(settings)
    assert capsys.readouterr().err == ""
    monkeypatch.setattr(vectorised, "CACHE_FOLDER", tmp_path)
    CompiledLearner(settings)
    assert capsys.readouterr().err == "The learner is compiled, once: about 15 s.\n"
