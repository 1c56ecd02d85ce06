"""Exercises of the lesson on the road, its actions and its reward."""

import numpy as np

from bootcourse.course.exercise import exercise
from bootcourse.road import formulas


def action_cases(rng):
    """All nine at once, each alone; then 20 at random."""
    yield from ((np.arange(9),), *((np.array([action]),) for action in range(9)))
    yield from ((rng.integers(0, 9, rng.integers(1, 8)),) for _ in range(20))


@exercise(
    "A = {-1, 0, 1} m/s² x {-π/50, 0, π/50} rad, Section III-C", minutes=5, difficulty=1, cases=action_cases,
    worked=[
        # "brake left" is the first, "keep straight" the middle one, "accelerate right" the last
        ((np.array([0, 4, 8]),), np.array([[-1, -np.pi / 50], [0, 0], [1, np.pi / 50]])),
    ],
    hints=(
        "Write 0 to 8 as three rows of three: which row is the acceleration, which column the steering?",
        "`actions // 3` is the row and `actions % 3` the column, each 0, 1 or 2.",
    ),
    mistakes={
        "return np.stack([actions % 3 - 1, (actions // 3 - 1) * np.pi / 50], axis=-1)":
            "You swapped the two parts: `//` gives the acceleration and `%` the steering, because the numbers go "
            "through all three steering angles before the acceleration changes.",
        "- 1 -> [2 times]":
            "Your actions neither brake nor steer left: 0, 1, 2 have to become -1, 0, 1.",
        "actions % 3 - 1 -> 1 - actions % 3":
            "Your left and right are swapped: y grows to the right, so steering left is negative.",
        "* np.pi / 50 ->":
            "Your steering is -1, 0 or 1 rad, which would turn the wheels by 57°. It is that times π/50.",
        "np.pi / 50 -> 3.6":
            "Your steering is in degrees: π/50 rad are 3.6°, and the column is in rad.",
        "np.pi / 50 -> 0":
            "Your steering is always 0. If you write into an array of whole numbers, ±π/50 is cut off to 0: make an "
            "array of floats.",
    },
)  # fmt: skip
def decode(actions):
    acceleration = actions // 3 - 1
    steering = (actions % 3 - 1) * np.pi / 50
    return np.stack([acceleration, steering], axis=-1)


def reward_cases(rng):
    """Each accident, steering left and right, far more than an action does, off the centre; then 40 at random."""
    yield from ((12.0, 0.0, 0.0, accident) for accident in range(4))
    yield from ((10.0, 0.8, theta, 0) for theta in (-np.pi / 50, np.pi / 50, -1.2, 1.2))
    for _ in range(40):
        yield *rng.uniform([0, -2, -1], [17, 2, 1]), rng.choice(4, p=[0.7, 0.1, 0.1, 0.1])


@exercise(
    "r(s, a), Section III-C, Reward; weights of Table III", minutes=6, difficulty=1, cases=reward_cases,
    worked=[
        ((10.0, 0.0, 0.0, 0), 0.15625),  # (1.5 · 2/15 + 0.05) / 1.6
        ((15.0, 0.0, 0.0, 0), 1.55 / 1.6),
        ((15.0, 0.0, 0.0, 3), -10.0),
    ],
    hints=(
        "Check for an accident first: in that second the reward is -10 and nothing else.",
        "`formulas.speed_reward(v_lon)`, `formulas.centring_reward(offset)` and `formulas.steering_reward(theta)` are "
        "the three terms.",
    ),
    mistakes={
        "if accident -> if accident == 1":
            "You penalise collisions only. Leaving the road (2) and stopping (3) give -10 as well.",
        ("if accident: return -10.0 ->", "/ (1.5 + 0.05 + 0.05) -> / 1.6 - 10.0 * (accident > 0)"):
            "You add the -10 to the other terms. In a second with an accident it replaces them.",
        "/ (1.5 + 0.05 + 0.05) ->":
            "You return the weighted sum. The reward is the weighted mean: divide by the sum of the weights, 1.6.",
        "+ 0.05 * r_theta -> - 0.05 * r_theta":
            "Your reward grows with the steering angle. r_θ is a cost: -|sin θ|.",
        "formulas.steering_reward(theta) -> -np.sin(theta)":
            "You reward steering to the left, where sin θ is negative. The cost uses the absolute value, |sin θ|.",
        "return (1.5 * v_lon + 0.05 * abs(offset) + 0.05 * abs(theta)) / 1.6":
            "You weigh the speed, the offset and the angle themselves. Each goes through its own term first: r_v, r_y "
            "and r_θ are functions of them.",
    },
)  # fmt: skip
def reward(v_lon, offset, theta, accident):
    if accident:
        return -10.0
    r_v = formulas.speed_reward(v_lon)
    r_y = formulas.centring_reward(offset)
    r_theta = formulas.steering_reward(theta)
    return (1.5 * r_v + 0.05 * r_y + 0.05 * r_theta) / (1.5 + 0.05 + 0.05)


def idle_cases(rng):
    """One second and a whole episode at the slowest speed, the usual and the highest; then 30 at random."""
    yield from ((speed, seconds) for seconds in (1, 150) for speed in (6.0, 10.0, 12.5))
    yield from ((rng.uniform(5.1, 12.5), rng.integers(1, 151)) for _ in range(30))


@exercise(
    "Σ r over an episode of doing nothing, Section III-C", minutes=6, difficulty=1, cases=idle_cases,
    worked=[((10.0, 1), 0.15625), ((10.0, 150), 23.4375), ((12.5, 1), 0.21875)],
    hints=(
        "What are r_v, r_y and r_θ at this speed, in the middle of the lane, with straight wheels?",
        "r_v = 2/75 v - 2/15, r_y = 1, r_θ = 0.",
    ),
    mistakes={
        "+ 0.05 * r_y ->":
            "Your r_y is 0. A car in the middle of its lane has r_y = exp(0) = 1.",
        "/ 1.6 -> / 1.55":
            "You divide by 1.55. The third weight counts even though its term is zero: 1.5 + 0.05 + 0.05.",
        "/ 1.6 ->":
            "You did not divide by the sum of the weights, 1.6.",
        "seconds * ->":
            "This is the reward of one second. The return is the sum over all the seconds.",
        "return seconds * (r_v + r_y) / 3":
            "You gave the three terms the same weight. Speed weighs 1.5, the other two 0.05 each.",
        "0.05 * r_y -> 0.1 * r_y":
            "You reward driving straight. r_θ = -|sin 0| is 0: driving straight costs nothing and earns nothing.",
    },
)  # fmt: skip
def idle_return(speed, seconds):
    r_v, r_y = 2 / 75 * speed - 2 / 15, 1.0  # and r_theta is 0
    return seconds * (1.5 * r_v + 0.05 * r_y) / 1.6


def risk_cases(rng):
    """The rule's numbers, an escape that pays no more than to stay, a harmless crash, all edges; 40 at random."""
    yield from ((23.4375, escape, -9.5) for escape in (51.0, 20.0, 23.4375))
    yield from ((stay, 51.0, -9.5) for stay in (-30.0, -9.5))
    yield 20.0, 20.5, -20.0  # hardly any risk is worth it
    yield 20.0, 100.0, 19.5  # almost any risk is worth it
    for _ in range(40):
        stay, gain = rng.uniform(-20, 40), rng.uniform(-10, 120)
        yield stay, stay + gain, stay + min(gain - 1, rng.uniform(-60, 10))


@exercise(
    "the q with (1 - q) · escape + q · crash = stay", minutes=8, difficulty=2, cases=risk_cases,
    worked=[
        ((20.0, 60.0, -20.0), 0.5),  # half of 60 and half of -20 are 20, what staying pays
        ((20.0, 100.0, -20.0), 2 / 3),
        ((20.0, 10.0, -20.0), 0.0),  # this way out pays less than to stay
        ((-50.0, 10.0, -20.0), 1.0),  # even a crash is better than to stay
    ],
    hints=(
        "A try pays `escape` with probability 1 - q and `crash` with probability q. What does it pay on average?",
        "Solve (1 - q) · escape + q · crash = stay for q. What is q if `escape` is not larger than `stay`? And if "
        "`crash` is not smaller than `stay`?",
    ),
    mistakes={
        "return (stay - crash) / (escape - crash)":
            "This is the share of tries that must *succeed*. The risk is the share that crash: one minus that.",
        "(escape - crash) -> abs(crash)":
            "You compare the gain with the crash's own return. A crash costs what the try would have earned otherwise, "
            "escape - crash.",
        "(escape - crash) -> (stay - crash)":
            "You divide by what a crash loses against staying. That ratio is the *odds*, crashes for each success; the "
            "question asks for a probability.",
        ("if escape <= stay: return 0.0 ->", "if crash >= stay: return 1.0 ->"):
            "Your risk leaves the range from 0 to 1. If the escape pays no more than to stay, no risk is worth it: 0. "
            "If even a crash pays more than to stay, each risk is: 1.",
        "if crash >= stay: return 1.0 ->":
            "If a crash pays as much as to stay or more, each risk is worth it: return 1.",
        "(escape - stay) -> escape":
            "You compare with a return of 0. The alternative to a try is to stay, which pays `stay`.",
    },
)  # fmt: skip
def bearable_risk(stay, escape, crash):
    if escape <= stay:
        return 0.0
    if crash >= stay:
        return 1.0
    return (escape - stay) / (escape - crash)


def outcomes_cases(rng):
    """A crash after overtaking, no success, level with trap 1, just ahead of it and just behind; then 30 at random."""
    yield np.array([900.0]), np.array([800.0]), np.array([1])
    yield np.array([1500.0, 12.0]), np.array([1515.0, 27.0]), np.array([0, 2])
    yield np.array([700.0, 700.01, 699.99]), np.array([700.0, 700.0, 700.0]), np.array([1, 3, 1])
    for _ in range(30):
        n = rng.integers(1, 12)
        yield rng.uniform(0, 2000, n), rng.uniform(15, 1515, n), rng.choice(4, n, p=[0.4, 0.3, 0.2, 0.1])


@exercise(
    "Successful completion, Section III-C", minutes=5, difficulty=1, cases=outcomes_cases,
    worked=[
        # behind, ahead, ahead and crashed, off the road at once
        ((np.array([1500.0, 1700.0, 900.0, 20.0]), np.array([1515.0, 1515.0, 800.0, 35.0]), np.array([0, 0, 1, 2])),
         np.array([0.5, 0.25, 0.25, 0.0])),
    ],
    hints=(
        "Compare the two positions at the end: they alone decide whether the episode is a success.",
        "The mean of an array of True and False is the share of True: `np.mean(accident == 1)`.",
    ),
    mistakes={
        "x_ego > x_trap_1 -> (x_ego > x_trap_1) & (accident == 0)":
            "You count a crash after overtaking as a failure. It counts as a success and, separately, as an accident.",
        "x_ego > x_trap_1 -> accident == 0":
            "Your success is 'no accident'. A driver that stays in the trap has no accident either.",
        "np.mean -> np.sum [2 times]":
            "You return the number of episodes. Return their share.",
        "np.mean -> 100 * np.mean [2 times]":
            "You return percentages: shares between 0 and 1 are asked for.",
        "np.mean(accident == kind) -> np.sum(accident == kind) / max(1, np.sum(accident > 0))":
            "You divide each kind by the number of accidents. Its rate is its share of *all* the episodes.",
        "(1, 2, 3) -> (0, 1, 2)":
            "Your kinds are shifted by one: 0 means no accident, 1 collision, 2 road departure, 3 stoppage.",
        "x_ego > x_trap_1 -> x_ego < x_trap_1":
            "You count the egos that are *behind* trap 1 at the end.",
        "x_ego > x_trap_1 -> x_ego >= x_trap_1":
            "You count an ego that is level with trap 1. Ahead means x_ego > x_trap_1.",
        "x_ego > x_trap_1 -> x_ego - 5 > x_trap_1":
            "You ask for a car's length more. The definition compares the two positions as they are.",
    },
)  # fmt: skip
def outcome_rates(x_ego, x_trap_1, accident):
    success = np.mean(x_ego > x_trap_1)
    kinds = [np.mean(accident == kind) for kind in (1, 2, 3)]
    return np.array([success, *kinds])
