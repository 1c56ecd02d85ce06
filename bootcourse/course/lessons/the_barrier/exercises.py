"""Exercises of the lesson on the barrier."""

import numpy as np

from bootcourse.course.exercise import exercise
from bootcourse.course.lessons.the_barrier import chain


def luck_cases(rng):
    """One attempt, every action good, one decision; then 50 at random."""
    yield from ((3, 2, 1), (9, 20, 5), (1, 1, 9), (1, 8, 1000))
    yield from ((rng.integers(1, 9), rng.integers(1, 8), rng.integers(1, 300)) for _ in range(50))


@exercise(
    "1 - (1 - (g/9)^n)^tries: the chance of a way out by chance", minutes=5, difficulty=2, cases=luck_cases,
    worked=[((3, 2, 1), 1 / 9), ((3, 1, 2), 5 / 9)],  # (1/3)²; 1 - (2/3)²
    hints=(
        "First one attempt: `good` of nine actions are right, `decisions` times in a row.",
        "Then all attempts: the chance that all of them fail is (1 - once) to the power of `tries`.",
    ),
    mistakes={
        "return tries * once":
            "Your chance can be above 1, because it counts two lucky attempts twice. Compute the chance that *every* "
            "attempt fails.",
        "return min(1.0, tries * once)":
            "You add the chances of the attempts, which counts two lucky ones twice. Compute the chance that *every* "
            "attempt fails.",
        "return (1 - once) ** tries":
            "This is the chance that *no* attempt is lucky. The chance of at least one is 1 minus that.",
        "return once":
            "This is the chance of one attempt. There are `tries` of them, and one lucky one is enough.",
        "return once**tries":
            "This is the chance that *all* attempts are lucky. One is enough.",
        "return 1 - (1 - good / 9) ** (decisions * tries)":
            "This is the chance that at least one decision is right. All decisions of one attempt have to be right.",
        "(good / 9) ** decisions -> min(1.0, decisions * good / 9)":
            "Within an attempt you add the chances. The chance that all decisions are right is their product.",
    },
)  # fmt: skip
def luck(good, decisions, tries):
    once = (good / 9) ** decisions
    return 1 - (1 - once) ** tries


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
        "One loop over `chances`. Start again in state 0 where `t % chain.EPISODE == 0`; choose a; update; move on to "
        "`chain.NEXT[s, a]`.",
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
