"""Answers to the exercises of the lesson on exploration."""

import numpy as np
from scipy import stats

from tests.answers import equivalent, right, wrong

# effective_actions ----------------------------------------------------------------------------------


for _value in (1.01, 1.1):
    _change = f"np.where(policy > 0, policy, 1.0)  ->  np.where(policy > 0, policy, {_value})"
    equivalent("effective_actions", _change, "its logarithm is multiplied by a policy of 0")


@right("effective_actions")
def with_scipy(policy):
    return np.exp(stats.entropy(policy, axis=-1))


@right("effective_actions")
def as_a_product(policy):
    return np.array([np.prod([p**-p for p in row if p > 0]) for row in policy])


@right("effective_actions")
def in_bits_to_the_end(policy):
    return 2 ** stats.entropy(policy, axis=-1, base=2)


@wrong("effective_actions", "NaN")
def zero_times_minus_infinity(policy):
    with np.errstate(all="ignore"):
        return np.exp(-(policy * np.log(policy)).sum(-1))


@wrong("effective_actions")
def inverse_of_the_largest(policy):
    return 1 / policy.max(axis=-1)


@wrong("effective_actions")
def away_from_zero(policy):
    return np.exp(-(policy * np.log(policy + 1e-3)).sum(-1))


@wrong("effective_actions", "a number")
def of_the_whole_drive(policy):
    return np.exp(stats.entropy(policy.mean(axis=0)))


# where_explored -------------------------------------------------------------------------------------


@right("where_explored")
def with_histogram(place, entropy, edges):
    return np.histogram(place, bins=edges, weights=entropy)[0] / np.sum(entropy)


@right("where_explored")
def bin_by_bin(place, entropy, edges):
    pairs = zip(edges[:-1], edges[1:], strict=True)
    return np.array([entropy[(place >= low) & (place < high)].sum() for low, high in pairs]) / entropy.sum()


@wrong("where_explored", "mean entropy")
def means(place, entropy, edges):
    pairs = zip(edges[:-1], edges[1:], strict=True)
    found = [entropy[(place >= low) & (place < high)] for low, high in pairs]
    return np.array([part.mean() if len(part) else 0.0 for part in found])


@wrong("where_explored")
def open_on_the_left(place, entropy, edges):
    pairs = zip(edges[:-1], edges[1:], strict=True)
    return np.array([entropy[(place > low) & (place <= high)].sum() for low, high in pairs]) / entropy.sum()


@right("where_explored")
def one_by_one(place, entropy, edges):
    spent = [0.0] * (len(edges) - 1)
    for x, h in zip(place, entropy, strict=True):
        for k in range(len(spent)):
            spent[k] += h * bool(edges[k] <= x < edges[k + 1])
    return [part / sum(entropy) for part in spent]


@wrong("where_explored", "shape")
def a_bin_for_each_edge(place, entropy, edges):
    return np.bincount(np.digitize(place, edges), weights=entropy, minlength=len(edges))[: len(edges)] / entropy.sum()


@wrong("where_explored")
def in_bins_of_equal_width(place, entropy, edges):
    return np.histogram(place, len(edges) - 1, (edges[0], edges[-1]), weights=entropy)[0] / entropy.sum()


@wrong("where_explored")
def added_up(place, entropy, edges):
    return np.cumsum(with_histogram(place, entropy, edges))


# coverage -------------------------------------------------------------------------------------------


NUMBERS = "np.unique(column[inside] * lanes {0} lane[inside])"
equivalent("coverage", f"{NUMBERS.format('+')}  ->  {NUMBERS.format('-')}", "each cell still has a number of its own")


@right("coverage")
def as_a_set(place, lane, edges, lanes):
    columns = np.searchsorted(edges, place, side="right") - 1
    seen = {(c, k) for c, k in zip(columns, lane, strict=True) if 0 <= c < len(edges) - 1}
    return len(seen) / (lanes * (len(edges) - 1))


@right("coverage")
def as_a_map(place, lane, edges, lanes):
    found, _, _ = np.histogram2d(place, lane, bins=[edges, np.arange(lanes + 1) - 0.5])
    return np.mean(found > 0)


@wrong("coverage")
def number_of_cells(place, lane, edges, lanes):
    return as_a_set(place, lane, edges, lanes) * lanes * (len(edges) - 1)


@right("coverage")
def cell_by_cell(place, lane, edges, lanes):
    visited = [
        any(edges[i] <= x < edges[i + 1] and k == j for x, k in zip(place, lane, strict=True))
        for i in range(len(edges) - 1)
        for j in range(lanes)
    ]
    return sum(visited) / len(visited)


@wrong("coverage")
def of_three_lanes(place, lane, edges, lanes):
    return as_a_set(place, lane, edges, 3)


@wrong("coverage")
def open_on_the_left_too(place, lane, edges, lanes):
    columns = np.searchsorted(edges, place, side="left") - 1
    seen = {(c, k) for c, k in zip(columns, lane, strict=True) if 0 <= c < len(edges) - 1}
    return len(seen) / (lanes * (len(edges) - 1))


@wrong("coverage")
def of_the_visited_stretches(place, lane, edges, lanes):
    columns = np.digitize(place, edges) - 1
    inside = (columns >= 0) & (columns < len(edges) - 1)
    stretches = len(set(columns[inside]))
    return as_a_set(place, lane, edges, lanes) * (len(edges) - 1) / max(stretches, 1)


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


@wrong("ever_tries")
def over_everything(policy):
    return 1 - policy.max() ** len(policy)


@right("ever_tries")
def first_at_each_second(policy):
    """Something else for the first time at second t: never before, and then."""
    favourite, so_far, never = policy.max(axis=1), 0.0, 1.0
    for p in favourite.tolist():
        so_far, never = so_far + never * (1 - p), never * p
    return so_far


@wrong("ever_tries")
def the_first_action(policy):
    return 1 - np.prod(policy[:, 0])


@wrong("ever_tries", "a NumPy array")
def of_each_action(policy):
    return 1 - np.prod(policy, axis=0)


@wrong("ever_tries")
def as_if_every_second_were_the_mean(policy):
    return 1 - policy.max(axis=1).mean() ** len(policy)


# forgetting -------------------------------------------------------------------------------------------


PADDED = "np.pad(np.asarray(success{0}), ((0, 0), (1, 0)))"
equivalent("forgetting", f"{PADDED.format(', dtype=float')}  ->  {PADDED.format('')}", "sums of 0 and 1 are exact")


@right("forgetting")
def agent_by_agent(success, window):
    rows = []
    for agent in success:
        means = [np.mean(agent[i : i + window]) for i in range(len(agent) - window + 1)]
        good = [i + window for i, mean in enumerate(means) if mean >= 0.5]
        rows.append([max(means), means[-1], good[-1] if good else 0])
    return np.array(rows, dtype=float)


@right("forgetting")
def by_sliding_windows(success, window):
    means = np.lib.stride_tricks.sliding_window_view(np.asarray(success), window, axis=1).mean(-1)
    ends = window + np.arange(means.shape[1])
    return np.stack([means.max(1), means[:, -1], np.where(means >= 0.5, ends, 0).max(1)], 1)


@wrong("forgetting")
def more_than_half(success, window):
    means = np.lib.stride_tricks.sliding_window_view(np.asarray(success), window, axis=1).mean(-1)
    ends = window + np.arange(means.shape[1])
    return np.stack([means.max(1), means[:, -1], np.where(means > 0.5, ends, 0).max(1)], 1)


@wrong("forgetting")
def blocks_that_do_not_overlap(success, window):
    n = np.asarray(success).shape[1] // window * window
    means = np.asarray(success)[:, :n].reshape(len(success), -1, window).mean(-1)
    ends = window * (1 + np.arange(means.shape[1]))
    return np.stack([means.max(1), means[:, -1], np.where(means >= 0.5, ends, 0).max(1)], 1)


@wrong("forgetting")
def the_first_good_window(success, window):
    means = np.lib.stride_tricks.sliding_window_view(np.asarray(success), window, axis=1).mean(-1)
    good = means >= 0.5
    return np.stack([means.max(1), means[:, -1], np.where(good.any(1), good.argmax(1) + window, 0)], 1)


@wrong("forgetting")
def the_last_episodes_alone(success, window):
    found = by_sliding_windows(success, window)
    found[:, 1] = np.asarray(success)[:, -1]
    return found


@right("forgetting")
def with_convolve(success, window):
    rows = []
    for agent in np.asarray(success, dtype=float):
        means = np.convolve(agent, np.full(window, 1 / window), mode="valid")
        good = np.flatnonzero(means >= 0.5 - 1e-9)
        rows.append((means.max(), means[-1], good.max() + window if good.size else 0))
    return np.array(rows)


@wrong("forgetting", "shape")
def of_the_first_agent(success, window):
    return by_sliding_windows(success, window)[0]


@wrong("forgetting")
def windows_that_grow(success, window):
    found = by_sliding_windows(success, window)
    found[:, 0] = (np.cumsum(success, axis=1) / np.arange(1, np.asarray(success).shape[1] + 1)).max(axis=1)
    return found
