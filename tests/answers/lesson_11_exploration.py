"""Answers to the exercises of the lesson on exploration."""

import numpy as np
from scipy import stats

from tests.answers import right, wrong

# effective_actions ----------------------------------------------------------------------------------


@right("effective_actions")
def with_scipy(policy):
    return np.exp(stats.entropy(policy, axis=-1))


@right("effective_actions")
def as_a_product(policy):
    return np.array([np.prod([p**-p for p in row if p > 0]) for row in policy])


@right("effective_actions")
def in_bits_to_the_end(policy):
    return 2 ** stats.entropy(policy, axis=-1, base=2)


@wrong("effective_actions", "This is the entropy")
def entropy_itself(policy):
    return stats.entropy(policy, axis=-1)


@wrong("effective_actions", "two units")
def bits_and_e(policy):
    return np.exp(stats.entropy(policy, axis=-1, base=2))


@wrong("effective_actions", "sign is wrong")
def without_minus(policy):
    return np.exp(-stats.entropy(policy, axis=-1))


@wrong("effective_actions", "possible at all")
def possible(policy):
    return np.count_nonzero(policy, axis=-1)


@wrong("effective_actions", "another effective number")
def simpson(policy):
    return 1 / (policy**2).sum(-1)


@wrong("effective_actions", "NaN")
def zero_times_minus_infinity(policy):
    with np.errstate(all="ignore"):
        return np.exp(-(policy * np.log(policy)).sum(-1))


@wrong("effective_actions")
def inverse_of_the_largest(policy):
    return 1 / policy.max(axis=-1)


# where_explored -------------------------------------------------------------------------------------


@right("where_explored")
def with_histogram(place, entropy, edges):
    return np.histogram(place, bins=edges, weights=entropy)[0] / np.sum(entropy)


@right("where_explored")
def bin_by_bin(place, entropy, edges):
    pairs = zip(edges[:-1], edges[1:], strict=True)
    return np.array([entropy[(place >= low) & (place < high)].sum() for low, high in pairs]) / entropy.sum()


@wrong("where_explored", "where the agent *was*")
def unweighted(place, entropy, edges):
    return np.histogram(place, bins=edges)[0] / len(place)


@wrong("where_explored", "inside the edges")
def inside_only(place, entropy, edges):
    spent = np.histogram(place, bins=edges, weights=entropy)[0]
    return spent / max(spent.sum(), 1e-12)


@wrong("where_explored", "mean entropy")
def means(place, entropy, edges):
    pairs = zip(edges[:-1], edges[1:], strict=True)
    found = [entropy[(place >= low) & (place < high)] for low, high in pairs]
    return np.array([part.mean() if len(part) else 0.0 for part in found])


@wrong("where_explored", "sums of entropy")
def sums(place, entropy, edges):
    return np.histogram(place, bins=edges, weights=entropy)[0]


@wrong("where_explored", "first or last bin")
def open_ends(place, entropy, edges):
    column = np.clip(np.digitize(place, edges) - 1, 0, len(edges) - 2)
    return np.bincount(column, weights=entropy, minlength=len(edges) - 1) / entropy.sum()


@wrong("where_explored")
def open_on_the_left(place, entropy, edges):
    pairs = zip(edges[:-1], edges[1:], strict=True)
    return np.array([entropy[(place > low) & (place <= high)].sum() for low, high in pairs]) / entropy.sum()


# coverage -------------------------------------------------------------------------------------------


@right("coverage")
def as_a_set(place, lane, edges, lanes):
    columns = np.searchsorted(edges, place, side="right") - 1
    seen = {(c, k) for c, k in zip(columns, lane, strict=True) if 0 <= c < len(edges) - 1}
    return len(seen) / (lanes * (len(edges) - 1))


@right("coverage")
def as_a_map(place, lane, edges, lanes):
    found, _, _ = np.histogram2d(place, lane, bins=[edges, np.arange(lanes + 1) - 0.5])
    return np.mean(found > 0)


@wrong("coverage", "forget the lanes")
def stretches(place, lane, edges, lanes):
    return np.mean(np.histogram(place, bins=edges)[0] > 0)


@wrong("coverage", "*decisions*")
def time_inside(place, lane, edges, lanes):
    return np.mean((place >= edges[0]) & (place < edges[-1]))


@wrong("coverage", "number of edges")
def one_too_many(place, lane, edges, lanes):
    return as_a_set(place, lane, edges, lanes) * (len(edges) - 1) / len(edges)


@wrong("coverage", "outside the edges")
def ends_open(place, lane, edges, lanes):
    columns = np.clip(np.searchsorted(edges, place, side="right") - 1, 0, len(edges) - 2)
    return len({*zip(columns, lane, strict=True)}) / (lanes * (len(edges) - 1))


@wrong("coverage", "every pair")
def both_margins(place, lane, edges, lanes):
    inside = (place >= edges[0]) & (place < edges[-1])
    return stretches(place, lane, edges, lanes) * len(set(lane[inside])) / lanes


@wrong("coverage")
def number_of_cells(place, lane, edges, lanes):
    return as_a_set(place, lane, edges, lanes) * lanes * (len(edges) - 1)


# ever_tries -----------------------------------------------------------------------------------------


@right("ever_tries")
def step_by_step(policy):
    never = 1.0
    for row in policy:
        never *= max(row)
    return 1 - never


@right("ever_tries")
def with_logarithms(policy):
    return -np.expm1(np.log(policy.max(axis=1)).sum())


@wrong("ever_tries", "*never*")
def never_tries(policy):
    return np.prod(np.max(policy, axis=1))


@wrong("ever_tries", "in one decision")
def on_average(policy):
    return np.mean(1 - policy.max(axis=1))


@wrong("ever_tries", "*number*")
def expected(policy):
    return (1 - policy.max(axis=1)).sum()


@wrong("ever_tries", "*every* decision")
def all_the_time(policy):
    return np.prod(1 - policy.max(axis=1))


@wrong("ever_tries", "least decided")
def best_chance(policy):
    return (1 - policy.max(axis=1)).max()


@wrong("ever_tries")
def over_everything(policy):
    return 1 - policy.max() ** len(policy)
