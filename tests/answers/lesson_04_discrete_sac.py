"""Answers to the exercises of the lesson on discrete SAC."""

import torch

from tests.answers import right, wrong


@right("critic_target")
def with_a_mask(reward, terminated, next_value, gamma):
    alive = 1 - terminated
    return reward + gamma * alive * next_value


@right("critic_target")
def with_where(reward, terminated, next_value, gamma):
    return torch.where(terminated.bool(), reward, reward + gamma * next_value)


@right("critic_target")
def one_by_one(reward, terminated, next_value, gamma):
    targets = []
    for r, t, v in zip(reward, terminated, next_value, strict=True):
        targets.append(r if t else r + gamma * v)
    return torch.stack(targets)


@wrong("critic_target", "after the accident")
def unmasked(reward, terminated, next_value, gamma):
    return reward + gamma * next_value


@wrong("critic_target", "mask is turned round")
def mask_turned(reward, terminated, next_value, gamma):
    return reward + gamma * terminated * next_value


@wrong("critic_target", "mask the reward")
def reward_masked(reward, terminated, next_value, gamma):
    return (reward + gamma * next_value) * (1 - terminated)


@wrong("critic_target", "not discounted")
def undiscounted(reward, terminated, next_value, gamma):
    return reward + (1 - terminated) * next_value


@wrong("critic_target", "discount this second's reward")
def all_discounted(reward, terminated, next_value, gamma):
    return gamma * reward + gamma * (1 - terminated) * next_value


@wrong("critic_target", "mean over the batch")
def averaged(reward, terminated, next_value, gamma):
    return torch.mean(reward + gamma * (1 - terminated) * next_value)


@wrong("critic_target")
def subtracted(reward, terminated, next_value, gamma):
    return reward - gamma * (1 - terminated) * next_value


@wrong("critic_target")
def reward_only(reward, terminated, next_value, gamma):
    return reward


@wrong("critic_target", "changes its argument `reward`")
def in_place(reward, terminated, next_value, gamma):
    reward += gamma * (1 - terminated) * next_value
    return reward


@wrong("critic_target", "shape")
def a_column(reward, terminated, next_value, gamma):
    return (reward + gamma * (1 - terminated) * next_value)[:, None]
