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
