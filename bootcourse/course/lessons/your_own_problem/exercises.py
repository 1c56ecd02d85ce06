"""Exercises of the lesson on a problem of one's own: a rule, why cloning averages, and when a bonus drowns the goal."""

from bootcourse.course.exercise import exercise
from bootcourse.course.lessons.your_own_problem.loops import UP, climb, explain_climb


@exercise(
    "push along the motion, which adds energy with each swing", minutes=8, difficulty=2, run=climb,
    cases=lambda rng: ((int(seed),) for seed in range(102, 120)), explain=explain_climb,
    worked=[((100,), UP), ((101,), UP)],
    hints=(
        "The engine is too weak for the hill. What adds energy to a swing, wherever the car is?",
        "Only the sign of the speed matters: push to the side to which the car moves.",
    ),
    mistakes={
        "return 2":
            "Your rule pushes to the right for 200 decisions and stays in the valley: the engine is too weak. The car "
            "has to swing.",
        "return 1":
            "In these episodes your rule never pushes: the car swings in the valley as high as it began.",
        "2 if speed >= 0 else 0 -> 0 if speed >= 0 else 2":
            "Your rule pushes *against* the motion. That brakes: each swing is smaller than the one before.",
        "speed >= 0 -> position >= -0.5":
            "Your rule pushes to the side on which the car is, away from the valley's bottom at -0.5. On its way back "
            "down the push brakes as much as it helped before: look at the speed.",
        "2 if speed >= 0 else 0 -> 2 if speed >= 0 else 1":
            "Your rule pushes to the right and never to the left. Swings to the left add energy, too.",
        "2 if speed >= 0 else 0 -> 3 if speed >= 0 else 0":
            "Your rule returns a number that is not an action: 0 is left, 1 no push, 2 right.",
    },
)  # fmt: skip
def climb_rule(position, speed):
    return 2 if speed >= 0 else 0


def majority_cases(rng):
    """One vote, two, an even number, right in half, always right, systematic, many votes; then 30 at random."""
    yield from ((0.7, 1), (0.7, 2), (0.6, 4), (0.5, 5), (1.0, 3), (0.0, 4), (0.2, 9), (0.7, 41), (0.52, 200))
    for _ in range(30):
        yield rng.uniform(0, 1), int(rng.integers(1, 30))


@exercise(
    "P(more than half of n labels are right), right in a share q each: Condorcet 1785",
    minutes=10, difficulty=2, cases=majority_cases,
    worked=[
        ((0.7, 1), 0.7),
        ((0.7, 3), 3 * 0.7**2 * 0.3 + 0.7**3),  # two of three, or all
        ((0.6, 2), 0.6**2 + 0.5 * 2 * 0.6 * 0.4),  # both, or one of two and a coin
    ],
    hints=(
        "The number of right labels is binomial: k of n with probability C(n, k) q^k (1 - q)^(n - k).",
        "Add up these probabilities for 2 k > n, and half of the one for 2 k = n. `math.comb(n, k)` is C(n, k).",
    ),
    mistakes={
        "comb(votes, k) * ->":
            "You count one order of the right and wrong labels. There are C(n, k) orders with k right ones.",
        "0.5 if 2 * k == votes -> 1.0 if 2 * k == votes":
            "You count a tie as won. At a tie the clone has no reason for either action: count half of it.",
        "0.5 if 2 * k == votes else 0.0 -> 0.0":
            "You leave ties out. At a tie the clone takes the right action in half of the cases.",
        "2 * k > votes -> 2 * k < votes":
            "This is the probability that the majority is *wrong*.",
        "return right":
            "This is the probability of one label. The clone learns from all labels of alike states together.",
        "return right**votes":
            "This is the probability that *all* labels are right. More than half is enough.",
        "return 1 - (1 - right)**votes":
            "This is the probability that at least *one* label is right. The clone does what more than half say.",
    },
)  # fmt: skip
def majority_right(right, votes):
    from math import comb

    total = 0.0
    for k in range(votes + 1):
        probability = comb(votes, k) * right**k * (1 - right) ** (votes - k)
        total += probability * (1.0 if 2 * k > votes else 0.5 if 2 * k == votes else 0.0)
    return total


def bonus_cases(rng):
    """Nothing on the way, a cost, a gain; no goal, a bad one; one decision, many; then 30 at random."""
    yield from ((0.0, 1.0, 9, 0.97), (-1.0, 0.0, 120, 0.99), (-1.0, 0.0, 20, 0.9), (0.1, 1.0, 4, 0.9))
    yield from ((0.5, 0.2, 3, 0.8), (0.0, 10.0, 1, 0.5), (-1.0, 500.0, 2, 0.5), (1.0, -40.0, 6, 0.9))
    yield (-1.0, 200.0, 150, 0.99)
    for number in range(30):
        n, most = int(rng.integers(1, 20)), 300 if number % 4 == 3 else 10
        yield rng.normal(0, 1), rng.uniform(0, most), n, rng.uniform(0.7, 0.99)


@exercise(
    "the c at which a loop for ever is worth as much as the way to the goal", minutes=15, difficulty=3,
    cases=bonus_cases,
    worked=[
        ((0.0, 1.0, 1, 0.5), 1.0),  # way c + 1, loop 2 c
        ((0.0, 1.0, 2, 0.8), 0.25),  # way 1.8 c + 0.8, loop 5 c
        ((-1.0, 0.0, 3, 0.9), 1.0),  # whatever follows the goal earns 0: so does the loop at c = 1
    ],
    hints=(
        "Write both values with geometric sums. The loop: (reward + c) / (1 - γ). The way: `decisions` times "
        "reward + c, and the goal in the last decision, discounted by γ^(decisions - 1).",
        "Set them equal and solve for c. On the side of c there remains c γ^decisions / (1 - γ).",
    ),
    mistakes={
        "gamma ** (decisions - 1) -> gamma**decisions":
            "You discount the goal once too often: the first decision is not discounted, so the last one is by "
            "γ^(decisions - 1).",
        "(gamma**decisions / (1 - gamma)) -> (1 / (1 - gamma))":
            "You leave out the bonuses on the way. The agent gets c in each decision before it reaches the goal, too.",
        "- reward * gamma**decisions / (1 - gamma) ->":
            "You leave out the reward. The loop earns it for ever, and the way only until the goal.",
        "- reward * gamma**decisions -> + reward * gamma**decisions":
            "The reward has the wrong sign: where each decision pays, a smaller bonus is enough for the loop.",
        "goal * gamma ** (decisions - 1) -> goal":
            "The goal comes in the last decision: discount it.",
        "return (1 - gamma) * goal":
            "This compares one decision of the loop with the goal. Count the discounts, the rewards, and the bonuses "
            "on the way.",
    },
)  # fmt: skip
def drowning_bonus(reward, goal, decisions, gamma):
    without_bonus = goal * gamma ** (decisions - 1) - reward * gamma**decisions / (1 - gamma)
    return without_bonus / (gamma**decisions / (1 - gamma))
