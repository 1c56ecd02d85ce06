"""To drag in this lesson: what speed is worth mid-lane to a driver that often acts at random."""

from functools import cache

import numpy as np

from bootcourse.course.lessons.the_barrier.attempts import drive
from bootcourse.course.lessons.the_barrier.easier import mid_lane_at
from bootcourse.episodes.evaluate import held_out_seeds
from bootcourse.methods import style
from bootcourse.panels.explorable import Axes, Curve, Explorable, curves
from bootcourse.panels.number import Number
from bootcourse.plots.svg import Drawing
from bootcourse.policies import PlanPolicy
from bootcourse.scenario import DEFAULT, IDLE, N_ACTIONS

SPEEDS, NOW = np.arange(6.0, 17.0), 4  # m/s; which of them the traps drive at
SHARES = np.linspace(0, 1, 5)  # of random actions
ROADS = held_out_seeds(7, 100)


@cache
def rewards_from(share: float) -> np.ndarray:
    """Drives from mid-lane at each of `SPEEDS` that do nothing but for a share of random actions.

    Returns their rewards (speeds, roads, decisions). Each speed has the same random actions on the same roads.
    """
    rng, shape = np.random.default_rng(0), (DEFAULT.clock.decisions, len(ROADS))
    actions = np.where(rng.random(shape) < share, rng.integers(N_ACTIONS, size=shape), IDLE)
    make_env = mid_lane_at(np.repeat(SPEEDS, len(ROADS)))
    driven = drive(PlanPolicy(np.tile(actions, len(SPEEDS))), list(ROADS) * len(SPEEDS), make_env).rewards
    rewards = np.zeros((len(driven), DEFAULT.clock.decisions))  # also if the last drive has ended before
    rewards[:, : driven.shape[1]] = driven
    return rewards.reshape(len(SPEEDS), len(ROADS), -1)


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
        "share": Number("random", 50, 0, 100, 25, "Of a hundred actions, so many are random; the others do nothing."),
        "price": Number("price", 10, 0, 20, 1, "What an accident costs."),
        "gamma": Number("γ", 0.8, 0.8, 0.95, 0.05, "What a reward one second later is worth, as a share of one now."),
    }
    return Explorable("Does speed pay?", draw, **numbers)
