"""To drag in this lesson: how often an attempt to leave ends in an accident, and what speed is worth to a driver that
often acts at random.
"""

from functools import cache

import numpy as np

from bootcourse.course.lessons.the_barrier.attempts import PLAN, ThenAccelerate, drive
from bootcourse.course.lessons.the_barrier.easier import mid_lane_at
from bootcourse.episodes.evaluate import held_out_seeds
from bootcourse.methods import style
from bootcourse.panels.explorable import Axes, Curve, Explorable, curves
from bootcourse.panels.number import Number
from bootcourse.plots.svg import Drawing
from bootcourse.policies import PlanPolicy, idle_policy
from bootcourse.scenario import DEFAULT, IDLE, N_ACTIONS

ROADS = held_out_seeds(7, 500)


def price() -> Explorable:
    """What attempts are worth, of which some end as a plan's accidents do and the others as its ways out."""
    out, stay = drive(ThenAccelerate(PLAN), ROADS), drive(idle_policy, ROADS)
    shares = np.linspace(0, 1, 101)

    def draw(gamma: float, accidents: float) -> Drawing:
        values, behind = out.values(gamma), stay.values(gamma).mean()
        attempts = (1 - shares) * values[out.accident == 0].mean() + shares * values[out.accident > 0].mean()
        mine = float(np.interp(accidents / 100, shares, attempts))
        pays = "pays" if mine > behind else "does not pay"
        named = {
            f"attempts: {mine:.2f}": Curve(attempts, style("soft").colour),
            f"staying: {behind:.2f}": Curve(np.full(101, behind), style("idle").colour, "--"),
        }
        says = f"γ = {gamma:g}: with {accidents:g} accidents in a hundred, an attempt {pays}."
        limits = 1.1 * min(attempts.min(), 0.0), 1.15 * max(attempts.max(), behind)
        axes = Axes("accidents of a hundred attempts", "discounted sum of the rewards, from the start", limits)
        return curves(says, axes, 100 * shares, named, mark=accidents)

    numbers = {
        "gamma": Number("γ", 0.8, 0.5, 0.98, 0.01, "What a reward one second later is worth, as a share of one now."),
        "accidents": Number("accidents", 30, 0, 100, 1, "Of a hundred attempts, so many end in an accident."),
    }
    return Explorable("When does it pay to try?", draw, **numbers)


SPEEDS, NOW = np.arange(6.0, 17.0), 4  # m/s; which of them the traps drive at
SHARES = np.linspace(0, 1, 11)  # of random actions
FEW = held_out_seeds(7, 200)


@cache
def rewards_from(share: float) -> np.ndarray:
    """Drives from mid-lane at each of `SPEEDS` that do nothing but for a share of random actions.

    Returns their rewards (speeds, roads, decisions). Each speed has the same random actions on the same roads.
    """
    rng, shape = np.random.default_rng(0), (DEFAULT.clock.decisions, len(FEW))
    actions = np.where(rng.random(shape) < share, rng.integers(N_ACTIONS, size=shape), IDLE)
    make_env = mid_lane_at(np.repeat(SPEEDS, len(FEW)))
    driven = drive(PlanPolicy(np.tile(actions, len(SPEEDS))), list(FEW) * len(SPEEDS), make_env).rewards
    rewards = np.zeros((len(driven), DEFAULT.clock.decisions))  # also if the last drive has ended before
    rewards[:, : driven.shape[1]] = driven
    return rewards.reshape(len(SPEEDS), len(FEW), -1)


def at_price(rewards: np.ndarray, price: float) -> np.ndarray:
    """The same rewards where an accident costs `price`."""
    return np.where(rewards == DEFAULT.reward.accident, -price, rewards)


def landscape() -> Explorable:
    """What speed is worth mid-lane to a driver that does nothing, but for a share of random actions."""
    rewards = np.array([rewards_from(share) for share in SHARES])
    safe, unsafe = at_price(rewards, 0.0).mean(axis=2), (rewards == DEFAULT.reward.accident).mean(axis=2)

    def draw(share: float, price: float, gamma: float) -> Drawing:
        each = (safe - price * unsafe) @ gamma ** np.arange(safe.shape[-1])  # (shares, speeds)
        values = np.array([np.interp(share / 100, SHARES, of_speed) for of_speed in each.T])
        more = values[NOW + 1] - values[NOW]
        verb = "hardly matters" if abs(more) < 0.1 else f"adds {more:.2f}" if more > 0 else f"costs {-more:.2f}"
        says = f"{share:g} % of random actions: from {SPEEDS[NOW]:g} m/s, one m/s more {verb}."
        room = 0.1 * max(np.ptp(values), 1.0)
        axes = Axes("speed mid-lane, m/s", "worth of the drive from there", (values.min() - room, values.max() + room))
        named = {f"price {price:g}, γ = {gamma:g}": Curve(values, style("sac").colour)}
        return curves(says, axes, SPEEDS, named, mark=SPEEDS[NOW])

    numbers = {
        "share": Number("random", 50, 0, 100, 10, "Of a hundred actions, so many are random; the others do nothing."),
        "price": Number("price", 10, 0, 20, 1, "What an accident costs."),
        "gamma": Number("γ", 0.8, 0.8, 0.95, 0.05, "What a reward one second later is worth, as a share of one now."),
    }
    return Explorable("Does speed pay?", draw, **numbers)
