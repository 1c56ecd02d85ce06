"""Answers to the exercises of the lesson on values."""

from tests.answers import equivalent, right_lines, wrong_lines

right_lines("""discounted_return
    from the end: total = 0.0
        for reward in reversed(list(rewards)):
            total = reward + gamma * total
        total
    one by one: sum(gamma**t * r for t, r in enumerate(rewards))
    as a product of vectors: np.dot(np.asarray(rewards), np.power(gamma, range(len(rewards))))
""")

wrong_lines("""discounted_return
    divided by the weights: solution(rewards, gamma) / sum(gamma**t for t in range(len(rewards)))
    for ever: solution(rewards, gamma) + gamma ** len(rewards) * rewards[-1]
    bounded: max(-10.0, min(10.0, solution(rewards, gamma)))
    the last one left out: solution(rewards[:-1], gamma) if len(rewards) > 1 else 0.0
""")

right_lines("""bellman_sweep
    pair by pair: new = np.zeros_like(q)
        for s in range(5):
            for a in range(2):
                new[s, a] = chain.REWARD[s, a] + gamma * max(q[chain.NEXT[s, a]])
        new
    a list of lists: [[chain.REWARD[s, a] + gamma * q[chain.NEXT[s, a]].max() for a in (0, 1)] for s in range(5)]
""")

wrong_lines("""bellman_sweep
    two sweeps: solution(solution(q, gamma), gamma)
    half of the way: 0.5 * q + 0.5 * solution(q, gamma)
    the values alone: solution(q, gamma).max(axis=1)
    never negative: np.maximum(solution(q, gamma), 0)
    the free road ends: new = solution(q, gamma)
        new[4] = 1.0
        new
""")

right_lines("""temporal_difference
    in two steps: target = reward + gamma * max(q[s_next])
        float(target - q[s][a])
    with numpy: np.add(reward, np.multiply(gamma, np.max(q[s_next]))) - q[s, a]
""")

wrong_lines("""temporal_difference
    a step of it: 0.3 * solution(q, s, a, reward, s_next, gamma)
    its size: abs(solution(q, s, a, reward, s_next, gamma))
    clipped: float(np.clip(solution(q, s, a, reward, s_next, gamma), -5, 5))
    the best of s: reward + gamma * q[s_next].max() - q[s].max()
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
