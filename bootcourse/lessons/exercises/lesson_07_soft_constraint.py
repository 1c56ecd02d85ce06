"""Exercises of the lesson on the soft constraint."""

import math

import torch

from bootcourse.lessons.exercise import Exercise, Mistake


def log_rule(rule_action, p, others):
    """log p for the rule's action, log `others` for the other eight: (batch,) -> (batch, 9)."""
    is_rule = torch.arange(9) == rule_action.unsqueeze(-1)
    return torch.where(is_rule, math.log(p), math.log(others))


def solution(log_pi, rule_action, p):
    log_rule = torch.full_like(log_pi, math.log((1 - p) / 8))
    log_rule.scatter_(-1, rule_action.unsqueeze(-1), math.log(p))
    return (log_pi.exp() * (log_pi - log_rule)).sum(-1)


def reverse(log_pi, rule_action, p):
    rule = log_rule(rule_action, p, (1 - p) / 8)
    return (rule.exp() * (rule - log_pi)).sum(-1)


def cross_entropy(log_pi, rule_action, p):
    return -(log_pi.exp() * log_rule(rule_action, p, (1 - p) / 8)).sum(-1)


def unweighted(log_pi, rule_action, p):
    return (log_pi - log_rule(rule_action, p, (1 - p) / 8)).sum(-1)


def not_shared(log_pi, rule_action, p):
    return (log_pi.exp() * (log_pi - log_rule(rule_action, p, 1 - p))).sum(-1)


def shared_by_nine(log_pi, rule_action, p):
    return (log_pi.exp() * (log_pi - log_rule(rule_action, p, (1 - p) / 9))).sum(-1)


def sure(action, size=9):
    """A policy that takes one action with all but e⁻⁴⁰ of its probability: (1, 9)."""
    return torch.full((1, size), -40.0).double().scatter(-1, torch.tensor([[action]]), 0.0)


def cases(rng):
    """A policy equal to the rule, one that is uniform, nine states (as many as actions); then 50 at random."""
    three = torch.tensor([3])
    yield log_rule(three, 0.9, 0.0125).double(), three, 0.9
    yield torch.full((2, 9), -math.log(9)).double(), torch.tensor([0, 8]), 0.5
    sizes = [9, 1, *rng.integers(1, 5, 50)]
    for size in sizes:
        log_pi = torch.tensor(rng.normal(0, rng.uniform(0.5, 4), (size, 9))).log_softmax(-1)
        yield log_pi, torch.tensor(rng.integers(0, 9, size)), float(rng.uniform(0.15, 0.99))


soft_constraint = Exercise(
    call="soft_constraint(log_pi, rule_action, p)",
    solution=solution,
    worked=(
        ((sure(5), torch.tensor([3]), 0.9), torch.tensor([math.log(80)])),  # log 1 / (0.1 / 8): 4.4 nats
        ((sure(3), torch.tensor([3]), 0.9), torch.tensor([-math.log(0.9)])),  # in agreement: log 1 / 0.9
    ),
    cases=cases,
    mistakes=(
        Mistake(
            answer=reverse,
            says="Your KL is the other way round: it is large where the *rule* puts mass and the policy does not. "
            "The paper charges the policy for going where the rule would not.",
            belief="A divergence is a distance, so its order does not matter.",
        ),
        Mistake(
            answer=cross_entropy,
            says="This is the cross-entropy: without the policy's own entropy it is not zero where both agree.",
            belief="The log π part does not depend on the rule, so it can be dropped. Its gradient cannot.",
        ),
        Mistake(
            answer=unweighted,
            says="You add up the log-ratios without weighing them: each counts as often as the policy acts so.",
            belief="The sum over actions is the expectation.",
        ),
        Mistake(
            answer=not_shared,
            says="Your rule's probabilities add up to more than 1: the other eight actions *share* 1 - p.",
            belief="1 - p is the probability of each other action.",
        ),
        Mistake(
            answer=shared_by_nine,
            says="You shared 1 - p among nine actions, but the rule's own has its p already: eight are left.",
            belief="The noise is uniform over all nine. (Then the rule's own action would have p + (1 - p) / 9.)",
        ),
        Mistake(
            answer=lambda log_pi, rule_action, p: -solution(log_pi, rule_action, p),
            says="Your sign is turned: a KL divergence is never negative.",
            belief="The constraint is subtracted in the objective, so the minus is put into the KL as well.",
        ),
        Mistake(
            answer=lambda log_pi, rule_action, p: solution(log_pi, rule_action, p) / math.log(2),
            says="You measure in bits. The paper's ξ, like every loss here, expects nats: the natural logarithm.",
            belief="Information is measured with log 2.",
        ),
        Mistake(
            answer=lambda log_pi, rule_action, p: solution(log_pi, rule_action, p).mean(),
            says="You took the mean over the batch: return one number for each state, the loss averages later.",
            belief="A loss term is a scalar.",
        ),
    ),
    hints=(
        "Write log π̃ first: an array of the shape of `log_pi` that holds log((1 - p) / 8), and log p in one column.",
        "The KL is an expectation under the *policy*: π times the difference of the logarithms, summed over actions.",
        "`(log_pi.exp() * (log_pi - log_rule)).sum(-1)`",
    ),
    minutes=5,
    difficulty=2,
    equation="D_KL(π(·|s) ‖ π̃(·|s)), Section IV-A",
)
