"""Exercises of the lesson on learning from demonstrations."""

import numpy as np
import torch

from bootcourse.learn import bootstrap
from bootcourse.lessons.exercise import Exercise, Mistake


def share_cases(rng):
    """The first episode, the last, long after, all at once, a start of 1; then 40 at random."""
    yield 0, 0.6, 1000
    yield 1000, 0.6, 1000
    yield 3000, 0.6, 1000
    yield np.array([0, 250, 500, 999, 1000, 5000]), 0.6, 1000
    yield 300, 1.0, 400
    for _ in range(40):
        yield rng.integers(0, 3000, 4), float(rng.uniform(0.1, 1)), int(rng.integers(100, 2000))


demonstration_share = Exercise(
    "demonstration_share(episode, beta_start, beta_episodes)",
    solution=bootstrap.demonstration_share, cases=share_cases,
    worked=(((500, 0.6, 1000), 0.3), ((2000, 0.6, 1000), 0.0)),
    mistakes=(
        Mistake(lambda episode, start, episodes: start * (1 - np.asarray(episode) / episodes),
            "After the last of the `beta_episodes` your share is negative. From there on it stays 0.",
            "Training ends with the `beta_episodes`."),
        Mistake(lambda episode, start, episodes: np.clip(1 - np.asarray(episode) / episodes, 0, start),
            "Your share starts to fall too late: the line begins at `beta_start` in episode 0, not at 1.",
            "The line runs from 1 to 0, and beta_start is a ceiling on it."),
        Mistake(lambda episode, start, episodes: np.clip(start - np.asarray(episode) / episodes, 0, 1),
            "Your share reaches 0 too early: it falls by `beta_start` in `beta_episodes`, not by 1.",
            "Each episode takes away 1 / beta_episodes."),
        Mistake(lambda episode, start, episodes: start * np.clip(np.asarray(episode) / episodes, 0, 1),
            "Your share grows with the episodes. It has to fall to 0.",
            "The share follows the progress, episode / beta_episodes."),
        Mistake(lambda episode, start, episodes: start * 0.001 ** (np.asarray(episode) / episodes),
            "Your share falls exponentially. The text asks for a straight line that ends at 0.",
            "Schedules in machine learning decay exponentially."),
    ),
    hints=(
        "What share of the `beta_episodes` is over, and what share is left?",
        "What is left is 1 - episode / beta_episodes, but at least 0. `np.clip` works for numbers and arrays.",
        "`beta_start * np.clip(1 - episode / beta_episodes, 0, 1)`",
    ),
    minutes=3, difficulty=1, equation="β, from 0.6 to 0 over 1000 episodes, Section IV-B",
)  # fmt: skip


def reward_cases(rng):
    """All demonstrations, none, c = 0, a negative c; then 30 at random."""
    for number in range(34):
        size = int(rng.integers(2, 7))
        is_demonstration = torch.tensor(rng.random(size) < 0.5).double()
        is_demonstration = (torch.ones(size), torch.zeros(size))[number] if number < 2 else is_demonstration
        bonus = {2: 0.0, 3: -1.0}.get(number, float(rng.uniform(0.1, 5)))
        yield torch.tensor(rng.normal(0, 3, size)), is_demonstration, bonus


augmented_reward = Exercise(
    "augmented_reward(reward, is_demonstration, bonus)",
    solution=bootstrap.augmented_reward, cases=reward_cases,
    worked=(
        ((torch.tensor([0.15, 0.15, -10.0]), torch.tensor([1.0, 0.0, 0.0]), 2.0), torch.tensor([2.15, 0.15, -10.0])),
    ),
    mistakes=(
        Mistake(lambda reward, is_demonstration, bonus: reward + bonus,
            "You add the bonus to every reward, even where the agent stays behind the trap: only demonstrations get "
            "it.",
            "The bonus is a new reward function."),
        Mistake(lambda reward, is_demonstration, bonus: reward + bonus * (1 - is_demonstration),
            "Your bonus goes to the agent's own driving: `is_demonstration` is 1 where the *rule* drove.",
            "The bonus encourages the agent, so its own driving gets it."),
        Mistake(lambda reward, is_demonstration, bonus: bonus * is_demonstration,
            "You drop the reward. (SQIL does that, and pays 1 or 0.) Here the bonus is added to the reward.",
            "The bonus replaces the reward."),
        Mistake(lambda reward, is_demonstration, bonus: reward * (1 + bonus * is_demonstration),
            "You multiply the reward. A demonstrated second that earns nothing has to get the bonus, too: add it.",
            "A bonus is a percentage."),
        Mistake(lambda reward, is_demonstration, bonus: (reward + bonus * is_demonstration).mean(),
            "You took the mean over the batch: each transition keeps its own reward.",
            "Everything in a loss ends in a mean."),
    ),
    hints=(
        "What is added where `is_demonstration` is 1, and what where it is 0?",
        "A product of two of the three arguments is the right amount in both cases.",
        "`reward + bonus * is_demonstration`",
    ),
    minutes=3, difficulty=1, equation="r'(s, a_E) = r(s, a_E) + c, Section IV-B",
)  # fmt: skip


def q_cases(rng):
    """Expert far ahead, ahead by less than the margin, behind, all equal, one state; then 40 at random."""
    q = torch.zeros(4, 9).double()
    q[0, 2], q[1, 2], q[2, 2] = 3.0, 0.4, -1.0
    yield q, torch.full((4,), 2)
    yield torch.tensor([[0.3, -0.2, 0.1]]), torch.tensor([1])
    yield torch.tensor([[-5.0, -7.0, -6.0], [-5.0, -7.0, -6.0]]), torch.tensor([0, 1])
    for _ in range(40):
        size = int(rng.integers(1, 6))
        yield torch.tensor(rng.normal(0, 1, (size, 9))), torch.tensor(rng.integers(0, 9, size))


def taken(q, expert_action):
    return q.gather(-1, expert_action.unsqueeze(-1)).squeeze(-1)


def others(q, expert_action):
    """q, with -∞ for the expert's action."""
    return q.scatter(-1, expert_action.unsqueeze(-1), -torch.inf)


large_margin_loss = Exercise(
    "large_margin_loss(q, expert_action)",
    solution=bootstrap.large_margin_loss, cases=q_cases,
    worked=(
        # the expert leads by 0.5: the loss is 0.5. It is behind by 2: 3. It leads by 2: 0.
        ((torch.tensor([[1.5, 1.0], [1.0, 3.0], [3.0, 1.0]]), torch.tensor([0, 0, 0])), torch.tensor([0.5, 3.0, 0.0])),
    ),
    mistakes=(
        Mistake(lambda q, expert: (q + 1).amax(-1) - taken(q, expert),
            "Your loss is at least 1: the expert's own action gets no margin, l(a_E, a_E) = 0.",
            "The margin is a constant in the formula."),
        Mistake(lambda q, expert: q.amax(-1) - taken(q, expert),
            "You have no margin: your loss is 0 as soon as the expert's Q equals the largest.",
            "It is enough that the expert's action is greedy. (A little noise can undo that.)"),
        Mistake(lambda q, expert: others(q, expert).amax(-1) + 1 - taken(q, expert),
            "Your loss goes below 0 where the expert leads by more than the margin: the maximum runs over *all* "
            "actions, the expert's included.",
            "The maximum is over the other actions."),
        Mistake(lambda q, expert:
            taken(q, expert) - (q + 1 - torch.nn.functional.one_hot(expert, q.shape[-1])).amax(-1),
            "Your sign is wrong: the loss grows with the expert's lead, so training would reduce the lead.",
            "The expert's value comes first, since it is the one that should be large."),
        Mistake(lambda q, expert: (q + 1 - torch.nn.functional.one_hot(expert, q.shape[-1])).sum(-1) - taken(q, expert),
            "You add up the actions. Only the largest counts: take the maximum.",
            "All wrong actions should be punished."),
        Mistake(lambda q, expert: bootstrap.large_margin_loss(q, expert).mean(),
            "You took the mean over the batch. Return one number for each state: the Q-filter comes next.",
            "A loss is a scalar."),
    ),
    hints=(
        "Add 1 to every action's Q but the expert's. By how much does the best of these exceed the expert's own Q?",
        "`torch.arange(q.shape[-1]) == expert_action.unsqueeze(-1)` is True in the expert's column.",
        "`(q + (~is_expert)).amax(-1) - q.gather(-1, expert_action.unsqueeze(-1)).squeeze(-1)`",
    ),
    minutes=8, difficulty=2, equation="J_E(Q) = max_a [Q(s,a) + l(a_E,a)] - Q(s,a_E), Section IV-B",
)  # fmt: skip

paper_q_filter = Exercise(
    "paper_q_filter(q, expert_action)",
    solution=bootstrap.paper_q_filter, cases=q_cases,
    worked=(
        # ahead, behind, and level with the best
        ((torch.tensor([[1.5, 1.0], [1.0, 3.0], [2.0, 2.0]]), torch.tensor([0, 0, 0])), torch.tensor([1.0, 0.0, 1.0])),
    ),
    mistakes=(
        Mistake(lambda q, expert: (taken(q, expert) > others(q, expert).amax(-1)).double(),
            "Your filter is off where the expert's Q equals the largest. The formula says ≥.",
            "At least as good means better."),
        Mistake(lambda q, expert: (taken(q, expert) < q.amax(-1)).double(),
            "Your filter is on where the printed one is off. That would make more sense, but this exercise asks for "
            "the printed one.",
            "A loss is needed where the expert is *not* greedy yet."),
        Mistake(lambda q, expert: (taken(q, expert) >= q.mean(-1)).double(),
            "You compare with the mean of Q. The printed filter compares with the *largest* Q.",
            "The expert is compared with the state's value, which is an average."),
        Mistake(lambda q, expert: (taken(q, expert) >= q.max()).double(),
            "You compare with the largest Q of the whole batch: each state has its own.",
            "`q.max()` works along the rows."),
        Mistake(lambda q, expert: (taken(q, expert) >= q.amax(-1)).double() * bootstrap.large_margin_loss(q, expert),
            "You return the filtered loss. The filter itself is 1 where it lets the loss through, else 0.",
            "The equation is about the filtered loss."),
    ),
    hints=(
        "Compare two numbers of each state: the expert's Q and the largest one.",
        "`q.gather(-1, expert_action.unsqueeze(-1)).squeeze(-1)` is the first, `q.amax(-1)` the second.",
        "`(q_expert >= q.amax(-1)).to(q.dtype)`",
    ),
    minutes=3, difficulty=1, equation="J_E^Q: on where Q(s,a_E) ≥ max_a Q(s,a), as printed in Section IV-B",
)  # fmt: skip


def filter_cases(rng):
    """All Q equal, an expert above the mean but below π's value, the opposite; then 40 at random."""
    even = torch.full((1, 3), -np.log(3)).double()
    greedy = torch.tensor([[0.02, 0.08, 0.9]]).double().log()
    yield torch.ones(2, 3).double(), torch.tensor([0, 2]), even.expand(2, 3).contiguous()
    yield torch.tensor([[1.0, 5.0, 6.0]]).double(), torch.tensor([1]), greedy
    yield torch.tensor([[9.0, 5.0, 1.0]]).double(), torch.tensor([1]), greedy
    for _ in range(40):
        size = int(rng.integers(1, 6))
        log_pi = torch.tensor(rng.normal(0, 2, (size, 9))).log_softmax(-1)
        yield torch.tensor(rng.normal(0, 1, (size, 9))), torch.tensor(rng.integers(0, 9, size)), log_pi


q_filter = Exercise(
    "q_filter(q, expert_action, log_pi)",
    solution=bootstrap.q_filter, cases=filter_cases,
    worked=(
        # π is worth 0.25 · 1 + 0.75 · 3 = 2.5, the expert's action 1; π is worth 1.5, the expert's action 3
        ((torch.tensor([[1.0, 3.0], [1.0, 3.0]]), torch.tensor([0, 1]),
          torch.tensor([[0.25, 0.75], [0.75, 0.25]]).log()),
         torch.tensor([0.0, 1.0])),
    ),
    mistakes=(
        Mistake(lambda q, expert, log_pi: bootstrap.paper_q_filter(q, expert),
            "This is the printed filter again: it compares with the largest Q, not with the mean of Q under π.",
            "Both filters ask whether the expert is at least as good."),
        Mistake(lambda q, expert, log_pi: (taken(q, expert) > q.mean(-1)).double(),
            "You give all actions the same weight. The policy's value is the mean of Q under *its* probabilities.",
            "The value of a state is the mean of its Q."),
        Mistake(lambda q, expert, log_pi: (taken(q, expert) < (log_pi.exp() * q).sum(-1)).double(),
            "Your filter is on where the policy is already better than the expert. It has to be on where the expert is "
            "better.",
            "The filter removes the demonstrations that are good."),
        Mistake(lambda q, expert, log_pi: (taken(q, expert) > taken(q, log_pi.argmax(-1))).double(),
            "You compare with the likeliest action's Q. The policy draws its action: take the mean under π.",
            "The policy takes its most probable action."),
        Mistake(lambda q, expert, log_pi: (taken(q, expert) > (log_pi * q).sum(-1)).double(),
            "You weigh Q with log π. The probabilities are `log_pi.exp()`.",
            "`log_pi` holds probabilities."),
    ),
    hints=(
        "What is the policy's own value in this state?",
        "The sum over actions of π Q. The filter is on where the expert's Q is above it.",
        "`(q_expert > (log_pi.exp() * q).sum(-1)).to(q.dtype)`",
    ),
    minutes=5, difficulty=2, equation="on where Q(s,a_E) > Σ_a π(a|s) Q(s,a); Nair et al., arXiv 1709.10089",
)  # fmt: skip
