"""What the numbers and claims in this lesson's text are computed from, beside tools/course/known.py."""

from functools import cache

import numpy as np

from bootcourse.course.lessons.values import chain, diagrams
from bootcourse.course.lessons.values.exercises import bellman_sweep, temporal_difference


def free_road_seen(explore: float, gamma: float, walks: int = 30) -> int:
    """How many learners of the barrier's chain have decided on its free road, whose every decision pays 1."""
    return sum(map(chain.has_been_free, chain.learned(explore, gamma, walks=walks)))


@cache
def with_draws(walks: int = 30) -> list[np.ndarray]:
    """Q of each of the chain's learners with A's ε and γ, if they draw one of two equal actions at random."""
    return [_drawing(seed)[-1] for seed in range(walks)]


@cache
def drawn_arrivals(walks: int = 30) -> list[int]:
    """On how many walks each of those that reach the free road does so."""
    counts = (len(chain.arrivals(np.array(_drawing(seed)))) for seed in range(walks))
    return [count for count in counts if count]


@cache
def _drawing(seed: int) -> list[np.ndarray]:
    """A's learner of this seed that draws so: its Q before the first walk and after each."""
    rng, q, s, found = np.random.default_rng(1000 + seed), np.zeros((chain.STATES, 2)), 0, []
    for t, chance in enumerate(chain.chances(0.1, 1000, seed)):
        if t % chain.EPISODE == 0:
            s = 0
            found.append(q.copy())
        greedy = rng.integers(2) if q[s, 0] == q[s, 1] else q[s].argmax()
        a = int(greedy) if chance < 0 else chance
        q[s, a] += 0.3 * (chain.REWARD[s, a] + 0.8 * q[chain.NEXT[s, a]].max() - q[s, a])
        s = chain.NEXT[s, a]
    return [*found, q]


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
def walks(seed: int) -> np.ndarray:
    """Q of one of the last figure's learners after each walk, the zeros before included: (walks + 1, 5, 2)."""
    return np.array(chain.over_walks(0.5, 0.8, seed))


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
