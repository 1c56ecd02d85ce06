"""Exercises of the lesson on other ways to use a teacher: what IBRL and jump-start RL take from it."""

import numpy as np
import torch

from bootcourse.course.exercise import MANY_ROWS, exercise


def two_cases(rng):
    """The rule best, worst, in the middle, no chance for the better ones, ties and near ties; then 30 at random.

    At last 130 rows with Q in the thousands, and the nearest tie that float32 has.
    """
    q = torch.arange(9.0)[None]
    for action in (8, 0, 4):
        yield torch.full((1, 9), 1 / 9), q, torch.tensor([action])
    yield torch.tensor([[0.5, 0.5] + [0.0] * 7]), q, torch.tensor([3])
    near = torch.zeros(3, 9)
    near[:, [1, 4]] = torch.tensor([[2e-5, 2e-5], [2e-5, 0.0], [0.0, 2e-5]])
    yield torch.full((3, 9), 1 / 9), near, torch.full((3,), 4)
    yield torch.full((1, 9), 1 / 9), torch.zeros(1, 9), torch.tensor([4])
    for number in range(30):
        n, size = rng.integers(1, 7), 80 if number % 3 == 2 else 2
        pi = torch.tensor(rng.normal(0, 2, (n, 9))).softmax(-1)
        yield pi, torch.tensor(rng.normal(0, size, (n, 9))), torch.tensor(rng.integers(0, 9, n))
    pi, q = (
        torch.tensor(rng.normal(0, 2, (MANY_ROWS, 9))).softmax(-1),
        torch.tensor(rng.normal(0, 3000, (MANY_ROWS, 9))),
    )
    yield pi, q, torch.tensor(rng.integers(0, 9, MANY_ROWS))
    next_to = torch.full((2, 9), 1.0)  # better, and worse, than the rule's by one step of a float32
    next_to[0, 2], next_to[1, 2] = torch.tensor(1.0).nextafter(torch.tensor([2.0, 0.0]))
    yield torch.full((2, 9), 1 / 9), next_to, torch.tensor([4, 4])


def one_hot(actions, pi):
    return torch.nn.functional.one_hot(actions, pi.shape[-1]).to(pi)


LOST = "Your probabilities do not add up to 1: where the agent's own action is not better, the rule's is taken."
SHARED = (
    "You share what is left over among all actions that remain. If a worse action is drawn, the rule's is taken "
    "instead: all of it goes to μ(s)."
)


def three_of_nine(*numbers):
    """Those of three actions, and 0 for the other six, which are never drawn: (1, 9)."""
    return torch.tensor([[*numbers, *[0.0] * 6]])


PI, Q = three_of_nine(0.5, 0.3, 0.2), three_of_nine(1.0, 2.0, 3.0)


@exercise(
    "argmax of Q over {μ(s), a}, a ~ π, as a distribution, arXiv 2311.02198",
    minutes=12, difficulty=3, cases=two_cases,
    worked=[
        # the rule takes the second action: an own third is better and keeps 0.2; an own first gives way, 0.5 + 0.3
        ((PI, Q, torch.tensor([1])), three_of_nine(0.0, 0.8, 0.2)),
        ((PI, Q, torch.tensor([2])), three_of_nine(0.0, 0.0, 1.0)),  # nothing is better than the rule's
        ((PI, Q, torch.tensor([0])), three_of_nine(0.5, 0.3, 0.2)),  # all others are
    ],
    hints=(
        "Go through the nine actions that π may draw: which of them stay as they are, and what happens to the others?",
        "What stays is `pi * (q > q_rule)`, with `q_rule = q.gather(-1, rule_actions[:, None])`. What is missing to 1 "
        "goes to the rule's action.",
    ),
    mistakes={
        "return one_hot(q.argmax(-1), pi)":
            "You take the best of all nine actions. The choice is between two: the rule's action, and one that the "
            "agent draws from π.",
        "return stays": LOST,
        "return pi * (q >= q_rule)": LOST,
        "shared = stays + one_hot(rule_actions, pi) * pi; "
        "return shared / shared.sum(-1, keepdim=True).clamp_min(1e-12)":
            SHARED,
        "stays = pi * (q >= q_rule); return stays / stays.sum(-1, keepdim=True)": SHARED,
        "stays = pi * (q >= q_rule) * (1 - one_hot(rule_actions, pi)); "
        "return stays.scatter_add(-1, rule_actions[:, None], 1 - stays.sum(-1, keepdim=True))":
            "You keep the own actions whose Q *equals* that of the rule's. They are not better: take the rule's.",
        "q > q_rule -> q < q_rule":
            "You keep the own actions that are valued *below* the rule's.",
        "better = (pi * q).sum(-1) > q_rule[:, 0]; "
        "return one_hot(torch.where(better, pi.argmax(-1), rule_actions), pi)":
            "You decide once for each state, by the mean value of π. The choice is made for the action that was drawn: "
            "each of the nine is compared with the rule's.",
        "return torch.where((q > q_rule).any(-1, keepdim=True), pi, one_hot(rule_actions, pi))":
            "Where one action is better than the rule's, you follow π altogether. The own actions that are worse still "
            "give way to the rule's.",
        "return pi":
            "This is π: the rule never has a say.",
    },
)  # fmt: skip
def better_of_two(pi, q, rule_actions):
    q_rule = q.gather(-1, rule_actions[:, None])
    stays = pi * (q > q_rule)
    return stays.scatter_add(-1, rule_actions[:, None], 1 - stays.sum(-1, keepdim=True))


def curriculum_cases(rng):
    """Too few returns, just as good, a little worse, one bad, better, negative ones, the first; then 40 at random."""
    yield [50.0, 50.0], 50.0, 3, 0.05
    yield [50.0, 50.0, 50.0], 50.0, 3, 0.05
    yield [49.0, 50.0, 51.0], 50.0, 3, 0.0
    yield from (([mean, mean, mean], 50.0, 3, 0.05) for mean in (49.96, 48.0, 47.0))
    yield [52.0, 0.0, 53.0], 50.0, 3, 0.05
    yield [0.0, 60.0, 60.0, 60.0], 50.0, 3, 0.0
    yield [90.0, 10.0, 10.0, 10.0], 25.0, 3, 0.05
    yield from (([mean, mean], -10.0, 2, 0.05) for mean in (-10.2, -12.0, -9.0))
    yield from (([mean, mean], 50.0, 2, 0.05) for mean in (47.5, 47.49999, 47.50001))  # the limit is 47.5
    yield from (([mean, mean], -40.0, 2, 0.25) for mean in (-50.0, -50.00001, -49.99999))
    yield from (([mean], 0.0, 1, 0.05) for mean in (0.0, -1e-5))
    yield [40.0] * 60 + [50.0] * 100, 50.0, 100, 0.0
    rising = [float(number) for number in range(100)]  # the last 20 have the mean 89.5
    yield from ((rising, best, 20, 0.0) for best in (89.5, 89.6))
    yield from ((rising[::-1], best, 20, 0.0) for best in (9.5, 9.6))
    yield from (([-500.0] * 30, best, 25, 0.0) for best in (-500.0, -499.0))
    yield [5.0, 7.0], -np.inf, 2, 0.1
    for _ in range(40):
        window = rng.integers(1, 5)
        returns = rng.normal(0, 10, rng.integers(0, 9)).tolist()
        yield returns, rng.normal(0, 8), window, rng.choice([0.0, 0.05, 0.3])


@exercise(
    "R(h) ≥ R_best - β |R_best|, the moving average of arXiv 2204.02372, Algorithm 1",
    minutes=6, difficulty=2, cases=curriculum_cases,
    worked=[
        (([40.0, 50.0, 60.0], 52.0, 2, 0.0), True),  # the last two: 55
        (([40.0, 50.0, 60.0], 52.0, 3, 0.05), True),  # 50 is above 52 - 2.6
        (([40.0, 50.0, 60.0], 52.0, 3, 0.01), False),  # and below 52 - 0.52
        (([40.0], 10.0, 2, 0.0), False),  # one return is no window of two
        (([-10.5], -10.0, 1, 0.1), True),  # above -10 - 1
    ],
    hints=(
        "Three steps: enough returns? The mean of the last `window`? Is it high enough?",
        "High enough: at least best - tolerance · |best|. The best may be negative, or minus infinity at first.",
    ),
    mistakes={
        "enough and ->":
            "You judge before there are enough returns: with fewer than `window` of them h stays.",
        "len(returns) >= window -> len(returns) > window":
            "You wait for one return too many: `window` returns are enough.",
        "returns[-window:] -> returns":
            "You take the mean of all returns. The last `window` of them say how good the two are now.",
        "returns[-window:] -> returns[:window]":
            "You take the first `window` returns. The last ones say how good the two are now.",
        "best - tolerance * abs(best) -> best * (1 - tolerance)":
            "With a negative best, best · (1 - tolerance) lies *above* the best. Use the size of the best: "
            "best - tolerance · |best|.",
        "* abs(best) ->":
            "The tolerance is a share of the best, not a return: subtract tolerance · |best|.",
        "- tolerance * abs(best) ->":
            "You leave out the tolerance: the mean may lie below the best by tolerance · |best|.",
        ">= best - tolerance * abs(best) -> > best":
            "You ask for a new best mean. It may lie below the best by the tolerance.",
        ">= best -> > best":
            "A mean that is just high enough will do: compare with `>=`.",
        "- tolerance -> + tolerance":
            "You ask for more than the best: subtract the tolerance.",
        "enough and -> enough and not":
            "This is the other way round: h would shrink where the return has fallen.",
    },
)  # fmt: skip
def guide_shrinks(returns, best, window, tolerance):
    enough = len(returns) >= window
    return enough and np.mean(returns[-window:]) >= best - tolerance * abs(best)
