"""Exercises of the lesson on values: a return, the Bellman equation, the temporal difference, Q-learning."""

import numpy as np

from bootcourse.course.exercise import exercise
from bootcourse.course.lessons.values import chain


def return_cases(rng):
    """One reward, none discounted, only the first counts, an accident, a late reward; then 40 at random."""
    yield from (([3.0], 0.5), ([1.0, 2.0, 4.0], 1.0), ([1.0, 2.0, 4.0], 0.0), ([0.16] * 3 + [-10.0], 0.8))
    yield [0.0] * 400 + [50.0], 0.995
    for _ in range(40):
        yield rng.normal(0, rng.choice([1, 10]), rng.integers(1, 150)).tolist(), rng.uniform(0.3, 1)


@exercise(
    "G = Σ_t γ^t r_t", minutes=4, difficulty=1, cases=return_cases,
    worked=[(([1.0, 1.0, 1.0], 0.5), 1.75), (([0.0, 0.0, 4.0], 0.5), 1.0)],  # 1 + 0.5 + 0.25; 0.25 · 4
    hints=(
        "The first reward counts whole, the second γ times, the third γ² times.",
        "`gamma ** np.arange(len(rewards))` are the weights.",
    ),
    mistakes={
        "gamma ** np.arange(len(rewards)) -> gamma ** np.arange(1, len(rewards) + 1)":
            "You discount the first reward, too. It comes at once and counts whole: γ⁰ = 1.",
        "gamma ** np.arange(len(rewards)) -> gamma ** np.arange(len(rewards))[::-1]":
            "You discount the early rewards most. A reward counts less the *later* it comes.",
        "gamma ** np.arange(len(rewards)) -> gamma * np.arange(len(rewards))":
            "You multiply γ by t. A reward after t seconds counts γ to the power of t.",
        "return float(np.sum(rewards))":
            "You add the rewards without discounting them.",
        "return float(np.mean(gamma ** np.arange(len(rewards)) * np.asarray(rewards)))":
            "You take the mean of the discounted rewards. The return is their sum.",
    },
)  # fmt: skip
def discounted_return(rewards, gamma):
    return float(np.sum(gamma ** np.arange(len(rewards)) * np.asarray(rewards)))


def sweep_cases(rng):
    """Zeros, the free road known, a better way back; then 40 at random, some as large as a crash."""
    yield np.zeros((chain.STATES, 2)), 0.8
    yield np.array([[0.8, 0], [0, 0], [0, 0], [0, 0], [5.0, 5.0]]), 0.8
    yield np.array([[2.0, 1], [3, 0], [0, 4], [1, 1], [0, 7.0]]), 0.95
    for k in range(40):
        yield rng.normal(0, (1, 43)[k % 2], (chain.STATES, 2)), rng.uniform(0.3, 0.99)


def in_place(q, gamma):
    """A sweep whose later pairs already see the new values."""
    q = np.array(q)
    for s in reversed(range(chain.STATES)):
        for a in (0, 1):
            q[s, a] = chain.REWARD[s, a] + gamma * q[chain.NEXT[s, a]].max()
    return q


@exercise(
    "Q(s, a) = r + γ max_a' Q(s', a'), Bellman (1957)", minutes=8, difficulty=2, cases=sweep_cases,
    worked=[
        ((np.zeros((5, 2)), 0.5), np.array([[0.16, 0], [0, 0], [0, 0], [0, 0], [1, 1]])),
        ((np.array([[0.16, 0], [0, 0], [0, 0], [0, 0], [1, 1.0]]), 0.5),
         np.array([[0.24, 0], [0.08, 0], [0.08, 0], [0.08, 0.5], [1.5, 1.5]])),
    ],
    hints=(
        "First the value of each state, the larger of its two numbers: `q.max(axis=1)`, five numbers.",
        "`chain.NEXT` has the state that follows each pair, so `values[chain.NEXT]` has the value of each.",
    ),
    mistakes={
        "q.max(axis=1) -> q.mean(axis=1)":
            "You take the mean of the next state's two values: that is the value of acting at random. The better "
            "action counts, the largest.",
        "q.max(axis=1) -> q[:, 1]":
            "You take the value of going on in the next state. The better of its two actions counts.",
        "gamma * ->":
            "The value of the next state comes one decision later: multiply it by γ.",
        "chain.REWARD + ->":
            "The reward of the decision itself is missing.",
        "[chain.NEXT] -> [:, None]":
            "You use the value of the state itself. What counts is the value of the state that *follows*, "
            "`chain.NEXT[s, a]`.",
        in_place:
            "Some of your pairs already see new values. In one sweep all pairs use the *old* Q: make a new array.",
        "return q + chain.REWARD + gamma * q.max(axis=1)[chain.NEXT]":
            "You add the right side to the old Q. The equation says what Q *is*: replace it.",
    },
)  # fmt: skip
def bellman_sweep(q, gamma):
    return chain.REWARD + gamma * q.max(axis=1)[chain.NEXT]


def difference_cases(rng):
    """A decision of each kind, a large surprise; then 40 at random."""
    q = np.array([[0.5, 0.1], [0, 0.2], [0.3, 0], [0, 0.9], [5.0, 4.0]])
    yield from ((q, 0, 1, 0.0, 1, 0.8), (q, 3, 1, 0.0, 4, 0.8), (q, 4, 0, 1.0, 4, 0.95), (q, 2, 0, -10.0, 0, 0.8))
    for k in range(40):
        s, a = int(rng.integers(5)), int(rng.integers(2))
        following = rng.normal(0, (1, 43)[k % 2], (5, 2))
        yield following, s, a, float(rng.normal()), int(rng.integers(5)), float(rng.uniform(0.3, 0.99))


@exercise(
    "δ = r + γ max_a' Q(s', a') - Q(s, a)", minutes=4, difficulty=1, cases=difference_cases,
    worked=[((np.array([[0.5, 0], [0, 0.25], [0, 0], [0, 0], [0, 0]]), 0, 0, 1.0, 1, 0.5), 0.625)],  # 1 + 0.125 - 0.5
    hints=(
        "The target is the right side of the Bellman equation, with this one reward and this next state.",
        "The difference is the target minus what was expected, Q(s, a).",
    ),
    mistakes={
        "- q[s, a] ->":
            "This is the target. The difference is how much it is more than what was expected: subtract Q(s, a).",
        "return q[s, a] - (reward + gamma * q[s_next].max())":
            "The sign is turned: a positive difference says that it went *better* than expected.",
        "q[s_next].max() -> q[s_next].mean()":
            "You take the mean of the next state's values. The better action counts, the largest.",
        "q[s_next].max() -> q[s_next, a]":
            "You take the value of repeating the same action. In the next state the better of the two counts.",
        "q[s_next] -> q[s]":
            "You use the values of the state in which the decision was made. Those of the state that *follows* count.",
        "gamma * ->":
            "The value of the next state comes one decision later: multiply it by γ.",
    },
)  # fmt: skip
def temporal_difference(q, s, a, reward, s_next, gamma):
    return reward + gamma * q[s_next].max() - q[s, a]


def chain_cases(rng):
    """Greedy only, one decision, two episodes, a demonstration and a part of one; then 30 at random."""
    yield np.full(30, -1), 0.8, 0.5, ()
    yield np.array([1]), 0.8, 0.5, ()
    yield np.full(3, -1), 0.9, 0.5, chain.WAY_OUT
    yield np.array([1] * 45), 0.8, 0.3, ()
    yield np.array([1, 1, 0] * 15), 0.8, 1.0, chain.WAY_OUT[3:]
    yield np.full(60, -1), 0.9, 0.002, chain.WAY_OUT  # differences of a thousandth decide
    yield np.array([0, 1] * 10), 0.7, 0.4, ((4, 1), (2, 1), (4, 1), (0, 0), (2, 1))  # in no order, some twice
    for seed in range(4):  # as long as the lesson's
        yield chain.chances(0.1, 1000, seed), 0.8, 0.3, chain.WAY_OUT
    for k in range(30):
        taught = chain.WAY_OUT if k % 2 else ()
        drawn = chain.chances(rng.uniform(0.2, 1), rng.integers(5, 90), rng.integers(1000))
        yield drawn, rng.uniform(0.5, 0.95), rng.uniform(0.1, 0.9), taught


def the_time_is_an_end(chances, gamma, step, taught):
    """Q-learning in whose last decision of an episode the target is the reward alone."""
    q, s = np.zeros((chain.STATES, 2)), 0
    for t, chance in enumerate(chances):
        s = 0 if t % chain.EPISODE == 0 else s
        a = int(q[s].argmax()) if chance < 0 else chance
        for number, each in enumerate([(s, a), *taught]):
            is_last = number == 0 and t % chain.EPISODE == chain.EPISODE - 1
            following = 0.0 if is_last else gamma * q[chain.NEXT[each]].max()
            q[each] += step * (chain.REWARD[each] + following - q[each])
        s = chain.NEXT[s, a]
    return q


def back_before_it_learns(chances, gamma, step, taught):
    """Q-learning that goes back to state 0 before its last decision's target is computed."""
    q, s = np.zeros((chain.STATES, 2)), 0
    for t, chance in enumerate(chances, 1):
        a = int(q[s].argmax()) if chance < 0 else chance
        after = 0 if t % chain.EPISODE == 0 else chain.NEXT[s, a]
        q[s, a] += step * (chain.REWARD[s, a] + gamma * q[after].max() - q[s, a])
        for each in taught:
            q[each] += step * (chain.REWARD[each] + gamma * q[chain.NEXT[each]].max() - q[each])
        s = after
    return q


REPLAYED_AT_THE_END = """
for state, action in taught:
    target = REWARD[state, action] + gamma * q[NEXT[state, action]].max()
    q[state, action] += step * (target - q[state, action])
return q
"""
learn_chain = exercise(
    "Q(s, a) ← Q(s, a) + step (r + γ max Q(s', ·) - Q(s, a)), Watkins & Dayan (1992)",
    minutes=20, difficulty=3, cases=chain_cases,
    worked=[
        ((np.array([0, 0]), 0.5, 0.5, ()), np.array([[0.14, 0], [0, 0], [0, 0], [0, 0], [0, 0]])),  # 0.08, then + 0.06
        ((np.array([0]), 0.8, 1.0, ((4, 1), (3, 1))), np.array([[0.16, 0], [0, 0], [0, 0], [0, 0.8], [0, 1.0]])),
    ],
    hints=(
        "One loop over `chances`. Start again in state 0 where `t % chain.EPISODE == 0`; choose a; update, after the "
        "last decision of a walk, too; move on to `chain.NEXT[s, a]`.",
        "The same update for your own decision and for each (s, a) in `taught`: the target is `chain.REWARD[s, a] + "
        "gamma * q[chain.NEXT[s, a]].max()`.",
    ),
    mistakes={
        "if t % EPISODE == 0: s = 0 ->":
            "Your walk does not start again: every 20 decisions the time is up, and it continues in state 0.",
        the_time_is_an_end:
            "You treat the last decision of an episode as an end, after which nothing follows. The time was up, and "
            "the road goes on: the target keeps γ max Q(s').",
        back_before_it_learns:
            "The target of your last decision holds the value of state 0, where the walk starts again. Learn from the "
            "state to which the action led, `chain.NEXT[s, a]`, and go back to 0 afterwards.",
        "int(q[s].argmax()) -> int(q[s, 1] >= q[s, 0])":
            "Of two equal actions your learner takes action 1. The greedy action is then action 0, which `argmax` "
            "gives.",
        ".max() -> [action]":
            "You bootstrap with the value of repeating the same action. In the next state the better of the two "
            "counts.",
        ".max() -> .mean()":
            "You bootstrap with the mean of Q(s', ·): that is the value of acting at random. Q-learning takes the "
            "largest.",
        ".max() -> [1]":
            "You bootstrap with the value of going on. In the next state the better of the two actions counts.",
        "gamma * ->":
            "The value of the next state is not discounted: multiply it by γ.",
        "+= step * (target - q[state, action]) -> = target":
            "You replace Q(s, a) by the target. Move it there by a part of the way only, `step` times the difference.",
        ("[(s, a), *taught] -> [(s, a)]", REPLAYED_AT_THE_END):
            "You replay the demonstration at the end. Replay it after *each* decision: the next choice depends on it.",
        "[(s, a), *taught] -> [*taught, (s, a)]":
            "You replay the demonstration before your own decision is learned. First your own, then `taught`.",
        "s = NEXT[s, a] -> s = NEXT[state, action]":
            "Your walk goes on from where the demonstration ends. It goes on from your *own* decision: use other names "
            "than s and a for what is replayed.",
        "[(s, a), *taught] -> [(s, a)]":
            "You do not replay the demonstration `taught`.",
    },
)(chain.learn_chain)  # fmt: skip
