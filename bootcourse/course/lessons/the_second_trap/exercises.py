"""Exercises of the lesson on the second trap: PPO's two formulas, and what a changed reward can do."""

import numpy as np
import torch

from bootcourse.course.exercise import Exercise, Mistake
from bootcourse.course.lessons.the_second_trap import second_trap
from bootcourse.learn import ppo
from bootcourse.road.formulas import speed_reward


def rows(*numbers):
    return torch.tensor(numbers, dtype=torch.float64)


def advantage_cases(rng):
    """No ending, an accident, time over, one decision, λ = 0 and 1, both endings on two roads; then 30 at random."""
    three, zeros = torch.tensor(rng.normal(0, 2, (3, 3, 2))), torch.zeros(3, 2, dtype=torch.float64)
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


def gae(
    delta=lambda r, v, n, terminated, ended, g: r + g * (1 - terminated) * n - v,
    carry=lambda terminated, ended: 1 - ended,
    weight=lambda gamma, lam: gamma * lam,
    backwards=True,
):
    """The solution with one piece replaced, for the known mistakes."""

    def answer(rewards, values, next_values, terminated, ended, gamma, lam):
        surprise = delta(rewards, values, next_values, terminated, ended, gamma)
        kept = carry(terminated, ended)
        found, following = torch.zeros_like(rewards), torch.zeros_like(rewards[0])
        steps = range(len(rewards))
        for t in reversed(steps) if backwards else steps:
            found[t] = following = surprise[t] + weight(gamma, lam) * kept[t] * following
        return found

    return answer


NONE = rows([0.0], [0.0], [0.0])
ZERO, ONE, TEN = (rows([number], [number]) for number in (0.0, 1.0, 10.0))
advantages = Exercise(
    "advantages(rewards, values, next_values, terminated, ended, gamma, lam)",
    solution=ppo.advantages, cases=advantage_cases,
    worked=(
        # nothing is expected, so δ = r: 4; 2 + 4/4; 1 + (2 + 4/4)/4, with γ λ = 1/4
        ((rows([1.0], [2.0], [4.0]), NONE, NONE, NONE, NONE, 0.5, 0.5), rows([1.75], [3.0], [4.0])),
        # an accident in the second decision: δ = 0 + 0 - 1; before it 0 + 10/2 - 1 = 4, and 4 - 1/4 with what follows
        ((ZERO, ONE, TEN, rows([0.0], [1.0]), rows([0.0], [1.0]), 0.5, 0.5), rows([3.75], [-1.0])),
        # out of time in the first: the last state has a value, and the next episode does not follow: 4, 4
        ((ZERO, ONE, TEN, ZERO, rows([1.0], [0.0]), 0.5, 0.5), rows([4.0], [4.0])),
    ),
    mistakes=(
        Mistake(gae(carry=lambda terminated, ended: 1 - terminated),
            "Where an episode ran out of time, the next row belongs to another episode: its surprises are not caused "
            "by this decision. Stop the sum wherever `ended` is 1.",
            "Only an accident ends the sum."),
        Mistake(gae(delta=lambda r, v, n, terminated, ended, g: r + g * (1 - ended) * n - v),
            "An episode that ran out of time has a last state, and that state has a value: only after an accident is "
            "it 0. Use `terminated` in δ and `ended` in the sum.",
            "An episode that is over is worth nothing from there on."),
        Mistake(gae(delta=lambda r, v, n, terminated, ended, g: r + g * n - v),
            "After an accident nothing follows: multiply the next value by 1 - terminated.",
            "The row holds a next value, so it counts."),
        Mistake(gae(weight=lambda gamma, lam: gamma),
            "λ is missing: a surprise k decisions later counts (γ λ)^k.",
            "λ belongs to the values."),
        Mistake(gae(weight=lambda gamma, lam: lam),
            "γ is missing in the sum: a surprise k decisions later counts (γ λ)^k.",
            "δ already contains γ."),
        Mistake(gae(backwards=False),
            "You add up from the first decision on, so each advantage contains the surprises *before* it. A decision "
            "is judged by what comes after it: begin with the last row.",
            "The sum runs in the order of time."),
        Mistake(gae(delta=lambda r, v, n, terminated, ended, g: r + g * (1 - terminated) * n),
            "This is what a decision brought. An advantage is by how much that was *more than expected*: subtract "
            "V(s).",
            "The advantage is the return."),
        Mistake(gae(weight=lambda gamma, lam: 0.0),
            "These are the surprises δ. Each advantage also has the later ones, weighted with (γ λ)^k.",
            "One step is enough."),
    ),
    hints=(
        "Two steps: all surprises δ at once, then one loop over t from the last row to the first.",
        "`following` holds A_{t+1}. What multiplies it is 0 where the row's episode is over.",
        "`found[t] = following = delta[t] + gamma * lam * (1 - ended[t]) * following`",
    ),
    minutes=15, difficulty=3,
    equation="A_t = δ_t + γ λ A_{t+1}, δ_t = r_t + γ V(s_{t+1}) - V(s_t), arXiv 1506.02438, Equation 16",
)  # fmt: skip


def clipped_cases(rng):
    """Inside the limits, above and below them with both signs, another ε; then 30 at random."""
    good, changed = rows(2.0, 1.0), rows(1.5, 0.5)
    yield from ((rows(0.9, 1.1), good, 0.2), (changed, good, 0.2), (changed, -good, 0.2))
    yield changed, rows(3.0, -1.0), 0.6
    for _ in range(30):
        n = rng.integers(2, 9)
        ratio, advantage = torch.tensor(np.exp(rng.normal(0, 0.5, n))), torch.tensor(rng.normal(0, 2, n))
        yield ratio, advantage, rng.choice([0.1, 0.2, 0.3])


def products(ratio, advantage, clip):
    """r A, and clip(r, 1 - ε, 1 + ε) A."""
    return ratio * advantage, ratio.clamp(1 - clip, 1 + clip) * advantage


clipped_loss = Exercise(
    "clipped_loss(ratio, advantage, clip)", solution=ppo.clipped_loss, cases=clipped_cases, slopes=("ratio",),
    worked=(
        # min(1.5 · 2, 1.2 · 2) = 2.4, and no slope: the action is likely enough
        ((rows(1.5), rows(2.0), 0.2), (torch.tensor(-2.4), rows(0.0))),
        # min(1.5 · -2, 1.2 · -2) = -3: a bad action that has become likelier may be unlearned
        ((rows(1.5), rows(-2.0), 0.2), (torch.tensor(3.0), rows(2.0))),
        # the mean of 1.1 · 2 and min(0.5 · -2, 0.8 · -2) = -1.6
        ((rows(1.1, 0.5), rows(2.0, -2.0), 0.2), (torch.tensor(-0.3), rows(-1.0, 0.0))),
    ),
    mistakes=(
        Mistake(lambda ratio, advantage, clip: -(ratio * advantage).mean(),
            "Nothing is clipped: with many passes over the same data, the policy can move as far as it likes.",
            "The advantage alone limits the step."),
        Mistake(lambda ratio, advantage, clip: -products(ratio, advantage, clip)[1].mean(),
            "You always take the clipped one. An action that went the wrong way then has no slope, and stays there: "
            "take the *smaller* of the two products.",
            "Clipping is all there is."),
        Mistake(lambda ratio, advantage, clip: -torch.maximum(*products(ratio, advantage, clip)).mean(),
            "You take the larger of the two products, the optimistic one: it pays for going further than ε. Take the "
            "smaller.",
            "A loss is minimised, so the objective takes the maximum."),
        Mistake(lambda ratio, advantage, clip: torch.minimum(*products(ratio, advantage, clip)).mean(),
            "Your sign is wrong: gradient descent on this makes good actions rarer.",
            "The objective is the loss."),
        Mistake(lambda ratio, advantage, clip: -torch.minimum(*products(ratio, advantage, clip)).sum(),
            "Take the mean over the batch, not the sum.",
            "The optimiser takes the mean."),
        Mistake(lambda ratio, advantage, clip:
                -(torch.minimum(ratio, ratio.clamp(1 - clip, 1 + clip)) * advantage).mean(),
            "You take the smaller *ratio*. With a negative advantage the smaller product belongs to the larger ratio: "
            "multiply first.",
            "min(r, clip(r)) A is min(r A, clip(r) A)."),
        Mistake(lambda ratio, advantage, clip:
                -torch.minimum(ratio * advantage, ratio.clamp(-clip, clip) * advantage).mean(),
            "A ratio is 1 where nothing has changed: clip it to 1 - ε and 1 + ε.",
            "ε is the largest ratio."),
        Mistake(lambda ratio, advantage, clip: ppo.clipped_loss(ratio, advantage, clip).detach(),
            "Your value is right, but no gradient flows back to the ratio: nothing would be learned.",
            "A loss is a number."),
    ),
    hints=(
        "Two products: with the ratio, and with the ratio clipped to [1 - ε, 1 + ε].",
        "`ratio.clamp(1 - clip, 1 + clip)`, and `torch.minimum` of two tensors.",
        "`-torch.minimum(ratio * advantage, ratio.clamp(1 - clip, 1 + clip) * advantage).mean()`",
    ),
    minutes=8, difficulty=2,
    equation="-E[min(r A, clip(r, 1 - ε, 1 + ε) A)], r = π(a|s) / π_old(a|s), arXiv 1707.06347, Equation 7",
)  # fmt: skip


def paid_at(middle):
    return lambda speeds: np.mean([speed_reward(v) for v in speeds]) - speed_reward(middle(speeds))


jensen_gap = Exercise(
    "jensen_gap(speeds)", solution=second_trap.jensen_gap,
    # steady, convex, linear below 12.5 m/s, concave over 15 m/s, unequal parts, one second; then 40 at random
    cases=lambda rng: [(np.full(4, 10.0),), (np.array([10.0, 15.0]),), (np.array([6.0, 12.0, 9.0]),),
                       (np.array([14.0, 15.5]),), (np.array([15.0, 5.0, 5.0, 5.0]),), (np.array([14.0]),),
                       *((rng.uniform(3, 15.5, rng.integers(2, 12)),) for _ in range(40))],
    worked=(
        ((np.array([5.0, 15.0]),), np.float64((0 + 1) / 2 - 2 / 15)),  # r_v(10) = 2/15
        ((np.array([10.0, 12.5]),), np.float64(0.0)),  # linear between 5 and 12.5 m/s
    ),
    mistakes=(
        Mistake(lambda speeds: -second_trap.jensen_gap(speeds),
            "Your sign is wrong: the gap is positive where changing speeds pay *more* than the steady one.",
            "The steady driver comes first."),
        Mistake(lambda speeds: np.mean([speed_reward(v) for v in speeds]),
            "This is what the changing speeds pay. Subtract what their *mean* speed would pay.",
            "The gap is the mean reward."),
        Mistake(paid_at(np.median),
            "You compare with the median speed. The steady driver who gets as far drives the *mean* speed.",
            "The median is the typical speed."),
        Mistake(paid_at(lambda speeds: (np.min(speeds) + np.max(speeds)) / 2),
            "You compare with the middle between the lowest and the highest speed. They need not last equally long: "
            "take the mean over all seconds.",
            "Somebody who alternates between two speeds drives their middle on average."),
        Mistake(lambda speeds: len(speeds) * second_trap.jensen_gap(speeds),
            "You add up over the seconds: take the mean reward of a second.",
            "A longer drive has a larger gap."),
        Mistake(lambda speeds: speed_reward(np.mean(speeds)) * 0.0,
            "You compare the reward at the mean speed with itself. First the reward of each second, then the mean.",
            "The mean of the rewards is the reward of the mean."),
        Mistake(paid_at(np.max),
            "You compare with the highest speed. The steady driver drives the mean speed.",
            "Jensen compares with the best."),
    ),
    hints=(
        "Two numbers: the mean of the rewards, and the reward of the mean.",
        "`bc.formulas.speed_reward` takes one speed: call it for each, and take `np.mean`.",
        "`np.mean([bc.formulas.speed_reward(v) for v in speeds]) - bc.formulas.speed_reward(np.mean(speeds))`",
    ),
    minutes=6, difficulty=2, equation="E[r_v(v)] - r_v(E[v]), Jensen's inequality, r_v: Equation 10",
)  # fmt: skip


def shaping_cases(rng):
    """No ending, an ending, Φ that does not change, a state of Φ = 0; then 30 at random."""
    yield np.array([1.0, 2.0]), np.array([2.0, 0.5]), np.zeros(2), 0.9
    yield np.array([1.0, 2.0]), np.array([2.0, 3.0]), np.array([1.0, 0.0]), 0.9
    yield np.full(3, 4.0), np.full(3, 4.0), np.zeros(3), 0.99
    yield np.zeros(2), np.array([1.0, -1.0]), np.zeros(2), 0.5
    for _ in range(30):
        n = rng.integers(1, 7)
        phi, next_phi = rng.normal(0, 3, (2, n))
        yield phi, next_phi, (rng.random(n) < 0.3).astype(float), rng.choice([0.5, 0.9, 0.99])


shaping_reward = Exercise(
    "shaping_reward(phi, next_phi, terminated, gamma)", solution=second_trap.shaping_reward, cases=shaping_cases,
    worked=(
        # 0.5 · 4 - 1; an accident ends the episode: 0 - 3
        ((np.array([1.0, 3.0]), np.array([4.0, 8.0]), np.array([0.0, 1.0]), 0.5), np.array([1.0, -3.0])),
        ((np.array([2.0]), np.array([2.0]), np.array([0.0]), 0.99), np.array([-0.02])),  # staying costs (1 - γ) Φ
    ),
    mistakes=(
        Mistake(lambda phi, next_phi, terminated, gamma: next_phi * (1 - terminated) - phi,
            "γ is missing: what comes a decision later counts γ times as much. Without it the discounted sum does not "
            "cancel, and the best policy may change.",
            "A difference of potentials needs no γ."),
        Mistake(lambda phi, next_phi, terminated, gamma: gamma * next_phi - phi,
            "After an accident Φ is 0: multiply the next potential by 1 - terminated. Otherwise the agent keeps what "
            "it was lent, and may crash in a good place.",
            "A terminal state has a potential like any other."),
        Mistake(lambda phi, next_phi, terminated, gamma: phi - gamma * next_phi * (1 - terminated),
            "Your sign is wrong: this charges the agent for reaching a higher potential.",
            "A potential is like a height: going up costs."),
        Mistake(lambda phi, next_phi, terminated, gamma: next_phi * (1 - terminated),
            "You pay the potential itself, at every decision: an agent can stay and collect it. Pay the *change*.",
            "Good states should be rewarded."),
        Mistake(lambda phi, next_phi, terminated, gamma: gamma * (next_phi * (1 - terminated) - phi),
            "γ belongs to the next potential alone: F = γ Φ(s') - Φ(s).",
            "The whole reward is discounted."),
        Mistake(lambda phi, next_phi, terminated, gamma: (gamma * next_phi - phi) * (1 - terminated),
            "At an accident the agent has to give back Φ(s): only the *next* potential is 0 there.",
            "Nothing is paid at the end."),
        Mistake(lambda phi, next_phi, terminated, gamma: np.maximum(gamma * next_phi * (1 - terminated) - phi, 0),
            "You pay for going up and charge nothing for going down: an agent could go to and fro and earn each time.",
            "A help should not punish."),
    ),
    hints=(
        "The next potential, discounted, less the present one. What is the potential after an accident?",
        "`(1 - terminated)` multiplies one of the two potentials.",
        "`gamma * next_phi * (1 - terminated) - phi`",
    ),
    minutes=6, difficulty=2, equation="F = γ Φ(s') - Φ(s), Ng, Harada and Russell 1999",
)  # fmt: skip
