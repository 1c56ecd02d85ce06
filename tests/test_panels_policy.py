"""`policy_panel` and `bonus_panel`: numbers worked by hand, and one walk through the controls of each."""

import math
import re
from dataclasses import replace
from xml.etree import ElementTree

import numpy as np
import pytest
import torch

from bootcourse.course.shipped import shipped_agents
from bootcourse.episodes.lookahead import nine_drives
from bootcourse.episodes.record import record
from bootcourse.errors import BootcourseError
from bootcourse.learn.bootstrap import kl_to_rule
from bootcourse.learn.settings import Settings
from bootcourse.panels import bonus_panel, policy_panel
from bootcourse.panels.bonus import bonus_numbers, targets
from bootcourse.panels.compromise import compromise
from bootcourse.panels.policy_numbers import policy_numbers
from bootcourse.policies import plan_policy, rule_policy
from bootcourse.road.state import EGO, X
from bootcourse.scenario import DEFAULT, N_ACTIONS
from tests.panels import at_its_ends, from_page, raise_in_callbacks, words  # noqa: F401
from tests.replays import thinking

pytestmark = pytest.mark.usefixtures("raise_in_callbacks")


@pytest.fixture(scope="module")
def agents_drive(escape):
    """A drive with π and Q, as if an agent had driven it."""
    return thinking(escape)


@pytest.mark.parametrize("p, price", [(0.9, 4.382), (0.99, 6.685)])
def test_a_policy_that_is_sure_of_another_action_pays_the_price_of_it(p, price):
    seen = policy_numbers(np.eye(N_ACTIONS)[7], None, 3, p, 2.0, 0.01)
    assert seen.price[7] == seen.shares[7] == seen.shares.sum() == seen.kl == pytest.approx(price, abs=1e-3)
    assert seen.price[3] == pytest.approx(-math.log(p))


def test_the_shares_add_up_to_the_kl_that_the_learner_uses():
    policy = np.random.default_rng(0).dirichlet(np.ones(N_ACTIONS))
    seen = policy_numbers(policy, None, 5, 0.7, 2.0, 0.01)
    by_learner = kl_to_rule(torch.tensor(policy).log()[None], torch.tensor([5]), torch.tensor(0.7))
    assert [seen.kl, seen.shares.sum()] == pytest.approx([float(by_learner[0])] * 2, abs=1e-6)
    same = policy_numbers(seen.rule, None, 5, 0.7, 2.0, 0.01)
    assert np.allclose(same.shares, 0), "a policy that is the stochastic rule pays nothing"


def test_the_optimum_is_the_softmax_of_q_over_alpha_and_lies_nearer_to_the_rule_the_larger_xi_is():
    q = 0.1 * np.eye(N_ACTIONS)[4]
    assert policy_numbers(None, q, 0, 0.9, 0.0, 0.1).optimum[4] == pytest.approx(math.e / (math.e + 8))
    q = np.full(N_ACTIONS, 1.5)
    half = policy_numbers(None, q, 6, 0.9, 1.0, 1.0)  # proportional to the root of π̃
    assert half.optimum[6] / half.optimum[0] == pytest.approx(math.sqrt(0.9 / 0.0125))
    assert half.worth[6] == pytest.approx(1.5 + math.log(0.9))
    whole = policy_numbers(None, q, 6, 0.9, 1e6, 1.0)
    assert np.allclose(whole.optimum, whole.rule, atol=1e-4)


def test_every_control_moves_its_own_numbers_and_the_picture_and_refuses_nonsense(agents_drive):
    panel = policy_panel(agents_drive, xi=0.0)
    before, by_rule, given = panel.svg, int(panel.seen.rule.argmax()), []
    from_page(panel.p.slider, value=0.59)
    assert panel.seen.rule.max() == pytest.approx(0.59) and panel.view.value == panel.svg != before
    for xi in (0.0, 0.5, 1.0, 5.0):
        from_page(panel.xi.slider, value=xi)
        given.append(panel.seen.optimum[by_rule])
    assert given == sorted(given) and given[-1] > 0.5
    from_page(panel.moment.slider, value=7.0)
    assert np.array_equal(panel.seen.policy, agents_drive.policy[7])
    for number in (panel.moment, panel.p, panel.xi):
        at_its_ends(panel, number)


def inside(widget) -> list:
    """A widget, and all that it holds."""
    return [widget, *(each for child in getattr(widget, "children", ()) for each in inside(child))]


def test_the_car_drives_on_by_the_compromise_between_the_agent_s_way_and_the_rule_s():
    agent = shipped_agents("soft")[0]
    [drive] = record(agent.as_policy(with_q=True), [10], label="soft")
    panel = policy_panel(drive, agent=agent, t=6.0, xi=0.001)
    metres = []
    for xi in (0.001, 10.0):
        from_page(panel.xi.slider, value=xi)
        own, rule, chosen = re.findall(r"(?:way|compromise): (\d+) m in 40 s", panel.svg.alt)
        metres.append(int(chosen))
        driven = drive.states[46 * drive.scenario.clock.steps, EGO, X] - drive.cars[6, EGO, X]
        assert abs(int(own) - driven) < 1, "its own way is the recorded one"
        assert words(panel).endswith(f"this compromise: {chosen} m in 40 s. "), "below the picture, where it wraps"
    assert abs(metres[0] - int(own)) < 10 and metres[1] == int(rule) < int(own) - 100
    alone = policy_panel(drive, agent=agent, t=6.0, xi=10.0, table=False)
    assert f"this compromise: {metres[1]} m in 40 s" in alone.svg.alt, "the road alone says the same"
    assert "brake left" not in alone.svg and "nats" not in alone.svg.alt
    assert alone.xi.slider in inside(alone) and alone.p.slider not in inside(alone)
    [by_rule] = record(compromise(agent, DEFAULT, 0.9, 1e6, 0.01), [10])
    assert np.array_equal(by_rule.actions, record(rule_policy(DEFAULT), [10])[0].actions), "a large ξ is the rule"
    with pytest.raises(BootcourseError, match="This agent has no Q"):
        policy_panel(drive, agent=replace(agent, critics=[]))
    with pytest.raises(BootcourseError, match="this drive has its decisions from 0 to 149 s"):
        policy_panel(drive, t=200)


def test_a_drive_shows_what_there_is_of_policy_and_q_and_says_what_is_missing(agents_drive, escape):
    panel = policy_panel(replace(agents_drive, q_values=None, label="ppo"))
    assert "This drive (PPO) has no Q: let an agent" in words(panel)
    assert panel.seen.kl > 0 and panel.seen.q is panel.seen.worth is panel.seen.optimum is None
    from_page(panel.moment.slider, value=5.0)
    assert "no Q" in panel.svg and "needs Q" in panel.svg and "compromise" not in panel.svg.alt
    panel = policy_panel(escape)
    assert "(rule controller) has no π and no Q" in words(panel) and panel.seen.kl is None
    from_page(panel.p.slider, value=0.5)
    assert panel.seen.rule.max() == 0.5
    ElementTree.fromstring(panel.svg)


def test_the_values_of_nine_imagined_drives_stand_beside_the_policies(agents_drive):
    driver = rule_policy(DEFAULT)
    panel = policy_panel(agents_drive, futures=driver)
    panel.moment.value = 2
    for value in nine_drives(agents_drive.cars[2:3], driver).values[0]:
        assert f"{value:.1f}".replace("-", "−") in panel.svg
    assert "rollouts" in panel.svg and "rollouts" not in policy_panel(agents_drive).svg


# The bonus


@pytest.mark.parametrize(
    "rewards, gamma, options, worth",
    [
        ([1.0, 0.0, 4.0], 0.5, {"terminated": True}, [2.0, 2.0, 4.0]),
        ([0.15625] * 3, 0.8, {}, [0.78125] * 3),  # a drive that ran out of time goes on as it did
        ([0.25, 0.5], 0.0, {"bonus": 1.0}, [1.25, 1.5]),  # without a future: the reward and the bonus
        ([0.0] * 3, 0.8, {"bonus": 2.0}, [10.0] * 3),
    ],
)
def test_a_target_is_the_discounted_sum_of_what_follows(rewards, gamma, options, worth):
    assert np.allclose(targets(np.array(rewards), gamma, **options), worth)


def test_at_the_crossing_both_are_worth_the_same_and_every_control_moves_the_picture():
    panel = bonus_panel()
    seen = panel.seen
    assert np.allclose(seen.weight, 5.0) and np.allclose(seen.crossing, (seen.trapped - seen.plain) / 5)
    assert np.allclose(seen.trapped, 0.15625 / 0.2)  # staying behind earns 0.15625 at each decision
    for k in (0, 30, 149):
        settings = replace(Settings(), bonus=float(seen.crossing[k]))
        crossed = bonus_numbers(panel.demonstration, panel.trapped, settings)
        assert crossed.augmented[k] == pytest.approx(crossed.trapped[k], abs=1e-9)
    before = panel.svg
    assert "The bonus adds c / (1 − γ) = 10." in before.alt
    from_page(panel.c.slider, value=1.95)
    assert np.allclose(panel.seen.augmented, seen.plain + 5 * 1.95) and panel.view.value == panel.svg != before
    for number in (panel.c, panel.gamma):
        at_its_ends(panel, number)
    from_page(panel.gamma.field, value=1.0)
    assert "0 or more, below 1" in words(panel) and panel.gamma.value < 1


def test_a_demonstration_that_ends_in_an_accident_is_worth_nothing_afterwards(idle):
    [crash] = record(plan_policy([("keep right", 20)]), [0], DEFAULT, "you")
    seen = bonus_numbers(crash, idle, Settings())
    assert seen.plain[-1] == pytest.approx(crash.rewards[-1]) and seen.weight[-1] == 1.0
    assert len(seen.trapped) == len(crash.actions)
