"""What the numbers and claims in this lesson's text are computed from, beside tools/course/known.py."""

from functools import cache

import numpy as np

from bootcourse.course.lessons.values import chain, diagrams
from bootcourse.course.lessons.values.exercises import bellman_sweep, temporal_difference

LOW_PAY = 0.16 * (0.8 / 0.2) / (0.95 / 0.05)  # turning back is worth as much with it at γ = 0.95 as else at 0.8


@cache
def as_c() -> np.ndarray:
    """The Q of 300 learners of C before their first walk and after each, (walks + 1, 300, 5, 2)."""
    return chain.many(0.5, 0.8)


@cache
def wins_after(arrivals: int) -> list[bool]:
    """Whether leaving wins right after this arrival, of each of those learners that has arrived so often."""
    walks = {k: chain.arrivals(as_c()[:, k]) for k in range(300)}
    return [chain.leaves(as_c()[each[arrivals - 1], k]) for k, each in walks.items() if len(each) >= arrivals]


def goes_on(replays: int) -> int:
    """How many of 30 learners as E go on in the states 1 to 3 after a walk, if replays follow so many decisions."""
    q = chain.many(0.1, 0.8, 30, chain.WAY_OUT, replays)[1]
    return int((q[:, 1:4, 1] > q[:, 1:4, 0]).all(axis=1).sum())


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


def walks_to(state: int, seed: int = 1) -> int:
    """After which walk such a learner goes on in a state, or leaves the trap (0), for good."""
    return diagrams.goes_on_from(walks(seed), state)


def unpaid_leave(explore: float) -> int:
    """How many of thirty learners learn to leave where staying in the trap pays nothing."""
    return sum(chain.leaves(walks(seed, explore, pay=0.0)[-1]) for seed in range(30))


def greedy_zero(explore: float) -> float:
    """In which share of the states 0 to 3 action 0 is greedy, after the walks before the first to the free road."""
    firsts = {seed: [*chain.arrivals(walks(seed, explore)), None][0] for seed in range(30)}
    before = [walks(seed, explore)[:first] for seed, first in firsts.items()]
    return float(np.mean(np.concatenate(before)[:, :4].argmax(axis=2) == 0))


@cache
def controls() -> dict[str, np.ndarray]:
    """Learners as in `chain.many`, each kind with one thing changed: {kind: how often each one reached the free road,
    and whether it learns to leave, (2, learners)}. All kinds walk at once, which is quicker.

    D: ε = 1; low pay: ε = 0.5 and γ = 0.95, but turning back is worth what it is at γ = 0.8; calm: as E with four
    replays, but without random actions in the states 1 to 3; ties 0 to 3: thirty as C, ties between Q drawn at random.
    """
    kinds = {"D": (1.0, 0.8, 300), "low pay": (0.5, 0.95, 300), "calm": (0.1, 0.8, 300)}
    kinds |= {f"ties {k}": (0.5, 0.8, 30) for k in range(4)}
    of = np.concatenate([[name] * each for name, (_, _, each) in kinds.items()])
    gamma, pay = np.array([kinds[name][1] for name in of]), np.where(of == "low pay", LOW_PAY, chain.REWARD[0, 0])
    drawn = [chain.chances(explore, 1000, k) for explore, _, each in kinds.values() for k in range(each)]
    random, calm, who, rng = np.char.startswith(of, "ties"), of == "calm", np.arange(len(of)), np.random.default_rng(0)
    q, s, came = np.zeros((len(of), chain.STATES, 2)), np.zeros(len(of), dtype=int), np.zeros((50, len(of)), dtype=bool)
    for t, chance in enumerate(np.array(drawn).T):
        s = s * (t % chain.EPISODE > 0)
        at = q[who, s]
        greedy = np.where(random & (at[:, 0] == at[:, 1]), rng.integers(0, 2, len(of)), at.argmax(axis=1))
        a = np.where((chance < 0) | (calm & (s > 0)), greedy, chance)
        came[t // chain.EPISODE] |= s == 4
        decisions = [(who, s, a), *((who[calm], np.full(300, each), 1) for each in range(5) if t < 4)]
        for k, state, action in decisions:
            paid = chain.REWARD[state, action] + (pay[k] - chain.REWARD[0, 0]) * ((state == 0) & (action == 0))
            target = paid + gamma[k] * q[k, chain.NEXT[state, action]].max(axis=1)
            q[k, state, action] += 0.3 * (target - q[k, state, action])
        s = chain.NEXT[s, a]
    return {name: np.array([came.sum(axis=0), q[:, 0, 1] > q[:, 0, 0]])[:, of == name] for name in kinds}


def change(kind: str) -> int:
    """How many of such learners learn to leave."""
    return int(controls()[kind][1].sum())


def came_to_c() -> np.ndarray:
    """On how many walks each of 300 learners of C reaches the free road."""
    return np.array([len(chain.arrivals(as_c()[:, k])) for k in range(300)])
