"""Answers to the exercises of the lesson on finding the way out and keeping it."""

from tests.answers import equivalent, right_lines, wrong_lines

equivalent("ever_lost", "(1, 0)  ->  (2, 0)", "a window of the first 49 changes nothing")

right_lines("""ever_lost
    by sliding windows: ahead = np.lib.stride_tricks.sliding_window_view(np.asarray(success), 50, axis=1).sum(-1)
        (np.maximum.accumulate(ahead >= had, axis=1) & (ahead <= limit)).any(1)
    by the lowest that is to come: ahead = np.lib.stride_tricks.sliding_window_view(success, 50, axis=1).sum(-1)
        lowest = np.minimum.accumulate(ahead[:, ::-1], axis=1)[:, ::-1]
        ((ahead >= had) & (lowest <= limit)).any(1)
    in a loop: answer = []
        for row in success:
            ahead = np.convolve(row, np.ones(50), "valid")
            good = np.flatnonzero(ahead >= had)
            answer.append(len(good) > 0 and ahead[good[0] :].min() <= limit)
        np.array(answer)
""")

wrong_lines("""ever_lost
    low before it was had: ahead = np.lib.stride_tricks.sliding_window_view(success, 50, axis=1).sum(-1)
        (np.maximum.accumulate(ahead <= limit, axis=1) & (ahead >= had)).any(1)
    after the best window: ahead = np.lib.stride_tricks.sliding_window_view(success, 50, axis=1).sum(-1)
        best = ahead.argmax(1)
        np.array([row[at] >= had and row[at:].min() <= limit for row, at in zip(ahead, best)])
    from more than half on: ahead = np.lib.stride_tricks.sliding_window_view(success, 50, axis=1).sum(-1)
        (np.maximum.accumulate(ahead > 25, axis=1) & (ahead <= limit)).any(1)
    how often: ahead = np.lib.stride_tricks.sliding_window_view(success, 50, axis=1).sum(-1)
        (np.maximum.accumulate(ahead >= had, axis=1) & (ahead <= limit)).sum(1)
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
