"""Exercises of the lesson on imitation."""

import math

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
        "return -torch.log(1 - torch.sigmoid(own_logits) + 1e-8)":
            "Your reward stops growing where the discriminator is certain: what you add inside the logarithm is then "
            "larger than 1 - D. `softplus` computes log (1 + e^x), the same, and needs no such number.",
    },
)(gail.imitation_reward)  # fmt: skip
