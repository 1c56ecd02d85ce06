"""What the numbers and claims in this lesson's text are computed from, beside tools/course/known.py."""

from collections.abc import Callable
from functools import cache

import numpy as np

from bootcourse.course.lessons.values import chain
from bootcourse.course.lessons.values.exercises import bellman_sweep


def free_road_seen(explore: float, gamma: float, walks: int = 30) -> int:
    """How many learners of the barrier's chain have decided on its free road, whose every decision pays 1."""
    return sum(map(chain.has_been_free, chain.learned(explore, gamma, walks=walks)))


@cache
def replayed(times: int, walks: int = 30, backwards: bool = False) -> int:
    """How many of the chain's learners with A's ε and γ leave if the way out is replayed before the first decision."""
    q = np.zeros((chain.STATES, 2))
    for s, a in chain.WAY_OUT[:: -1 if backwards else 1] * times:
        q[s, a] += 0.3 * (chain.REWARD[s, a] + 0.8 * q[chain.NEXT[s, a]].max() - q[s, a])
    return sum(_leaves(q.copy(), 0.1, seed) for seed in range(walks))


def optimistic(explore: float, start: float, walks: int = 30) -> int:
    """How many of the chain's learners leave at γ = 0.8 if Q begins at `start` instead of 0."""
    return sum(_leaves(np.full((chain.STATES, 2), float(start)), explore, seed) for seed in range(walks))


@cache
def with_ties(pick: str, walks: int = 30) -> int:
    """How many of the chain's learners with A's ε and γ leave, by what they do with two equal actions: "1" takes
    action 1, "random" draws one of the two."""

    def of_equal(seed: int) -> Callable[[int], int]:
        return (lambda _: 1) if pick == "1" else np.random.default_rng([seed, 1]).integers

    return sum(_leaves(np.zeros((chain.STATES, 2)), 0.1, seed, of_equal(seed)) for seed in range(walks))


@cache
def own_decisions(updates: int, walks: int = 30) -> int:
    """How many of the chain's learners with A's ε and γ leave if they learn from each decision `updates` times."""
    return sum(_leaves(np.zeros((chain.STATES, 2)), 0.1, seed, updates=updates) for seed in range(walks))


def _leaves(
    q: np.ndarray, explore: float, seed: int, of_equal: Callable[[int], int] = lambda _: 0, updates: int = 1
) -> bool:
    """Does a learner of the chain that begins with this Q, which it changes in 1,000 decisions, leave at γ = 0.8?

    of_equal(2): which of two equal actions it takes. updates: how often it learns from each decision.
    """
    s = 0
    for t, chance in enumerate(chain.chances(explore, 1000, seed)):
        s = 0 if t % chain.EPISODE == 0 else s
        greedy = int(q[s].argmax()) if q[s, 0] != q[s, 1] else int(of_equal(2))
        a = greedy if chance < 0 else chance
        for _ in range(updates):
            q[s, a] += 0.3 * (chain.REWARD[s, a] + 0.8 * q[chain.NEXT[s, a]].max() - q[s, a])
        s = chain.NEXT[s, a]
    return chain.leaves(q)


def sweeps(times: int, gamma: float) -> np.ndarray:
    """Q of the chain after so many sweeps of the Bellman equation, from zeros: (5, 2)."""
    q = np.zeros((chain.STATES, 2))
    for _ in range(times):
        q = bellman_sweep.solution(q, gamma)
    return q
