"""Exercises of the lesson on the road, its actions and its reward."""

import numpy as np

from bootcourse.course.exercise import Exercise, Mistake
from bootcourse.road import formulas


def decode_solution(actions):
    acceleration = actions // 3 - 1
    steering = (actions % 3 - 1) * np.pi / 50
    return np.stack([acceleration, steering], axis=-1)


def columns(acceleration, steering):
    return np.stack([acceleration, steering], axis=-1).astype(float)


decode = Exercise(
    "decode(actions)", solution=decode_solution,
    # all nine at once, each alone; then 20 at random
    cases=lambda rng: [(np.arange(9),), *((np.array([action]),) for action in range(9)),
                       *((rng.integers(0, 9, rng.integers(1, 8)),) for _ in range(20))],
    worked=(
        # "brake left" is the first, "keep straight" the middle one, "accelerate right" the last
        ((np.array([0, 4, 8]),), np.array([[-1, -np.pi / 50], [0, 0], [1, np.pi / 50]])),
    ),
    mistakes=(
        Mistake(lambda actions: columns(actions % 3 - 1, (actions // 3 - 1) * np.pi / 50),
            "You swapped the two parts: `//` gives the acceleration and `%` the steering, because the numbers go "
            "through all three steering angles before the acceleration changes.",
            "It does not matter which part changes first as the numbers go up."),
        Mistake(lambda actions: columns(actions // 3, (actions % 3) * np.pi / 50),
            "Your actions neither brake nor steer left: 0, 1, 2 have to become -1, 0, 1.",
            "The quotient is the acceleration itself."),
        Mistake(lambda actions: columns(actions // 3 - 1, (1 - actions % 3) * np.pi / 50),
            "Your left and right are swapped: y grows to the right, so steering left is negative.",
            "Positive angles turn left, as in mathematics. On this road y points to the right."),
        Mistake(lambda actions: columns(actions // 3 - 1, actions % 3 - 1),
            "Your steering is -1, 0 or 1 rad, which would turn the wheels by 57°. It is that times π/50.",
            "An action is a plain number; its unit comes later."),
        Mistake(lambda actions: columns(actions // 3 - 1, (actions % 3 - 1) * 3.6),
            "Your steering is in degrees: π/50 rad are 3.6°, and the column is in rad.",
            "An angle is a number of degrees."),
        Mistake(lambda actions: columns(actions // 3 - 1, 0 * actions),
            "Your steering is always 0. If you write into an array of whole numbers, ±π/50 is cut off to 0: make an "
            "array of floats.",
            "An array takes whatever number is written into it."),
    ),
    hints=(
        "Write 0 to 8 as three rows of three: which row is the acceleration, which column the steering?",
        "`actions // 3` is the row and `actions % 3` the column, each 0, 1 or 2.",
        "`np.stack([actions // 3 - 1, (actions % 3 - 1) * np.pi / 50], axis=-1)`",
    ),
    minutes=5, difficulty=1, equation="A = {-1, 0, 1} m/s² x {-π/50, 0, π/50} rad, Section III-C",
)  # fmt: skip


def reward_solution(v_lon, offset, theta, accident):
    if accident:
        return -10.0
    r_v = formulas.speed_reward(v_lon)
    r_y = formulas.centring_reward(offset)
    r_theta = formulas.steering_reward(theta)
    return (1.5 * r_v + 0.05 * r_y + 0.05 * r_theta) / (1.5 + 0.05 + 0.05)


def weighted_sum(v, d, theta):
    return 1.5 * formulas.speed_reward(v) + 0.05 * np.exp(-1.5 * d**2) - 0.05 * abs(np.sin(theta))


def reward_cases(rng):
    """Each accident, steering left and right, far more than an action does, off the centre; then 40 at random."""
    yield from ((12.0, 0.0, 0.0, accident) for accident in range(4))
    yield from ((10.0, 0.8, theta, 0) for theta in (-np.pi / 50, np.pi / 50, -1.2, 1.2))
    for _ in range(40):
        yield *rng.uniform([0, -2, -1], [17, 2, 1]), rng.choice(4, p=[0.7, 0.1, 0.1, 0.1])


reward = Exercise(
    "reward(v_lon, offset, theta, accident)", solution=reward_solution, cases=reward_cases,
    worked=(
        ((10.0, 0.0, 0.0, 0), 0.15625),  # (1.5 · 2/15 + 0.05) / 1.6
        ((15.0, 0.0, 0.0, 0), 1.55 / 1.6),
        ((15.0, 0.0, 0.0, 3), -10.0),
    ),
    mistakes=(
        Mistake(lambda v, d, theta, accident: -10.0 if accident == 1 else weighted_sum(v, d, theta) / 1.6,
            "You penalise collisions only. Leaving the road (2) and stopping (3) give -10 as well.",
            "An accident is a collision."),
        Mistake(lambda v, d, theta, accident: weighted_sum(v, d, theta) / 1.6 - 10.0 * (accident > 0),
            "You add the -10 to the other terms. In a second with an accident it replaces them.",
            "A penalty is one more term of the sum."),
        Mistake(lambda v, d, theta, accident: -10.0 if accident else weighted_sum(v, d, theta),
            "You return the weighted sum. The reward is the weighted mean: divide by the sum of the weights, 1.6.",
            "The weights add up to one."),
        Mistake(lambda v, d, theta, accident:
            -10.0 if accident else (weighted_sum(v, d, theta) + 0.1 * abs(np.sin(theta))) / 1.6,
            "Your reward grows with the steering angle. r_θ is a cost: -|sin θ|.",
            "Every term of a reward is something good."),
        Mistake(lambda v, d, theta, accident:
            -10.0 if accident else (weighted_sum(v, d, 0.0) - 0.05 * np.sin(theta)) / 1.6,
            "You reward steering to the left, where sin θ is negative. The cost uses the absolute value, |sin θ|.",
            "The sign of the steering angle does not matter, so the absolute value can be left out."),
        Mistake(lambda v, d, theta, accident:
            -10.0 if accident else (1.5 * v + 0.05 * abs(d) + 0.05 * abs(theta)) / 1.6,
            "You weigh the speed, the offset and the angle themselves. Each goes through its own term first: r_v, r_y "
            "and r_θ are functions of them.",
            "The terms are the quantities."),
    ),
    hints=(
        "Check for an accident first: in that second the reward is -10 and nothing else.",
        "`formulas.speed_reward(v_lon)`, `formulas.centring_reward(offset)` and `formulas.steering_reward(theta)` are "
        "the three terms.",
        "`(1.5 * r_v + 0.05 * r_y + 0.05 * r_theta) / 1.6`",
    ),
    minutes=6, difficulty=1, equation="r(s, a), Section III-C, Reward; weights of Table III",
)  # fmt: skip


def idle_solution(speed, seconds):
    r_v, r_y, r_theta = 2 / 75 * speed - 2 / 15, 1.0, 0.0
    return seconds * (1.5 * r_v + 0.05 * r_y + 0.05 * r_theta) / 1.6


idle_return = Exercise(
    "idle_return(speed, seconds)", solution=idle_solution,
    cases=lambda rng: [*((speed, seconds) for seconds in (1, 150) for speed in (6.0, 10.0, 12.5)),
                       *((rng.uniform(5.1, 12.5), rng.integers(1, 151)) for _ in range(30))],
    worked=(((10.0, 1), 0.15625), ((10.0, 150), 23.4375), ((12.5, 1), 0.21875)),
    mistakes=(
        Mistake(lambda speed, seconds: seconds * 1.5 * (2 / 75 * speed - 2 / 15) / 1.6,
            "Your r_y is 0. A car in the middle of its lane has r_y = exp(0) = 1.",
            "The car is not off the centre, so this term adds nothing."),
        Mistake(lambda speed, seconds: seconds * (1.5 * (2 / 75 * speed - 2 / 15) + 0.05) / 1.55,
            "You divide by 1.55. The third weight counts even though its term is zero: 1.5 + 0.05 + 0.05.",
            "A term that is zero is not part of the mean."),
        Mistake(lambda speed, seconds: seconds * (1.5 * (2 / 75 * speed - 2 / 15) + 0.05),
            "You did not divide by the sum of the weights, 1.6.",
            "The weights add up to one."),
        Mistake(lambda speed, seconds: (1.5 * (2 / 75 * speed - 2 / 15) + 0.05) / 1.6,
            "This is the reward of one second. The return is the sum over all the seconds.",
            "Return is another word for reward."),
        Mistake(lambda speed, seconds: seconds * (2 / 75 * speed - 2 / 15 + 1) / 3,
            "You gave the three terms the same weight. Speed weighs 1.5, the other two 0.05 each.",
            "A mean of three terms divides by three."),
        Mistake(lambda speed, seconds: seconds * (1.5 * (2 / 75 * speed - 2 / 15) + 0.1) / 1.6,
            "You reward driving straight. r_θ = -|sin 0| is 0: driving straight costs nothing and earns nothing.",
            "Good behaviour is worth 1 in each term."),
    ),
    hints=(
        "What are r_v, r_y and r_θ at this speed, in the middle of the lane, with straight wheels?",
        "r_v = 2/75 v - 2/15, r_y = 1, r_θ = 0.",
        "`seconds * (1.5 * r_v + 0.05 * r_y) / 1.6`",
    ),
    minutes=6, difficulty=1, equation="Σ r over an episode of doing nothing, Section III-C",
)  # fmt: skip


def risk_solution(stay, escape, crash):
    if escape <= stay:
        return 0.0
    if crash >= stay:
        return 1.0
    return (escape - stay) / (escape - crash)


def risk_cases(rng):
    """The rule's numbers, an escape that pays no more than to stay, a harmless crash, all edges; 40 at random."""
    yield from ((23.4375, escape, -9.5) for escape in (51.0, 20.0, 23.4375))
    yield from ((stay, 51.0, -9.5) for stay in (-30.0, -9.5))
    yield 20.0, 20.5, -20.0  # hardly any risk is worth it
    yield 20.0, 100.0, 19.5  # almost any risk is worth it
    for _ in range(40):
        stay, gain = rng.uniform(-20, 40), rng.uniform(-10, 120)
        yield stay, stay + gain, stay + min(gain - 1, rng.uniform(-60, 10))


def risk(share):
    """An answer that has the two special cases right, and another share(stay, escape, crash)."""
    return lambda s, e, c: 0.0 if e <= s else 1.0 if c >= s else share(s, e, c)


bearable_risk = Exercise(
    "bearable_risk(stay, escape, crash)", solution=risk_solution, cases=risk_cases,
    worked=(
        ((20.0, 60.0, -20.0), 0.5),  # half of 60 and half of -20 are 20, what staying pays
        ((20.0, 100.0, -20.0), 2 / 3),
        ((20.0, 10.0, -20.0), 0.0),  # this way out pays less than to stay
        ((-50.0, 10.0, -20.0), 1.0),  # even a crash is better than to stay
    ),
    mistakes=(
        Mistake(risk(lambda s, e, c: (s - c) / (e - c)),
            "This is the share of tries that must *succeed*. The risk is the share that crash: one minus that.",
            "The probability in the equation is that of success."),
        Mistake(risk(lambda s, e, c: (e - s) / abs(c)),
            "You compare the gain with the crash's own return. A crash costs what the try would have earned otherwise, "
            "escape - crash.",
            "A crash costs ten, whatever it interrupts."),
        Mistake(risk(lambda s, e, c: (e - s) / (s - c)),
            "You divide by what a crash loses against staying. That ratio is the *odds*, crashes for each success; the "
            "question asks for a probability.",
            "Odds and probability are the same."),
        Mistake(lambda s, e, c: (e - s) / (e - c),
            "Your risk leaves the range from 0 to 1. If the escape pays no more than to stay, no risk is worth it: 0. "
            "If even a crash pays more than to stay, each risk is: 1.",
            "The formula holds for all numbers."),
        Mistake(lambda s, e, c: max(0.0, (e - s) / (e - c)),
            "If a crash pays as much as to stay or more, each risk is worth it: return 1.",
            "A crash is worse than to stay."),
        Mistake(risk(lambda s, e, c: e / (e - c)),
            "You compare with a return of 0. The alternative to a try is to stay, which pays `stay`.",
            "Staying pays nothing."),
    ),
    hints=(
        "A try pays `escape` with probability 1 - q and `crash` with probability q. What does it pay on average?",
        "(1 - q) · escape + q · crash = stay. Solve for q.",
        "What is q if `escape` is not larger than `stay`? And if `crash` is not smaller than `stay`?",
    ),
    minutes=8, difficulty=2, equation="the q with (1 - q) · escape + q · crash = stay",
)  # fmt: skip


def outcomes_solution(x_ego, x_trap_1, accident):
    success = np.mean(x_ego > x_trap_1)
    kinds = [np.mean(accident == kind) for kind in (1, 2, 3)]
    return np.array([success, *kinds])


def rates(success, accident, kinds=(1, 2, 3)):
    return np.array([np.mean(success), *(np.mean(accident == kind) for kind in kinds)])


def outcomes_cases(rng):
    """A crash after overtaking, no success, level with trap 1, just ahead of it and just behind; then 30 at random."""
    yield np.array([900.0]), np.array([800.0]), np.array([1])
    yield np.array([1500.0, 12.0]), np.array([1515.0, 27.0]), np.array([0, 2])
    yield np.array([700.0, 700.01, 699.99]), np.array([700.0, 700.0, 700.0]), np.array([1, 3, 1])
    for _ in range(30):
        n = rng.integers(1, 12)
        yield rng.uniform(0, 2000, n), rng.uniform(15, 1515, n), rng.choice(4, n, p=[0.4, 0.3, 0.2, 0.1])


outcome_rates = Exercise(
    "outcome_rates(x_ego, x_trap_1, accident)", solution=outcomes_solution, cases=outcomes_cases,
    worked=(
        # behind, ahead, ahead and crashed, off the road at once
        ((np.array([1500.0, 1700.0, 900.0, 20.0]), np.array([1515.0, 1515.0, 800.0, 35.0]), np.array([0, 0, 1, 2])),
         np.array([0.5, 0.25, 0.25, 0.0])),
    ),
    mistakes=(
        Mistake(lambda x, x1, accident: rates((x > x1) & (accident == 0), accident),
            "You count a crash after overtaking as a failure. It counts as a success and, separately, as an accident.",
            "An episode with a crash cannot be a success."),
        Mistake(lambda x, x1, accident: rates(accident == 0, accident),
            "Your success is 'no accident'. A driver that stays in the trap has no accident either.",
            "Driving safely to the end is the goal."),
        Mistake(lambda x, x1, accident: rates(x > x1, accident) * len(x),
            "You return the number of episodes. Return their share.",
            "A rate is a count."),
        Mistake(lambda x, x1, accident: rates(x > x1, accident) * 100,
            "You return percentages: shares between 0 and 1 are asked for.",
            "Rates are written in per cent, as in the paper's tables."),
        Mistake(lambda x, x1, accident: np.array([np.mean(x > x1), *(
                np.sum(accident == kind) / max(1, np.sum(accident > 0)) for kind in (1, 2, 3))]),
            "You divide each kind by the number of accidents. Its rate is its share of *all* the episodes.",
            "The rates of the three kinds add up to one."),
        Mistake(lambda x, x1, accident: rates(x > x1, accident, (0, 1, 2)),
            "Your kinds are shifted by one: 0 means no accident, 1 collision, 2 road departure, 3 stoppage.",
            "Counting begins at 0."),
        Mistake(lambda x, x1, accident: rates(x < x1, accident),
            "You count the egos that are *behind* trap 1 at the end.",
            "The car with the larger x is further back."),
        Mistake(lambda x, x1, accident: rates(x >= x1, accident),
            "You count an ego that is level with trap 1. Ahead means x_ego > x_trap_1.",
            "Not behind is ahead."),
        Mistake(lambda x, x1, accident: rates(x - 5 > x1, accident),
            "You ask for a car's length more. The definition compares the two positions as they are.",
            "A car is ahead when its tail is."),
    ),
    hints=(
        "Compare the two positions at the end: they alone decide whether the episode is a success.",
        "The mean of an array of True and False is the share of True: `np.mean(accident == 1)`.",
        "`np.array([np.mean(x_ego > x_trap_1), np.mean(accident == 1), ...])`",
    ),
    minutes=5, difficulty=1, equation="Successful completion, Section III-C",
)  # fmt: skip
