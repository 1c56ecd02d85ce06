"""Safe PPO: the price of an accident, the labels of the risk and the mask against numbers worked by hand."""

import math
from dataclasses import replace

import numpy as np
import pytest
import torch

from bootcourse.learn.learner import learner_for
from bootcourse.learn.networks import mlp
from bootcourse.learn.quantiles import mean_of_the_worst, quantile_loss
from bootcourse.learn.risk import accident_within, masked, resolved, risk_loss
from bootcourse.learn.safe import SafeMinibatch, accident_rate, multiplier_step
from bootcourse.learn.settings import settings_for
from bootcourse.learn.shield import needed_braking
from bootcourse.learn.training import Training

SMALL = {"hidden": (8,), "envs_per_agent": 4, "horizon": 16, "batch": 16, "epochs": 2, "buffer_size": 16}
SMALL |= {"cloning_updates": 2, "demonstration_episodes": 2}
OFF = {"accident_cost": 0.0, "multiplier_step": 0.0, "risk_limit": 1.0}
BRAKE, KEEP, ACCELERATE = 1, 4, 7  # straight
KEEP_LEFT = 3


def trained(decisions: int = 40, **changes) -> Training:
    """A small training after some decisions on each road."""
    training = Training([settings_for(**{"method": "ppo_safe"} | SMALL | changes)], 50)
    for _ in range(decisions):
        training.step()
    return training


def test_with_everything_off_it_is_ppo_after_cloning():
    safe, plain = trained(**OFF), trained(method="ppo_cloned")
    assert safe.updates == plain.updates > 0
    for one, other in zip(safe.agent(0).actor, plain.agent(0).actor, strict=True):
        assert torch.equal(one, other)


def test_an_accident_costs_the_learner_more_and_the_curves_show_the_road_s_reward():
    training = trained(**OFF | {"accident_cost": 40.0})
    training.replay.table[..., -3] = 0.0
    training.replay.table[3, 0, 1, -4:-2] = torch.tensor([-10.0, 1.0])  # reward and accident
    training.replay.filled = SMALL["horizon"]
    training.learner.prepare(training.replay)
    dear = training.replay.columns
    training.learner.accident_cost[:] = 0
    training.learner.prepare(training.replay)
    difference = (training.replay.columns.advantages - dear.advantages)[0].view(16, 4)
    assert difference[3, 1].item() == pytest.approx(40.0, abs=1e-3)
    discount = settings_for("ppo_safe").gamma * settings_for("ppo_safe").gae_lambda
    assert difference[2, 1].item() in (0.0, pytest.approx(40.0 * discount, abs=1e-3))  # 0: an episode ended there
    assert not difference[4:].any() and not difference[:, [0, 2, 3]].any()


def test_accidents_of_any_kind_are_counted_in_the_last_episodes_of_each_agent():
    accident = np.array([[1.0, 0, 0, 3, np.nan], [0, 0, 2, 0, 0], [1, np.nan, np.nan, np.nan, np.nan]])
    found = accident_rate(accident, np.array([4, 5, 1]), least=2, window=4)
    np.testing.assert_allclose(found, [2 / 4, 1 / 4, np.nan])
    more_than_are_recorded = accident_rate(accident[:2, :4], np.array([4, 9]), least=1, window=2)
    assert more_than_are_recorded.tolist() == [1 / 2, 1 / 2]


def test_the_multiplier_rises_above_the_budget_and_falls_to_zero_below_it():
    step, budget = torch.full((4, 1), 10.0), torch.full((4, 1), 0.1)
    rate = torch.tensor([[0.3], [0.05], [0.0], [math.nan]])
    found = multiplier_step(torch.tensor([[1.0], [1.0], [0.5], [2.0]]), rate, budget, step)
    assert found[:, 0].tolist() == pytest.approx([3.0, 0.5, 0.0, 2.0])


def test_the_multiplier_prices_the_accidents_that_the_second_value_function_predicts():
    """With V_C = 0 the cost's advantage is (γ λ)^n for an accident n decisions later in the same episode."""
    training = trained(multiplier_step=10.0, accident_budget=0.0, accident_cost=0.0)
    learner, replay = training.learner, training.replay
    replay.table[..., -3], replay.ended[:] = 0.0, 0.0
    replay.table[5, 0, 2, -3], replay.ended[5, 0, 2] = 1.0, 1.0
    with torch.no_grad():
        torch._foreach_zero_(learner.cost_value)
    training.curves.values["accident"][0, :10], training.curves.finished[:] = [1, 0, 0, 0, 0, 0, 0, 0, 0, 2], 10
    learner.multiplier[:] = 0.0
    learner.prepare(replay)
    priced = replay.columns.advantages
    assert learner.multiplier.item() == pytest.approx(10 * 0.2)
    learner.constrained = False
    learner.prepare(replay)
    taken_off = (replay.columns.advantages - priced)[0].view(16, 4)
    decay = learner.settings[0].gamma * learner.settings[0].gae_lambda
    assert taken_off[:7, 2].tolist() == pytest.approx([2 * decay**n for n in (5, 4, 3, 2, 1, 0)] + [0.0], abs=1e-4)
    assert not taken_off[:, [0, 1, 3]].any()


def test_the_curves_show_the_multiplier():
    training = trained(multiplier_step=10.0)
    training.learner.multiplier[:] = 7.0
    assert training._coefficients()["xi"] == 7.0


def test_an_accident_is_near_for_as_many_decisions_as_asked_and_not_across_an_episode_s_end():
    accident = torch.tensor([0.0, 0, 0, 1, 0, 0, 0, 0])
    ended = torch.tensor([0.0, 1, 0, 1, 0, 0, 1, 0])
    assert accident_within(accident, ended, 1).tolist() == accident.tolist()
    assert accident_within(accident, ended, 3).tolist() == [0, 0, 1, 1, 0, 0, 0, 0]
    assert resolved(accident, 3).tolist() == [1, 1, 1, 1, 1, 1, 0, 0]
    assert resolved(accident, 8).tolist() == [1] + [0] * 7


def test_the_risk_s_loss_is_the_cross_entropy_of_what_is_known():
    logits, label = torch.tensor([0.0, math.log(3), 50.0]), torch.tensor([1.0, 0.0, 0.0])
    found = risk_loss(logits, label, torch.tensor([1.0, 1.0, 0.0]))
    assert found.item() == pytest.approx((math.log(2) + math.log(4)) / 2)
    assert risk_loss(logits, label, torch.zeros(3)).item() == 0.0


@pytest.mark.parametrize(
    "risk, expected",
    [
        ([0.0, 0.0, 0.0], [0.6, 0.3, 0.1]),
        ([0.2, 0.0, 0.1], [0.0, 0.75, 0.25]),  # 0.1 is the limit, and allowed
        ([0.9, 0.8, 0.7], [0.0, 0.0, 1.0]),  # no action is allowed: the least risky,
        ([0.9, 0.7, 0.7], [0.0, 0.75, 0.25]),  # or those that are
        ([math.inf] * 3, [0.6, 0.3, 0.1]),
    ],
)
def test_the_mask_leaves_the_policy_its_safe_actions(risk, expected):
    found = masked(torch.tensor([0.6, 0.3, 0.1]), torch.tensor(risk), torch.tensor(0.1))
    assert found.tolist() == pytest.approx(expected)


def test_a_classifier_learns_which_action_ends_in_an_accident():
    learner = learner_for([settings_for("ppo_safe", hidden=(8,), critic_lr=0.02, risk_limit=0.3)], 3)
    actions, zeros, states = torch.arange(180)[None] % 9, torch.zeros(1, 180), torch.ones(1, 180, 3)
    soon, uniform = (actions == ACCELERATE).float(), zeros - math.log(9)
    batch = SafeMinibatch(states, actions, uniform, zeros, zeros, actions, zeros, soon, zeros + 1)
    for _ in range(200):
        learner.update(batch)
    with torch.no_grad():
        state, risk = torch.ones(1, 1, 3), learner.risk(torch.ones(1, 1, 3))[0, 0]
        torch._foreach_zero_(learner.actor)
    assert risk[ACCELERATE] > 0.8 and risk.sort().values[-2] < 0.1
    pi = learner.driving_policy(state, torch.zeros(1, 1, dtype=torch.int64))[0, 0]
    assert pi[ACCELERATE] == 0 and pi[BRAKE].item() == pytest.approx(1 / 8)
    assert learner.acting_policy(state, None, None)[0, 0, ACCELERATE].item() == pytest.approx(1 / 9)  # in training


def test_the_quantiles_loss_weighs_too_high_and_too_low_by_the_quantile():
    """Four quantiles, τ = 1/8, 3/8, 5/8, 7/8; a return of 2 is above the first two and below the last two."""
    quantiles = torch.tensor([[0.0, 1.0, 3.0, 6.0]])
    found = quantile_loss(quantiles, torch.tensor([2.0]))
    assert found.item() == pytest.approx(2 * 1 / 8 + 1 * 3 / 8 + 1 * 3 / 8 + 4 * 1 / 8)


def test_the_worst_share_of_the_quantiles_is_the_value():
    quantiles = torch.tensor([[5.0, -4.0, 1.0, 2.0], [8.0, 8.0, 8.0, 0.0]])
    assert mean_of_the_worst(quantiles, 1.0).tolist() == [1.0, 6.0]
    assert mean_of_the_worst(quantiles, 0.5).tolist() == [-1.5, 4.0]
    assert mean_of_the_worst(quantiles, 0.01).tolist() == [-4.0, 0.0]  # of one quantile at least


def test_a_distributional_critic_learns_how_often_a_state_ends_badly():
    """Returns are 10, or -10 in one drive of five: so are the quantiles, and the value is that of the worst quarter."""
    settings = settings_for("ppo_safe", hidden=(8,), critic_lr=0.05, value_quantiles=20, worst_share=0.25, **OFF)
    learner, (n, zeros) = learner_for([settings], 3), (200, torch.zeros(1, 200))
    returns, actions = torch.where(torch.arange(n) % 5 == 0, -10.0, 10.0)[None], torch.zeros(1, n, dtype=torch.int64)
    batch = SafeMinibatch(torch.ones(1, n, 3), actions, zeros, zeros, returns, actions, zeros, zeros, zeros)
    for _ in range(1500):
        learner.update(batch)
    with torch.no_grad():
        quantiles = mlp(learner.value, torch.ones(1, 1, 3))[0, 0].sort().values
    assert quantiles[:3].max() < -9 and quantiles[5:].min() > 9
    value = learner.state_value(quantiles[None])
    assert value.item() == pytest.approx(quantiles[:5].mean().item()) and value.item() < -6


def seen(speed: float, dx: float, dy: float, other: float) -> torch.Tensor:
    """The observation of an ego in the right lane with one car, dx m ahead and dy m to the right of it; m/s."""
    state = torch.zeros(26)
    state[[0, 2, 3]] = torch.tensor([1.0, 2.0, speed / 15])
    state[6:11] = torch.tensor([1.0, dx / 50, dy / 4, (other - speed) / 5, 0.0])
    return state


def test_the_shield_brakes_as_hard_as_a_steady_car_ahead_needs():
    """At 15 m/s, 40 m behind 9 m/s: after a second 34 m, less a car's 5 m and the margin of 1 m, 28 m remain."""
    found = needed_braking(seen(15.0, 40.0, 0.0, 9.0))
    assert found[KEEP].item() == pytest.approx(6**2 / (2 * 28), rel=1e-5)
    assert found[ACCELERATE].item() == pytest.approx(7**2 / (2 * 27.5), rel=1e-5)
    assert found[BRAKE].item() == pytest.approx(5**2 / (2 * 28.5), rel=1e-5)


def test_the_shield_needs_no_braking_for_a_faster_car_or_one_in_another_lane_and_does_not_steer_into_one():
    assert needed_braking(seen(10.0, 20.0, 0.0, 12.0))[[0, 1, 3, 4, 6, 7]].max() == 0
    beside = needed_braking(seen(15.0, 1.0, -4.0, 15.0))
    assert beside[KEEP] == 0 and beside[KEEP_LEFT] == math.inf
    behind = needed_braking(seen(15.0, -20.0, -4.0, 15.0))
    assert behind[[0, 1, 3, 4, 6, 7]].max() == 0 and behind[[2, 5, 8]].min() == math.inf  # to the right is no road


def test_a_standing_car_needs_no_braking():
    assert needed_braking(seen(0.0, 20.0, 0.0, 0.0))[[BRAKE, KEEP]].tolist() == [0.0, 0.0]
    assert needed_braking(seen(0.0, 20.0, 0.0, 0.0)).isfinite().all()


def test_an_agent_with_the_shield_does_not_drive_into_the_car_ahead():
    agent = trained(**OFF).agent(0)
    with torch.no_grad():
        torch._foreach_zero_(agent.actor[:-1])
        agent.actor[-1][:] = 2 * torch.eye(9)[ACCELERATE] + torch.eye(9)[BRAKE]  # it accelerates, or else brakes
    free, blocked = seen(12.0, 190.0, 0.0, 12.0), seen(15.0, 20.0, 0.0, 9.0)
    states = torch.stack([free, blocked]).numpy()
    shielded = replace(agent, settings=replace(agent.settings, shield=True))
    assert agent.as_policy()(states, None).actions.tolist() == [ACCELERATE, ACCELERATE]
    assert shielded.as_policy()(states, None).actions.tolist() == [ACCELERATE, BRAKE]
