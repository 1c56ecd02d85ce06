"""Exercises of the lesson on discrete SAC."""

import torch

from bootcourse.learn import sac
from bootcourse.lessons.exercise import Exercise, Mistake


def cases(rng):
    """All ended, none ended, a batch of one, γ = 1 and γ = 0; then 60 at random."""

    def batch(size, ended, gamma):
        reward, value = torch.tensor(rng.normal(0, 3, (2, size)))
        return reward, torch.tensor(rng.random(size) < ended).double(), value, gamma

    for size, ended, gamma in ((4, 1.0, 0.8), (4, 0.0, 0.8), (1, 0.0, 0.9), (3, 0.5, 1.0), (3, 0.5, 0.0)):
        yield batch(size, ended, gamma)
    for _ in range(60):
        yield batch(int(rng.integers(1, 7)), 0.4, float(rng.uniform(0.1, 0.99)))


critic_target = Exercise(
    call="critic_target(reward, terminated, next_value, gamma)",
    solution=sac.critic_target,
    worked=(
        # it goes on: 1 + 0.8 · 10; it ended: -10 and nothing after it
        (
            (torch.tensor([1.0, -10.0]), torch.tensor([0.0, 1.0]), torch.tensor([10.0, 10.0]), 0.8),
            torch.tensor([9.0, -10.0]),
        ),
    ),
    cases=cases,
    mistakes=(
        Mistake(
            answer=lambda reward, terminated, next_value, gamma: reward + gamma * next_value,
            says="Your target counts on a future after the accident. Where an episode ended, only its reward is left.",
            belief="The mask is bookkeeping that the average evens out. It does not: -10 plus a rosy V' is no warning.",
        ),
        Mistake(
            answer=lambda reward, terminated, next_value, gamma: reward + gamma * terminated * next_value,
            says="Your mask is turned round: `terminated` is 1 where the episode ended, and there nothing may follow.",
            belief="`terminated` is taken for 'still alive'.",
        ),
        Mistake(
            answer=lambda reward, terminated, next_value, gamma: (1 - terminated) * (reward + gamma * next_value),
            says="You also mask the reward. The last reward, here the accident's -10, is the one that must be heard.",
            belief="A terminated row is one to ignore.",
        ),
        Mistake(
            answer=lambda reward, terminated, next_value, gamma: reward + (1 - terminated) * next_value,
            says="Your future is not discounted: a reward one second later counts γ times as much.",
            belief="γ is already inside the value. It is, from the second step on.",
        ),
        Mistake(
            answer=lambda reward, terminated, next_value, gamma: gamma * (reward + (1 - terminated) * next_value),
            says="You discount this second's reward, too. γ belongs to what comes later.",
            belief="γ multiplies everything on the right-hand side.",
        ),
        Mistake(
            answer=lambda reward, terminated, next_value, gamma: (
                reward + gamma * (1 - terminated) * next_value
            ).mean(),
            says="You took the mean over the batch. Each transition has its own target; the mean comes in the loss.",
            belief="Losses end in a mean, so targets do.",
        ),
    ),
    hints=(
        "What is a transition worth if it ended the episode? And what if it did not?",
        "`1 - terminated` is 1 where the road goes on, and 0 where it ended.",
        "`reward + gamma * (1 - terminated) * ...`",
    ),
    minutes=5,
    difficulty=1,
    equation="y = r + γ (1 - terminated) V(s'), Section III-C",
)
