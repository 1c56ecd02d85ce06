"""Exercises of the lesson on exploration."""

import numpy as np

from bootcourse.course.exercise import Exercise, Mistake


def some_policies(rng, rows: int) -> np.ndarray:
    """Policies from undecided to sure, (rows, 9)."""
    logits = rng.normal(0, 1, (rows, 9)) * rng.uniform(0, 4, (rows, 1))
    policy = np.exp(logits - logits.max(axis=-1, keepdims=True))
    return policy / policy.sum(axis=-1, keepdims=True)


SURE = np.eye(9)[[4, 0]]  # two states, one action each
EVEN = np.full((3, 9), 1 / 9)
HALVES = np.array([[0.5, 0.5, 0, 0, 0, 0, 0, 0, 0], [0.25, 0.25, 0.25, 0.25, 0, 0, 0, 0, 0]])


def effective_actions_solution(policy):
    safe = np.where(policy > 0, policy, 1.0)
    return np.exp(-np.sum(policy * np.log(safe), axis=-1))


effective_actions = Exercise(
    "effective_actions(policy)", solution=effective_actions_solution,
    # sure, even, halves; then 40 at random
    cases=lambda rng: [(SURE,), (EVEN,), (HALVES,), *((some_policies(rng, rng.integers(1, 8)),) for _ in range(40))],
    worked=(((EVEN[:1],), np.array([9.0])), ((HALVES,), np.array([2.0, 4.0]))),
    mistakes=(
        Mistake(lambda policy: np.log(effective_actions_solution(policy)),
            "This is the entropy, in nats. The effective number of actions is e to the power of it.",
            "The entropy is the number of actions."),
        Mistake(lambda policy: np.exp(np.log(effective_actions_solution(policy)) / np.log(2)),
            "You mix two units: an entropy in bits (log2) goes with a power of 2, one in nats with a power of e.",
            "The base of the logarithm does not matter."),
        Mistake(lambda policy: 1 / effective_actions_solution(policy),
            "Your number is below 1: the sign is wrong. Entropy is *minus* the sum of π log π.",
            "log π is positive."),
        Mistake(lambda policy: np.sum(policy > 0, axis=-1).astype(float),
            "You count all actions with a probability above 0. One of probability 0.001 should hardly count.",
            "An action either counts or it does not."),
        Mistake(lambda policy: 1 / np.sum(policy**2, axis=-1),
            "This is another effective number, 1 / Σ π². Ours comes from the entropy: e to the power of H.",
            "There is only one effective number of actions."),
        Mistake(lambda policy: np.exp(np.log(effective_actions_solution(policy)) / 9),
            "You took the mean over the nine actions. Entropy is a sum: π is the weight already.",
            "An average over actions needs a division by nine."),
    ),
    hints=(
        "Entropy first: minus the sum over the actions of π log π. Then e to the power of it.",
        "0 · log 0 counts as 0: where π is 0, take the logarithm of 1 instead.",
        "`np.exp(-np.sum(policy * np.log(np.where(policy > 0, policy, 1.0)), axis=-1))`",
    ),
    minutes=6, difficulty=1, equation="exp(H(π(·|s))), the entropy figure of Section V",
)  # fmt: skip


def where_explored_solution(place, entropy, edges):
    column = np.digitize(place, edges) - 1
    inside = (column >= 0) & (column < len(edges) - 1)
    spent = np.bincount(column[inside], weights=entropy[inside], minlength=len(edges) - 1)
    return spent / entropy.sum()


def counted(place, entropy, edges):
    return where_explored_solution(place, np.ones_like(entropy), edges)


def of_the_inside(place, entropy, edges):
    spent = where_explored_solution(place, entropy, edges)
    return spent / max(spent.sum(), 1e-12)


def mean_of_each(place, entropy, edges):
    count = counted(place, entropy, edges) * len(entropy)
    return where_explored_solution(place, entropy, edges) * entropy.sum() / np.maximum(count, 1)


def place_cases(rng):
    """On an edge, outside on both sides, an empty bin; then 40 at random."""
    edges = np.array([-20.0, -10.0, 0.0, 30.0])
    yield np.array([-10.0, -20.0, 0.0]), np.array([1.0, 2.0, 1.0]), edges
    yield np.array([-50.0, 5.0, 90.0]), np.array([3.0, 1.0, 4.0]), edges
    yield np.array([-15.0, 12.0]), np.array([0.5, 1.5]), edges
    for _ in range(40):
        n = rng.integers(3, 60)
        yield rng.normal(0, 25, n), rng.uniform(0, 2.2, n), np.sort(rng.uniform(-50, 50, rng.integers(3, 8)))


where_explored = Exercise(
    "where_explored(place, entropy, edges)", solution=where_explored_solution, cases=place_cases,
    worked=(
        ((np.array([1.0, 2.0, 12.0]), np.array([1.0, 1.0, 2.0]), np.array([0.0, 10.0, 20.0])), np.array([0.5, 0.5])),
        ((np.array([5.0, 99.0]), np.array([1.0, 3.0]), np.array([0.0, 10.0, 20.0])), np.array([0.25, 0.0])),
    ),
    mistakes=(
        Mistake(counted,
            "This is where the agent *was*: every decision counts the same. Weigh each with its entropy.",
            "An agent explores wherever it is."),
        Mistake(of_the_inside,
            "You divide by the entropy inside the edges. Divide by the entropy of all decisions, also those outside.",
            "Shares have to add up to 1."),
        Mistake(mean_of_each,
            "This is the mean entropy in each bin. The share also depends on how long the agent was there.",
            "A bin's value is the mean of what is in it."),
        Mistake(lambda place, entropy, edges: where_explored_solution(place, entropy, edges) * entropy.sum(),
            "These are sums of entropy, in nats. Divide by the entropy of all decisions together.",
            "A weighted count is a share already."),
        Mistake(lambda place, entropy, edges:
            where_explored_solution(np.clip(place, edges[0], edges[-1] - 1e-9), entropy, edges),
            "You put decisions outside the edges into the first or last bin. Leave them out of every bin.",
            "The outermost bins are open."),
    ),
    hints=(
        "`np.digitize(place, edges)` says in which bin each decision lies; 0 and len(edges) are outside.",
        "`np.bincount(..., weights=entropy[...], minlength=len(edges) - 1)` adds up what lies in each bin.",
        "Divide by `entropy.sum()`, the sum over all decisions. (`np.histogram` has weights as well.)",
    ),
    minutes=8, difficulty=2, equation="Σ_{t in bin} H_t / Σ_t H_t",
)  # fmt: skip


def coverage_solution(place, lane, edges, lanes):
    column = np.digitize(place, edges) - 1
    inside = (column >= 0) & (column < len(edges) - 1)
    cells = np.unique(column[inside] * lanes + lane[inside])
    return len(cells) / ((len(edges) - 1) * lanes)


def columns_only(place, lane, edges, lanes):
    return coverage_solution(place, np.zeros_like(lane), edges, 1)


def margins(place, lane, edges, lanes):
    inside = (place >= edges[0]) & (place < edges[-1])
    return columns_only(place, lane, edges, lanes) * len(np.unique(lane[inside])) / lanes


def cell_cases(rng):
    """One cell again and again, all outside, a diagonal, on two edges; then 40 at random."""
    edges = np.array([0.0, 10.0, 20.0, 30.0])
    yield np.array([1.0, 2.0, 3.0]), np.array([2, 2, 2]), edges, 3
    yield np.array([-5.0, 45.0]), np.array([0, 1]), edges, 3
    yield np.array([5.0, 15.0, 25.0]), np.array([0, 1, 2]), edges, 3
    yield np.array([0.0, 10.0]), np.array([2, 0]), edges, 3
    for _ in range(40):
        n = rng.integers(1, 40)
        edges = np.arange(-30.0, 31.0, rng.integers(5, 15))
        yield rng.normal(0, 20, n), rng.integers(0, 3, n), edges, 3


coverage = Exercise(
    "coverage(place, lane, edges, lanes)", solution=coverage_solution, cases=cell_cases,
    worked=(
        ((np.array([1.0, 2.0, 11.0]), np.array([0, 0, 1]), np.array([0.0, 10.0, 20.0]), 2), 0.5),
        ((np.array([1.0, 2.0]), np.array([0, 1]), np.array([0.0, 10.0, 20.0]), 2), 0.5),
    ),
    mistakes=(
        Mistake(columns_only,
            "You count stretches of road without their lanes: each lane of a stretch is a cell of its own.",
            "A place is a position along the road."),
        Mistake(lambda place, lane, edges, lanes: float(np.mean((place >= edges[0]) & (place < edges[-1]))),
            "This is the share of the *decisions* that lie inside. Count each visited cell once.",
            "More time inside means more coverage."),
        Mistake(lambda place, lane, edges, lanes:
            coverage_solution(place, lane, edges, lanes) * (len(edges) - 1) / len(edges),
            "You divide by the number of edges. Between n edges there are n - 1 stretches.",
            "There are as many bins as edges."),
        Mistake(lambda place, lane, edges, lanes:
            coverage_solution(np.clip(place, edges[0], edges[-1] - 1e-9), lane, edges, lanes),
            "You count decisions outside the edges in the first or last stretch. Leave them out.",
            "The outermost bins are open."),
        Mistake(margins,
            "You multiply the share of stretches by the share of lanes. Count the pairs of a stretch and a lane that "
            "were visited.",
            "Being in each lane once and in each stretch once covers the road."),
    ),
    hints=(
        "Give every cell a number: stretch · lanes + lane.",
        "`np.unique` of the numbers of the cells that were visited; those outside the edges are left out first.",
        "`len(np.unique(column[inside] * lanes + lane[inside])) / ((len(edges) - 1) * lanes)`",
    ),
    minutes=7, difficulty=2, equation="cells visited at least once / all cells",
)  # fmt: skip


def ever_tries_solution(policy):
    return 1 - np.prod(policy.max(axis=-1))


ever_tries = Exercise(
    "ever_tries(policy)", solution=ever_tries_solution,
    # a drive of one decision, a sure one, an even one; then 40 at random
    cases=lambda rng: [(HALVES[:1],), (SURE,), (EVEN,), (np.concatenate([SURE, HALVES]),),
                       *((some_policies(rng, rng.integers(2, 12)),) for _ in range(40))],
    worked=(((HALVES[:1],), 0.5), ((HALVES,), 0.875), ((SURE,), 0.0)),  # 1 - 1/2; 1 - 1/2 · 1/4
    mistakes=(
        Mistake(lambda policy: np.prod(policy.max(axis=-1)),
            "This is the chance that the agent *never* tries anything else. Return one minus this.",
            "The product of the chances is the chance of at least one."),
        Mistake(lambda policy: 1 - np.mean(policy.max(axis=-1)),
            "This is the chance in one decision, on average. One try in the whole drive is enough.",
            "The chance in a drive equals the chance in one decision."),
        Mistake(lambda policy: np.sum(1 - policy.max(axis=-1)),
            "This is the expected *number* of tries, which can be above 1. The chances of several decisions cannot be "
            "added.",
            "Chances are added."),
        Mistake(lambda policy: np.prod(1 - policy.max(axis=-1)),
            "This is the chance that the agent tries something else in *every* decision. Once is enough.",
            "Independent events are multiplied."),
        Mistake(lambda policy: 1 - np.min(policy.max(axis=-1)),
            "You use only the decision with the smallest max π. The agent can try something else in the others, too.",
            "Only the best opportunity counts."),
    ),
    hints=(
        "In one decision, the likeliest action is drawn with probability max π.",
        "The agent tries nothing else if that happens in every decision: a product over the decisions.",
        "`1 - np.prod(policy.max(axis=-1))`",
    ),
    minutes=5, difficulty=2, equation="1 - Π_t max_a π(a|s_t)",
)  # fmt: skip


def forgetting_solution(success, window):
    sums = np.cumsum(np.pad(np.asarray(success, dtype=float), ((0, 0), (1, 0))), axis=1)
    means = (sums[:, window:] - sums[:, :-window]) / window
    often = means >= 0.5
    from_the_end = often[:, ::-1].argmax(axis=1)
    last = np.where(often.any(axis=1), window + means.shape[1] - 1 - from_the_end, 0)
    return np.stack([means.max(axis=1), means[:, -1], last], axis=1)


def training_curves(rng):
    """Never, always, found and kept, found and lost, a window as long as the training; then 30 at random."""
    yield np.zeros((2, 6)), 3
    yield np.ones((1, 5)), 2
    yield np.array([[0, 0, 1, 1, 1, 1], [0, 1, 1, 1, 0, 0]]), 2
    yield np.array([[1, 1, 0, 0, 0, 1, 0, 0]]), 2
    yield np.array([[0, 1, 1, 0]]), 4
    for _ in range(30):
        agents, episodes = rng.integers(1, 4), rng.integers(6, 20)
        yield (rng.random((agents, episodes)) < rng.random((agents, 1))).astype(int), rng.integers(2, 6)


def with_last(change):
    """The solution with its third column changed."""

    def answer(success, window):
        found = forgetting_solution(success, window)
        found[:, 2] = change(found[:, 2], np.asarray(success), window)
        return found

    return answer


forgetting = Exercise(
    "forgetting(success, window)", solution=forgetting_solution, cases=training_curves,
    worked=(
        # the means of two in a row: 0, 1/2, 1, 1, 1/2, 0; the last of at least 1/2 ends with episode 6
        ((np.array([[0, 0, 1, 1, 1, 0, 0]]), 2), np.array([[1.0, 0.0, 6.0]])),
        ((np.array([[0, 0, 0, 0], [1, 0, 1, 1]]), 4), np.array([[0.0, 0.0, 0.0], [0.75, 0.75, 4.0]])),
    ),
    mistakes=(
        Mistake(with_last(lambda last, success, window: np.where(last > 0, last - 1, 0)),
            "Your third number is one too small: episodes are counted from 1, so a window that ends with the first "
            "`window` episodes ends with episode `window`.",
            "Episodes are counted from 0, as in Python."),
        Mistake(with_last(lambda last, success, window: np.where(last > 0, last - window + 1, 0)),
            "Your third number says where the last good window *begins*. Say with which episode it ends.",
            "A window is where it begins."),
        Mistake(lambda success, window:
                np.stack([np.asarray(success).mean(1), *forgetting_solution(success, window).T[1:]], 1),
            "Your first number is the mean over the whole training. The best window says whether the agent ever could.",
            "How well an agent learned is its mean."),
        Mistake(lambda success, window: forgetting_solution(success, window)[:, [1, 0, 2]],
            "Your first two numbers are swapped: the best window first, then the last one.",
            "The order of the columns does not matter."),
    ),
    hints=(
        "First the mean of every `window` episodes in a row, for each agent. A cumulative sum gives all of them.",
        "`sums = np.cumsum(...)` with a 0 in front: the difference of sums `window` apart, divided by `window`.",
        "The last window of at least one half: look for the first one in the reversed row, `[:, ::-1].argmax(axis=1)`.",
    ),
    minutes=15, difficulty=3,
    equation="means over a sliding window: their maximum, the last, and the end of the last good one",
)  # fmt: skip
