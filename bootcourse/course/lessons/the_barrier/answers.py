"""Answers to the exercises of the lesson on the barrier."""

from tests.answers import right_lines, wrong_lines

right_lines("""luck
    binomial: 1 - stats.binom.pmf(0, tries, (good / 9) ** decisions)
    with logarithms: 1.0 if good == 9 else -math.expm1(tries * math.log1p(-((good / 9) ** decisions)))
    the first lucky one: once = (good / 9) ** decisions; sum(once * (1 - once) ** k for k in range(tries))
    not all fail: fails = 1.0
        for _ in range(tries):
            fails *= 1 - (good / 9) ** decisions
        1 - fails
""")

wrong_lines("""luck
    each action once: once = math.prod(max(good - k, 0) / (9 - k) for k in range(min(decisions, 9)))
        1 - (1 - once) ** tries
    for rare luck: 1 - math.exp(-tries * (good / 9) ** decisions)
    in float32: float(1 - (1 - np.float32(good / 9) ** decisions) ** tries)
    never sure: min(0.999, solution(good, decisions, tries))
    of eight: 1 - (1 - (good / 8) ** decisions) ** tries
""")

right_lines("""going_on
    drive by drive: rests = [row[t:] for row, seconds in zip(rewards, lasted) if seconds > t]
        sum(gamma**k * r for rest in rests for k, r in enumerate(rest)) / len(rests)
    weighted: still = lasted > t
        worths = (rewards[:, t:] * gamma ** np.arange(rewards.shape[1] - t)).sum(axis=1)
        (worths * still).sum() / still.sum()
    a mean of each second: rest = rewards[lasted > t].mean(axis=0)[t:]
        np.dot(rest, np.power(float(gamma), np.arange(len(rest))))
""")

wrong_lines("""going_on
    only the next second: rewards[lasted > t, t].mean()
    only what comes out well: rest = rewards[lasted > t, t:]
        np.maximum(rest @ gamma ** np.arange(rest.shape[1]), 0).mean()
    the median: rest = rewards[lasted > t, t:]
        np.median(rest @ gamma ** np.arange(rest.shape[1]))
    a mean of each drive's seconds: rest = rewards[lasted > t, t:]
        (rest * gamma ** np.arange(rest.shape[1])).mean()
    each drive by itself: rest = rewards[lasted > t, t:]
        rest @ gamma ** np.arange(rest.shape[1])
""")
