"""The exercises of the lesson on the soft constraint in which the KL enters the two losses."""

import math

import torch

from bootcourse.lessons.exercise import Exercise, Mistake


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
    solution=constrained_loss_solution, cases=loss_cases, slopes=("log_pi", "q", "kl"),
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
