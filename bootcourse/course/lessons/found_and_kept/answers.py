"""Answers to the exercises of the lesson on finding the way out and keeping it."""

from tests.answers import equivalent, right_lines, wrong_lines

PADDED = "np.pad(np.asarray(success{0}), ((0, 0), (1, 0)))"
equivalent("forgetting", f"{PADDED.format(', dtype=float')}  ->  {PADDED.format('')}", "sums of 0 and 1 are exact")


right_lines("""forgetting
    by sliding windows: means = np.lib.stride_tricks.sliding_window_view(np.asarray(success), window, axis=1).mean(-1)
        ends = np.where(means > 0.5, window + np.arange(means.shape[1]), 0)
        np.stack([np.where(ends > 0, ends, 10**9).min(1) * (ends.max(1) > 0), ends.max(1)], 1)
""")

wrong_lines("""forgetting
    blocks that do not overlap: n = np.asarray(success).shape[1] // window * window
        means = np.asarray(success)[:, :n].reshape(len(success), -1, window).mean(-1)
        ends = np.where(means > 0.5, window * (1 + np.arange(means.shape[1])), 0)
        np.stack([np.where(ends > 0, ends, 10**9).min(1) * (ends.max(1) > 0), ends.max(1)], 1)
""")

right_lines("""reads_as_printed
    in a loop: chance = 1.0
        for success, ahead in zip(rows, printed):
            chance *= sum((s if ahead else 1 - s) ** episodes for s in success) / len(success)
        chance
    by the binomial distribution: each = [stats.binom.pmf(episodes * ahead, episodes, success).mean()
            for success, ahead in zip(rows, printed)]
        np.prod(each)
""")

wrong_lines("""reads_as_printed
    of each row: [np.mean((s if ahead else 1 - s) ** episodes) for s, ahead in zip(rows, printed)]
    one of the rows: sum(np.mean((s if ahead else 1 - s) ** episodes) for s, ahead in zip(rows, printed))
""")

PAIRS = "zip(rows, printed, strict=True)"
for _change in (
    f"for success, all_ahead in {PAIRS}:  ->  for success, all_ahead in zip(rows, printed):",
    f"{PAIRS}  ->  zip(rows, printed, strict=False)",
):
    equivalent("reads_as_printed", _change, "both have as many rows")

wrong_lines("""forgetting
    more than 51 in 100: windows = np.lib.stride_tricks.sliding_window_view(success, window, axis=1)
        each = windows.mean(-1) > 0.515
        [np.flatnonzero(row)[[0, -1]] + window if row.any() else (0, 0) for row in each]
    one too early: first, last = solution(success, window).T; np.stack([first, np.maximum(last - 1, first)], 1)
""")
