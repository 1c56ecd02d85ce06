"""Exercises of the lesson beyond the paper: what RLPD, IBRL and jump-start RL take from a teacher; a safe driver."""

import numpy as np
import torch

from bootcourse.course.exercise import Exercise, Mistake
from bootcourse.learn import ibrl


def ensemble_cases(rng):
    """Two of five critics, one of them, all, the same critic lowest everywhere; then 20 at random."""
    five = torch.tensor(rng.normal(0, 2, (5, 4, 9)))
    for chosen in ([1, 4], [3], [4, 0, 1, 2, 3]):
        yield five, torch.tensor(chosen)
    yield torch.cat([five[:2] + 10, five[2:] - 10]), torch.tensor([0, 1])
    for _ in range(20):
        critics = rng.integers(2, 8)
        chosen = rng.choice(critics, rng.integers(1, critics + 1), replace=False)
        yield torch.tensor(rng.normal(0, 2, (critics, rng.integers(1, 6), 9))), torch.tensor(chosen)


def smallest(q, chosen):
    """The lowest value of the chosen critics for each action."""
    return q[chosen].amin(0)


THREE = torch.tensor([[[1.0, 5.0]], [[2.0, 3.0]], [[0.0, 9.0]]])  # three critics, one state, two actions
smallest_of = Exercise(
    "smallest_of(q, chosen)", solution=smallest, cases=ensemble_cases,
    worked=(
        ((THREE, torch.tensor([0, 1])), torch.tensor([[1.0, 3.0]])),  # the third critic is not asked
        ((THREE, torch.tensor([2])), torch.tensor([[0.0, 9.0]])),
    ),
    mistakes=(
        Mistake(lambda q, chosen: q.amin(0),
            "You ask all critics. The target asks the chosen ones alone: the smallest of all five would be too low in "
            "most states.",
            "More critics make a safer target."),
        Mistake(lambda q, chosen: q[chosen].mean(0),
            "You take the mean of the chosen critics. Their mean does not keep the largest guesses out of the target: "
            "take the smallest.",
            "The mean of an ensemble is its best guess."),
        Mistake(lambda q, chosen: q[chosen].amax(0),
            "You take the largest value, so each target contains the most hopeful guess. Take the smallest.",
            "A value is what can be reached at best."),
        Mistake(lambda q, chosen: q[chosen].amin(-1),
            "You take the smallest value over the *actions*, in the last axis. The critics stand in the first one.",
            "amin(-1) is over the critics."),
        Mistake(lambda q, chosen: q[: len(chosen)].amin(0),
            "You ask the first critics instead of the chosen ones: `chosen` holds their numbers.",
            "k critics are the first k."),
        Mistake(lambda q, chosen: q[chosen].mean(-1).argmin(0),
            "This is the number of a critic. Return values, for each state and action: (batch, 9).",
            "One critic is the smallest everywhere."),
    ),
    hints=(
        "First the chosen critics, (k, batch, 9), then the smallest value over the first axis.",
        "A tensor of whole numbers picks rows: `q[chosen]`.",
        "`q[chosen].amin(0)`",
    ),
    minutes=4, difficulty=1,
    equation="min over Z of Q_i(s', a'), Z: k critics drawn for this update, arXiv 2302.02948, Algorithm 1",
)  # fmt: skip


def two_cases(rng):
    """The rule best, the rule worst, in the middle, no chance for the better ones; then 30 at random."""
    q = torch.arange(9.0, dtype=torch.float64)[None]
    even = torch.full((1, 9), 1 / 9, dtype=torch.float64)
    for action in (8, 0, 4):
        yield even, q, torch.tensor([action])
    yield torch.tensor([[0.5, 0.5, 0, 0, 0, 0, 0, 0, 0]], dtype=torch.float64), q, torch.tensor([3])
    for _ in range(30):
        n = rng.integers(1, 7)
        pi = torch.tensor(rng.normal(0, 2, (n, 9))).softmax(-1)
        yield pi, torch.tensor(rng.normal(0, 2, (n, 9))), torch.tensor(rng.integers(0, 9, n))


def better(pi, q, rule_actions):
    """IBRL's distribution: an own action above the rule's keeps its probability, the rest goes to the rule's."""
    taken = pi * (q > q.gather(-1, rule_actions[:, None]))
    return taken.scatter_add(-1, rule_actions[:, None], 1 - taken.sum(-1, keepdim=True))


def one_hot(actions, pi):
    return torch.nn.functional.one_hot(actions, pi.shape[-1]).to(pi)


def above(q, rule_actions):
    """Which actions are valued above the rule's, as numbers 0 and 1."""
    return (ibrl.advantage(q, rule_actions) > 0).to(q)


PI, Q = torch.tensor([[0.5, 0.3, 0.2]]), torch.tensor([[1.0, 2.0, 3.0]])
better_of_two = Exercise(
    "better_of_two(pi, q, rule_actions)", solution=better, cases=two_cases,
    worked=(
        # the rule takes the second action: an own third is better and keeps 0.2; an own first gives way, 0.5 + 0.3
        ((PI, Q, torch.tensor([1])), torch.tensor([[0.0, 0.8, 0.2]])),
        ((PI, Q, torch.tensor([2])), torch.tensor([[0.0, 0.0, 1.0]])),  # nothing is better than the rule's
        ((PI, Q, torch.tensor([0])), torch.tensor([[0.5, 0.3, 0.2]])),  # all others are
    ),
    mistakes=(
        Mistake(lambda pi, q, rule_actions: one_hot(q.argmax(-1), pi),
            "You take the best of all nine actions. The choice is between two: the rule's action, and one that the "
            "agent draws from π.",
            "The better one is the one with the highest Q."),
        Mistake(lambda pi, q, rule_actions: pi * above(q, rule_actions),
            "Your probabilities do not add up to 1: where the agent's own action is not better, the rule's is taken.",
            "What is worse is left out."),
        Mistake(lambda pi, q, rule_actions: (lambda kept: kept / kept.sum(-1, keepdim=True).clamp_min(1e-12))(
                    pi * above(q, rule_actions) + one_hot(rule_actions, pi) * pi),
            "You share what is left over among all actions that remain. If a worse action is drawn, the rule's is "
            "taken instead: all of it goes to μ(s).",
            "A distribution is normalised at the end."),
        Mistake(lambda pi, q, rule_actions: better(pi, -q, rule_actions),
            "You keep the own actions that are valued *below* the rule's.",
            "The comparison is the other way round."),
        Mistake(lambda pi, q, rule_actions: one_hot(torch.where(
                    (pi * q).sum(-1) > q.gather(-1, rule_actions[:, None])[:, 0], pi.argmax(-1), rule_actions), pi),
            "You decide once for each state, by the mean value of π. The choice is made for the action that was drawn: "
            "each of the nine is compared with the rule's.",
            "π has one value in a state."),
        Mistake(lambda pi, q, rule_actions: torch.where(above(q, rule_actions).sum(-1, keepdim=True) > 0, pi,
                    one_hot(rule_actions, pi)),
            "Where one action is better than the rule's, you follow π altogether. The own actions that are worse still "
            "give way to the rule's.",
            "One better action is enough to trust π."),
        Mistake(lambda pi, q, rule_actions: pi,
            "This is π: the rule never has a say.",
            "An agent follows its policy."),
    ),
    hints=(
        "Go through the nine actions that π may draw: which of them stay as they are, and what happens to the others?",
        "What stays is `pi * (q > q_rule)`, with `q_rule = q.gather(-1, rule_actions[:, None])`. What is missing to 1 "
        "goes to the rule's action.",
        "`taken.scatter_add(-1, rule_actions[:, None], 1 - taken.sum(-1, keepdim=True))`",
    ),
    minutes=12, difficulty=3,
    equation="argmax of Q over {μ(s), a}, a ~ π, as a distribution, arXiv 2311.02198",
)  # fmt: skip


def curriculum_cases(rng):
    """Too few returns, just as good, a little worse, one bad, better, negative ones, the first; then 40 at random."""
    yield [50.0, 50.0], 50.0, 3, 0.05
    yield [50.0, 50.0, 50.0], 50.0, 3, 0.05
    yield [49.0, 50.0, 51.0], 50.0, 3, 0.0
    yield from (([mean, mean, mean], 50.0, 3, 0.05) for mean in (48.0, 47.0))
    yield [52.0, 0.0, 53.0], 50.0, 3, 0.05
    yield [0.0, 60.0, 60.0, 60.0], 50.0, 3, 0.0
    yield [90.0, 10.0, 10.0, 10.0], 25.0, 3, 0.05
    yield from (([mean, mean], -10.0, 2, 0.05) for mean in (-10.2, -12.0, -9.0))
    yield [5.0, 7.0], -np.inf, 2, 0.1
    for _ in range(40):
        window = rng.integers(1, 5)
        returns = rng.normal(0, 10, rng.integers(0, 9)).tolist()
        yield returns, rng.normal(0, 8), window, rng.choice([0.0, 0.05, 0.3])


def shrinks(returns, best, window, tolerance):
    """Are there enough returns, and does the mean of the last ones hold?"""
    enough = len(returns) >= window
    return enough and np.mean(returns[-window:]) >= best - tolerance * abs(best)


def holds(mean, best, tolerance):
    return mean >= best - tolerance * abs(best)


def shrinks_with(holds=holds, judged=lambda returns, window: returns[-window:]):
    """The solution with another comparison, or the mean of other returns."""

    def answer(returns, best, window, tolerance):
        return bool(len(returns) >= window and holds(np.mean(judged(returns, window)), best, tolerance))

    return answer


guide_shrinks = Exercise(
    "guide_shrinks(returns, best, window, tolerance)", solution=shrinks, cases=curriculum_cases,
    worked=(
        (([40.0, 50.0, 60.0], 52.0, 2, 0.0), True),  # the last two: 55
        (([40.0, 50.0, 60.0], 52.0, 3, 0.05), True),  # 50 is above 52 - 2.6
        (([40.0, 50.0, 60.0], 52.0, 3, 0.01), False),  # and below 52 - 0.52
        (([40.0], 10.0, 2, 0.0), False),  # one return is no window of two
        (([-10.5], -10.0, 1, 0.1), True),  # above -10 - 1
    ),
    mistakes=(
        Mistake(lambda returns, best, window, tolerance: holds(np.mean(returns[-window:] or [-1e9]), best, tolerance),
            "You judge before there are enough returns: with fewer than `window` of them h stays.",
            "A mean of fewer returns is a mean, too."),
        Mistake(shrinks_with(judged=lambda returns, window: returns),
            "You take the mean of all returns. The last `window` of them say how good the two are now.",
            "More returns, a better mean."),
        Mistake(shrinks_with(lambda mean, best, tolerance: mean >= best * (1 - tolerance)),
            "With a negative best, best · (1 - tolerance) lies *above* the best. Use the size of the best: "
            "best - tolerance · |best|.",
            "5 % less is 0.95 times."),
        Mistake(shrinks_with(lambda mean, best, tolerance: mean > best),
            "You ask for a new best mean. It may lie below the best by the tolerance.",
            "The guide leaves when things get better."),
        Mistake(shrinks_with(lambda mean, best, tolerance: mean >= best - tolerance),
            "The tolerance is a share of the best, not a return: subtract tolerance · |best|.",
            "0.05 is 0.05 points."),
        Mistake(shrinks_with(lambda *case: not holds(*case)),
            "This is the other way round: h would shrink where the return has fallen.",
            "A falling return means that the guide is in the way."),
        Mistake(shrinks_with(judged=lambda returns, window: returns[:window]),
            "You take the first `window` returns. The last ones say how good the two are now.",
            "A window begins at the beginning."),
    ),
    hints=(
        "Three steps: enough returns? The mean of the last `window`? Is it high enough?",
        "High enough: at least best - tolerance · |best|. The best may be negative, or minus infinity at first.",
        "`len(returns) >= window and np.mean(returns[-window:]) >= best - tolerance * abs(best)`",
    ),
    minutes=6, difficulty=2,
    equation="R(h) ≥ R_best - β |R_best|, the moving average of arXiv 2204.02372, Algorithm 1",
)  # fmt: skip


def price_cases(rng):
    """Too many accidents, few, none at a price of 0, no rate yet, no step, just on budget; then 30 at random."""
    yield from ((1.0, 0.03, 0.01, 10.0), (1.0, 0.0, 0.01, 10.0), (0.0, 0.0, 0.01, 10.0), (0.05, 0.0, 0.1, 2.0))
    yield from ((0.7, float("nan"), 0.01, 10.0), (2.0, 0.5, 0.01, 0.0), (3.0, 0.25, 0.25, 4.0))
    for _ in range(30):
        rate = rng.choice([rng.random(), 0.0, np.nan], p=[0.7, 0.2, 0.1])
        yield rng.exponential(1.0), rate, rng.random(), rng.exponential(3.0)


def next_price(multiplier, rate, budget, step):
    """λ after one round: up with the accidents beyond the budget, down to 0 at least without them."""
    return multiplier if np.isnan(rate) else max(0.0, multiplier + step * (rate - budget))


multiplier_step = Exercise(
    "multiplier_step(multiplier, rate, budget, step)", solution=next_price, cases=price_cases,
    worked=(
        ((1.0, 0.5, 0.25, 2.0), 1.5),  # a quarter too much, twice
        ((1.0, 0.25, 0.5, 2.0), 0.5),
        ((0.25, 0.0, 0.5, 2.0), 0.0),  # it would be -0.75
        ((0.5, float("nan"), 0.25, 2.0), 0.5),  # no rate yet
    ),
    mistakes=(
        Mistake(lambda multiplier, rate, budget, step: multiplier if np.isnan(rate)
                    else multiplier + step * (rate - budget),
            "Your λ becomes negative: an accident would be rewarded. It stays 0 at least.",
            "Few accidents call for a negative price."),
        Mistake(lambda multiplier, rate, budget, step: max(0.0, multiplier + step * (rate - budget)),
            "With a rate of nan your λ becomes nan or 0. As long as there is no rate, λ stays.",
            "Every round has a rate."),
        Mistake(lambda multiplier, rate, budget, step: next_price(multiplier, rate, budget, -step),
            "This is the other way round: your price falls while there are too many accidents.",
            "A step goes downhill."),
        Mistake(lambda multiplier, rate, budget, step: multiplier if np.isnan(rate)
                    else multiplier + max(0.0, step * (rate - budget)),
            "Your λ never falls. The bound of 0 is for λ, not for its step.",
            "The step is what must not be negative."),
        Mistake(lambda multiplier, rate, budget, step: multiplier if np.isnan(rate)
                    else max(0.0, step * (rate - budget)),
            "You forget the λ there was: it would jump back to 0 as soon as the budget is kept. Add the step to it.",
            "The price is a share of the excess."),
        Mistake(lambda multiplier, rate, budget, step: next_price(multiplier, rate, 0.0, step),
            "You leave out the budget: your λ rises as long as there are any accidents.",
            "No accident is acceptable."),
    ),
    hints=(
        "Three cases: there is no rate yet; too many accidents; fewer than the budget allows.",
        "The two cases with a rate are one formula: λ + η (rate - budget), and 0 if that is negative.",
        "`multiplier if np.isnan(rate) else max(0.0, multiplier + step * (rate - budget))`",
    ),
    minutes=5, difficulty=2,
    equation="λ ← max(0, λ + η (J_C - d)), the integral control of arXiv 2007.03964",
)  # fmt: skip
