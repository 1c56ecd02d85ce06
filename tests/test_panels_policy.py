"""`policy_panel`: its numbers against numbers worked by hand, its controls at their ends and beyond."""

import math
from dataclasses import replace
from xml.etree import ElementTree

import numpy as np
import pytest
import torch

from bootcourse.episodes.record import record
from bootcourse.errors import BootcourseError
from bootcourse.learn.agent import Agent
from bootcourse.learn.bootstrap import kl_to_rule
from bootcourse.learn.learner import SACLearner
from bootcourse.learn.settings import settings_for
from bootcourse.panels import policy_panel
from bootcourse.panels.number import Number
from bootcourse.panels.policy_numbers import policy_numbers
from bootcourse.plots.svg import printed
from bootcourse.policies import idle_policy, random_policy, rule_policy
from bootcourse.rule import rule
from bootcourse.scenario import DEFAULT, N_ACTIONS, Clock, Road
from tests.panels import from_page, inside, raise_in_callbacks, seconds_of_a_drag, words  # noqa: F401

pytestmark = pytest.mark.usefixtures("raise_in_callbacks")


@pytest.fixture(scope="module")
def agents_drive():
    """A drive of an agent that has learned nothing, with π and Q."""
    settings = settings_for("bootstrapped", seed=1)
    learner = SACLearner([settings], DEFAULT.observation_size)
    actor, critics = ([each.detach() for each in part] for part in (learner.actor, learner.critics))
    agent = Agent(settings, actor, critics, 0.01)
    return record(agent.as_policy(with_q=True), [3], DEFAULT, "bootstrapped")[0]


@pytest.fixture(scope="module")
def rules_drive():
    return record(rule_policy(DEFAULT), [3], DEFAULT, "rule")[0]


def test_who_is_sure_of_another_action_pays_the_price_of_it():
    policy = np.eye(N_ACTIONS)[7]
    for p, price in ((0.9, 4.382), (0.99, 6.685)):
        seen = policy_numbers(policy, None, 3, p, 2.0, 0.01)
        assert seen.price[7] == pytest.approx(price, abs=1e-3)
        assert seen.kl == pytest.approx(price, abs=1e-3)
        assert seen.shares[7] == seen.kl and seen.shares.sum() == seen.kl
        assert seen.price[3] == pytest.approx(-math.log(p))


def test_a_policy_that_is_the_stochastic_rule_pays_nothing():
    policy = np.full(N_ACTIONS, 0.1 / 8)
    policy[2] = 0.9
    seen = policy_numbers(policy, None, 2, 0.9, 2.0, 0.01)
    assert np.allclose(seen.shares, 0) and np.allclose(seen.rule, policy)


def test_the_shares_add_up_to_the_kl_that_the_learner_uses():
    policy = np.random.default_rng(0).dirichlet(np.ones(N_ACTIONS))
    seen = policy_numbers(policy, None, 5, 0.7, 2.0, 0.01)
    by_learner = kl_to_rule(torch.tensor(policy).log()[None], torch.tensor([5]), torch.tensor(0.7))
    assert seen.kl == pytest.approx(float(by_learner[0]), abs=1e-6)


def test_without_a_pull_the_optimum_is_the_softmax_of_q_over_alpha():
    q = np.zeros(N_ACTIONS)
    q[4] = 0.1
    optimum = policy_numbers(None, q, 0, 0.9, 0.0, 0.1).optimum
    assert optimum[4] == pytest.approx(math.e / (math.e + 8))


def test_where_all_actions_are_worth_the_same_the_optimum_lies_between_even_and_the_rule():
    q = np.full(N_ACTIONS, 1.5)
    assert np.allclose(
        policy_numbers(None, q, 6, 0.9, 1e6, 1.0).optimum, policy_numbers(None, q, 6, 0.9, 0, 1).rule, atol=1e-4
    )
    half = policy_numbers(None, q, 6, 0.9, 1.0, 1.0)  # proportional to the root of π̃
    assert half.optimum[6] / half.optimum[0] == pytest.approx(math.sqrt(0.9 / 0.0125))
    assert half.worth[6] == pytest.approx(1.5 + math.log(0.9))


@pytest.mark.parametrize(
    "p, xi, alpha", [(1.0, 2, 0.1), (0.05, 2, 0.1), (0.9, -1, 0.1), (0.9, 2, 0), (0.9, math.nan, 1), (0.9, 1, math.inf)]
)
def test_weights_that_make_no_sense_are_refused_in_one_sentence(p, xi, alpha):
    with pytest.raises(BootcourseError, match="give a finite number|is outside"):
        policy_numbers(None, None, 0, p, xi, alpha)


def test_the_panel_shows_policy_rule_and_optimum_of_the_moment(agents_drive):
    panel = policy_panel(agents_drive)
    last = len(agents_drive.actions) - 1
    for k in (0, 1, last):
        from_page(panel.moment.slider, value=float(k))
        cars = agents_drive.states[k * DEFAULT.clock.steps][None]
        assert panel.seen.policy is not None and np.array_equal(panel.seen.policy, agents_drive.policy[k])
        assert panel.seen.rule.argmax() == agents_drive.rule_actions[k] == rule(cars, DEFAULT).actions[0]
        assert f"{k} s into the drive of the bootstrapped SAC" in panel.svg.alt
    assert panel.says.value == ""


def test_every_number_at_both_ends_and_at_nonsense_leaves_a_drawing_of_the_same_size(agents_drive):
    panel = policy_panel(agents_drive)
    size = panel.svg.split(' role="img"')[0]
    for number in inside(panel, Number):
        low, high = number.slider.min, number.slider.max  # of α: powers of ten
        low, high = (10**low, 10**high) if number is panel.alpha else (low, high)
        for value in (high, low, -1.0, 1e9, float("nan")):
            number.field.value = value
            ElementTree.fromstring(panel.svg)
            assert panel.svg.split(' role="img"')[0] == size
            assert (number.refused is None) == math.isclose(number.value, value)
        assert number.refused is not None and "bc-wrong" in number.help.value
        middle = round((low + high) / 2, 1)
        from_page(number.slider, value=middle)
        assert math.isclose(number.value, middle, rel_tol=1e-6) and number.refused is None


def test_dragging_p_moves_the_rule_the_kl_and_the_picture_within_a_frame(agents_drive):
    panel = policy_panel(agents_drive)
    before = panel.svg
    seconds = seconds_of_a_drag(panel.p.slider, [round(0.2 + 0.01 * i, 2) for i in range(40)])
    assert panel.svg != before and panel.view.value == panel.svg
    assert panel.seen.rule.max() == pytest.approx(0.59)
    assert seconds < 0.03, f"{1000 * seconds:.1f} ms"  # 1 ms on a quiet machine


def test_the_pull_gets_stronger_with_xi(agents_drive):
    panel = policy_panel(agents_drive, xi=0.0)
    rules, given = int(panel.seen.rule.argmax()), []
    for xi in (0.0, 0.5, 1.0, 5.0):
        panel.xi.value = xi
        given.append(panel.seen.optimum[rules])
    assert given == sorted(given) and given[-1] > 0.8


def test_a_drive_of_the_rule_shows_what_there_is_and_says_what_is_missing(rules_drive):
    panel = policy_panel(rules_drive)
    assert "recorded no policy π and no Q" in words(panel) and "rule controller" in words(panel)
    assert panel.seen.optimum is None and panel.seen.kl is None
    panel.p.value = 0.5
    assert panel.seen.rule.max() == 0.5
    ElementTree.fromstring(panel.svg)


def test_a_drive_with_a_policy_but_without_q_says_so():
    drive = record(random_policy(np.random.default_rng(0)), [0], DEFAULT, "random")[0]
    panel = policy_panel(drive)
    assert "recorded no Q:" in words(panel) and panel.seen.kl == pytest.approx(1.71, abs=0.01)


def test_a_drive_of_one_decision_and_one_of_another_clock_are_shown():
    short = replace(DEFAULT, clock=Clock(decisions=1))
    policy_panel(record(idle_policy, [0], short, "idle")[0])
    fast = replace(DEFAULT, clock=Clock(decisions=7, decision_rate=2, simulation_rate=4), road=Road(lanes=6))
    panel = policy_panel(record(idle_policy, [0], fast, "idle")[0])
    from_page(panel.moment.slider, value=3.0)
    assert "3 s into" in panel.svg.alt
    ElementTree.fromstring(panel.svg)


@pytest.mark.parametrize(
    "wrong", [{"p": 1.0}, {"p": 0.1}, {"p": "0.9"}, {"xi": -1}, {"xi": None}, {"alpha": 0.0}, {"alpha": math.nan}]
)
def test_a_call_with_nonsense_raises_one_sentence_and_leaves_no_panel(rules_drive, wrong):
    with pytest.raises(BootcourseError) as error:
        policy_panel(rules_drive, **wrong)
    assert "\n" not in str(error.value)


@pytest.mark.parametrize("wrong", [None, [], 3, "drive.npz"])
def test_a_call_without_a_drive_says_what_to_give(wrong):
    with pytest.raises(BootcourseError, match="give .*drive, such as record"):
        policy_panel(wrong)


def test_the_picture_names_the_settings_and_the_reason(agents_drive):
    panel = policy_panel(agents_drive, p=0.8, xi=1.5)
    picture = printed(panel.picture()).decode()
    assert "the rule, p = 0.8" in picture and "ξ = 1.5, α = 0.01" in picture and "The rule: " in picture
    assert "var(" not in picture
