"""Answers to the exercises of the lesson on the barrier."""

import numpy as np
from scipy import stats

from tests.answers import right, wrong

# discounted_value -----------------------------------------------------------------------------------


@right("discounted_value")
def backwards(rewards, gamma):
    value = 0.0
    for reward in rewards[::-1]:
        value = reward + gamma * value
    return value


@right("discounted_value")
def as_a_polynomial(rewards, gamma):
    return np.polyval(rewards[::-1], gamma)


@wrong("discounted_value", "the first reward, too")
def from_one(rewards, gamma):
    return sum(gamma ** (t + 1) * reward for t, reward in enumerate(rewards))


@wrong("discounted_value", "backwards")
def forwards(rewards, gamma):
    value = 0.0
    for reward in rewards:
        value = reward + gamma * value
    return value


@wrong("discounted_value")
def linear(rewards, gamma):
    return sum(max(0, 1 - t * (1 - gamma)) * reward for t, reward in enumerate(rewards))


@wrong("discounted_value", "returns")
def each_second(rewards, gamma):
    return gamma ** np.arange(len(rewards)) * rewards


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
