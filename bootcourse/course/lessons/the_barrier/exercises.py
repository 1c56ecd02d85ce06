"""Exercises of the lesson on the barrier."""

import numpy as np

from bootcourse.course.exercise import Exercise, Mistake
from bootcourse.course.lessons.the_barrier import chain


def share_of_the_future_solution(gamma, seconds):
    return gamma**seconds


share_of_the_future = Exercise(
    "share_of_the_future(gamma, seconds)", solution=share_of_the_future_solution,
    # now (everything is still to come), far away, a γ near 1; then 40 at random
    cases=lambda rng: [(0.8, 0), (0.8, 50), (0.99, 1), (0.5, 1),
                       *((rng.uniform(0.5, 0.99), rng.integers(1, 60)) for _ in range(40))],
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


luck = Exercise(
    "luck(good, decisions, tries)", solution=luck_solution,
    # one try, every action good, one decision; then 50 at random
    cases=lambda rng: [(3, 2, 1), (9, 20, 5), (1, 1, 9), (1, 8, 1000),
                       *((rng.integers(1, 9), rng.integers(1, 8), rng.integers(1, 300)) for _ in range(50))],
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


def walk(
    chances, gamma, step, taught, best=np.max, restart=True, ends=False, one_step=False, after=False, own_last=False,
    lost=False,
):  # fmt: skip
    """Q-learning in the chain, with one thing done differently: what students do."""
    q, s = np.zeros((chain.STATES, 2)), 0
    for t, chance in enumerate(chances):
        if restart and t % chain.EPISODE == 0:
            s = 0
        a = int(q[s].argmax()) if chance < 0 else chance
        seen = [(s, a)] if after else [*taught, (s, a)] if own_last else [(s, a), *taught]
        for state, action in seen:
            last = ends and t % chain.EPISODE == chain.EPISODE - 1 and (state, action) == (s, a)
            target = chain.REWARD[state, action] + (0 if last else gamma) * best(q[chain.NEXT[state, action]])
            q[state, action] = target if one_step else q[state, action] + step * (target - q[state, action])
        s = chain.NEXT[seen[-1] if lost else (s, a)]
    for state, action in taught if after else ():
        target = chain.REWARD[state, action] + gamma * best(q[chain.NEXT[state, action]])
        q[state, action] += step * (target - q[state, action])
    return q


def chain_cases(rng):
    """Greedy only, one decision, two episodes, a demonstration and a part of one; then 30 at random."""
    yield np.full(30, -1), 0.8, 0.5, ()
    yield np.array([1]), 0.8, 0.5, ()
    yield np.full(3, -1), 0.9, 0.5, chain.WAY_OUT
    yield np.array([1] * 45), 0.8, 0.3, ()
    yield np.array([1, 1, 0] * 15), 0.8, 1.0, chain.WAY_OUT[3:]
    for k in range(30):
        taught = chain.WAY_OUT if k % 2 else ()
        drawn = chain.chances(rng.uniform(0.2, 1), rng.integers(5, 90), rng.integers(1000))
        yield drawn, rng.uniform(0.5, 0.95), rng.uniform(0.1, 0.9), taught


learn_chain = Exercise(
    "learn_chain(chances, gamma, step, taught)", solution=chain.learn_chain, cases=chain_cases,
    worked=(
        ((np.array([0, 0]), 0.5, 0.5, ()), np.array([[0.14, 0], [0, 0], [0, 0], [0, 0], [0, 0]])),  # 0.08, then + 0.06
        ((np.array([0]), 0.8, 1.0, ((4, 1), (3, 1))), np.array([[0.16, 0], [0, 0], [0, 0], [0, 0.8], [0, 1.0]])),
    ),
    mistakes=(
        Mistake(lambda *case: walk(*case, restart=False),
            "Your walk does not start again: every 20 decisions the time is up, and it continues in state 0.",
            "An episode goes on until somebody ends it."),
        Mistake(lambda *case: walk(*case, ends=True),
            "You treat the last decision of an episode as an end, after which nothing follows. The time was up, and "
            "the road goes on: the target keeps γ max Q(s').",
            "Nothing follows the last row of an episode."),
        Mistake(lambda *case: walk(*case, best=np.mean),
            "You bootstrap with the mean of Q(s', ·): that is the value of acting at random. Q-learning takes the "
            "largest.",
            "The value of a state is the mean over its actions."),
        Mistake(lambda *case: walk(*case, best=lambda each: each[1]),
            "You bootstrap with the value of going on. In the next state the better of the two actions counts.",
            "The next action is the one that we want it to learn."),
        Mistake(lambda chances, gamma, step, taught: walk(chances, 1.0, step, taught),
            "The value of the next state is not discounted: multiply it by γ.",
            "γ discounts rewards, and a value is no reward."),
        Mistake(lambda *case: walk(*case, one_step=True),
            "You replace Q(s, a) by the target. Move it there by a part of the way only, `step` times the difference.",
            "The target is the new value."),
        Mistake(lambda *case: walk(*case, after=True),
            "You replay the demonstration at the end. Replay it after *each* decision: the next choice depends on it.",
            "The order of the updates does not matter."),
        Mistake(lambda *case: walk(*case, own_last=True),
            "You replay the demonstration before your own decision is learned. First your own, then `taught`.",
            "The order of the updates does not matter."),
        Mistake(lambda *case: walk(*case, lost=True),
            "Your walk goes on from where the demonstration ends. It goes on from your *own* decision: use other names "
            "than s and a for what is replayed.",
            "A loop has names of its own."),
        Mistake(lambda chances, gamma, step, taught: walk(chances, gamma, step, ()),
            "You do not replay the demonstration `taught`.",
            "A learner learns from its own decisions."),
    ),
    hints=(
        "One loop over `chances`. Start again in state 0 where `t % chain.EPISODE == 0`; choose a; update; move on.",
        "The same update for your own decision and for each (s, a) in `taught`: the target is `chain.REWARD[s, a] + "
        "gamma * q[chain.NEXT[s, a]].max()`.",
        "`q[s, a] += step * (target - q[s, a])`; the next state of the walk is `chain.NEXT[s, a]` of *your* decision.",
    ),
    minutes=20, difficulty=3,
    equation="Q(s, a) ← Q(s, a) + step (r + γ max Q(s', ·) - Q(s, a)), Watkins & Dayan (1992)",
)  # fmt: skip


def lowest_rate_solution(agents):
    return 0.025 ** (1 / agents)


lowest_rate = Exercise(
    "lowest_rate(agents)", solution=lowest_rate_solution, cases=lambda rng: ((n,) for n in range(1, 41)),
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
