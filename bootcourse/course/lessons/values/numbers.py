"""What the numbers and claims in this lesson's text are computed from, beside tools/course/known.py."""

from functools import cache

import numpy as np

from bootcourse.course.lessons.values import chain, diagrams
from bootcourse.course.lessons.values.exercises import bellman_sweep, temporal_difference


@cache
def as_c(gamma: float = 0.8, pay: float = 0.16, step: float = 0.3) -> np.ndarray:
    """The Q of 300 learners of C before their first walk and after each, (walks + 1, 300, 5, 2)."""
    return chain.many(0.5, gamma, pay=pay, step=step)


def leave_c(gamma: float = 0.8, pay: float = 0.16, step: float = 0.3) -> int:
    """How many of those learners learn to leave."""
    return sum(map(chain.leaves, as_c(gamma, pay, step)[-1]))


def often(times: int) -> int:
    """How many of those learners reach the free road so often or more, with γ = 0.8."""
    return sum(len(each) >= times for _, each in arrived(as_c()))


def state_3(seed: int, action: int) -> float:
    """What an action in state 3 is worth to C's learner of this seed right after its second arrival."""
    return float(walks(seed)[chain.arrivals(walks(seed))[1]][3, action])


def leave_later(decisions: int) -> int:
    """How many of C's thirty learn to leave if they make so many decisions."""
    return sum(chain.leaves(chain.learn_chain(chain.chances(0.5, decisions, k), 0.8, 0.3, ())) for k in range(30))


def thrice(gamma: float) -> tuple[float, float]:
    """Of those of the 300 that arrive three times, right after it: the mean Q(3, 0), and for which share it loses."""
    q = as_c(gamma)
    q3 = np.array([q[each[2], k, 3] for k, each in arrived(q) if len(each) > 2])
    return float(q3[:, 0].mean()), float((q3[:, 1] > q3[:, 0]).mean())


def mean_arrivals(gamma: float) -> float:
    """How often the 300 reach the free road, on average."""
    return float(np.mean([len(each) for _, each in arrived(as_c(gamma))]))


def by_chance(explore: float) -> float:
    """In how many of 50 walks action 1, drawn with ε / 2 at each decision, reaches the free road, on average."""
    at = np.eye(chain.STATES)[0]
    for _ in range(chain.EPISODE - 1):
        on = explore / 2 * at[:4]
        at = np.array([at[:4].sum() - on.sum(), *on[:3], on[3] + at[4]])
    return float(50 * at[4])


def trap_worth(gamma: float) -> float:
    """What staying seems to be worth to those learners in the end, the median."""
    return float(np.median(as_c(gamma)[-1][:, 0, 0]))


def arrived(q: np.ndarray) -> list[tuple[int, np.ndarray]]:
    """(learner, the walks in which it reaches the free road), of the Q of learners after each walk."""
    return [(k, chain.arrivals(q[:, k])) for k in range(q.shape[1])]


def turns_back(gamma: float) -> tuple[float, float]:
    """The mean Q(3, 0) and Q(3, 1) of those that arrive twice, right after it."""
    q = as_c(gamma)
    return tuple(np.mean([q[each[1], k, 3] for k, each in arrived(q) if len(each) > 1], axis=0))


def free_road_seen(explore: float, gamma: float, walks: int = 30) -> int:
    """How many learners of the barrier's chain have decided on its free road, whose every decision pays 1."""
    return sum(map(chain.has_been_free, chain.many(explore, gamma, walks)[-1]))


def sweeps(times: int, gamma: float) -> np.ndarray:
    """Q of the chain after so many sweeps of the Bellman equation, from zeros: (5, 2)."""
    q = np.zeros((chain.STATES, 2))
    for _ in range(times):
        q = bellman_sweep.solution(q, gamma)
    return q


def walked(times: int, backwards: bool = False) -> list[bool]:
    """Which Q(s, 1) are above 0 after so many walks out, each learned with a step of 0.3 and γ = 0.8."""
    return (after_walks(times, backwards) > 0).tolist()


def after_walks(times: int, backwards: bool) -> np.ndarray:
    """Those Q(s, 1), (5,)."""
    q = np.zeros((chain.STATES, 2))
    for s in [*range(chain.STATES)][:: -1 if backwards else 1] * times:
        q[s, 1] += 0.3 * temporal_difference.solution(q, s, 1, chain.REWARD[s, 1], chain.NEXT[s, 1], 0.8)
    return q[:, 1]


def backwards() -> float:
    """Q(0, 1) after one walk learned in reverse."""
    return float(after_walks(1, True)[0])


@cache
def walks(seed: int, explore: float = 0.5, start: float = 0.0) -> np.ndarray:
    """Q of C's learner of this seed (or with another ε) before its first walk and after each: (walks + 1, 5, 2).

    start: what all Q are at first.
    """
    q, s, found = np.full((chain.STATES, 2), start), 0, []
    for t, chance in enumerate(chain.chances(explore, 1000, seed)):
        if t % chain.EPISODE == 0:
            s = 0
            found.append(q.copy())
        a = int(q[s].argmax()) if chance < 0 else chance
        q[s, a] += 0.3 * temporal_difference.solution(q, s, a, chain.REWARD[s, a], chain.NEXT[s, a], 0.8)
        s = chain.NEXT[s, a]
    return np.array([*found, q])


def goes_on_for_good(seed: int = 1) -> list[int]:
    """After which walk such a learner goes on for good in the states 3, 2 and 1, and leaves the trap."""
    return [diagrams.goes_on_from(walks(seed), state) for state in (3, 2, 1, 0)]


def unpaid_leave(explore: float) -> int:
    """How many of thirty learners learn to leave where staying in the trap pays nothing."""
    return sum(map(chain.leaves, chain.many(explore, 0.8, 30, pay=0.0)[-1]))


def greedy_zero(explore: float) -> float:
    """In which share of the states 0 to 3 action 0 is greedy, after the walks before the first to the free road."""
    firsts = {seed: [*chain.arrivals(walks(seed, explore)), None][0] for seed in range(30)}
    before = [walks(seed, explore)[:first] for seed, first in firsts.items()]
    return float(np.mean(np.concatenate(before)[:, :4].argmax(axis=2) == 0))
