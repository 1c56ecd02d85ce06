"""What the numbers and claims in this lesson's text are computed from, beside tools/course/known.py."""

from functools import cache

import numpy as np

from bootcourse.course.lessons.values import chain, diagrams
from bootcourse.course.lessons.values.exercises import bellman_sweep, temporal_difference


def free_road_seen(explore: float, gamma: float, walks: int = 30) -> int:
    """How many learners of the barrier's chain have decided on its free road, whose every decision pays 1."""
    return sum(map(chain.has_been_free, chain.learned(explore, gamma, walks=walks)))


def sweeps(times: int, gamma: float) -> np.ndarray:
    """Q of the chain after so many sweeps of the Bellman equation, from zeros: (5, 2)."""
    q = np.zeros((chain.STATES, 2))
    for _ in range(times):
        q = bellman_sweep.solution(q, gamma)
    return q


def walked(times: int, backwards: bool = False) -> list[bool]:
    """Which Q(s, 1) are above 0 after so many walks out, each learned with a step of 0.3 and γ = 0.8."""
    q = np.zeros((chain.STATES, 2))
    for s in [*range(chain.STATES)][:: -1 if backwards else 1] * times:
        q[s, 1] += 0.3 * temporal_difference.solution(q, s, 1, chain.REWARD[s, 1], chain.NEXT[s, 1], 0.8)
    return (q[:, 1] > 0).tolist()


@cache
def walks(seed: int, explore: float = 0.5, start: float = 0.0, pay: float = 0.16) -> np.ndarray:
    """Q of C's learner of this seed (or with another ε) before its first walk and after each: (walks + 1, 5, 2).

    start: what all Q are at first; pay: what staying in the trap pays.
    """
    q, s, found = np.full((chain.STATES, 2), start), 0, []
    for t, chance in enumerate(chain.chances(explore, 1000, seed)):
        if t % chain.EPISODE == 0:
            s = 0
            found.append(q.copy())
        a = int(q[s].argmax()) if chance < 0 else chance
        reward = chain.REWARD[s, a] if s or a else pay
        q[s, a] += 0.3 * temporal_difference.solution(q, s, a, reward, chain.NEXT[s, a], 0.8)
        s = chain.NEXT[s, a]
    return np.array([*found, q])


def arrivals(seed: int) -> np.ndarray:
    """The walks of such a learner that reach the free road."""
    return chain.arrivals(walks(seed))


def walks_until(state: int, seed: int = 1) -> int:
    """After how many of them it goes on in a state, or leaves the trap (0), for good."""
    return int((arrivals(seed) <= diagrams.goes_on_from(walks(seed), state)).sum())


@cache
def needed_walks() -> list[int]:
    """How many walks to the free road each of C's learners that leave needed."""
    return [walks_until(0, seed) for seed in range(30) if chain.leaves(walks(seed)[-1])]


def arrived_seldom() -> int:
    """How many of C's learners reach the free road in one or two walks, and do not learn to leave."""
    return sum(0 < len(arrivals(seed)) < 3 and not chain.leaves(walks(seed)[-1]) for seed in range(30))


def unpaid_leave(explore: float) -> int:
    """How many of thirty learners learn to leave where staying in the trap pays nothing."""
    return sum(chain.leaves(walks(seed, explore, pay=0.0)[-1]) for seed in range(30))


def greedy_zero(explore: float) -> float:
    """In which share of the states 0 to 3 action 0 is greedy, after the walks before the first to the free road."""
    firsts = {seed: [*chain.arrivals(walks(seed, explore)), None][0] for seed in range(30)}
    before = [walks(seed, explore)[:first] for seed, first in firsts.items()]
    return float(np.mean(np.concatenate(before)[:, :4].argmax(axis=2) == 0))
