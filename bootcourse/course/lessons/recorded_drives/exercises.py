"""Exercises of the lesson on learning from recorded drives: GAIL's reward, and CQL's loss."""

import math

import torch

from bootcourse.course.exercise import MANY_ROWS, exercise
from bootcourse.learn import gail, sac

FLOAT32 = (
    "This is right on paper, but not in float32: e²⁰⁰ is infinite and e⁻²⁰⁰ is 0. `q.logsumexp(-1)` takes the largest "
    "Q out of the sum first."
)


def own_cases(rng):
    """D = 1/2, near 0 and 1, D = 1 in floating point, e^x infinite; then 40 at random, and one of 130 rows."""
    yield from ((torch.tensor(x),) for x in ([0.0], [5.0, -5.0], [60.0, -60.0, 1.0], [100.0, -100.0, 2.0]))
    yield from ((torch.tensor(rng.normal(0, 3, rng.integers(1, 8))),) for _ in range(40))
    yield (torch.tensor(rng.normal(0, 300, MANY_ROWS)),)


imitation_reward = exercise(
    "r(s,a) = -log (1 - D(s,a)), Ho & Ermon, arXiv 1606.03476; D as in bootcourse.learn.gail",
    minutes=6, difficulty=2, cases=own_cases,
    worked=[
        ((torch.tensor([0.0]),), torch.tensor([math.log(2)])),  # D = 1/2
        # D = 3/4 and 1/4
        ((torch.tensor([math.log(3), -math.log(3)]),), torch.tensor([math.log(4), math.log(4 / 3)])),
    ],
    hints=(
        "With D = σ(x): 1 - D = 1 / (1 + e^x). What is minus the logarithm of that?",
        "log (1 + e^x) has a name and a function that is safe for a large x: `torch.nn.functional.softplus`.",
    ),
    mistakes={
        "return F.logsigmoid(own_logits)":
            "This is log D. It grows with D as it should, but it is at most 0: each second on the road costs "
            "something, so the agent gains by crashing early.",
        "return -F.softplus(own_logits)":
            "This is log (1 - D): it is largest where the discriminator recognises the agent. A minus is missing.",
        "return F.softplus(-own_logits)":
            "This is -log D: it is largest for what the demonstrator would not do.",
        "return torch.sigmoid(own_logits)":
            "This is D itself. Take minus the logarithm of 1 - D.",
        "return own_logits":
            "This is the logit, log D - log (1 - D), which another method (AIRL) pays. It is negative where the "
            "discriminator recognises the agent.",
        "return -torch.log(1 - torch.sigmoid(own_logits))":
            "This is right on paper, but infinite where the discriminator is very certain: in floating point σ(60) is "
            "exactly 1. -log (1 - σ(x)) is log (1 + e^x), which is called softplus.",
        "return torch.log(1 + torch.exp(own_logits))":
            "This is right on paper, but in float32 e^x is infinite (and σ(-x) is 0) from x = 89 on, so your reward is "
            "infinite there. `softplus` computes log (1 + e^x) safely.",
        "return -torch.log(1 - torch.sigmoid(own_logits) + 1e-8)":
            "Your reward stops growing where the discriminator is certain: what you add inside the logarithm is then "
            "larger than 1 - D. `softplus` computes log (1 + e^x), the same, and needs no such number.",
    },
)(gail.imitation_reward)  # fmt: skip


def offline_cases(rng):
    """All equal, the data's action far ahead, far behind, Q of 200 and of -200, also in one batch; 40 at random.

    At last a batch of 130 rows with Q in the thousands.
    """
    ahead = 8.0 * torch.eye(9)[[2, 5]]
    yield torch.zeros(3, 9), torch.tensor([0, 4, 8])
    yield ahead, torch.tensor([2, 5])
    yield ahead, torch.tensor([5, 2])
    yield 25 * ahead, torch.tensor([2, 2])  # e^200 is infinite in float32
    yield 25 * ahead - 200, torch.tensor([2, 5])
    yield torch.full((1, 9), -200.0), torch.tensor([3])  # and e^-200 is 0
    yield torch.tensor([[200.0], [-200.0]]) * torch.ones(9), torch.tensor([0, 8])  # each state has a largest Q
    for _ in range(40):
        n = rng.integers(2, 8)
        yield torch.tensor(rng.normal(0, 2, (n, 9))), torch.tensor(rng.integers(0, 9, n))
    yield torch.tensor(rng.normal(0, 3000, (MANY_ROWS, 9))), torch.tensor(rng.integers(0, 9, MANY_ROWS))


conservative_loss = exercise(
    "E_s[log Σ_a exp Q(s,a) - Q(s,a_data)], Kumar et al., arXiv 2006.04779, Equation 4",
    minutes=6, difficulty=2, cases=offline_cases, slopes=["q"],
    worked=[
        # e^Q is 8 for the data's action and 1 for the other eight, so log Σ is log 16; the data's Q is log 8
        ((math.log(8) * torch.eye(9)[[1]], torch.tensor([1])), torch.tensor(math.log(2))),
        # log 9 - 0, and log (8 + 8) - 0
        ((math.log(8) * torch.eye(9)[[2]] * torch.tensor([[0.0], [1.0]]), torch.tensor([0, 1])),
         torch.tensor((math.log(9) + math.log(16)) / 2)),
    ],
    hints=(
        "In each state two numbers: log Σ_a exp Q(s,a), and the Q of the action that the data holds.",
        "`q.logsumexp(-1)`, and `q.gather(-1, actions.unsqueeze(-1)).squeeze(-1)`; their difference, then the mean.",
    ),
    mistakes={
        "return -> return -":
            "Your sign is wrong: gradient descent on this raises the Q of untried actions and lowers the Q of the "
            "data's action.",
        "q.logsumexp(-1) -> q.amax(-1)":
            "You push down the highest Q only. log Σ exp also pushes down the Q that come close to it, and it raises "
            "the data's Q even where that is the highest.",
        "q.logsumexp(-1) -> q.mean(-1)":
            "You push down the mean of all nine, so your loss can fall without limit. log Σ exp pushes the *highest* "
            "most.",
        "- q.gather(-1, actions.unsqueeze(-1)).squeeze(-1) ->":
            "You push every Q down and raise none: subtract the Q of the data's action.",
        ".mean(-1) ->":
            "This is the term of each state: take the mean over the batch.",
        "q.logsumexp(-1) -> q.exp().sum(-1).log()": FLOAT32,
        "return -q.softmax(-1).log().gather(-1, actions.unsqueeze(-1)).squeeze(-1).mean(-1)":
            "This is right on paper, but in float32 the softmax of a Q that lies 110 below the largest is 0, and its "
            "logarithm infinite. Use `q.log_softmax(-1)`, or `q.logsumexp(-1)`.",
        "q.logsumexp(-1) -> q.exp().mean(-1).log()":
            "You took the mean of e^Q over the actions. With the *sum* the term is always above 0; yours can be "
            "negative.",
    },
)(sac.conservative_loss)  # fmt: skip


def critic_cases(rng):
    """No weight, no next value, both ends; critics that disagree on the best action; then 30 at random.

    In every third case Q, targets and errors are as large as in a training, up to 200. The last has 130 rows, and
    rewards, Q and targets in the thousands.
    """
    for case in range(35):
        n, size, paid = rng.integers(2, 7), 80 if case % 3 == 2 else 2, 5
        if case == 34:
            n, size, paid = MANY_ROWS, 3000, 3000
        q, next_q, next_target = (torch.tensor(rng.normal(0, size, (n, 9))) for _ in range(3))
        terminated = torch.tensor((rng.random(n) < (0.0, 1.0, 0.5)[case % 3]).astype(float))
        actions, rewards = torch.tensor(rng.integers(0, 9, n)), torch.tensor(rng.normal(0, paid, n))
        gamma, weight = rng.choice([0.5, 0.8, 0.99]), (0.0, 1.0, 0.3, 5.0)[case % 4]
        yield q, next_q, next_target, actions, rewards, terminated, gamma, weight


ONE = (torch.zeros(1, 9), torch.tensor([[0.0, 2.0] + [1.0] * 7]), torch.tensor([[3.0, 4.0] + [9.0] * 7]),
       torch.tensor([0]), torch.tensor([1.0]))  # fmt: skip
NO_SLOPE = torch.zeros(1, 9)


@exercise(
    "E[(Q(s,a) - y)²] + w E[log Σ_a exp Q(s,a) - Q(s,a_data)], y = r + γ Q'(s', argmax_a Q(s',a))",
    minutes=20, difficulty=3, cases=critic_cases, slopes=["q", "next_q", "next_target"],
    worked=[
        # the critic's best next action is 1, which the target critic values at 4: y = 1 + 4/2 = 3, (0 - 3)² + log 9
        ((*ONE, torch.zeros(1), 0.5, 1.0),
         (torch.tensor(9 + math.log(9)), torch.tensor([[-6 - 8 / 9] + [1 / 9] * 8]), NO_SLOPE, NO_SLOPE)),
        # after an accident y = r = 1, and without a weight the term is gone
        ((*ONE, torch.ones(1), 0.5, 0.0),
         (torch.tensor(1.0), torch.tensor([[-2.0] + [0.0] * 8]), NO_SLOPE, NO_SLOPE)),
    ],
    hints=(
        "Three pieces: the next value (`next_q` chooses the action, `next_target` values it), the target y without "
        "gradient, and (Q - y)² plus the weighted term of `conservative_loss`.",
        "`next_target.gather(-1, next_q.argmax(-1, keepdim=True)).squeeze(-1)` is the next value. What multiplies it?",
    ),
    mistakes={
        "next_q.argmax -> next_target.argmax":
            "You take the target critic's own best action, which is ordinary Q-learning: its largest guess is chosen "
            "and believed by the same network. Double Q-learning lets `next_q` choose and `next_target` value.",
        "next_target.gather -> next_q.gather":
            "You value the next action by the network that is being trained. `next_q` only chooses it; `next_target` "
            "says what it is worth.",
        ("next_target.gather -> next_q.gather", "next_q.argmax -> next_target.argmax"):
            "The two are swapped: `next_q` chooses the next action, and `next_target` says what it is worth.",
        "next_target.gather(-1, next_q.argmax(-1, keepdim=True)).squeeze(-1) -> next_target.mean(-1)":
            "You take the mean over the next actions. The agent will take one of them: the one that `next_q` prefers.",
        "(1 - terminated) * ->":
            "Where an accident ended the episode, nothing comes after it: multiply the next value by 1 - terminated.",
        ".detach() ->":
            "The target is a constant for the gradient: nothing may flow into `next_target`. Use `.detach()`.",
        "weight * ->":
            "The weight of the conservative term is missing.",
        "q.logsumexp(-1) -> q.exp().sum(-1).log()": FLOAT32,
        "(taken - target).square().mean() -> 2 * torch.nn.functional.smooth_l1_loss(taken, target)":
            "This is Huber's loss: a large error counts by its size only. Here the error is squared, however large.",
        "+ weight -> - weight":
            "You subtract the conservative term: this *rewards* high values of actions that nobody tried.",
    },
)  # fmt: skip
def offline_loss(q, next_q, next_target, actions, rewards, terminated, gamma, weight):
    next_value = next_target.gather(-1, next_q.argmax(-1, keepdim=True)).squeeze(-1)
    target = (rewards + gamma * (1 - terminated) * next_value).detach()
    taken = q.gather(-1, actions.unsqueeze(-1)).squeeze(-1)
    return (taken - target).square().mean() + weight * (q.logsumexp(-1) - taken).mean()
