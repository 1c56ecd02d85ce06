"""Answers to the exercises of the lesson on exploration."""

import numpy as np

from tests.answers import equivalent, right_lines, wrong, wrong_lines

for _value in (1.01, 1.1):
    _change = f"np.where(policy > 0, policy, 1.0)  ->  np.where(policy > 0, policy, {_value})"
    equivalent("effective_actions", _change, "its logarithm is multiplied by a policy of 0")


right_lines("""effective_actions
    with scipy: np.exp(stats.entropy(policy, axis=-1))
    as a product: np.array([np.prod([p**-p for p in row if p > 0]) for row in policy])
    in bits to the end: 2 ** stats.entropy(policy, axis=-1, base=2)
""")


@wrong("effective_actions", "NaN")
def zero_times_minus_infinity(policy):
    with np.errstate(all="ignore"):
        return np.exp(-(policy * np.log(policy)).sum(-1))


wrong_lines("""effective_actions
    inverse of the largest: 1 / policy.max(axis=-1)
    away from zero: np.exp(-(policy * np.log(policy + 1e-3)).sum(-1))
    of the whole drive: np.exp(stats.entropy(policy.mean(axis=0)))  # a number
""")

right_lines("""where_explored
    with histogram: np.histogram(place, bins=edges, weights=entropy)[0] / np.sum(entropy)
    bin by bin: pairs = zip(edges[:-1], edges[1:], strict=True)
        np.array([entropy[(place >= low) & (place < high)].sum() for low, high in pairs]) / entropy.sum()
""")


@wrong("where_explored", "mean entropy")
def means(place, entropy, edges):
    pairs = zip(edges[:-1], edges[1:], strict=True)
    found = [entropy[(place >= low) & (place < high)] for low, high in pairs]
    return np.array([part.mean() if len(part) else 0.0 for part in found])


wrong_lines("""where_explored
    open on the left: pairs = zip(edges[:-1], edges[1:], strict=True)
        np.array([entropy[(place > low) & (place <= high)].sum() for low, high in pairs]) / entropy.sum()
    a bin for each edge:
        np.bincount(np.digitize(place, edges), weights=entropy, minlength=len(edges))[: len(edges)] / entropy.sum()
        # shape
    in bins of equal width:
        np.histogram(place, len(edges) - 1, (edges[0], edges[-1]), weights=entropy)[0] / entropy.sum()
    added up: np.cumsum(solution(place, entropy, edges))
""")


NUMBERS = "np.unique(column[inside] * lanes {0} lane[inside])"
equivalent("coverage", f"{NUMBERS.format('+')}  ->  {NUMBERS.format('-')}", "each cell still has a number of its own")


right_lines("""coverage
    as a set: columns = np.searchsorted(edges, place, side="right") - 1
        seen = {(c, k) for c, k in zip(columns, lane, strict=True) if 0 <= c < len(edges) - 1}
        len(seen) / (lanes * (len(edges) - 1))
    as a map: found, _, _ = np.histogram2d(place, lane, bins=[edges, np.arange(lanes + 1) - 0.5]); np.mean(found > 0)
""")

wrong_lines("""coverage
    number of cells: solution(place, lane, edges, lanes) * lanes * (len(edges) - 1)
    of three lanes: solution(place, lane, edges, 3)
    open on the left too: columns = np.searchsorted(edges, place, side="left") - 1
        seen = {(c, k) for c, k in zip(columns, lane, strict=True) if 0 <= c < len(edges) - 1}
        len(seen) / (lanes * (len(edges) - 1))
    of the visited stretches: columns = np.digitize(place, edges) - 1
        inside = (columns >= 0) & (columns < len(edges) - 1)
        stretches = len(set(columns[inside]))
        solution(place, lane, edges, lanes) * (len(edges) - 1) / max(stretches, 1)
""")

right_lines("""ever_tries
    with logarithms: -np.expm1(np.log(policy.max(axis=1)).sum())
    step by step: never = 1.0
        for row in policy:
            never *= max(row)
        1 - never
""")

wrong_lines("""ever_tries
    over everything: 1 - policy.max() ** len(policy)
    the first action: 1 - np.prod(policy[:, 0])
    of each action: 1 - np.prod(policy, axis=0)  # a NumPy array
    as if every second were the mean: 1 - policy.max(axis=1).mean() ** len(policy)
""")


PADDED = "np.pad(np.asarray(success{0}), ((0, 0), (1, 0)))"
equivalent("forgetting", f"{PADDED.format(', dtype=float')}  ->  {PADDED.format('')}", "sums of 0 and 1 are exact")


right_lines("""forgetting
    by sliding windows: means = np.lib.stride_tricks.sliding_window_view(np.asarray(success), window, axis=1).mean(-1)
        ends = window + np.arange(means.shape[1])
        np.stack([means.max(1), means[:, -1], np.where(means >= 0.5, ends, 0).max(1)], 1)
    agent by agent: rows = []
        for agent in success:
            means = [np.mean(agent[i : i + window]) for i in range(len(agent) - window + 1)]
            good = [i + window for i, mean in enumerate(means) if mean >= 0.5]
            rows.append([max(means), means[-1], good[-1] if good else 0])
        np.array(rows, dtype=float)
""")

wrong_lines("""forgetting
    more than half: means = np.lib.stride_tricks.sliding_window_view(np.asarray(success), window, axis=1).mean(-1)
        ends = window + np.arange(means.shape[1])
        np.stack([means.max(1), means[:, -1], np.where(means > 0.5, ends, 0).max(1)], 1)
    blocks that do not overlap: n = np.asarray(success).shape[1] // window * window
        means = np.asarray(success)[:, :n].reshape(len(success), -1, window).mean(-1)
        ends = window * (1 + np.arange(means.shape[1]))
        np.stack([means.max(1), means[:, -1], np.where(means >= 0.5, ends, 0).max(1)], 1)
    the first good window:
        means = np.lib.stride_tricks.sliding_window_view(np.asarray(success), window, axis=1).mean(-1)
        good = means >= 0.5
        np.stack([means.max(1), means[:, -1], np.where(good.any(1), good.argmax(1) + window, 0)], 1)
    the last episodes alone: found = solution(success, window); found[:, 1] = np.asarray(success)[:, -1]; found
    of the first agent: solution(success, window)[0]  # shape
    windows that grow: found = solution(success, window)
        found[:, 0] = (np.cumsum(success, axis=1) / np.arange(1, np.asarray(success).shape[1] + 1)).max(axis=1)
        found
""")
