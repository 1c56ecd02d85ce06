"""Answers to the exercises of the lesson on the barrier."""

from tests.answers import equivalent, right_lines, wrong_lines

right_lines("""luck
    binomial: 1 - stats.binom.pmf(0, tries, (good / 9) ** decisions)
    not all fail: fails = 1.0
        for _ in range(tries):
            fails *= 1 - (good / 9) ** decisions
        1 - fails
""")

wrong_lines("""luck
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
    the values of the states: chain.learn_chain(chances, gamma, step, taught).max(axis=1)
""")
