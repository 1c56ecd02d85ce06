"""Exercises of the lesson on exploration."""

import numpy as np

from bootcourse.course.exercise import exercise


def some_policies(rng, rows: int) -> np.ndarray:
    """Policies from undecided to sure, (rows, 9)."""
    logits = rng.normal(0, 1, (rows, 9)) * rng.uniform(0, 4, (rows, 1))
    policy = np.exp(logits - logits.max(axis=-1, keepdims=True))
    return policy / policy.sum(axis=-1, keepdims=True)


SURE = np.eye(9)[[4, 0]]  # two states, one action each
EVEN = np.full((3, 9), 1 / 9)
HALVES = np.array([[0.5, 0.5, 0, 0, 0, 0, 0, 0, 0], [0.25, 0.25, 0.25, 0.25, 0, 0, 0, 0, 0]])


def policy_cases(rng):
    """Sure, even, halves, a drive of one decision, sure and not; then 40 at random."""
    yield from ((policy,) for policy in (SURE, EVEN, HALVES, HALVES[:1], np.concatenate([SURE, HALVES])))
    yield from ((some_policies(rng, rng.integers(1, 12)),) for _ in range(40))


@exercise(
    "exp(H(π(·|s))), the entropy figure of Section V", minutes=6, difficulty=1, cases=policy_cases,
    worked=[((EVEN[:1],), np.array([9.0])), ((HALVES,), np.array([2.0, 4.0]))],
    hints=(
        "Entropy first: minus the sum over the actions of π log π. Then e to the power of it.",
        "0 · log 0 counts as 0: where π is 0, take the logarithm of 1 instead.",
    ),
    mistakes={
        "np.exp ->":
            "This is the entropy, in nats. The effective number of actions is e to the power of it.",
        "np.log -> np.log2":
            "You mix two units: an entropy in bits (log2) goes with a power of 2, one in nats with a power of e.",
        "-np.sum -> np.sum":
            "Your number is below 1: the sign is wrong. Entropy is *minus* the sum of π log π.",
        "return np.sum(policy > 0, axis=-1).astype(float)":
            "You count all actions with a probability above 0. One of probability 0.001 should hardly count.",
        "return 1 / np.sum(policy**2, axis=-1)":
            "This is another effective number, 1 / Σ π². Ours comes from the entropy: e to the power of H.",
        "np.sum -> np.mean":
            "You took the mean over the nine actions. Entropy is a sum: π is the weight already.",
    },
)  # fmt: skip
def effective_actions(policy):
    safe = np.where(policy > 0, policy, 1.0)
    return np.exp(-np.sum(policy * np.log(safe), axis=-1))


def place_cases(rng):
    """On an edge, outside on both sides, an empty bin; then 40 at random."""
    edges = np.array([-20.0, -10.0, 0.0, 30.0])
    yield np.array([-10.0, -20.0, 0.0]), np.array([1.0, 2.0, 1.0]), edges
    yield np.array([-50.0, 5.0, 90.0]), np.array([3.0, 1.0, 4.0]), edges
    yield np.array([-15.0, 12.0]), np.array([0.5, 1.5]), edges
    for _ in range(40):
        n = rng.integers(3, 60)
        yield rng.normal(0, 25, n), rng.uniform(0, 2.2, n), np.sort(rng.uniform(-50, 50, rng.integers(3, 8)))


@exercise(
    "Σ_{t in bin} H_t / Σ_t H_t", minutes=8, difficulty=2, cases=place_cases,
    worked=[
        ((np.array([1.0, 2.0, 12.0]), np.array([1.0, 1.0, 2.0]), np.array([0.0, 10.0, 20.0])), np.array([0.5, 0.5])),
        ((np.array([5.0, 99.0]), np.array([1.0, 3.0]), np.array([0.0, 10.0, 20.0])), np.array([0.25, 0.0])),
    ],
    hints=(
        "`np.digitize(place, edges)` says in which bin each decision lies; 0 and len(edges) are outside.",
        "`np.bincount(..., weights=entropy[...], minlength=len(edges) - 1)` adds up what lies in each bin. Divide by "
        "the sum over all decisions.",
    ),
    mistakes={
        "return np.bincount(column[inside], minlength=len(edges) - 1) / len(place)":
            "This is where the agent *was*: every decision counts the same. Weigh each with its entropy.",
        "return spent / max(spent.sum(), 1e-12)":
            "You divide by the entropy inside the edges. Divide by the entropy of all decisions, also those outside.",
        "return spent / np.maximum(np.bincount(column[inside], minlength=len(edges) - 1), 1)":
            "This is the mean entropy in each bin. The share also depends on how long the agent was there.",
        "return spent":
            "These are sums of entropy, in nats. Divide by the entropy of all decisions together.",
        "place -> np.clip(place, edges[0], edges[-1] - 1e-9)":
            "You put decisions outside the edges into the first or last bin. Leave them out of every bin.",
    },
)  # fmt: skip
def where_explored(place, entropy, edges):
    column = np.digitize(place, edges) - 1
    inside = (column >= 0) & (column < len(edges) - 1)
    spent = np.bincount(column[inside], weights=entropy[inside], minlength=len(edges) - 1)
    return spent / entropy.sum()


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


@exercise(
    "cells visited at least once / all cells", minutes=7, difficulty=2, cases=cell_cases,
    worked=[
        ((np.array([1.0, 2.0, 11.0]), np.array([0, 0, 1]), np.array([0.0, 10.0, 20.0]), 2), 0.5),
        ((np.array([1.0, 2.0]), np.array([0, 1]), np.array([0.0, 10.0, 20.0]), 2), 0.5),
    ],
    hints=(
        "Give every cell a number: stretch · lanes + lane.",
        "`np.unique` of the numbers of the cells that were visited; those outside the edges are left out first.",
    ),
    mistakes={
        "return len(np.unique(column[inside])) / (len(edges) - 1)":
            "You count stretches of road without their lanes: each lane of a stretch is a cell of its own.",
        "return np.mean(inside)":
            "This is the share of the *decisions* that lie inside. Count each visited cell once.",
        "return len(cells) / (len(edges) * lanes)":
            "You divide by the number of edges. Between n edges there are n - 1 stretches.",
        "place -> np.clip(place, edges[0], edges[-1] - 1e-9)":
            "You count decisions outside the edges in the first or last stretch. Leave them out.",
        "return len(np.unique(column[inside])) * len(np.unique(lane[inside])) / ((len(edges) - 1) * lanes)":
            "You multiply the share of stretches by the share of lanes. Count the pairs of a stretch and a lane that "
            "were visited.",
    },
)  # fmt: skip
def coverage(place, lane, edges, lanes):
    column = np.digitize(place, edges) - 1
    inside = (column >= 0) & (column < len(edges) - 1)
    cells = np.unique(column[inside] * lanes + lane[inside])
    return len(cells) / ((len(edges) - 1) * lanes)


@exercise(
    "1 - Π_t max_a π(a|s_t)", minutes=5, difficulty=2, cases=policy_cases,
    worked=[((HALVES[:1],), 0.5), ((HALVES,), 0.875), ((SURE,), 0.0)],  # 1 - 1/2; 1 - 1/2 · 1/4
    hints=(
        "In one decision, the likeliest action is drawn with probability max π.",
        "The agent tries nothing else if that happens in every decision: a product over the decisions.",
    ),
    mistakes={
        "1 - np.prod -> np.prod":
            "This is the chance that the agent *never* tries anything else. Return one minus this.",
        "np.prod -> np.mean":
            "This is the chance in one decision, on average. One try in the whole drive is enough.",
        "return np.sum(1 - policy.max(axis=-1))":
            "This is the expected *number* of tries, which can be above 1. The chances of several decisions cannot be "
            "added.",
        "return np.prod(1 - policy.max(axis=-1))":
            "This is the chance that the agent tries something else in *every* decision. Once is enough.",
        "np.prod -> np.min":
            "You use only the decision with the smallest max π. The agent can try something else in the others, too.",
    },
)  # fmt: skip
def ever_tries(policy):
    return 1 - np.prod(policy.max(axis=-1))


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


@exercise(
    "means over a sliding window: their maximum, the last, and the end of the last good one",
    minutes=15, difficulty=3, cases=training_curves,
    worked=[
        # the means of two in a row: 0, 1/2, 1, 1, 1/2, 0; the last of at least 1/2 ends with episode 6
        ((np.array([[0, 0, 1, 1, 1, 0, 0]]), 2), np.array([[1.0, 0.0, 6.0]])),
        ((np.array([[0, 0, 0, 0], [1, 0, 1, 1]]), 4), np.array([[0.0, 0.0, 0.0], [0.75, 0.75, 4.0]])),
    ],
    hints=(
        "First the mean of every `window` episodes in a row, for each agent: `sums = np.cumsum(...)` with a 0 in "
        "front, then the difference of sums `window` apart, divided by `window`.",
        "The last window of at least one half: look for the first one in the reversed row, `[:, ::-1].argmax(axis=1)`.",
    ),
    mistakes={
        "- 1 - from_the_end -> - 2 - from_the_end":
            "Your third number is one too small: episodes are counted from 1, so a window that ends with the first "
            "`window` episodes ends with episode `window`.",
        "window + means.shape[1] - 1 -> means.shape[1]":
            "Your third number says where the last good window *begins*. Say with which episode it ends.",
        "means.max(axis=1) -> np.mean(success, axis=1)":
            "Your first number is the mean over the whole training. The best window says whether the agent ever could.",
        "means.max(axis=1), means[:, -1] -> means[:, -1], means.max(axis=1)":
            "Your first two numbers are swapped: the best window first, then the last one.",
    },
)  # fmt: skip
def forgetting(success, window):
    sums = np.cumsum(np.pad(np.asarray(success, dtype=float), ((0, 0), (1, 0))), axis=1)
    means = (sums[:, window:] - sums[:, :-window]) / window
    often = means >= 0.5
    from_the_end = often[:, ::-1].argmax(axis=1)
    last = np.where(often.any(axis=1), window + means.shape[1] - 1 - from_the_end, 0)
    return np.stack([means.max(axis=1), means[:, -1], last], axis=1)
