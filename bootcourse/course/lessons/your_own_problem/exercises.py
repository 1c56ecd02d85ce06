"""Exercises of the lesson on a problem of one's own: a rule, and when a bonus drowns the goal."""

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
