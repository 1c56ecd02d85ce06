"""Exercises of the lesson on the soft constraint."""

import math

import torch

from bootcourse.course.exercise import Exercise, Mistake, logits
from bootcourse.learn import bootstrap


def one_column_for_all(rule_action, p):
    log_rule = torch.full((len(rule_action), 9), math.log((1 - p) / 8))
    log_rule[:, rule_action] = math.log(p)
    return log_rule


def log_stochastic_rule_solution(rule_action, p):
    log_rule = torch.full((len(rule_action), 9), math.log((1 - p) / 8))
    return log_rule.scatter(-1, rule_action.unsqueeze(-1), math.log(p))


log_stochastic_rule = Exercise(
    "log_stochastic_rule(rule_action, p)", solution=log_stochastic_rule_solution,
    # the first and the last action, one state, nine states, p = 1/2; then 40 at random
    cases=lambda rng: [(torch.tensor([0, 8]), 0.9), (torch.tensor([4]), 0.5), (torch.arange(9), 0.99), *(
                       (torch.tensor(rng.integers(0, 9, rng.integers(1, 6))), rng.uniform(0.15, 0.99))
                       for _ in range(40))],
    worked=(
        ((torch.tensor([3]), 0.9), torch.tensor([[math.log(0.0125)] * 3 + [math.log(0.9)] + [math.log(0.0125)] * 5])),
    ),
    mistakes=(
        Mistake(lambda rule_action, p: log_rule(rule_action, p, (1 - p) / 8).exp(),
            "These are the probabilities themselves. Return their natural logarithms.",
            "The logarithm is taken later."),
        Mistake(lambda rule_action, p: log_rule(rule_action, p, 1 - p),
            "Your nine probabilities add up to more than 1: the other eight actions *share* 1 - p.",
            "1 - p is the probability of each other action."),
        Mistake(lambda rule_action, p: log_rule(rule_action, p, (1 - p) / 9),
            "Your nine probabilities add up to less than 1: the rule's own action has its p, so eight are left.",
            "There are nine actions, so the rest is shared by nine."),
        Mistake(lambda rule_action, p: log_rule(rule_action, p, (1 - p) / 8) / math.log(10),
            "You took the logarithm to base 10. Use the natural one, `math.log` or `torch.log`.",
            "log means log10, as on a calculator."),
        Mistake(lambda rule_action, p: -log_rule(rule_action, p, (1 - p) / 8),
            "Your sign is wrong: these are the prices, -log π̃. The logarithm of a probability is at most 0.",
            "The text speaks of prices, so prices are returned."),
        Mistake(lambda rule_action, p: log_rule(rule_action[:1].expand(len(rule_action)), p, (1 - p) / 8),
            "All your rows are the same. The rule has its own action in each state.",
            "The rule's action is the same in the whole batch."),
        Mistake(one_column_for_all,
            "You wrote log p into the same columns of *every* row: `x[:, rule_action]` picks columns for all rows at "
            "once. Pair each row with its own column, as `scatter` or `x[torch.arange(len(x)), rule_action]` does.",
            "`x[:, rule_action] = ...` goes through the rows and the actions side by side."),
        Mistake(lambda rule_action, p: log_rule(rule_action, 0.9, 0.0125),
            "Your p is always 0.9: use the argument.",
            "p is a constant of the course."),
    ),
    hints=(
        "Begin with a tensor of shape (batch, 9) that holds log((1 - p) / 8) everywhere.",
        "Then write log(p) into one column of each row: the one whose number stands in `rule_action`.",
        "`log_rule.scatter(-1, rule_action.unsqueeze(-1), math.log(p))`",
    ),
    minutes=5, difficulty=1, equation="log π̃(a|s), Section IV-A, Equation of the stochastic rule",
)  # fmt: skip


def log_rule(rule_action, p, others):
    """log p for the rule's action, log `others` for the other eight: (batch,) -> (batch, 9)."""
    is_rule = torch.arange(9) == rule_action.unsqueeze(-1)
    return torch.where(is_rule, math.log(p), math.log(others))


def solution(log_pi, rule_action, p):
    log_rule = torch.full_like(log_pi, math.log((1 - p) / 8))
    log_rule.scatter_(-1, rule_action.unsqueeze(-1), math.log(p))
    return (log_pi.exp() * (log_pi - log_rule)).sum(-1)


def sure(action):
    """log π of a policy that takes one action with probability 1 - 8 e⁻⁴⁰: (1, 9)."""
    return torch.full((1, 9), -40.0).double().scatter(-1, torch.tensor([[action]]), 0.0)


def cases(rng):
    """A policy equal to the rule, one that is uniform, nine states (as many as actions); then 50 at random."""
    three = torch.tensor([3])
    yield log_rule(three, 0.9, 0.0125).double(), three, 0.9
    yield torch.full((2, 9), -math.log(9)).double(), torch.tensor([0, 8]), 0.5
    for size in (9, 1, *rng.integers(1, 5, 50)):
        log_pi = torch.tensor(rng.normal(0, rng.uniform(0.5, 4), (size, 9))).log_softmax(-1)
        yield log_pi, torch.tensor(rng.integers(0, 9, size)), rng.uniform(0.15, 0.99)


soft_constraint = Exercise(
    "soft_constraint(log_pi, rule_action, p)", solution=solution, cases=cases, slopes=(logits("log_pi"),),
    worked=(
        ((sure(5), torch.tensor([3]), 0.9), torch.tensor([math.log(80)])),  # log 1 / (0.1 / 8): 4.4 nats
        ((sure(3), torch.tensor([3]), 0.9), torch.tensor([-math.log(0.9)])),  # in agreement: log 1 / 0.9
    ),
    mistakes=(
        Mistake(lambda log_pi, rule_action, p: bootstrap.kl_from_rule(log_pi, rule_action, torch.tensor(p)),
            "Your KL is the other way round: it is large where the *rule* puts mass and the policy does not. The paper "
            "charges the policy for actions that the rule would not take.",
            "A divergence is a distance, so its order does not matter."),
        Mistake(lambda log_pi, rule_action, p: -(log_pi.exp() * log_rule(rule_action, p, (1 - p) / 8)).sum(-1),
            "This is the cross-entropy: without the policy's own entropy it is not zero where both agree.",
            "The log π part does not depend on the rule, so it can be dropped. Its gradient cannot."),
        Mistake(lambda log_pi, rule_action, p: (log_pi - log_rule(rule_action, p, (1 - p) / 8)).sum(-1),
            "You add up the log-ratios without weighing them: weigh each by π, the probability of its action.",
            "The sum over actions is the expectation."),
        Mistake(lambda log_pi, rule_action, p: (log_pi.exp() * (log_pi - log_rule(rule_action, p, 1 - p))).sum(-1),
            "Your rule's probabilities add up to more than 1: the other eight actions *share* 1 - p.",
            "1 - p is the probability of each other action."),
        Mistake(lambda log_pi, rule_action, p:
            (log_pi.exp() * (log_pi - log_rule(rule_action, p, (1 - p) / 9))).sum(-1),
            "You shared 1 - p among nine actions, but the rule's own action already has p: eight are left.",
            "The noise is uniform over all nine. (Then the rule's own action would have p + (1 - p) / 9.)"),
        Mistake(lambda log_pi, rule_action, p: -solution(log_pi, rule_action, p),
            "Your sign is wrong: a KL divergence is never negative.",
            "The constraint is subtracted in the objective, so the KL has a minus."),
        Mistake(lambda log_pi, rule_action, p: solution(log_pi, rule_action, p) / math.log(2),
            "You measure in bits. The paper's ξ, like every loss here, expects nats: the natural logarithm.",
            "Information is measured in bits."),
        Mistake(lambda log_pi, rule_action, p: solution(log_pi, rule_action, p).mean(),
            "You took the mean over the batch: return one number for each state; the loss takes the mean later.",
            "A loss term is a scalar."),
        Mistake(lambda log_pi, rule_action, p: (log_pi.exp() * (log_pi - one_column_for_all(rule_action, p))).sum(-1),
            "You wrote log p into the same columns of *every* row: `x[:, rule_action]` picks columns for all rows at "
            "once. Pair each row with its own column, as `scatter` or `x[torch.arange(len(x)), rule_action]` does.",
            "`x[:, rule_action] = ...` goes through the rows and the actions side by side."),
        Mistake(lambda log_pi, rule_action, p: solution(log_pi.detach(), rule_action, p),
            "Your KL has the right value but no gradient, so it cannot change the policy: leave out `.detach()`, "
            "`.item()` and NumPy.",
            "A constraint is a number that is only measured."),
    ),
    hints=(
        "Write log π̃ first: an array of the shape of `log_pi` that holds log((1 - p) / 8), and log p in one column.",
        "The KL is an expectation under the *policy*: π times the difference of the logarithms, summed over actions.",
        "`(log_pi.exp() * (log_pi - log_rule)).sum(-1)`",
    ),
    minutes=5, difficulty=2, equation="D_KL(π(·|s) ‖ π̃(·|s)), Section IV-A",
)  # fmt: skip


def policy_cases(rng):
    """ξ = 0 (without the rule), Q all equal, ξ far above α, one state; then 40 at random."""

    def case(size, alpha, xi, scale=2.0):
        q, p = torch.tensor(rng.normal(0, scale, (size, 9))), rng.uniform(0.2, 0.99)
        return q, log_rule(torch.tensor(rng.integers(0, 9, size)), p, (1 - p) / 8).double(), alpha, xi

    yield from (case(3, 0.5, 0.0), case(2, 0.3, 0.7, scale=0.0), case(1, 0.01, 2.0))
    yield from (case(rng.integers(1, 5), rng.uniform(0.2, 2), rng.uniform(0.05, 3)) for _ in range(40))


regularised_policy = Exercise(
    "regularised_policy(q, log_rule, alpha, xi)", solution=bootstrap.regularised_policy, cases=policy_cases,
    worked=(
        # two actions, Q equal: π̃ counts with ξ / (α + ξ) = 1/2, so with the roots of 0.8 and 0.2
        ((torch.zeros(1, 2), torch.tensor([[0.8, 0.2]]).log(), 1.0, 1.0), torch.tensor([[2 / 3, 1 / 3]])),
        # no rule: softmax(Q / α), with e² to 1
        ((torch.tensor([[1.0, 0.0]]), torch.tensor([[0.5, 0.5]]).log(), 0.5, 0.0),
         torch.tensor([[0.880797, 0.119203]])),
    ),
    mistakes=(
        Mistake(lambda q, log_rule, alpha, xi: ((q + xi * log_rule) / alpha).softmax(-1),
            "You divide by α only. The KL contains another entropy, with weight ξ: divide by α + ξ.",
            "The temperature of a softmax is α, as in SAC."),
        Mistake(lambda q, log_rule, alpha, xi: (q / alpha + xi * log_rule).softmax(-1),
            "You divide Q only. Divide both terms, Q and ξ log π̃, by α + ξ.",
            "ξ log π̃ is added to SAC's own logits at the end."),
        Mistake(lambda q, log_rule, alpha, xi: ((q - xi * log_rule) / (alpha + xi)).softmax(-1),
            "Your policy avoids the rule's action. *Add* ξ log π̃: it is negative, and most negative for the other "
            "actions.",
            "The KL is subtracted in the objective, so log π̃ is subtracted, too."),
        Mistake(lambda q, log_rule, alpha, xi: ((q + xi * log_rule.exp()) / (alpha + xi)).softmax(-1),
            "You add ξ π̃. Add ξ times the *logarithm* of the rule's probability.",
            "The rule's probabilities are a bonus on Q."),
        Mistake(lambda q, log_rule, alpha, xi: ((q + xi * log_rule) / (alpha + xi)).log_softmax(-1),
            "You return logarithms. Return the probabilities: each row adds up to 1.",
            "log_softmax is the stable softmax, so it is always the right one."),
        Mistake(lambda q, log_rule, alpha, xi: ((q + xi * log_rule) / (alpha + xi)).softmax(0),
            "You normalise over the states. Each *row* is one policy: the softmax runs over the last axis.",
            "softmax(0) runs over the actions."),
    ),
    hints=(
        "Write out the KL. What multiplies π(a) in the objective, and what multiplies π(a) log π(a)?",
        "π(a) is multiplied by Q + ξ log π̃, and π log π by -(α + ξ): as with α alone, the best π is a softmax.",
        "`((q + xi * log_rule) / (alpha + xi)).softmax(-1)`",
    ),
    minutes=15, difficulty=3, equation="π* = softmax((Q + ξ log π̃) / (α + ξ)), from the objective of Section IV-A",
)  # fmt: skip


def constrained_loss_solution(log_pi, q, alpha, xi, kl):
    value = (log_pi.exp() * (q.detach() - alpha * log_pi)).sum(-1) - xi * kl
    return -value.mean()


def loss_cases(rng):
    """No rule (ξ = 0), no entropy (α = 0), one state; then 30 at random."""
    for size, alpha, xi in ((3, 0.2, 0.0), (3, 0.0, 1.0), (1, 0.1, 2.0), *((n, 0.1, 0.7) for n in range(1, 31))):
        log_pi = torch.tensor(rng.normal(0, 2, (size, 9))).log_softmax(-1)
        q, kl = torch.tensor(rng.normal(0, 3, (size, 9))), torch.tensor(rng.uniform(0, 4, size))
        yield log_pi, q, alpha, xi, kl


constrained_loss = Exercise(
    "constrained_loss(log_pi, q, alpha, xi, kl)",
    solution=constrained_loss_solution, cases=loss_cases, slopes=(logits("log_pi"), "q", "kl"),
    worked=(
        # two actions, half and half: V = (1 + 3)/2 + 0.5 log 2 - 2 · 0.25
        ((torch.full((1, 2), -math.log(2)), torch.tensor([[1.0, 3.0]]), 0.5, 2.0, torch.tensor([0.25])),
         torch.tensor(-(2 + 0.5 * math.log(2) - 0.5))),
    ),
    mistakes=(
        Mistake(lambda log_pi, q, alpha, xi, kl: -((log_pi.exp() * (q - alpha * log_pi)).sum(-1) - xi * kl).mean(),
            "Your value is right, but the gradient flows into Q, too: the actor's step would change the critic. Use "
            "`q.detach()`.",
            "The actor's step cannot change the critic. (Here one optimiser holds both networks.)"),
        Mistake(lambda log_pi, q, alpha, xi, kl: constrained_loss_solution(log_pi, q, alpha, -xi, kl),
            "You reward the actor for leaving the rule: your loss falls as the KL grows. Subtract ξ times the KL from "
            "V.",
            "A penalty is added to V. (The minus of the loss turns it into a reward.)"),
        Mistake(lambda log_pi, q, alpha, xi, kl: constrained_loss_solution(log_pi, q, alpha, xi, kl.detach()),
            "Your KL has no gradient, so it does not change the actor. Detach Q, not the KL.",
            "Everything that is not π is detached in the actor's loss."),
        Mistake(lambda log_pi, q, alpha, xi, kl: -constrained_loss_solution(log_pi, q, alpha, xi, kl),
            "This is the value, and training would make it *small*. A loss is minimised: return -V.",
            "The objective is maximised, and a loss is the objective."),
        Mistake(lambda log_pi, q, alpha, xi, kl: constrained_loss_solution(log_pi, q, alpha, 1.0, kl),
            "Your KL has no weight: multiply it by ξ.",
            "A KL in nats is already on the reward's scale."),
        Mistake(lambda log_pi, q, alpha, xi, kl: constrained_loss_solution(log_pi, q, -alpha, xi, kl),
            "You penalise entropy: H is *minus* the sum of π log π, so α log π is subtracted from Q.",
            "Entropy is the sum of π log π."),
    ),
    hints=(
        "Write V of each state first: the expectation of Q - α log π under π, minus ξ times its KL.",
        "The loss is minus the mean of V. Which of `q` and `kl` may not receive a gradient?",
        "`-((log_pi.exp() * (q.detach() - alpha * log_pi)).sum(-1) - xi * kl).mean()`",
    ),
    minutes=8, difficulty=2, equation="-E_s[Σ_a π (Q - α log π) - ξ D_KL], Section IV-A",
)  # fmt: skip


def constrained_target_solution(reward, terminated, next_log_pi, next_q_pair, next_kl, alpha, xi, gamma):
    next_q = next_q_pair.amin(0)
    value = (next_log_pi.exp() * (next_q - alpha * next_log_pi)).sum(-1) - xi * next_kl
    return reward + gamma * (1 - terminated) * value


def target_cases(rng):
    """All ended, none ended, ξ = 0, α = 0, one state, nine states; then 40 at random."""

    def case(size, ended=0.4, alpha=None, xi=None):
        log_pi = torch.tensor(rng.normal(0, 1.5, (size, 9))).log_softmax(-1)
        numbers = torch.tensor(rng.normal(0, 3, size)), torch.tensor(rng.random(size) < ended).double()
        q_pair, kl = torch.tensor(rng.normal(0, 3, (2, size, 9))), torch.tensor(rng.uniform(0, 4, size))
        alpha, xi = rng.uniform(0.05, 1) if alpha is None else alpha, rng.uniform(0.1, 2) if xi is None else xi
        return *numbers, log_pi, q_pair, kl, alpha, xi, rng.uniform(0.5, 0.99)

    yield from (case(4, ended=1.0), case(4, ended=0.0), case(3, xi=0.0), case(3, alpha=0.0), case(1, ended=0.0))
    yield case(9)
    for _ in range(40):
        yield case(rng.integers(2, 7))


def target_with(value):
    """A target that computes the next state's value otherwise: value(log_pi, q_pair, kl, alpha, xi)."""

    def target(reward, terminated, log_pi, q_pair, kl, alpha, xi, gamma):
        return reward + gamma * (1 - terminated) * value(log_pi, q_pair, kl, alpha, xi)

    return target


def soft(log_pi, q, alpha):
    return (log_pi.exp() * (q - alpha * log_pi)).sum(-1)


EVEN = torch.full((2, 9), -math.log(9))
Q_PAIR = torch.tensor([[2.0] * 4 + [9.0] * 5, [5.0] * 4 + [2.0] * 5])[:, None].expand(2, 2, 9)
constrained_target = Exercise(
    "constrained_target(reward, terminated, next_log_pi, next_q_pair, next_kl, alpha, xi, gamma)",
    solution=constrained_target_solution, cases=target_cases,
    worked=(
        # all actions alike, min Q = 2: V = 2 + 0.5 log 9 - 2 · 0.25; it goes on: 1 + 0.8 V; it ended: -10
        ((torch.tensor([1.0, -10.0]), torch.tensor([0.0, 1.0]), EVEN, Q_PAIR, torch.tensor([0.25, 0.25]),
          0.5, 2.0, 0.8),
         torch.tensor([1 + 0.8 * (1.5 + 0.5 * math.log(9)), -10.0])),
    ),
    mistakes=(
        Mistake(target_with(lambda log_pi, q, kl, alpha, xi: soft(log_pi, q.amin(0), alpha)),
            "Your target has no KL: the critic would price every future as if the rule did not exist.",
            "The KL belongs in the actor's loss only."),
        Mistake(target_with(lambda log_pi, q, kl, alpha, xi: soft(log_pi, q.amin(0), alpha) + xi * kl),
            "Your target rewards leaving the rule: a large KL makes the next state's value *smaller*.",
            "A penalty is added, as in a loss."),
        Mistake(target_with(lambda log_pi, q, kl, alpha, xi: soft(log_pi, q.amin(0), alpha) - kl),
            "Your KL has no weight: multiply it by ξ.",
            "A KL in nats is already on the reward's scale."),
        Mistake(target_with(lambda log_pi, q, kl, alpha, xi: soft(log_pi, q.amax(0), alpha) - xi * kl),
            "You take the larger of the two critics. The smaller one keeps the estimates from growing without limit.",
            "The best estimate is the highest."),
        Mistake(target_with(lambda log_pi, q, kl, alpha, xi: soft(log_pi, q.mean(0), alpha) - xi * kl),
            "You take the mean of the two critics: here it is the smaller of the two, for each action.",
            "Two estimates are averaged."),
        Mistake(target_with(lambda log_pi, q, kl, alpha, xi:
            torch.minimum(soft(log_pi, q[0], alpha), soft(log_pi, q[1], alpha)) - xi * kl),
            "You take the smaller of two values of the state. Take the smaller Q of *each action*, then the mean "
            "under π.",
            "The order of minimum and mean does not matter."),
        Mistake(lambda r, ended, log_pi, q, kl, alpha, xi, gamma:
            r + gamma * (1 - ended) * soft(log_pi, q.amin(0), alpha) - xi * kl,
            "Your KL stands outside the value of s': it is charged after an accident, too, and is not discounted. It "
            "is part of V(s').",
            "The KL is subtracted from the reward of this second. (That KL is of s, before the action.)"),
        Mistake(lambda reward, terminated, *rest: constrained_target_solution(reward, 0 * terminated, *rest),
            "Your target adds a future after the accident. Where an episode ended, the target is the reward alone.",
            "The mask makes no difference on average. (It does: -10 plus a high V' is no warning.)"),
        Mistake(target_with(lambda log_pi, q, kl, alpha, xi: (log_pi.exp() * q.amin(0)).sum(-1) - xi * kl),
            "Your value has no entropy: add α H(π(·|s')).",
            "The KL replaces the entropy. (It contains one, with the weight ξ; α's comes on top.)"),
        Mistake(target_with(lambda log_pi, q, kl, alpha, xi: soft(log_pi, q.amin(0), -alpha) - xi * kl),
            "You penalise entropy: H is *minus* the sum of π log π, so α log π is subtracted from Q.",
            "Entropy is the sum of π log π."),
    ),
    hints=(
        "What is the value of s' if each second pays r + α H - ξ KL? Which of these terms belong to s, which to s'?",
        "The soft value of s' as in lesson 4, of the smaller Q (`next_q_pair.amin(0)`), minus ξ times `next_kl`.",
        "`value = (next_log_pi.exp() * (next_q - alpha * next_log_pi)).sum(-1) - xi * next_kl`",
    ),
    minutes=20, difficulty=3, equation="y = r + γ (1 - terminated) (V(s') - ξ D_KL(s')), from Equation 15",
)  # fmt: skip
