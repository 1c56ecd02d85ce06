"""Exercises of the lesson on discrete SAC: the soft value, its target and its three losses."""

import math

import torch

from bootcourse.course.exercise import MANY_ROWS, exercise, logits
from bootcourse.learn import sac

LOG_2 = math.log(2)
OF_NOTHING = "exp(-120) is 0 in float32, and log 0 is minus infinity. Use `log_pi` itself, not the logarithm of π."


def sure(size: int, others: float = -120.0) -> torch.Tensor:
    """log π of policies that are sure of one action, another in each state; all else has about `others`: (size, 9)."""
    return torch.full((size, 9), others).scatter(1, torch.arange(size)[:, None] % 9, 0.0).log_softmax(-1)


def value_cases(rng):
    """Corner cases, the extremes of a training, then 40 at random: log π, Q and α.

    In a training α goes from 10 down to 1e-5, and |Q| up to 200; a policy becomes so sure that a probability is 0.
    """

    def case(log_pi, alpha, scale=3.0):
        return log_pi, torch.tensor(rng.normal(0, scale, tuple(log_pi.shape))), torch.tensor(alpha)

    def states(size, scale):
        return torch.tensor(rng.normal(0, scale, (size, 9))).log_softmax(-1)

    even = torch.full((2, 9), -math.log(9))
    yield from (case(even, 0.0), case(states(3, 8), 1.0), case(states(1, 1), 0.2))
    yield from (case(sure(9), 0.2), case(sure(2, -11.5), 10.0, scale=0.0), case(states(3, 2), 10.0))
    yield from (case(even, 1e-5, scale=1e-3), case(even, 0.002, scale=0.01))
    for size, alpha in ((4, 0.002), (1, 1.0), (4, 10.0)):
        log_pi = states(size, 2)
        yield log_pi, 200 * torch.tensor(rng.choice([-1.0, 1.0], (size, 9))), torch.tensor(alpha)
    for size in (9, *rng.integers(1, 6, 40)):
        yield case(states(size, rng.uniform(0.3, 3)), rng.uniform(0.01, 1))
    yield case(states(MANY_ROWS, 3), 0.1, scale=100.0)


HALF = torch.full((1, 2), -LOG_2)


@exercise(
    "V(s) = Σ_a π(a|s) (Q(s,a) - α log π(a|s)), Section III-C", minutes=4, difficulty=1, cases=value_cases,
    worked=[
        ((HALF, torch.tensor([[1.0, 3.0]]), torch.tensor(0.5)), torch.tensor([2 + 0.5 * LOG_2])),
        # sure of the second action: its Q and nothing else
        ((torch.tensor([[-40.0, 0.0]]), torch.tensor([[1.0, 3.0]]), torch.tensor(0.5)), torch.tensor([3.0])),
    ],
    hints=(
        "What is the mean of Q if the action is drawn from π? And how much does the entropy add?",
        "Both are expectations under π: of Q, and of -α log π.",
    ),
    mistakes={
        "q - alpha -> q + alpha":
            "You penalise entropy: log π is negative, so α log π is *subtracted* from Q.",
        "return q.amax(-1) + alpha * sac.entropy(log_pi)":
            "You take the best action's value. The actor draws its action from π, so it gets the mean of Q under π.",
        "(q - alpha * log_pi) -> q":
            "Your value has no entropy term: this is the value of ordinary actor-critic, α = 0.",
        "return (log_pi.exp() * q - alpha * log_pi).sum(-1)":
            "You add up log π without weighing it by π: both terms are expectations under π.",
        "return (log_pi.exp() * q).mean(-1) + alpha * sac.entropy(log_pi)":
            "You divide by the number of actions: π adds up to 1 already, so the expectation is a *sum* of π Q.",
        ".sum(-1) -> .sum(-1).mean()":
            "You took the mean over the batch. Each state has its own value; the loss takes the mean later.",
        "alpha * log_pi -> alpha * log_pi.exp().log()":
            f"Your value is not a number where a policy is sure of an action: {OF_NOTHING}",
    },
)  # fmt: skip
def soft_value(log_pi, q, alpha):
    return (log_pi.exp() * (q - alpha * log_pi)).sum(-1)


def target_cases(rng):
    """All ended, none ended, a batch of one, γ = 1 and γ = 0; values of training, and up to 600; then 60 at random."""

    def batch(size, ended, gamma, scale=3.0):
        reward, value = torch.tensor(rng.normal(0, scale, (2, size)))
        return reward, torch.tensor(rng.random(size) < ended).float(), value, gamma

    yield from (batch(4, 1.0, 0.8), batch(4, 0.0, 0.8), batch(1, 0.0, 0.9), batch(3, 0.5, 1.0), batch(3, 0.5, 0.0))
    yield torch.tensor([0.16, -10.0, 1.0, -1.0]), torch.tensor([0.0, 1, 0, 0]), torch.tensor([-54.0, 5, 200, -200]), 0.8
    yield from (batch(8, 0.4, 0.99, scale=60.0), batch(8, 0.4, 0.8, scale=20.0), batch(8, 0.4, 0.99, scale=300.0))
    yield from (batch(rng.integers(1, 7), 0.4, rng.uniform(0.1, 0.99)) for _ in range(60))
    yield batch(MANY_ROWS, 0.4, 0.9, scale=100.0)


critic_target = exercise(
    "y = r + γ (1 - terminated) V(s'), Section III-C", minutes=4, difficulty=1, cases=target_cases,
    worked=[
        # it goes on: 1 + 0.8 · 10; it ended: -10 and nothing after it
        ((torch.tensor([1.0, -10.0]), torch.tensor([0.0, 1.0]), torch.tensor([10.0, 10.0]), 0.8),
         torch.tensor([9.0, -10.0])),
    ],
    hints=(
        "What is the target of a transition that ended the episode? And of one that did not?",
        "`1 - terminated` is 1 where the episode goes on, and 0 where it ended.",
    ),
    mistakes={
        "(1 - terminated) * ->":
            "Your target adds a future after the accident. Where an episode ended, the target is the reward alone.",
        "(1 - terminated) -> terminated":
            "Your mask is inverted: `terminated` is 1 where the episode ended, and there the next value must be left "
            "out.",
        "return (1 - terminated) * (reward + gamma * next_value)":
            "You also mask the reward. The last reward, here the -10 of the accident, belongs in the target.",
        "gamma * ->":
            "Your future is not discounted: a reward one second later counts γ times as much.",
        "return gamma * (reward + (1 - terminated) * next_value)":
            "You discount this second's reward, too. γ multiplies only what comes later.",
        "return (reward + gamma * (1 - terminated) * next_value).mean()":
            "You took the mean over the batch. Each transition has its own target; the loss takes the mean later.",
    },
)(sac.critic_target)  # fmt: skip


def pair_cases(rng):
    """One state, nine states (as many as actions), two actions, a target that is met, errors of 30 and more; 30 drawn.

    The lesson's agents have targets of -43, and the pole's values reach 100.
    """

    def case(size, actions=9, scale=2.0):
        q_pair = torch.tensor(rng.normal(0, scale, (2, size, actions)))
        return q_pair, torch.tensor(rng.integers(0, actions, size)), torch.tensor(rng.normal(0, scale, size))

    yield from (case(1), case(9), case(4, 2))
    q_pair, action, _ = case(3)
    yield q_pair, action, q_pair[0].gather(-1, action[:, None])[:, 0]
    yield from (case(4, scale=30.0), case(6, 2, scale=100.0))
    yield torch.zeros(2, 1, 2), torch.tensor([1]), torch.tensor([-43.0])
    for _ in range(30):
        yield case(rng.integers(2, 8))
    yield case(MANY_ROWS, scale=100.0)


@exercise(
    "the sum over both critics of mean (Q(s,a) - y)², Section III-C",
    minutes=6, difficulty=2, cases=pair_cases, slopes=["q_pair", "target"],
    worked=[
        # critic 1 is 1 too high for the first action, critic 2 is 2 too low; the second action was not taken
        ((torch.tensor([[[4.0, 9.0]], [[1.0, 9.0]]]), torch.tensor([0]), torch.tensor([3.0])), torch.tensor(5.0)),
    ],
    hints=(
        "First, Q of the action that was taken, for both critics: (2, batch). Then the error, squared.",
        "`gather` needs an index of as many axes as `q_pair`: `action.expand(2, -1).unsqueeze(-1)`.",
    ),
    mistakes={
        "target.detach() -> target":
            "Your value is right, but the gradient flows into the target, too: the target is held fixed. Use "
            "`target.detach()`.",
        ".mean(-1).sum() -> .mean()":
            "Your loss is half of the right one: each critic's own mean counts in full. Add the two, without a mean "
            "over the critics and without a factor ½.",
        "return (q_pair - target.detach().unsqueeze(-1)).square().mean(1).sum()":
            "You compare all actions with the target. Only the action that was taken led to this reward.",
        "return (q_pair[:, :, action] - target.detach()).square().mean((1, 2)).sum()":
            "`q_pair[:, :, action]` takes these actions in *every* state. Each state has one action: use `gather`, or "
            "give the number of the state as well, `q_pair[:, torch.arange(len(action)), action]`.",
        "return (q_pair.amax(-1) - target.detach()).square().mean(-1).sum()":
            "You compare the largest Q with the target. The reward came from the action that was *taken*.",
        ("q_pair.gather -> q_pair.amin(0, keepdim=True).expand_as(q_pair).gather", ".sum() -> [0]"):
            "You train the smaller value of the two. The minimum is for the target: here each critic has an "
            "error of its own.",
        ".sum() -> [0]":
            "You train the first critic only. The second has an error of its own: add it.",
        ".square() ->":
            "You forgot the square: errors of opposite sign would cancel.",
    },
)  # fmt: skip
def critic_loss(q_pair, action, target):
    q_taken = q_pair.gather(-1, action.expand(2, -1).unsqueeze(-1)).squeeze(-1)
    return (q_taken - target.detach()).square().mean(-1).sum()


@exercise(
    "-E_s[Σ_a π (Q - α log π)], Section III-C",
    minutes=5, difficulty=2, cases=value_cases, slopes=[logits("log_pi"), "q"],
    worked=[((HALF, torch.tensor([[1.0, 3.0]]), torch.tensor(0.5)), torch.tensor(-(2 + 0.5 * LOG_2)))],
    hints=(
        "The soft value should become large, and a loss is made small.",
        "Minus the mean over the batch of V. Through which of `log_pi` and `q` may the gradient flow?",
    ),
    mistakes={
        "q.detach() -> q":
            "Your value is right, but the gradient flows into Q, too: the actor's step would change the critic. Use "
            "`q.detach()`.",
        "-value -> value":
            "This is the value, and training would make it *small*. A loss is minimised: return -V.",
        "log_pi -> log_pi.detach() [2 times]":
            "Your loss has the right value but no gradient: it should change π. Detach Q only.",
        "- alpha -> + alpha":
            "You penalise entropy: log π is negative, so α log π is *subtracted* from Q.",
        ".sum(-1) ->":
            "You took the mean over actions, too. Sum over the actions, then take the mean over the batch.",
        "alpha * log_pi -> alpha * log_pi.exp().log()":
            f"Your loss is not a number where a policy is sure of an action: {OF_NOTHING}",
    },
)  # fmt: skip
def actor_loss(log_pi, q, alpha):
    value = (log_pi.exp() * (q.detach() - alpha * log_pi)).sum(-1)
    return -value.mean()


def temperature_cases(rng):
    """Entropy on target, above, below, a negative target, one state; α from 1e-5 to 10; then 30 at random."""
    pairs = [(0.5, 0.5), (2.0, 0.5), (0.1, 0.5), (0.3, -1.0)]
    pairs += [(rng.uniform(0, 2.2), rng.uniform(-1, 2)) for _ in range(30)]
    for middle, target in pairs:
        state_entropy = torch.tensor(middle + 0.05 * rng.normal(0, 1, rng.integers(2, 6)))
        yield torch.tensor(rng.uniform(-5, 0.5)), state_entropy, torch.tensor(target)
    for alpha, middle, target in ((1e-5, 2.0, -1.0), (1e-4, 0.02, 2.0), (10.0, 0.3, 1.0), (0.3, 0.505, 0.5)):
        yield torch.tensor(math.log(alpha)), torch.full((1,), middle), torch.tensor(target)
    yield torch.tensor(-2.0), torch.tensor(rng.uniform(0, 2.2, MANY_ROWS)), torch.tensor(0.5)


temperature_loss = exercise(
    "α (H(π) - η), η the target entropy, Table of RL hyper-parameters",
    minutes=4, difficulty=2, cases=temperature_cases, slopes=["log_alpha", "state_entropy"],
    tolerance=1e-5,  # it shows a difference in α where α is 1e-5
    worked=[
        # α = 1/2, mean entropy 1, target 0.6: 0.5 · 0.4
        ((torch.tensor(-LOG_2), torch.tensor([0.5, 1.5]), torch.tensor(0.6)), torch.tensor(0.2)),
    ],
    hints=(
        "If the entropy is above its target, α has to fall: which sign does the gradient of the loss need?",
        "α times (mean entropy - target). Only log α may receive a gradient.",
    ),
    mistakes={
        "log_alpha.exp() -> -log_alpha.exp()":
            "Your sign is wrong: this α grows while the policy is *more* random than it should be.",
        ".detach() ->":
            "Your loss also changes the policy's entropy. It should change only the temperature: detach the entropy.",
        "log_alpha.exp() -> log_alpha":
            "You multiply by log α. Here the factor is α itself. Some libraries use log α, which gives other steps.",
        "- target_entropy -> + target_entropy":
            "You add the target. It is H - target; the sum only looks familiar from continuous SAC, whose target is "
            "negative.",
        "log_alpha.exp() -> log_alpha.exp().detach()":
            "Your loss has the right value but no gradient: it should change log α.",
        ".mean(-1) ->":
            "You return one number for each state. There is one temperature for all states: take the mean over the "
            "batch.",
    },
)(sac.temperature_loss)  # fmt: skip
