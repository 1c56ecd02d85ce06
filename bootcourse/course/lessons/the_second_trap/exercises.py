"""Exercises of the lesson on the second trap: PPO's advantages and its loss."""

import numpy as np
import torch

from bootcourse.course.exercise import MANY_ROWS, exercise
from bootcourse.learn import ppo


def rows(*numbers):
    return torch.tensor(numbers)


def advantage_cases(rng):
    """No ending, an accident, time over, one decision, λ = 0 and 1, both endings on two roads; then 30 at random.

    At last 80 decisions with rewards and values of a training, and 40 on many roads.
    """
    three, zeros = torch.tensor(rng.normal(0, 2, (3, 3, 2))), torch.zeros(3, 2)
    ends = zeros.clone()
    ends[1, 0] = 1.0
    yield from ((*three, *marks, 0.9, 0.8) for marks in ((zeros, zeros), (ends, ends), (zeros, ends)))
    yield *three[:, :1], zeros[:1], zeros[:1], 0.9, 0.8
    yield from ((*three, zeros, ends, 0.9, lam) for lam in (0.0, 1.0))
    for _ in range(30):
        shape = rng.integers(2, 9), rng.integers(1, 4)
        columns = (torch.tensor(rng.normal(0, 2, shape)) for _ in range(3))
        ended = rng.random(shape) < 0.3
        terminated = ended & (rng.random(shape) < 0.5)
        marks = (torch.tensor(each.astype(float)) for each in (terminated, ended))
        yield *columns, *marks, rng.choice([0.5, 0.9, 0.99]), rng.uniform(0, 1)
    ended = torch.tensor((rng.random((80, 2)) < 0.02).astype(float))
    rewards = torch.where(ended > 0, -10.0, 1.0)
    values, next_values = (torch.tensor(rng.normal(30, 40, (80, 2))) for _ in range(2))
    yield rewards, values, next_values, ended, ended, 0.99, 0.97
    ended = torch.tensor((rng.random((40, MANY_ROWS)) < 0.05).astype(float))
    yield *(torch.tensor(rng.normal(0, 30, (40, MANY_ROWS))) for _ in range(3)), ended, ended, 0.99, 0.97


NONE = rows([0.0], [0.0], [0.0])
ZERO, ONE, TEN = (rows([number], [number]) for number in (0.0, 1.0, 10.0))

advantages = exercise(
    "A_t = δ_t + γ λ A_{t+1}, δ_t = r_t + γ V(s_{t+1}) - V(s_t), arXiv 1506.02438, Equation 16",
    minutes=15, difficulty=3, cases=advantage_cases,
    worked=[
        # nothing is expected, so δ = r: 4; 2 + 4/4; 1 + (2 + 4/4)/4, with γ λ = 1/4
        ((rows([1.0], [2.0], [4.0]), NONE, NONE, NONE, NONE, 0.5, 0.5), rows([1.75], [3.0], [4.0])),
        # an accident in the second decision: δ = 0 + 0 - 1; before it 0 + 10/2 - 1 = 4, and 4 - 1/4 with what follows
        ((ZERO, ONE, TEN, rows([0.0], [1.0]), rows([0.0], [1.0]), 0.5, 0.5), rows([3.75], [-1.0])),
        # out of time in the first: the last state has a value, and the next episode does not follow: 4, 4
        ((ZERO, ONE, TEN, ZERO, rows([1.0], [0.0]), 0.5, 0.5), rows([4.0], [4.0])),
    ],
    hints=(
        "Two steps: all surprises δ at once, then one loop over t from the last row to the first.",
        "`following` holds A_{t+1}. What multiplies it is 0 where the row's episode is over.",
    ),
    mistakes={
        "ended[t] -> terminated[t]":
            "Where an episode ran out of time, the next row belongs to another episode: its surprises are not caused "
            "by this decision. Stop the sum wherever `ended` is 1.",
        "(1 - ended[t]) * ->":
            "Your sum goes on into the next episode: stop it wherever `ended` is 1.",
        "terminated -> ended":
            "An episode that ran out of time has a last state, and that state has a value: only after an accident is "
            "it 0. Use `terminated` in δ and `ended` in the sum.",
        "(1 - terminated) * ->":
            "After an accident nothing follows: multiply the next value by 1 - terminated.",
        "lam * ->":
            "λ is missing: a surprise k decisions later counts (γ λ)^k.",
        "gamma * lam -> lam":
            "γ is missing in the sum: a surprise k decisions later counts (γ λ)^k.",
        "reversed(range(len(delta))) -> range(len(delta))":
            "You add up from the first decision on, so each advantage contains the surprises *before* it. A decision "
            "is judged by what comes after it: begin with the last row.",
        "- values ->":
            "This is what a decision brought. An advantage is by how much that was *more than expected*: subtract "
            "V(s).",
        "return delta":
            "These are the surprises δ. Each advantage also has the later ones, weighted with (γ λ)^k.",
    },
)(ppo.advantages)  # fmt: skip


def clipped_cases(rng):
    """Inside the limits, above and below them with both signs, another ε, far outside; then 30 at random.

    At last many decisions, with ratios from e⁻⁹ to e⁹ and advantages in the thousands.
    """
    good, changed = rows(2.0, 1.0), rows(1.5, 0.5)
    yield from ((rows(0.9, 1.1), good, 0.2), (changed, good, 0.2), (changed, -good, 0.2))
    yield changed, rows(3.0, -1.0), 0.6
    yield rows(40.0, 40.0, 0.01, 0.01), rows(25.0, -30.0, 25.0, -30.0), 0.2
    yield rows(1.3), rows(-2.0), 0.2
    for number in range(30):
        n, size = rng.integers(2, 9), 20 if number % 3 == 2 else 2
        ratio, advantage = torch.tensor(np.exp(rng.normal(0, 0.5, n))), torch.tensor(rng.normal(0, size, n))
        yield ratio, advantage, rng.choice([0.1, 0.2, 0.3])
    yield torch.tensor(np.exp(rng.normal(0, 3, MANY_ROWS))), torch.tensor(rng.normal(0, 3000, MANY_ROWS)), 0.2


clipped_loss = exercise(
    "-E[min(r A, clip(r, 1 - ε, 1 + ε) A)], r = π(a|s) / π_old(a|s), arXiv 1707.06347, Equation 7",
    minutes=8, difficulty=2, cases=clipped_cases, slopes=["ratio"],
    worked=[
        # min(1.5 · 2, 1.2 · 2) = 2.4, and no gradient: the action is likely enough
        ((rows(1.5), rows(2.0), 0.2), (torch.tensor(-2.4), rows(0.0))),
        # min(1.5 · -2, 1.2 · -2) = -3: a bad action that has become likelier may be unlearned
        ((rows(1.5), rows(-2.0), 0.2), (torch.tensor(3.0), rows(2.0))),
        # the mean of 1.1 · 2 and min(0.5 · -2, 0.8 · -2) = -1.6
        ((rows(1.1, 0.5), rows(2.0, -2.0), 0.2), (torch.tensor(-0.3), rows(-1.0, 0.0))),
    ],
    hints=(
        "Two products: with the ratio, and with the ratio clipped to [1 - ε, 1 + ε].",
        "`ratio.clamp(1 - clip, 1 + clip)`, and `torch.minimum` of two tensors.",
    ),
    mistakes={
        "return -(ratio * advantage).mean()":
            "Nothing is clipped: with many passes over the same data, the policy can move as far as it likes.",
        "return -(ratio.clamp(1 - clip, 1 + clip) * advantage).mean()":
            "You always take the clipped one. An action that went the wrong way then has no gradient, and stays there: "
            "take the *smaller* of the two products.",
        "minimum -> maximum":
            "You take the larger of the two products, the optimistic one: it pays for going further than ε. Take the "
            "smaller.",
        "-torch.minimum -> torch.minimum":
            "Your sign is wrong: gradient descent on this makes good actions rarer.",
        "mean -> sum":
            "Take the mean over the batch, not the sum.",
        "return -(torch.minimum(ratio, ratio.clamp(1 - clip, 1 + clip)) * advantage).mean()":
            "You take the smaller *ratio*. With a negative advantage the smaller product belongs to the larger ratio: "
            "multiply first.",
        "1 - clip, 1 + clip -> -clip, clip":
            "A ratio is 1 where nothing has changed: clip it to 1 - ε and 1 + ε.",
        ".mean(-1) -> .mean(-1).detach()":
            "Your value is right, but no gradient flows back to the ratio: nothing would be learned.",
    },
)(ppo.clipped_loss)  # fmt: skip
