"""Exercises of the lesson on the road, its actions and its reward."""

import numpy as np

from bootcourse.course.exercise import MANY_ROWS, NotAsAsked, exercise
from bootcourse.road import formulas


def action_cases(rng):
    """All nine at once, each alone; then 20 at random."""
    yield from ((np.arange(9),), *((np.array([action]),) for action in range(9)))
    yield from ((rng.integers(0, 9, rng.integers(1, 8)),) for _ in range(20))
    yield (rng.integers(0, 9, MANY_ROWS),)


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
    """Each accident, steering left and right, far more than an action does, off the centre, fast; 40 at random."""
    yield from ((12.0, 0.0, 0.0, accident) for accident in range(4))
    yield from ((10.0, 0.8, theta, 0) for theta in (-np.pi / 50, np.pi / 50, -1.2, 1.2))
    yield from ((v, 0.3, 0.0, 0) for v in (0.5, 4.99, 5.01, 12.49, 12.51, 14.99, 15.01, 18.5, 30.0))
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
        "A weighted mean: multiply each term by its weight, add the three, and divide by the sum of the weights.",
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


SUCCEED = "This is the share of attempts that must *succeed*. The risk is the share that crash: one minus that."


def risk_cases(rng):
    """The rule's numbers, a way out that pays no more than to stay, a harmless crash, all edges; 40 at random."""
    yield from ((23.4375, out, -9.5) for out in (51.0, 20.0, 23.4375))
    yield from ((stay, 51.0, -9.5) for stay in (-30.0, -9.5))
    yield 20.0, 20.5, -20.0  # hardly any risk is worth it
    yield 20.0, 100.0, 19.5  # almost any risk is worth it
    yield from ((20.0, 20.002, -20.0), (20.0, 30.0, 19.999))  # 5 in 100,000, and all but 1 in 10,000
    yield from ((-0.5, 0.5, -9.5), (-5.0, -2.0, -9.5))  # returns of less than 0
    for _ in range(40):
        stay, gain = rng.uniform(-20, 40), rng.uniform(-10, 120)
        yield stay, stay + gain, stay + min(gain - 1, rng.uniform(-60, 10))


@exercise(
    "the q with (1 - q) · out + q · crash = stay", minutes=8, difficulty=2, cases=risk_cases,
    worked=[
        ((20.0, 60.0, -20.0), 0.5),  # half of 60 and half of -20 are 20, what staying pays
        ((20.0, 100.0, -20.0), 2 / 3),
        ((20.0, 10.0, -20.0), 0.0),  # this way out pays less than to stay
        ((-50.0, 10.0, -20.0), 1.0),  # even a crash is better than to stay
    ],
    hints=(
        "An attempt pays `out` with probability 1 - q and `crash` with probability q. What does it pay on average?",
        "Solve (1 - q) · out + q · crash = stay for q. What is q if `out` is not larger than `stay`? And if "
        "`crash` is not smaller than `stay`?",
    ),
    mistakes={
        "return (stay - crash) / (out - crash)":
            SUCCEED,
        ("if out <= stay: return 0.0 ->", "if crash >= stay: return 1.0 ->",
         "return min(1.0, max(0.0, (stay - crash) / (out - crash)))"):
            SUCCEED,
        "(out - crash) -> abs(crash)":
            "You compare the gain with the crash's own return. A crash costs what the attempt would have earned, "
            "out - crash.",
        "(out - crash) -> (stay - crash)":
            "You divide by what a crash loses against staying. That ratio is the *odds*, crashes for each success; the "
            "question asks for a probability.",
        ("if out <= stay: return 0.0 ->", "if crash >= stay: return 1.0 ->"):
            "Your risk leaves the range from 0 to 1. If getting out pays no more than to stay, no risk is worth it: 0. "
            "If even a crash pays more than to stay, each risk is: 1.",
        "if crash >= stay: return 1.0 ->":
            "If a crash pays as much as to stay or more, each risk is worth it: return 1.",
        "(out - stay) -> out":
            "You compare with a return of 0. The alternative to an attempt is to stay, which pays `stay`.",
    },
)  # fmt: skip
def bearable_risk(stay, out, crash):
    if out <= stay:
        return 0.0
    if crash >= stay:
        return 1.0
    return (out - stay) / (out - crash)


def locks(rng):
    """Roads on which some of the eight seconds decide, and on most all of them together: see `gets_out` below.

    1 in 9 to 1 in 729 plans gets out.
    """
    for deciding in (3, 2, 2, 2, 2, 2, 2, 4, 6, 6, 6, 6, 6, *rng.integers(2, 5, 9)):
        actions = rng.integers(3, 6, deciding).tolist()
        yield tuple(rng.permutation(8)[:deciding].tolist()), actions, int(rng.integers(3)) if deciding < 6 else None


MANY = 100_000  # actions
TOGETHER = np.array([1, 2, 1, 1, 2, 2, 1, 2])  # how much each second steers, where all decide together
NOT_AGAIN = "Two equal generators give different plans: draw with `rng`, so that a search can be repeated."
NOT_DRAWN = "Your planner asks about some plans twice and draws none with `rng`: draw with the generator it is given."


def found_on(answer, seconds, actions, rest):
    """Whether a planner's plan gets out where these seconds need these actions; 1 or 0.

    rest: what is left of the weighted sum of all actions, divided by 3; None where only these seconds decide. With it
    the mean of two plans that get out need not get out, and no second can be tried alone.
    """
    asked = {3: 0, 4: 0, 5: 0}  # how often each action stood in a plan

    asked_twice, known = False, np.zeros(3**8, dtype=bool)  # by the plan's number

    def gets_out(plans):
        nonlocal asked_twice
        plans = np.asarray(plans)
        if plans.ndim != 2 or plans.shape[1] != 8:
            raise NotAsAsked(f"You asked about plans of shape {plans.shape}: `gets_out` takes many at once, (n, 8).")
        if not np.isin(plans, (3, 4, 5)).all():
            raise NotAsAsked("Your plans hold other actions: those that keep the speed are 3, 4 and 5.")
        for action in asked:
            asked[action] += int((plans == action).sum())
        if min(asked.values()) == 0 and max(asked.values()) > MANY:  # it would search for ever
            missing = min(asked, key=asked.get)
            raise NotAsAsked(f"None of your plans holds action {missing}. `rng.integers(low, high)` leaves out `high`: "
                             "3, 4 and 5 are `rng.integers(3, 6)`.")  # fmt: skip
        numbers = (plans.astype(int) - 3) @ 3 ** np.arange(8)
        asked_twice |= bool(known[numbers].any()) or len(np.unique(numbers)) < len(numbers)
        known[numbers] = True
        out = (plans[:, list(seconds)] == actions).all(axis=1)
        return out if rest is None else out & (plans @ TOGETHER % 3 == rest)

    def planned():
        nonlocal asked_twice
        asked_twice, known[:] = False, False
        rng = np.random.default_rng(0)
        before = str(rng.bit_generator.state)
        plan = answer(gets_out, rng)
        if asked_twice and str(rng.bit_generator.state) == before:  # who asks about each plan once needs no generator
            raise NotAsAsked(NOT_DRAWN)
        if plan is None:
            return None
        plan = np.asarray(plan)
        if plan.shape != (8,):
            raise NotAsAsked(f"Your planner returns an array of shape {plan.shape}: one plan is (8,).")
        return plan

    plan = planned()
    if plan is None:
        return None
    found = float(gets_out(plan[None])[0])
    if len(seconds) == 4 and found and not np.array_equal(plan, planned()):  # most plans fail here: few would agree
        raise NotAsAsked(NOT_AGAIN)
    return found


def does_not_get_out(cases, answers):
    """A sentence on a plan that does not get out."""
    return "Your planner returns a plan that does not get out: return one for which `gets_out` said True."


@exercise(
    "random search over plans of eight seconds", minutes=10, difficulty=2, cases=locks, run=found_on,
    explain=does_not_get_out,
    worked=[(((0, 1), (3, 5), None), 1.0), (((7,), (4,), 1), 1.0)],  # a plan that gets out has to be returned
    hints=(
        "`rng.integers(3, 6, (500, 8))` draws 500 plans. Ask `gets_out` about all of them at once.",
        "If `out.any()`, return `plans[out.argmax()]`, the first that gets out. If none does, draw again: a loop.",
    ),
    mistakes={
        "return plans[out.argmax()] -> return plans[0]":
            "Your planner returns a plan that does not get out: return one for which `gets_out` said True.",
        "return plans[out.argmax()] -> return plans[out.argmin()]":
            "Your planner returns a plan for which `gets_out` said False, or that it has not asked about: return one "
            "for which it said True.",
        "if out.any(): return plans[out.argmax()] -> return plans[out.argmax()]":
            "Your planner gives up after one draw: where none of the plans gets out, draw again.",
    },
)  # fmt: skip
def find_plan(gets_out, rng):
    while True:
        plans = rng.integers(3, 6, (500, 8))
        out = gets_out(plans)
        if out.any():
            return plans[out.argmax()]
