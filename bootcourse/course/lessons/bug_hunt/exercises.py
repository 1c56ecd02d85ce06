"""Exercises of the bug hunt."""

import math

import numpy as np
import torch

from bootcourse.course.exercise import Exercise, Mistake, logits
from bootcourse.course.lessons.bug_hunt import target_probe
from bootcourse.course.lessons.bug_hunt.target_probe import standard_target


def end_error_solution(q, actions, rewards, terminated):
    taken = q[np.arange(len(actions)), actions]
    ended = terminated > 0
    if not ended.any():
        return 0.0
    return (taken[ended] - rewards[ended]).mean()


def of_rows(q, actions, rewards, terminated, q_of=None, over=None):
    """The probe with another Q of each row, or another divisor."""
    ended = terminated > 0
    taken = q[np.arange(len(actions)), actions] if q_of is None else q_of(q)
    return float((taken - rewards)[ended].sum() / max(1, ended.sum() if over is None else over(ended)))


def end_cases(rng):
    """No accident at all, only accidents, one row; then 40 at random, half of them on a road with other rewards."""
    shares = [0.0, 1.0, 1.0, *rng.uniform(0.2, 0.8, 40)]
    for number, share in enumerate(shares):
        n = 1 if number == 2 else rng.integers(3, 9)
        terminated = (rng.random(n) < share).astype(float)
        rewards = rng.uniform(-10, 5, n) if number % 2 else np.where(terminated > 0, -10.0, rng.uniform(0, 1, n))
        yield rng.normal(-10, 6, (n, 9)), rng.integers(0, 9, n), rewards, terminated


end_error = Exercise(
    "end_error(q, actions, rewards, terminated)", solution=end_error_solution, cases=end_cases,
    worked=(
        # two accidents: Q(s, a) is -8 and -9, both should be -10; the third row goes on
        ((np.array([[-8.0] + [0] * 8, [5, -9] + [5] * 7, range(9)]), np.array([0, 1, 2]), np.array([-10.0, -10, 0.5]),
          np.array([1.0, 1, 0])),
         1.5),
        ((np.array([[4.0, 2.0] + [1] * 7]), np.array([1]), np.array([0.3]), np.array([0.0])), 0.0),
    ),
    mistakes=(
        Mistake(lambda q, actions, rewards, terminated: float((q[np.arange(len(actions)), actions] - rewards).mean()),
            "You use every row. The right Q is known exactly only where the episode ended: it is r.",
            "More rows make a better mean."),
        Mistake(lambda *a: of_rows(*a, q_of=lambda q: q.max(-1)),
            "You take the best action's Q. The accident followed the action that was *taken*: pick that one.",
            "A critic gives the value of a state."),
        Mistake(lambda *a: of_rows(*a, over=len),
            "You divide by the number of rows. Divide by the number of accidents among them.",
            "A mean divides by the size of the batch."),
        Mistake(lambda *a: -of_rows(*a),
            "Your sign is wrong: a Q that is too high should give a positive error.",
            "An error is target minus estimate."),
        Mistake(lambda *a: of_rows(*a, q_of=lambda q: q.mean(-1)),
            "You average over the nine actions. Only one of them was taken.",
            "All nine actions count."),
    ),
    hints=(
        "Where an episode ended there is no next state: y = r, without any network.",
        "`q[np.arange(len(actions)), actions]` is the Q of the action taken in each row.",
        "Keep the rows with `terminated > 0`; if there are none, return 0.",
    ),
    minutes=6, difficulty=2, equation="mean of Q(s, a) - r over the decisions that ended an episode",
)  # fmt: skip

BUGS = ("flipped_kl", "no_end", "sampled", "no_stop", "bonus_for_all", "shifted_labels")


def diagnose_solution(agent):
    bugs = {
        "A": "flipped_kl",
        "B": "sampled",
        "C": "shifted_labels",
        "D": "no_end",
        "E": "bonus_for_all",
        "F": "no_stop",
    }
    return bugs[agent]


def explain_hunt(cases, answers):
    """That not all verdicts are right; neither how many nor which, so that guessing does not help."""
    unknown = [answer for answer in answers if answer not in BUGS]
    if unknown:
        return f"Your function returns {str(unknown[0])[:40]!r}: the six names are {', '.join(BUGS)}."
    if {agent: answer for (agent,), answer in zip(cases, answers, strict=True)} == {
        a: diagnose_solution(a) for a in "ABCDEF"
    }:
        return "Your function answers the same question differently each time: it must not draw at random or remember."
    return (
        "Not all six verdicts are right. Write beside each the picture that shows it; the one without a picture is the "
        "one to doubt."
    )


def renamed(**others):
    """The right verdicts, except on some agents."""
    return lambda agent: others.get(agent) or diagnose_solution(agent)


diagnose = Exercise(
    "diagnose(agent)", solution=diagnose_solution,
    cases=lambda rng: [(letter,) for _ in range(4) for letter in rng.permutation(list("ABCDEF")).tolist()],
    explain=explain_hunt,
    worked=((("A",), "flipped_kl"), (("F",), "no_stop")),
    mistakes=(
        Mistake(renamed(A="shifted_labels", C="flipped_kl"),
            "You swapped the two agents whose bug concerns the rule. One starts slowly, between what the "
            "rule does now and what it does one second later; the other keeps its rarest action likely.",
            "All bugs of the KL look the same."),
        Mistake(renamed(D="bonus_for_all", E="no_end"),
            "You swapped two agents whose critics are wrong: one critic is wrong everywhere by about the "
            "same amount, the other only where episodes end.",
            "All wrong critics look the same."),
        Mistake(renamed(B="no_stop", F="sampled"),
            "You swapped the two that drive worst: one promises more than any possible return; the other "
            "has a modest promise and a high entropy.",
            "The driving alone shows the bug."),
    ),
    hints=(
        "Begin with the two that drive badly, then look for a promise that is too high, then at where episodes end.",
        "What each bug shows: without an end, Q is wrong by many points where episodes end; with a drawn value Q does "
        "not reach the actor, so the entropy stays near the stochastic rule's; without the stop-gradient the promise "
        "grows far beyond any return; a bonus for all adds about c / (1 - γ) to it.",
        "The last two drive like the healthy agent. Compare `alike` with `late` at the first updates (shifted labels), "
        "then `rarest` (a flipped KL keeps every action a little likely).",
    ),
    minutes=15, difficulty=3, equation="six bugs, six agents",
)  # fmt: skip


def target_cases(rng):
    """Nothing special, all demonstrations, all terminated, no bonus; then 40 at random."""
    kinds = [(0, 0, 2.0), (1, 0, 2.0), (0, 1, 2.0), (1, 1, 0.0)]
    for number in range(44):
        n = rng.integers(2, 6)
        demos, ended, bonus = kinds[number] if number < 4 else (None, None, rng.uniform(0.5, 3))
        is_demonstration = torch.tensor(rng.integers(0, 2, n) if demos is None else np.full(n, demos)).double()
        terminated = torch.tensor(rng.integers(0, 2, n) if ended is None else np.full(n, ended)).double()
        reward, value = torch.tensor(rng.uniform(-10, 1, n)), torch.tensor(rng.uniform(1, 6, n))
        yield reward, is_demonstration, bonus, terminated, value, rng.uniform(0.7, 0.99)


fixed_target = Exercise(
    "fixed_target(reward, is_demonstration, bonus, terminated, next_value, gamma)",
    solution=standard_target, cases=target_cases,
    worked=(
        ((torch.tensor([1.0, 1.0, -10.0]), torch.tensor([0.0, 1.0, 0.0]), 2.0, torch.tensor([0.0, 0.0, 1.0]),
          torch.tensor([5.0, 5.0, 5.0]), 0.8),
         torch.tensor([5.0, 7.0, -10.0])),
    ),
    mistakes=(
        Mistake(lambda r, d, c, t, v, g: r + c + g * v,
            "Both bugs are still there: every transition gets the bonus, and the target adds a future after an "
            "accident.",
            "The code runs, so it is right."),
        Mistake(lambda r, d, c, t, v, g: r + c * d + g * v,
            "The bonus is right. But after an accident you still add the value of the next state.",
            "The -10 is enough for an accident."),
        Mistake(lambda r, d, c, t, v, g: r + c + g * (1 - t) * v,
            "The mask is right. But the agent's own driving still gets the bonus of a demonstration.",
            "A constant added to every reward changes nothing."),
        Mistake(lambda r, d, c, t, v, g: r + c * d + g * t * v,
            "Your mask is inverted: `terminated` is 1 where the episode is over, so multiply by 1 - terminated.",
            "`terminated` is 1 while the episode goes on."),
        Mistake(lambda r, d, c, t, v, g: (r + c * d) * (1 - t) + g * (1 - t) * v,
            "You mask the reward as well: the -10 of an accident vanishes. Mask the future only.",
            "The last transition does not count."),
    ),
    hints=(
        "Two of the six arguments are never used in the code above. Which?",
        "The bonus is multiplied by `is_demonstration`, the future by `1 - terminated`.",
        "`reward + bonus * is_demonstration + gamma * (1 - terminated) * next_value`",
    ),
    minutes=4, difficulty=1, equation="y = r + c [demonstration] + γ (1 - terminated) V(s')",
)  # fmt: skip

unmasks = target_probe.unmasks


def fixed_value_solution(log_pi, q, alpha):
    return (log_pi.exp() * (q - alpha * log_pi)).sum(-1)


def value_cases(rng):
    """α = 0, one state, an even policy, nine states; then 40 at random."""
    for number in range(44):
        n, alpha = {0: (3, 0.0), 1: (1, 0.2), 3: (9, 0.3)}.get(number, (rng.integers(2, 6), rng.uniform(0.01, 1)))
        logits = torch.tensor(rng.normal(0, 0.0 if number == 2 else 2.0, (n, 9)))
        yield logits.log_softmax(-1), torch.tensor(rng.normal(0, 3, (n, 9))), alpha


EVEN = torch.full((1, 9), -math.log(9))
ONE_TO_NINE = torch.arange(1.0, 10.0)[None]

fixed_value = Exercise(
    "fixed_value(log_pi, q, alpha)", solution=fixed_value_solution, cases=value_cases, slopes=(logits("log_pi"),),
    worked=(
        # nine actions, all alike: (1 + 2 + ... + 9) / 9 + 0.5 log 9
        ((EVEN, ONE_TO_NINE, 0.5), torch.tensor([5 + 0.5 * math.log(9)])),
    ),
    mistakes=(
        Mistake(lambda log_pi, q, alpha: (q - alpha * log_pi).gather(-1, log_pi.argmax(-1, keepdim=True)).squeeze(-1),
            "You use the most probable action only. All nine count, each with its probability π.",
            "The policy takes its most probable action, so the state has the value of that action."),
        Mistake(lambda log_pi, q, alpha: (q - alpha * log_pi).mean(-1),
            "You give the nine actions the same weight. Weigh each by its probability, `log_pi.exp()`.",
            "The expectation is the mean over actions."),
        Mistake(lambda log_pi, q, alpha: (log_pi.exp() * (q + alpha * log_pi)).sum(-1),
            "You penalise entropy: log π is negative, so -α log π is a bonus.",
            "Entropy is added, so α log π is."),
        Mistake(lambda log_pi, q, alpha: (log_pi.exp() * q).sum(-1),
            "Your value has no entropy term: -α log π is missing.",
            "The value of a state is the mean of Q."),
        Mistake(lambda log_pi, q, alpha: (log_pi * (q - alpha * log_pi)).sum(-1),
            "You weigh by log π. The weights are probabilities: `log_pi.exp()`.",
            "log_pi is the policy."),
    ),
    hints=(
        "With nine actions no sample is needed: add up over all of them.",
        "Each action contributes its probability times (Q - α log π).",
        "`(log_pi.exp() * (q - alpha * log_pi)).sum(-1)`",
    ),
    minutes=4, difficulty=1, equation="V(s) = Σ_a π (Q - α log π), nothing sampled",
)  # fmt: skip


def fixed_loss_solution(log_pi, q, log_rule, alpha, xi):
    pi = log_pi.exp()
    kl = (pi * (log_pi - log_rule)).sum(-1)
    value = (pi * (q.detach() - alpha * log_pi)).sum(-1) - xi * kl
    return -value.mean()


def loss_of(log_pi, q, log_rule, alpha, xi, flipped=False):
    pi, rule = log_pi.exp(), log_rule.exp()
    kl = (rule * (log_rule - log_pi)).sum(-1) if flipped else (pi * (log_pi - log_rule)).sum(-1)
    return -((pi * (q - alpha * log_pi)).sum(-1) - xi * kl).mean()


def loss_cases(rng):
    """No rule (ξ = 0), no entropy (α = 0), one state; then 40 at random."""
    for size, alpha, xi in ((3, 0.2, 0.0), (3, 0.0, 1.0), (1, 0.1, 2.0), *((n, 0.1, 0.7) for n in range(1, 41))):
        log_pi = torch.tensor(rng.normal(0, 2, (min(size, 6), 9))).log_softmax(-1)
        rule = torch.full(log_pi.shape, 0.0125).double()
        rule[torch.arange(len(rule)), torch.tensor(rng.integers(0, 9, len(rule)))] = 0.9
        yield log_pi, torch.tensor(rng.normal(0, 3, log_pi.shape)), rule.log(), alpha, xi


fixed_loss = Exercise(
    "fixed_loss(log_pi, q, log_rule, alpha, xi)",
    solution=fixed_loss_solution, cases=loss_cases, slopes=(logits("log_pi"), "q"),
    worked=(
        # π even, Q = 1 to 9, π̃ = π, α = 0.5, ξ = 1: V = 5 + 0.5 log 9; slopes in the logits: -π (Q - 5)
        ((EVEN, ONE_TO_NINE, EVEN, 0.5, 1.0),
         (torch.tensor(-(5 + 0.5 * math.log(9))), (5 - ONE_TO_NINE) / 9, torch.zeros(1, 9))),
    ),
    mistakes=(
        Mistake(lambda log_pi, q, log_rule, alpha, xi: loss_of(log_pi, q, log_rule, alpha, xi, flipped=True),
            "Both bugs are still there: the gradient flows into Q, and the KL is the other way round.",
            "The code runs, so it is right."),
        Mistake(loss_of,
            "The KL is right. But a gradient still flows into Q: the actor's step would change the critic.",
            "The value of the loss is what counts."),
        Mistake(lambda log_pi, q, log_rule, alpha, xi: loss_of(log_pi, q.detach(), log_rule, alpha, xi, True),
            "The stop-gradient is right. But your KL is weighed by the rule: it has to be weighed by π.",
            "A divergence is symmetric."),
        Mistake(lambda log_pi, q, log_rule, alpha, xi: loss_of(log_pi.detach(), q, log_rule, alpha, xi),
            "You detached the policy, which this loss should change. Detach Q.",
            "It does not matter which of the two is detached."),
        Mistake(lambda log_pi, q, log_rule, alpha, xi: loss_of(log_pi, q.detach(), log_rule, alpha, -xi),
            "You reward leaving the rule: subtract ξ times the KL from the value; the loss is minus the value.",
            "A penalty is added to V. (The minus of the loss turns it into a reward.)"),
    ),
    hints=(
        "Which of the two networks may this loss change?",
        "`q.detach()`; and the KL is weighed by π: `(pi * (log_pi - log_rule)).sum(-1)`.",
        "`-((pi * (q.detach() - alpha * log_pi)).sum(-1) - xi * kl).mean()`",
    ),
    minutes=6, difficulty=2, equation="-E[Σ π (Q - α log π) - ξ D_KL(π ‖ π̃)], Q held fixed",
)  # fmt: skip


def label_pairs_solution(asked):
    return np.stack([asked[:-1], asked[1:]], axis=-1)


label_pairs = Exercise(
    "label_pairs(asked)", solution=label_pairs_solution,
    cases=lambda rng: [(rng.integers(0, 9, n),) for n in (2, 9, 10, *rng.integers(3, 12, 30))],
    worked=(((np.array([4, 1, 0, 7]),), np.array([[4, 1], [1, 0], [0, 7]])), ((np.array([2, 5]),), np.array([[2, 5]]))),
    mistakes=(
        Mistake(lambda asked: np.stack([asked[1:], np.append(asked[2:], asked[-1])], axis=-1),
            "The bug is still there: the first label of each pair belongs to the state one second later.",
            "The rule's answer after a step is the label of that step."),
        Mistake(lambda asked: np.stack([asked[1:], asked[:-1]], axis=-1),
            "Your columns are swapped: first μ(s), then μ(s').",
            "The newer label comes first."),
        Mistake(lambda asked: np.stack([asked[:-1], asked[:-1]], axis=-1),
            "Your two labels are the same: s' is the next state, and has the next label.",
            "One decision, one label."),
        Mistake(lambda asked: np.stack([asked, np.append(asked[1:], asked[-1])], axis=-1),
            "You have one pair too many: T + 1 states make T decisions, and there is no decision in the last state.",
            "Every state gets a row."),
    ),
    hints=(
        "Decision t leads from state t to state t + 1.",
        "`asked[:-1]` are the labels of the states in which a decision was made.",
        "`np.stack([asked[:-1], asked[1:]], axis=-1)`",
    ),
    minutes=4, difficulty=1, equation="(μ(s_t), μ(s_t+1)) for each decision t",
)  # fmt: skip
