"""Exercises of the lesson on the soft constraint."""

import math

import torch

from bootcourse.course.exercise import MANY_ROWS, exercise, logits
from bootcourse.course.lessons.discrete_sac.exercises import OF_NOTHING
from bootcourse.learn import bootstrap

WRONG_COLUMNS = (
    "You wrote log p into the same columns of *every* row: `x[:, rule_action]` picks columns for all rows at "
    "once. Pair each row with its own column, as `scatter` or `x[torch.arange(len(x)), rule_action]` does."
)
NOT_WEIGHTED = "Your KL has no weight: multiply it by ξ."
MINUS_ENTROPY = "You penalise entropy: H is *minus* the sum of π log π, so α log π is subtracted from Q."


def log_stochastic_rule(rule_action, p):
    """log π̃(a|s), (batch, 9)."""
    return bootstrap.log_stochastic_rule(rule_action, torch.tensor(float(p)))


def sure(action, others=-40.0):
    """log π of a policy that takes one action with probability 1 - 8 exp(others): (1, 9)."""
    return torch.full((1, 9), others).scatter(-1, torch.tensor([[action]]), 0.0)


def constraint_cases(rng):
    """A policy equal to the rule, a uniform one, sure ones (9 nats and more), nine states; then 50 at random."""
    three = torch.tensor([3])
    yield log_stochastic_rule(three, 0.9), three, 0.9
    yield torch.full((2, 9), -math.log(9)), torch.tensor([0, 8]), 0.5
    yield from ((sure(action, -120.0), three, p) for action, p in ((5, 0.999), (5, 0.9999), (3, 0.999), (0, 0.112)))
    for size in (9, 1, *rng.integers(1, 5, 50)):
        log_pi = torch.tensor(rng.normal(0, rng.uniform(0.5, 4), (size, 9))).log_softmax(-1)
        yield log_pi, torch.tensor(rng.integers(0, 9, size)), rng.uniform(0.15, 0.99)
    yield (
        torch.tensor(rng.normal(0, 4, (MANY_ROWS, 9))).log_softmax(-1),
        torch.tensor(rng.integers(0, 9, MANY_ROWS)),
        0.9,
    )


@exercise(
    "D_KL(π(·|s) ‖ π̃(·|s)), Section IV-A", minutes=7, difficulty=2, cases=constraint_cases, slopes=[logits("log_pi")],
    worked=[
        ((sure(5), torch.tensor([3]), 0.9), torch.tensor([math.log(80)])),  # log 1 / (0.1 / 8): 4.4 nats
        ((sure(3), torch.tensor([3]), 0.9), torch.tensor([-math.log(0.9)])),  # in agreement: log 1 / 0.9
    ],
    hints=(
        "Write log π̃ first: an array of the shape of `log_pi` that holds log((1 - p) / 8), and log p in one column.",
        "The KL is an expectation under the *policy*: π times the difference of the logarithms, summed over actions.",
    ),
    mistakes={
        "return (log_rule.exp() * (log_rule - log_pi)).sum(-1)":
            "Your KL is the other way round: it is large where the *rule* puts mass and the policy does not. The paper "
            "charges the policy for actions that the rule would not take.",
        "log_pi - log_rule -> -log_rule":
            "This is the cross-entropy: without the policy's own entropy it is not zero where both agree.",
        "log_pi.exp() * (log_pi - log_rule) -> log_pi - log_rule":
            "You add up the log-ratios without weighing them: weigh each by π, the probability of its action.",
        "(1 - p) / 8 -> 1 - p":
            "Your rule's probabilities add up to more than 1: the other eight actions *share* 1 - p.",
        "/ 8 -> / 9":
            "You shared 1 - p among nine actions, but the rule's own action already has p: eight are left.",
        "log_pi - log_rule -> log_rule - log_pi":
            "Your sign is wrong: a KL divergence is never negative.",
        ".sum(-1) -> .sum(-1) / math.log(2)":
            "You measure in bits. The paper's ξ, like every loss here, expects nats: the natural logarithm.",
        ".sum(-1) -> .sum(-1).mean()":
            "You took the mean over the batch: return one number for each state; the loss takes the mean later.",
        "log_rule.scatter_(-1, rule_action.unsqueeze(-1), math.log(p)) -> log_rule[:, rule_action] = math.log(p)":
            WRONG_COLUMNS,
        "log_pi.exp() * (log_pi - log_rule) -> log_pi.detach().exp() * (log_pi.detach() - log_rule)":
            "Your KL has the right value but no gradient, so it cannot change the policy: leave out `.detach()`, "
            "`.item()` and NumPy.",
        "log_pi - log_rule -> log_pi.exp().log() - log_rule":
            f"Your KL is not a number where a policy is sure of an action: {OF_NOTHING}",
    },
)  # fmt: skip
def soft_constraint(log_pi, rule_action, p):
    log_rule = torch.full_like(log_pi, math.log((1 - p) / 8))
    log_rule.scatter_(-1, rule_action.unsqueeze(-1), math.log(p))
    return (log_pi.exp() * (log_pi - log_rule)).sum(-1)


def policy_cases(rng):
    """ξ = 0 (without the rule), Q all equal, ξ far above α, one state, training's extremes; then 40 at random."""

    def case(size, alpha, xi, scale=2.0, p=None):
        q, p = torch.tensor(rng.normal(0, scale, (size, 9))), rng.uniform(0.2, 0.99) if p is None else p
        return q, log_stochastic_rule(torch.tensor(rng.integers(0, 9, size)), p), alpha, xi

    yield from (case(3, 0.5, 0.0), case(2, 0.3, 0.7, scale=0.0), case(1, 0.01, 2.0))
    yield from (case(3, 0.002, 0.0, scale=200.0), case(3, 10.0, 1.0, scale=200.0), case(3, 0.5, 2.0, scale=30.0))
    yield from (case(3, 1e-5, 0.002, scale=0.002, p=0.999), case(3, 0.002, 0.0, scale=0.002))
    yield case(3, 0.05, 2.0, p=0.999)
    yield from (case(rng.integers(1, 5), rng.uniform(0.2, 2), rng.uniform(0.05, 3)) for _ in range(40))
    yield case(MANY_ROWS, 0.5, 0.7, scale=20.0)


regularised_policy = exercise(
    "π* = softmax((Q + ξ log π̃) / (α + ξ)), from the objective of Section IV-A",
    minutes=13, difficulty=3, cases=policy_cases,
    worked=[
        # two actions, Q equal: π̃ counts with ξ / (α + ξ) = 1/2, so with the roots of 0.8 and 0.2
        ((torch.zeros(1, 2), torch.tensor([[0.8, 0.2]]).log(), 1.0, 1.0), torch.tensor([[2 / 3, 1 / 3]])),
        # no rule: softmax(Q / α), with e² to 1
        ((torch.tensor([[1.0, 0.0]]), torch.tensor([[0.5, 0.5]]).log(), 0.5, 0.0),
         torch.tensor([[0.880797, 0.119203]])),
    ],
    hints=(
        "Write out the KL. What multiplies π(a) in the objective, and what multiplies π(a) log π(a)?",
        "π(a) is multiplied by Q + ξ log π̃, and π log π by -(α + ξ): as with α alone, the best π is a softmax.",
    ),
    mistakes={
        "return ((q + xi * log_rule) / alpha).softmax(-1)":
            "You divide by α only. The KL contains another entropy, with weight ξ: divide by α + ξ.",
        "return (q / alpha + xi * log_rule).softmax(-1)":
            "You divide Q only. Divide both terms, Q and ξ log π̃, by α + ξ.",
        "return ((q - xi * log_rule) / (alpha + xi)).softmax(-1)":
            "Your policy avoids the rule's action. *Add* ξ log π̃: it is negative, and most negative for the other "
            "actions.",
        "return ((q + xi * log_rule.exp()) / (alpha + xi)).softmax(-1)":
            "You add ξ π̃. Add ξ times the *logarithm* of the rule's probability.",
        "return ((q + xi * log_rule) / (alpha + xi)).log_softmax(-1)":
            "You return logarithms. Return the probabilities: each row adds up to 1.",
        "return ((q + xi * log_rule) / (alpha + xi)).softmax(0)":
            "You normalise over the states. Each *row* is one policy: the softmax runs over the last axis.",
        "weights = ((q + xi * log_rule) / (alpha + xi)).exp(); return weights / weights.sum(-1, keepdim=True)":
            "Your policy is not a number where Q / (α + ξ) is large: exp(100) is infinite in float32. Use "
            "`softmax(-1)`, which subtracts the largest number first.",
    },
)(bootstrap.regularised_policy)  # fmt: skip


def loss_cases(rng):
    """No rule (ξ = 0), no entropy (α = 0), one state, training's extremes; then 30 at random."""

    def case(size, alpha, xi, scale=3.0, most=4.0):
        log_pi = torch.tensor(rng.normal(0, 2, (size, 9))).log_softmax(-1)
        q, kl = torch.tensor(rng.normal(0, scale, (size, 9))), torch.tensor(rng.uniform(0, most, size))
        return log_pi, q, alpha, xi, kl

    yield from (case(3, 0.2, 0.0), case(3, 0.0, 1.0), case(1, 0.1, 2.0))
    yield sure(3, -120.0), torch.tensor(rng.normal(0, 3, (1, 9))), 0.2, 2.0, torch.tensor([9.0])
    yield torch.full((2, 9), -math.log(9)), torch.zeros(2, 9), 1e-4, 0.002, torch.tensor([9.0, 0.01])
    yield from (case(4, 0.05, 10.0, most=12.0), case(4, 10.0, 0.5), case(4, 0.01, 2.0, scale=60.0))
    yield from (case(size, 0.1, 0.7) for size in range(1, 31))
    yield case(MANY_ROWS, 0.1, 0.7, scale=100.0, most=12.0)


@exercise(
    "-E_s[Σ_a π (Q - α log π) - ξ D_KL], Section IV-A",
    minutes=3, difficulty=1, cases=loss_cases, slopes=[logits("log_pi"), "q", "kl"],
    worked=[
        # two actions, half and half: V = (1 + 3)/2 + 0.5 log 2 - 2 · 0.25
        ((torch.full((1, 2), -math.log(2)), torch.tensor([[1.0, 3.0]]), 0.5, 2.0, torch.tensor([0.25])),
         torch.tensor(-(2 + 0.5 * math.log(2) - 0.5))),
    ],
    hints=(
        "`value` is the soft value of each state. Subtract ξ times the state's KL from it.",
        "The loss is minus the mean. `q` receives no gradient, but `kl` must: it depends on the policy.",
    ),
    mistakes={
        "q.detach() -> q":
            "Your value is right, but the gradient flows into Q, too: the actor's step would change the critic. Use "
            "`q.detach()`.",
        "- xi * kl -> + xi * kl":
            "You reward the actor for leaving the rule: your loss falls as the KL grows. Subtract ξ times the KL from "
            "V.",
        "xi * kl -> xi * kl.detach()":
            "Your KL has no gradient, so it does not change the actor. Detach Q, not the KL.",
        "return -(value -> return (value":
            "This is the value, and training would make it *small*. A loss is minimised: return -V.",
        "xi * kl -> kl": NOT_WEIGHTED,
        "- alpha * log_pi -> + alpha * log_pi": MINUS_ENTROPY,
        "alpha * log_pi -> alpha * log_pi.exp().log()":
            f"Your loss is not a number where a policy is sure of an action: {OF_NOTHING}",
    },
)  # fmt: skip
def constrained_loss(log_pi, q, alpha, xi, kl):
    value = (log_pi.exp() * (q.detach() - alpha * log_pi)).sum(-1)
    return -(value - xi * kl).mean()


def target_cases(rng):
    """All ended, none ended, ξ = 0, α = 0, one state, nine states, training's extremes; then 40 at random."""

    def case(size, ended=0.4, alpha=None, xi=None, scale=3.0, most=4.0):
        log_pi = torch.tensor(rng.normal(0, 1.5, (size, 9))).log_softmax(-1)
        numbers = torch.tensor(rng.normal(0, scale, size)), torch.tensor(rng.random(size) < ended).double()
        q_pair, kl = torch.tensor(rng.normal(0, scale, (2, size, 9))), torch.tensor(rng.uniform(0, most, size))
        alpha, xi = rng.uniform(0.05, 1) if alpha is None else alpha, rng.uniform(0.1, 2) if xi is None else xi
        return *numbers, log_pi, q_pair, kl, alpha, xi, rng.uniform(0.5, 0.99)

    yield from (case(4, ended=1.0), case(4, ended=0.0), case(3, xi=0.0), case(3, alpha=0.0), case(1, ended=0.0))
    yield case(9)
    yield from (case(6, scale=300.0), case(6, scale=30.0, most=12.0), case(6, xi=10.0, most=12.0), case(6, alpha=10.0))
    yield from (case(6, alpha=1e-4, xi=0.002, scale=0.01), case(6, alpha=0.002, xi=0.0, scale=0.01))
    reward, terminated, _, q_pair, kl, *numbers = case(2, ended=0.0)
    yield reward, terminated, torch.cat([sure(3, -120.0), sure(0, -120.0)]), q_pair, kl, *numbers
    for _ in range(40):
        yield case(rng.integers(2, 7))
    yield case(MANY_ROWS, scale=100.0, most=12.0)


EVEN = torch.full((2, 9), -math.log(9))
Q_PAIR = torch.tensor([[2.0] * 4 + [9.0] * 5, [5.0] * 4 + [2.0] * 5])[:, None].expand(2, 2, 9)


@exercise(
    "y = r + γ (1 - terminated) (V(s') - ξ D_KL(s')), from Equation 15", minutes=11, difficulty=3, cases=target_cases,
    worked=[
        # all actions alike, min Q = 2: V = 2 + 0.5 log 9 - 2 · 0.25; it goes on: 1 + 0.8 V; it ended: -10
        ((torch.tensor([1.0, -10.0]), torch.tensor([0.0, 1.0]), EVEN, Q_PAIR, torch.tensor([0.25, 0.25]),
          0.5, 2.0, 0.8),
         torch.tensor([1 + 0.8 * (1.5 + 0.5 * math.log(9)), -10.0])),
    ],
    hints=(
        "What is the value of s' if each second pays r + α H - ξ KL? Which of these terms belong to s, which to s'?",
        "The soft value of s' as in plain SAC, of the smaller Q (`next_q_pair.amin(0)`), minus ξ times `next_kl`.",
    ),
    mistakes={
        "- xi * next_kl ->":
            "Your target has no KL: the critic would price every future as if the rule did not exist.",
        "- xi * next_kl -> + xi * next_kl":
            "Your target rewards leaving the rule: a large KL makes the next state's value *smaller*.",
        "xi * next_kl -> next_kl": NOT_WEIGHTED,
        "amin -> amax":
            "You take the larger of the two critics. The smaller one keeps the estimates from growing without limit.",
        "amin -> mean":
            "You take the mean of the two critics: here it is the smaller of the two, for each action.",
        ("next_q_pair.amin(0) -> next_q_pair", ".sum(-1) -> .sum(-1).amin(0)"):
            "You take the smaller of two values of the state. Take the smaller Q of *each action*, then the mean "
            "under π.",
        ("- xi * next_kl ->", "* value -> * value - xi * next_kl"):
            "Your KL stands outside the value of s': it is charged after an accident, too, and is not discounted. It "
            "is part of V(s').",
        ("- xi * next_kl ->", "* value -> * value - gamma * xi * next_kl"):
            "Your KL is charged after an accident, too. There the policy does not choose again: the KL is part of "
            "V(s').",
        "(1 - terminated) * ->":
            "Your target adds a future after the accident. Where an episode ended, the target is the reward alone.",
        "(next_q - alpha * next_log_pi) -> next_q":
            "Your value has no entropy: add α H(π(·|s')).",
        "- alpha * next_log_pi -> + alpha * next_log_pi": MINUS_ENTROPY,
        "alpha * next_log_pi -> alpha * next_log_pi.exp().log()":
            "Your target is not a number where a policy is sure of an action: exp(-120) is 0 in float32, and log 0 is "
            "minus infinity. Use `next_log_pi` itself, not the logarithm of π.",
    },
)  # fmt: skip
def constrained_target(reward, terminated, next_log_pi, next_q_pair, next_kl, alpha, xi, gamma):
    next_q = next_q_pair.amin(0)
    value = (next_log_pi.exp() * (next_q - alpha * next_log_pi)).sum(-1) - xi * next_kl
    return reward + gamma * (1 - terminated) * value
