"""Settings: what the paper says is the default, and nonsense is refused in one sentence."""

import pytest

from bootcourse.errors import BootcourseError
from bootcourse.learn.learner import SACLearner, learner_for
from bootcourse.learn.settings import Settings, settings_for
from bootcourse.learn.training import Training
from bootcourse.methods import ABLATION, METHODS


def test_the_paper_s_setting_takes_two_updates_for_each_decision_and_the_quick_one_a_quarter():
    quick, paper = (settings_for("bootstrapped", setting) for setting in ("quick", "paper"))
    assert [s.updates / s.envs_per_agent for s in (quick, paper)] == [0.25, 2.0]


NONSENSE = [
    ({"gamma": 1.5}, "gamma = 1.5: give a finite number of 0 or more, at most 1."),
    ({"alpha_init": 0.0}, "alpha_init = 0.0: give a finite number above 0."),
    ({"bonus": float("inf")}, "bonus = inf: give a finite number."),
    ({"rule_p": 1.0}, "rule_p = 1.0"),
    ({"seed": -1}, "seed = -1: give a whole number of 0 or more, at most 8,000,000."),
    ({"updates": True}, "updates = True: give a whole number of 1 or more."),
    ({"buffer_size": 64, "envs_per_agent": 65}, "buffer_size = 64: give a whole number from 65"),
    ({"kl_in_target": "no"}, "kl_in_target = 'no': give True or False."),
    ({"hidden": (64, 0)}, "hidden = (64, 0): give the layers' sizes"),
    ({"xi_fixed": -1.0}, "xi_fixed = -1.0: give a finite number of 0 or more."),
    ({"gamma": None}, "gamma = None"),
    ({"method": "rlpd", "target_critics": 6}, "target_critics = 6: give a whole number from 0 to 5."),
    ({"method": "ppo", "anneal_decisions": 0}, "anneal_decisions = 0"),
    ({"method": "bootstraped"}, "'bootstraped' is unknown: did you mean 'bootstrapped'"),
    ({"setting": "papr"}, "'papr' is unknown: did you mean 'paper'"),
    ({"gama": 0.9}, "Setting of 'bootstrapped' 'gama' is unknown: did you mean 'gamma'"),
    # a method cannot be given what its name says it lacks, nor what another has
    ({"method": "sac", "xi_multiplier": 200.0}, "method 'sac' is defined by doing without"),
    ({"method": "demos", "xi_fixed": 1.0}, "xi_fixed = 1.0, but method 'demos' is defined by doing without"),
    ({"method": "gail", "bonus": 2.0}, "method 'gail' is defined by doing without"),
    ({"method": "ppo", "critics": 1}, "Setting of 'ppo' 'critics' is unknown"),
]


@pytest.mark.parametrize(("changes", "sentence"), NONSENSE)
def test_nonsense_is_refused_in_one_sentence(changes, sentence):
    with pytest.raises(BootcourseError) as refusal:
        settings_for(**{"method": "bootstrapped"} | changes)
    assert sentence in str(refusal.value) and "\n" not in str(refusal.value)


IMPOSSIBLE = [
    (lambda: Settings(method="sac"), r"write settings_for\('sac'\)"),
    (lambda: SACLearner([settings_for("sac"), settings_for("sac", batch=32)], 26), "need the same batch: train these"),
    (lambda: learner_for([settings_for("sac"), settings_for("bc")], 26), "bc, sac cannot train side by side"),
    (lambda: Training([], 10), "no agents: give the settings of at least one"),
    (lambda: Training([settings_for("sac")], 0), "episodes = 0: give a whole number from 1"),
]


@pytest.mark.parametrize(("call", "sentence"), IMPOSSIBLE)
def test_agents_that_cannot_be_trained_are_refused_in_one_sentence(call, sentence):
    with pytest.raises(BootcourseError, match=sentence):
        call()


def test_only_methods_with_demonstrations_ask_for_them():
    asks = {method for method in ABLATION if settings_for(method).needs_demonstrations}
    assert asks == {"demos", "bootstrapped", "margin", "margin_soft"}


def test_an_on_policy_method_s_own_episodes_are_more_than_one_round_of_decisions_can_hold():
    for method in (name for name, entry in METHODS.items() if entry.on_policy):
        settings = settings_for(method)
        assert METHODS[method].episodes > settings.envs_per_agent * settings.horizon
