"""Answers to the exercises of the lesson on finding the way out and keeping it."""

from tests.answers import equivalent, right_lines, wrong_lines

PADDED = "np.pad(np.asarray(success{0}), ((0, 0), (1, 0)))"
equivalent("forgetting", f"{PADDED.format(', dtype=float')}  ->  {PADDED.format('')}", "sums of 0 and 1 are exact")


right_lines("""forgetting
    by sliding windows: means = np.lib.stride_tricks.sliding_window_view(np.asarray(success), window, axis=1).mean(-1)
        ends = np.where(means > 0.5, window + np.arange(means.shape[1]), 0)
        np.stack([np.where(ends > 0, ends, 10**9).min(1) * (ends.max(1) > 0), ends.max(1)], 1)
    agent by agent: rows = []
        for agent in success:
            ends = [i for i in range(window, len(agent) + 1) if sum(agent[i - window : i]) > window / 2]
            rows.append([ends[0], ends[-1]] if ends else [0, 0])
        rows
    by convolution: rows = []
        for agent in np.asarray(success):
            ends = window + np.flatnonzero(np.convolve(agent, np.ones(window), "valid") > window / 2)
            rows.append(ends[[0, -1]] if len(ends) else np.zeros(2, int))
        np.array(rows)
""")

wrong_lines("""forgetting
    at least half: means = np.lib.stride_tricks.sliding_window_view(np.asarray(success), window, axis=1).mean(-1)
        ends = np.where(means >= 0.5, window + np.arange(means.shape[1]), 0)
        np.stack([np.where(ends > 0, ends, 10**9).min(1) * (ends.max(1) > 0), ends.max(1)], 1)
    blocks that do not overlap: n = np.asarray(success).shape[1] // window * window
        means = np.asarray(success)[:, :n].reshape(len(success), -1, window).mean(-1)
        ends = np.where(means > 0.5, window * (1 + np.arange(means.shape[1])), 0)
        np.stack([np.where(ends > 0, ends, 10**9).min(1) * (ends.max(1) > 0), ends.max(1)], 1)
    the first one only: solution(success, window)[:, :1]  # shape
    counted from zero: np.maximum(solution(success, window) - 1, 0)
    single successes: rows = []
        for agent in np.asarray(success):
            ahead = 1 + np.flatnonzero(agent)
            rows.append([ahead[0], ahead[-1]] if len(ahead) else [0, 0])
        rows
    of the first agent: solution(success, window)[0]  # shape
""")

right_lines("""reads_as_printed
    in a loop: chance = 1.0
        for success, ahead in zip(rows, printed):
            chance *= sum((s if ahead else 1 - s) ** episodes for s in success) / len(success)
        chance
    by the binomial distribution: each = [stats.binom.pmf(episodes * ahead, episodes, success).mean()
            for success, ahead in zip(rows, printed)]
        np.prod(each)
    turned round: math.prod(float(np.mean(np.abs(1 - ahead - s) ** episodes)) for s, ahead in zip(rows, printed))
""")

wrong_lines("""reads_as_printed
    the first agent of each: solution([s[:1] for s in rows], printed, episodes)
    twenty always: solution(rows, printed, 20)
    the best agent of each: np.prod([(s if ahead else 1 - s).max() ** episodes for s, ahead in zip(rows, printed)])
    turned: solution(rows, [1 - ahead for ahead in printed], episodes)
    of each row: [np.mean((s if ahead else 1 - s) ** episodes) for s, ahead in zip(rows, printed)]
    one of the rows: sum(np.mean((s if ahead else 1 - s) ** episodes) for s, ahead in zip(rows, printed))
""")

equivalent("forgetting", "means > 0.5  ->  means > 0.505", "a mean of 50 episodes is a multiple of 0.02")
PAIRS = "zip(rows, printed, strict=True)"
for _change in (
    f"for success, all_ahead in {PAIRS}:  ->  for success, all_ahead in zip(rows, printed):",
    f"{PAIRS}  ->  zip(rows, printed, strict=False)",
):
    equivalent("reads_as_printed", _change, "both have as many rows")

wrong_lines("""forgetting
    the beginnings: found = [[k for k in range(len(row) - window + 1) if sum(row[k : k + window]) > window / 2] for row in success]
        np.array([[ends[0] + 1, ends[-1] + 1] if ends else [0, 0] for ends in found])  # *begin*
    counted from 0: found = [[k for k in range(window, len(row) + 1) if sum(row[k - window : k]) > window / 2] for row in success]
        np.array([[ends[0] - 1, ends[-1] - 1] if ends else [0, 0] for ends in found])  # Both numbers are one too small
""")  # noqa: E501
