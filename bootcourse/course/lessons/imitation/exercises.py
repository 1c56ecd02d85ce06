"""Exercises of the lesson on imitation."""

import math

import numpy as np
import torch
import torch.nn.functional as F

from bootcourse.course.exercise import exercise
from bootcourse.learn import gail


def judged_cases(rng):
    """D near 1/2, right and wrong, very certain, batches of two lengths; then 30 at random."""
    yield torch.tensor([0.01, -0.01]), torch.tensor([0.01, 0.0, -0.01])
    yield torch.tensor([3.0, 1.0]), torch.tensor([-2.0, -4.0])
    yield torch.tensor([-3.0, -1.0]), torch.tensor([2.0, 4.0])
    yield torch.tensor([60.0, -60.0]), torch.tensor([-60.0, 60.0, 0.0])
    yield torch.tensor([100.0, -100.0]), torch.tensor([-100.0, 100.0, 0.0])  # e^100 is infinite
    for _ in range(30):
        yield tuple(torch.tensor(rng.normal(0, 3, n)) for n in rng.integers(1, 8, 2))


@exercise(
    "-E_rule[log D] - E_own[log (1 - D)], Ho & Ermon, arXiv 1606.03476, Equation 17, with D for 1 - D",
    minutes=15, difficulty=3, cases=judged_cases, slopes=["rule_logits", "own_logits"],
    worked=[
        # D = 3/4 for the rule, 1/4 for the agent: twice -log 3/4; the slopes are D - 1 and D
        ((torch.tensor([math.log(3)]), torch.tensor([-math.log(3)])),
         (torch.tensor(2 * math.log(4 / 3)), torch.tensor([-0.25]), torch.tensor([0.25]))),
        # the rule's D are 3/4 and 1/4, the agent's 1/4; each term is a mean over its batch
        ((torch.tensor([math.log(3), -math.log(3)]), torch.tensor([-math.log(3)])),
         (torch.tensor((math.log(4 / 3) + math.log(4)) / 2 + math.log(4 / 3)),
          torch.tensor([-1 / 8, -3 / 8]), torch.tensor([1 / 4]))),
    ],
    hints=(
        "With D = σ(x): log D = -log (1 + e⁻ˣ), and log (1 - D) = -log (1 + eˣ).",
        "`torch.nn.functional.softplus(x)` is log (1 + eˣ), safe for every x. Mind the sign of each x.",
    ),
    mistakes={
        "return F.softplus(-own_logits).mean() + F.softplus(rule_logits).mean()":
            "You have taken the two batches for each other: this discriminator learns to give the *agent* a high D.",
        "return -F.softplus(-rule_logits).mean() - F.softplus(own_logits).mean()":
            "Your sign is wrong: gradient descent on this makes the discriminator take each for the other.",
        "return -torch.log(torch.sigmoid(rule_logits)).mean() - torch.log(1 - torch.sigmoid(own_logits)).mean()":
            "This is right on paper, but infinite where the discriminator is certain and wrong: in floating point "
            "σ(100) is exactly 1. -log σ(x) is log (1 + e⁻ˣ), which is called softplus.",
        "return torch.log(1 + torch.exp(-rule_logits)).mean() + torch.log(1 + torch.exp(own_logits)).mean()":
            "e¹⁰⁰ is too large for a float32, so your loss is infinite there. `softplus` computes log (1 + eˣ) safely.",
        "mean -> sum [2 times]":
            "Both terms are expectations: take the mean over each batch, so that a longer batch does not count more.",
        "F.softplus(-rule_logits).mean() + ->":
            "The rule's half is missing: nothing keeps D high where the rule drives, so D = 0 everywhere is the best.",
    },
)  # fmt: skip
def discriminator_loss(rule_logits, own_logits):
    return F.softplus(-rule_logits).mean() + F.softplus(own_logits).mean()


def own_cases(rng):
    """D = 1/2, near 0 and 1, D = 1 in floating point, e^x infinite; then 40 at random."""
    yield from ((torch.tensor(x),) for x in ([0.0], [5.0, -5.0], [60.0, -60.0, 1.0], [100.0, -100.0, 2.0]))
    yield from ((torch.tensor(rng.normal(0, 3, rng.integers(1, 8))),) for _ in range(40))


imitation_reward = exercise(
    "r(s,a) = -log (1 - D(s,a)), Ho & Ermon, arXiv 1606.03476; D as in bootcourse.learn.gail",
    minutes=6, difficulty=2, cases=own_cases,
    worked=[
        ((torch.tensor([0.0]),), torch.tensor([math.log(2)])),  # D = 1/2
        # D = 3/4 and 1/4
        ((torch.tensor([math.log(3), -math.log(3)]),), torch.tensor([math.log(4), math.log(4 / 3)])),
    ],
    hints=(
        "With D = σ(x): 1 - D = 1 / (1 + e^x). What is minus the logarithm of that?",
        "log (1 + e^x) has a name and a function that is safe for a large x: `torch.nn.functional.softplus`.",
    ),
    mistakes={
        "return F.logsigmoid(own_logits)":
            "This is log D. It grows with D as it should, but it is at most 0: each second on the road costs "
            "something, so the agent gains by crashing early.",
        "return -F.softplus(own_logits)":
            "This is log (1 - D): it is largest where the discriminator recognises the agent. A minus is missing.",
        "return F.softplus(-own_logits)":
            "This is -log D: it is largest for what the demonstrator would not do.",
        "return torch.sigmoid(own_logits)":
            "This is D itself. Take minus the logarithm of 1 - D.",
        "return own_logits":
            "This is the logit, log D - log (1 - D), which another method (AIRL) pays. It is negative where the "
            "discriminator recognises the agent.",
        "return -torch.log(1 - torch.sigmoid(own_logits))":
            "This is right on paper, but infinite where the discriminator is very certain: in floating point σ(60) is "
            "exactly 1. -log (1 - σ(x)) is log (1 + e^x), which is called softplus.",
        "return torch.log(1 + torch.exp(own_logits))":
            "This is right on paper, but in float32 e^x is infinite (and σ(-x) is 0) from x = 89 on, so your reward is "
            "infinite there. `softplus` computes log (1 + e^x) safely.",
    },
)(gail.imitation_reward)  # fmt: skip


def rate_cases(rng):
    """One of 20, none, all, one of two; then 40 at random."""
    yield from ((1, 20), (0, 20), (20, 20), (1, 2))
    for _ in range(40):
        n = rng.integers(3, 60)
        yield rng.integers(1, n), n


@exercise(
    "100 √(p (1 - p) n / (n - 1)) with p = k / n: what a table of rates prints behind its ±",
    minutes=5, difficulty=1, cases=rate_cases,
    worked=[((1, 2), 100 / math.sqrt(2)), ((2, 2), 0.0), ((1, 4), 50.0)],  # √((75² + 3 · 25²) / 3) = 50
    hints=(
        "Write down what is averaged: n numbers, k of them 100 and the others 0.",
        "`np.repeat([100.0, 0.0], [k, n - k])` are these numbers. A sample's deviation divides by n - 1.",
    ),
    mistakes={
        "ddof=1 -> ddof=0":
            "You divide by n. The deviation of a *sample* divides by n - 1, which NumPy calls `ddof=1`; with n, one of "
            "20 would give 21.79.",
        "return outcomes.std(ddof=1) / math.sqrt(n)":
            "This is the standard error: how far the *rate* may be off. A table's ± SD says how far single episodes "
            "lie apart.",
        "100.0 -> 1.0":
            "This is the deviation of zeros and ones. In percent it is a hundred times as large.",
        "std -> var":
            "This is the variance: take its root, so that it has the unit of the rate.",
        "return 100 * math.sqrt(k) / n":
            "This is the error of a count, √k. It says how much k would vary, not how far single episodes lie apart.",
    },
)  # fmt: skip
def deviation_of_a_rate(k, n):
    outcomes = np.repeat([100.0, 0.0], [k, n - k])
    return outcomes.std(ddof=1)


def accident_rates(rng):
    """Nearly always, one in two, one in twenty, one in a thousand; then 40 at random."""
    yield from ((0.97,), (0.5,), (0.05,), (0.01,), (0.001,))
    yield from ((np.exp(rng.uniform(np.log(0.002), np.log(0.6))),) for _ in range(40))


@exercise(
    "the smallest n with (1 - rate)^n ≤ 0.05; for small rates 3 / rate, the rule of three",
    minutes=5, difficulty=2, cases=accident_rates,
    worked=[((0.5,), 5), ((0.9,), 2)],  # 1/2^5 = 1/32 is under 1/20, 1/2^4 is not; 1/10^2 is, 1/10 is not
    hints=(
        "The chance that n episodes all go well is (1 - rate)^n. It must be 5 % or less.",
        "n · log (1 - rate) ≤ log 0.05, and log (1 - rate) is negative. Round up.",
    ),
    mistakes={
        "return math.ceil(3 / rate)":
            "This is the rule of three, a good estimate for small rates. The exact number is a little smaller.",
        "return max(1, math.floor(math.log(0.05) / math.log(1 - rate)))":
            "You rounded down: after that many episodes the chance is still above 5 %.",
        "math.ceil ->":
            "Episodes are whole numbers: round up to the first one that is enough.",
        "0.05 -> 0.95":
            "After that many episodes an accident has had a chance of 5 %. It must have had one of 95 %.",
        "return math.ceil(1 / rate)":
            "After that many episodes *one* accident is expected, but about one driver in three has had none by then.",
        "1 - rate -> rate":
            "You multiply the chances of accidents. Multiply the chances that an episode goes *well*.",
    },
)  # fmt: skip
def episodes_needed(rate):
    return math.ceil(math.log(0.05) / math.log(1 - rate))
