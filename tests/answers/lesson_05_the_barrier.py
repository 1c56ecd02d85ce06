"""Answers to the exercises of the lesson on the barrier."""

import numpy as np
from scipy import stats

from bootcourse.lessons import chain
from tests.answers import equivalent, right, wrong

# share_of_the_future --------------------------------------------------------------------------------


@right("share_of_the_future")
def added_up(gamma, seconds):
    weights = gamma ** np.arange(10_000)
    return weights[seconds:].sum() / weights.sum()


@right("share_of_the_future")
def less_the_past(gamma, seconds):
    past = (1 - gamma**seconds) / (1 - gamma)
    return (1 / (1 - gamma) - past) * (1 - gamma)


@wrong("share_of_the_future")
def product(gamma, seconds):
    return gamma * seconds


# luck -----------------------------------------------------------------------------------------------


@right("luck")
def not_all_fail(good, decisions, tries):
    fails = 1.0
    for _ in range(tries):
        fails *= 1 - (good / 9) ** decisions
    return 1 - fails


@right("luck")
def binomial(good, decisions, tries):
    return 1 - stats.binom.pmf(0, tries, (good / 9) ** decisions)


@wrong("luck")
def capped(good, decisions, tries):
    return min(1.0, tries * (good / 9) ** decisions)


@wrong("luck")
def of_eight(good, decisions, tries):
    return 1 - (1 - (good / 8) ** decisions) ** tries


# learn_chain ----------------------------------------------------------------------------------------

for _start in (-1, 1):
    _before, _after = (f"(np.zeros((STATES, 2)), {s})" for s in (0, _start))
    equivalent("learn_chain", f"{_before}  ->  {_after}", "decision 0 begins an episode, and so in state 0")
equivalent(
    "learn_chain",
    "int(q[s].argmax()) if chance < 0 else chance  ->  q[s].argmax() if chance < 0 else chance",
    "a number of NumPy's is an index, too",
)


@right("learn_chain")
def with_lists(chances, gamma, step, taught):
    q, s = [[0.0, 0.0] for _ in range(5)], 0
    for t, chance in enumerate(list(chances)):
        s = 0 if t % 20 == 0 else s
        a = chance if chance >= 0 else int(q[s][1] > q[s][0])
        for x, u in ((s, a),) + tuple(taught):
            q[x][u] = (1 - step) * q[x][u] + step * (chain.REWARD[x, u] + gamma * max(q[chain.NEXT[x, u]]))
        s = chain.NEXT[s, a]
    return np.array(q)


@right("learn_chain")
def episode_by_episode(chances, gamma, step, taught):
    q = np.zeros((5, 2))

    def update(s, a):
        after = chain.NEXT[s][a]
        q[s][a] += step * (chain.REWARD[s][a] + gamma * np.max(q[after]) - q[s][a])
        return after

    for begin in range(0, len(chances), chain.EPISODE):
        s = 0
        for chance in chances[begin : begin + chain.EPISODE]:
            s = update(s, np.argmax(q[s]) if chance == -1 else chance)
            for each in taught:
                update(*each)
    return q


@right("learn_chain")
def with_one_row_of_numbers(chances, gamma, step, taught):
    q, s = np.zeros(10), 0
    for t in range(len(chances)):
        s = 0 if t % 20 == 0 else s
        a = int(chances[t]) if chances[t] != -1 else int(q[2 * s + 1] > q[2 * s])
        for x, u in ((s, a), *taught):
            y = chain.NEXT[x, u]
            error = chain.REWARD[x, u] + gamma * max(q[2 * y], q[2 * y + 1]) - q[2 * x + u]
            q[2 * x + u] = q[2 * x + u] + step * error
        s = chain.NEXT[s, a]
    return q.reshape(5, 2)


def chain_learner(first=0, ties=0, ahead=0, sarsa=False, own=True):
    """Q-learning in the chain with other slips than the exercise knows."""

    def answer(chances, gamma, step, taught):
        q, s = np.zeros((5, 2)), 0
        for t, chance in enumerate(chances):
            s = 0 if t % 20 == first else s
            greedy = int(q[s, 1] > q[s, 0]) if not ties else int(q[s, 1] >= q[s, 0])
            a = greedy if chance < 0 else chance
            for x, u in [(s, a)] * own + list(taught):
                y = chain.NEXT[x, u] if not ahead else x
                best = q[y, u] if sarsa else q[y].max()
                q[x, u] += step * (chain.REWARD[x, u] + gamma * best - q[x, u])
            s = chain.NEXT[s, a]
        return q

    return answer


for _slip in ({"first": 19}, {"ties": 1}, {"ahead": 1}, {"sarsa": True}, {"own": False}):
    wrong("learn_chain")(chain_learner(**_slip))


@wrong("learn_chain")
def with_a_step_of_a_half(chances, gamma, step, taught):
    return chain.learn_chain(chances, gamma, 0.5, taught)


@wrong("learn_chain")
def with_the_paper_s_discount(chances, gamma, step, taught):
    return chain.learn_chain(chances, 0.8, step, taught)


@wrong("learn_chain")
def the_values_of_the_states(chances, gamma, step, taught):
    return chain.learn_chain(chances, gamma, step, taught).max(axis=1)


# lowest_rate ----------------------------------------------------------------------------------------


@right("lowest_rate")
def scipy_s(agents):
    return stats.binomtest(agents, agents).proportion_ci(0.95, method="exact").low


@right("lowest_rate")
def with_logarithms(agents):
    return np.exp(np.log(0.025) / agents)


@wrong("lowest_rate")
def bayes(agents):
    return (agents + 1) / (agents + 2)
