"""A barrier of five states, and Q-learning in it: the barrier's road with everything left out but the detour.

State 0 is the trap, state 4 the free road. Action 0 stays (in states 1 to 3: goes back to the trap), action 1 goes on.
"""

from collections.abc import Callable, Sequence

import numpy as np

STATES, EPISODE = 5, 20  # decisions in an episode; then the time is up and the next one begins in state 0
NEXT = np.array([[0, 1], [0, 2], [0, 3], [0, 4], [4, 4]])  # NEXT[s, a]
REWARD = np.array([[0.16, 0.0], [0.0, 0.0], [0.0, 0.0], [0.0, 0.0], [1.0, 1.0]])  # REWARD[s, a]
WAY_OUT = tuple((s, 1) for s in range(STATES))  # a demonstration: (state, action)


def learn_chain(chances, gamma, step, taught):
    """Q (5, 2) after len(chances) decisions, from zeros.

    chances: at each decision -1 for the greedy action (of two equal ones action 0), or the action that is tried.
    taught: decisions (s, a) of a demonstrator, replayed in this order after each decision of our own.
    """
    q, s = np.zeros((STATES, 2)), 0
    for t, chance in enumerate(chances):
        if t % EPISODE == 0:
            s = 0
        a = int(q[s].argmax()) if chance < 0 else chance
        for state, action in [(s, a), *taught]:
            target = REWARD[state, action] + gamma * q[NEXT[state, action]].max()
            q[state, action] += step * (target - q[state, action])
        s = NEXT[s, a]
    return q


def chances(explore: float, decisions: int, seed: int) -> np.ndarray:
    """ε-greedy: which decisions are drawn at random, and what is tried there: (decisions,) of -1, 0 or 1."""
    rng = np.random.default_rng(seed)
    return np.where(rng.random(decisions) < explore, rng.integers(0, 2, decisions), -1)


def learned(
    explore: float,
    gamma: float,
    taught: Sequence[tuple[int, int]] = (),
    walks: int = 30,
    learn: Callable[..., np.ndarray] = learn_chain,
) -> list[np.ndarray]:
    """The Q of each of `walks` learners after 1,000 decisions. learn: `learn_chain`, or a student's."""
    return [learn(chances(explore, 1000, seed), gamma, 0.3, taught) for seed in range(walks)]


def over_walks(
    explore: float, gamma: float, seed: int, learn: Callable[..., np.ndarray] = learn_chain
) -> list[np.ndarray]:
    """The Q of one of the `learned` before its first walk of 20 decisions and after each of the fifty."""
    drawn = chances(explore, 1000, seed)
    return [learn(drawn[:decisions], gamma, 0.3, ()) for decisions in range(0, len(drawn) + 1, EPISODE)]


def many(
    explore: float,
    gamma: float,
    learners: int = 300,
    taught: Sequence[tuple[int, int]] = (),
    step: float = 0.3,
    pay: float = float(REWARD[0, 0]),
) -> np.ndarray:
    """What `learn_chain` learns, for many learners at once, before each one's first walk and after each: their Q.

    pay: for staying in the trap. Returns (walks + 1, learners, 5, 2).
    """
    drawn, paid = np.array([chances(explore, 1000, seed) for seed in range(learners)]), REWARD.copy()
    paid[0, 0] = pay
    q, s, who = np.zeros((learners, STATES, 2)), np.zeros(learners, dtype=int), np.arange(learners)
    found = [q.copy()]
    for t, chance in enumerate(drawn.T):
        a = np.where(chance < 0, q[who, s].argmax(axis=1), chance)
        for state, action in [(s, a), *taught]:
            target = paid[state, action] + gamma * q[who, NEXT[state, action]].max(axis=1)
            q[who, state, action] += step * (target - q[who, state, action])
        s = NEXT[s, a]
        if (t + 1) % EPISODE == 0:
            s = np.zeros(learners, dtype=int)
            found.append(q.copy())
    return np.array(found)


def leaves(q: np.ndarray) -> bool:
    """Whether leaving is worth more than staying in the trap, as this Q says."""
    return bool(q[0, 1] > q[0, 0])


def has_been_free(q: np.ndarray) -> bool:
    """Whether this Q has learned from a decision on the free road, each of which pays 1."""
    return bool(q[4].max() > 0)


def arrivals(q: np.ndarray) -> np.ndarray:
    """The walks that reach the free road, from a learner's Q before the first and after each: q (walks + 1, 5, 2)."""
    return 1 + np.flatnonzero((q[1:, 4] != q[:-1, 4]).any(axis=1))


def leaving(explore: float, gamma: float, taught: Sequence[tuple[int, int]] = (), walks: int = 30) -> int:
    """How many of so many learners (`walks`) end with leaving above staying in the trap. Otherwise as in `many`."""
    return sum(map(leaves, many(explore, gamma, walks, taught)[-1]))
