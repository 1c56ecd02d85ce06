"""Answers to the exercises of the lesson on the barrier."""

from tests.answers import equivalent, right_lines, wrong_lines

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


for _start in (-1, 1):
    _before, _after = (f"(np.zeros((STATES, 2)), {s})" for s in (0, _start))
    equivalent("learn_chain", f"{_before}  ->  {_after}", "decision 0 begins an episode, and so in state 0")
equivalent(
    "learn_chain",
    "int(q[s].argmax()) if chance < 0 else chance  ->  q[s].argmax() if chance < 0 else chance",
    "a number of NumPy's is an index, too",
)


right_lines("""learn_chain
    with lists: q, s = [[0.0, 0.0] for _ in range(5)], 0
        for t, chance in enumerate(list(chances)):
            s = 0 if t % 20 == 0 else s
            a = chance if chance >= 0 else int(q[s][1] > q[s][0])
            for x, u in ((s, a),) + tuple(taught):
                q[x][u] = (1 - step) * q[x][u] + step * (chain.REWARD[x, u] + gamma * max(q[chain.NEXT[x, u]]))
            s = chain.NEXT[s, a]
        np.array(q)
""")


wrong_lines("""learn_chain
    columns turned: chain.learn_chain(chances, gamma, step, taught)[:, ::-1]
    replayed from the end: chain.learn_chain(chances, gamma, step, tuple(taught)[::-1])
    the values of the states: chain.learn_chain(chances, gamma, step, taught).max(axis=1)
""")
