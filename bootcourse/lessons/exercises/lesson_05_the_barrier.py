"""Exercises of the lesson on the barrier."""

import numpy as np

from bootcourse.lessons.exercise import Exercise, Mistake


def discounted_value_solution(rewards, gamma):
    return float(np.sum(gamma ** np.arange(len(rewards)) * rewards))


def value_cases(rng):
    """One reward, γ = 1, γ = 0, a late reward alone; then 40 at random."""
    yield np.array([3.0]), 0.8
    yield np.array([1.0, 2.0, 4.0]), 1.0
    yield np.array([1.0, 2.0, 4.0]), 0.0
    yield np.array([0.0, 0.0, 0.0, -10.0]), 0.9
    for _ in range(40):
        yield rng.normal(0, 1, int(rng.integers(2, 40))), float(rng.uniform(0.3, 0.99))


discounted_value = Exercise(
    "discounted_value(rewards, gamma)",
    solution=discounted_value_solution, cases=value_cases,
    worked=(((np.array([1.0, 1.0, 1.0]), 0.5), 1.75), ((np.array([0.0, 0.0, 8.0]), 0.5), 2.0)),
    mistakes=(
        Mistake(lambda rewards, gamma: gamma * discounted_value_solution(rewards, gamma),
            "You discount the first reward, too. It comes now, so its weight is γ⁰ = 1.",
            "Counting begins at 1."),
        Mistake(lambda rewards, gamma: float(np.sum(rewards)),
            "This is the return without a discount. The reward after t seconds has the weight γ^t.",
            "γ is in the reward already."),
        Mistake(lambda rewards, gamma: float(gamma * np.sum(rewards)),
            "You multiply the whole sum by γ. Each further second adds another factor γ.",
            "The discount is a factor, so it is multiplied once."),
        Mistake(lambda rewards, gamma: discounted_value_solution(rewards[::-1], gamma),
            "Your weights run backwards: the last reward counts in full, and the first one hardly at all.",
            "The recursion y = r + γ y begins with the first reward."),
        Mistake(lambda rewards, gamma: discounted_value_solution(rewards, gamma) * (1 - gamma),
            "You normalised: this is a weighted mean of the rewards. Leave out the factor 1 - γ.",
            "Weights have to add up to 1."),
    ),
    hints=(
        "The first reward counts 1, the next γ, the next γ²: write these weights as an array.",
        "`gamma ** np.arange(len(rewards))` are the weights.",
        "`np.sum(gamma ** np.arange(len(rewards)) * rewards)`",
    ),
    minutes=3, difficulty=1, equation="Σ_t γ^t r_t, Section III, Equation of the objective",
)  # fmt: skip


def share_of_the_future_solution(gamma, seconds):
    return gamma**seconds


def share_cases(rng):
    """Now (everything is still to come), far away, a γ near 1; then 40 at random."""
    yield from ((0.8, 0), (0.8, 50), (0.99, 1), (0.5, 1))
    for _ in range(40):
        yield float(rng.uniform(0.5, 0.99)), int(rng.integers(1, 60))


share_of_the_future = Exercise(
    "share_of_the_future(gamma, seconds)",
    solution=share_of_the_future_solution, cases=share_cases,
    worked=(((0.5, 2), 0.25), ((0.8, 0), 1.0)),  # of 1 + 1/2 + 1/4 + ... = 2, 1/4 + 1/8 + ... = 1/2 is left
    mistakes=(
        Mistake(lambda gamma, seconds: 1 - gamma**seconds,
            "This is the share *before* that moment. Return the share after it.",
            "The sum of the first n terms is the formula to use."),
        Mistake(lambda gamma, seconds: gamma**seconds / (1 - gamma),
            "This is the weight that is left. For its share, divide by the weight of all seconds, 1 / (1 - γ).",
            "The weights add up to 1."),
        Mistake(lambda gamma, seconds: gamma**seconds * (1 - gamma),
            "This is the share of that one second. Add up all seconds from there on.",
            "The future is that one second."),
        Mistake(lambda gamma, seconds: gamma ** (seconds + 1),
            "You begin one second too late: the second that starts at that moment belongs to the future, too.",
            "After n seconds means from n + 1 on."),
        Mistake(lambda gamma, seconds: max(0.0, 1 - seconds * (1 - gamma)),
            "Your share falls in a straight line and ends. It falls by the same *factor* each second.",
            "Each second takes the same part away from the horizon of 1 / (1 - γ)."),
    ),
    hints=(
        "All seconds together weigh 1 + γ + γ² + ... = 1 / (1 - γ). What do those from `seconds` on weigh?",
        "Take out the first factor: γ^n + γ^(n+1) + ... = γ^n (1 + γ + ...).",
        "`gamma**seconds`",
    ),
    minutes=3, difficulty=1, equation="Σ_{t ≥ n} γ^t / Σ_t γ^t = γ^n",
)  # fmt: skip


def luck_solution(good, decisions, tries):
    once = (good / 9) ** decisions
    return 1 - (1 - once) ** tries


def luck_cases(rng):
    """One try, every action good, one decision; then 50 at random."""
    yield from ((3, 2, 1), (9, 20, 5), (1, 1, 9), (1, 8, 1000))
    for _ in range(50):
        yield int(rng.integers(1, 9)), int(rng.integers(1, 8)), int(rng.integers(1, 300))


luck = Exercise(
    "luck(good, decisions, tries)",
    solution=luck_solution, cases=luck_cases,
    worked=(((3, 2, 1), 1 / 9), ((3, 1, 2), 5 / 9)),  # (1/3)²; 1 - (2/3)²
    mistakes=(
        Mistake(lambda good, decisions, tries: tries * (good / 9) ** decisions,
            "Your chance can be above 1, because it counts two lucky tries twice. Compute the chance that *every* try "
            "fails.",
            "Chances of several tries add up."),
        Mistake(lambda good, decisions, tries: (good / 9) ** decisions,
            "This is the chance of one try. There are `tries` of them, and one lucky one is enough.",
            "Each try has the same chance, so the chance stays the same."),
        Mistake(lambda good, decisions, tries: (good / 9) ** (decisions * tries),
            "This is the chance that *all* tries are lucky. One is enough.",
            "Independent events are multiplied."),
        Mistake(lambda good, decisions, tries: 1 - (1 - good / 9) ** (decisions * tries),
            "This is the chance that at least one decision is right. All decisions of one try have to be right.",
            "At least one: 1 - (1 - p) to the number of all decisions."),
        Mistake(lambda good, decisions, tries: 1 - (1 - min(1.0, decisions * good / 9)) ** tries,
            "Within a try you add the chances. The chance that all decisions are right is their product.",
            "More decisions mean a higher chance."),
    ),
    hints=(
        "First one try: `good` of nine actions are right, `decisions` times in a row.",
        "Then the tries: the chance that all of them fail is (1 - once) to the power of `tries`.",
        "`1 - (1 - (good / 9) ** decisions) ** tries`",
    ),
    minutes=5, difficulty=2, equation="1 - (1 - (g/9)^n)^tries: the chance of a way out by chance",
)  # fmt: skip


def lowest_rate_solution(agents):
    return 0.025 ** (1 / agents)


lowest_rate = Exercise(
    "lowest_rate(agents)",
    solution=lowest_rate_solution, cases=lambda rng: ((int(n),) for n in range(1, 41)),
    worked=(((1,), 0.025), ((2,), 0.158114)),
    mistakes=(
        Mistake(lambda agents: 0.05 ** (1 / agents),
            "You use all of the 5 % at this end. An interval has two ends: each gets 2.5 %.",
            "95 % leaves 5 %."),
        Mistake(lambda agents: 1 - 0.025 ** (1 / agents),
            "Your rate falls as more agents succeed. This is the highest possible rate of *failures*, one minus the "
            "right answer.",
            "The rate is one minus the chance."),
        Mistake(lambda agents: 0.025 / agents,
            "You divide by the number of agents. The chance that all succeed is the *product* of their chances: take a "
            "root.",
            "The risk is shared among the agents."),
        Mistake(lambda agents: 0.975 ** (1 / agents),
            "At your rate this happens in 97.5 % of the cases. Find the rate at which it happens in 2.5 %.",
            "95 % sure means that it happens 95 % of the time."),
        Mistake(lambda agents: max(0.0, 1 - 3 / agents),
            "This is the rule of three, which is one-sided and holds for many agents. Solve rate^agents = 0.025.",
            "A rule of thumb holds for small numbers as well."),
    ),
    hints=(
        "If each agent escapes with probability `rate`, how likely is it that all of them do?",
        "Find the rate at which that has a probability of 2.5 %: rate ** agents = 0.025.",
        "`0.025 ** (1 / agents)`",
    ),
    minutes=5, difficulty=2, equation="the lower end of the exact (Clopper-Pearson) 95 % interval of n out of n",
)  # fmt: skip
