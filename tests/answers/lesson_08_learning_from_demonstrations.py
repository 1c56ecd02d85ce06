"""Answers to the exercises of the lesson on learning from demonstrations."""

import numpy as np
import torch

from tests.answers import right, wrong

# demonstration_share --------------------------------------------------------------------------------


@right("demonstration_share")
def what_is_left(episode, beta_start, beta_episodes):
    left = np.maximum(beta_episodes - episode, 0)
    return beta_start * left / beta_episodes


@right("demonstration_share")
def interpolated(episode, beta_start, beta_episodes):
    return np.interp(episode, [0, beta_episodes], [beta_start, 0.0])


@wrong("demonstration_share")
def halving(episode, beta_start, beta_episodes):
    return beta_start * 0.5 ** (episode / beta_episodes)


@wrong("demonstration_share")
def a_switch(episode, beta_start, beta_episodes):
    return np.where(np.asarray(episode) < beta_episodes, beta_start, 0.0)


@wrong("demonstration_share", "raises an error")
def numbers_only(episode, beta_start, beta_episodes):
    return max(0.0, beta_start * (1 - episode / beta_episodes))


# augmented_reward -----------------------------------------------------------------------------------


@right("augmented_reward")
def with_where(reward, is_demonstration, bonus):
    return torch.where(is_demonstration > 0, reward + bonus, reward)


@right("augmented_reward")
def on_a_copy(reward, is_demonstration, bonus):
    paid = reward.clone()
    paid[is_demonstration.bool()] += bonus
    return paid


@wrong("augmented_reward", "own driving")
def to_the_agent(reward, is_demonstration, bonus):
    return torch.where(is_demonstration > 0, reward, reward + bonus)


@wrong("augmented_reward", "multiply the reward")
def a_percentage(reward, is_demonstration, bonus):
    return reward + bonus * is_demonstration * reward


@wrong("augmented_reward")
def subtracted(reward, is_demonstration, bonus):
    return reward - bonus * is_demonstration


@wrong("augmented_reward", "changes its argument `reward`")
def in_place(reward, is_demonstration, bonus):
    reward += bonus * is_demonstration
    return reward


# large_margin_loss ----------------------------------------------------------------------------------


def of_expert(q, expert_action):
    return q[torch.arange(len(q)), expert_action]


@right("large_margin_loss")
def with_one_hot(q, expert_action):
    margin = 1 - torch.nn.functional.one_hot(expert_action, q.shape[-1])
    return (q + margin).max(dim=-1).values - of_expert(q, expert_action)


@right("large_margin_loss")
def rivals_and_relu(q, expert_action):
    rivals = q.scatter(-1, expert_action[:, None], float("-inf")).amax(-1)
    return torch.relu(rivals + 1 - of_expert(q, expert_action))


@wrong("large_margin_loss")
def margin_for_the_expert(q, expert_action):
    margin = torch.nn.functional.one_hot(expert_action, q.shape[-1])
    return (q + margin).amax(-1) - of_expert(q, expert_action)


@wrong("large_margin_loss")
def cross_entropy(q, expert_action):
    return torch.nn.functional.cross_entropy(q, expert_action, reduction="none")


# paper_q_filter -------------------------------------------------------------------------------------


@right("paper_q_filter")
def nobody_is_better(q, expert_action):
    return 1.0 - (q > of_expert(q, expert_action)[:, None]).any(dim=1).double()


@right("paper_q_filter")
def level_with_the_best(q, expert_action):
    return torch.where(of_expert(q, expert_action) == q.max(dim=1).values, 1.0, 0.0)


@wrong("paper_q_filter")
def always_on(q, expert_action):
    return torch.ones(len(q))


@wrong("paper_q_filter")
def never_on(q, expert_action):
    return (of_expert(q, expert_action) > q.amax(-1)).double()


# q_filter -------------------------------------------------------------------------------------------


@right("q_filter")
def advantage(q, expert_action, log_pi):
    worth = torch.einsum("ba,ba->b", log_pi.exp(), q)
    return torch.heaviside(of_expert(q, expert_action) - worth - 1e-9, torch.zeros(1, dtype=q.dtype))


@right("q_filter")
def with_where_again(q, expert_action, log_pi):
    worth = (torch.exp(log_pi) * q).sum(dim=1)
    return torch.where(of_expert(q, expert_action) > worth, 1.0, 0.0)


@wrong("q_filter")
def with_the_expert_s_probability(q, expert_action, log_pi):
    return (of_expert(q * log_pi.exp(), expert_action) > (log_pi.exp() * q).sum(-1)).double()


@wrong("q_filter", "shape")
def for_each_action(q, expert_action, log_pi):
    return (q > (log_pi.exp() * q).sum(-1, keepdim=True)).double()
