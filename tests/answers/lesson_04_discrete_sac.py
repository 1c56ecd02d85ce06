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


# entropy --------------------------------------------------------------------------------------------


@right("entropy")
def with_torch_s_own(log_pi):
    return torch.distributions.Categorical(logits=log_pi).entropy()


@right("entropy")
def with_special_entr(log_pi):
    return torch.special.entr(log_pi.exp()).sum(dim=1)


@wrong("entropy", "mean over the batch")
def one_for_all(log_pi):
    return torch.distributions.Categorical(logits=log_pi).entropy().mean()


@wrong("entropy")
def of_the_logarithm(log_pi):
    return -(log_pi * torch.log(-log_pi + 1e-12)).sum(-1)


@wrong("entropy", "shape")
def each_action_s(log_pi):
    return -log_pi * log_pi.exp()


# soft_value -----------------------------------------------------------------------------------------


@right("soft_value")
def value_and_entropy(log_pi, q, alpha):
    pi = log_pi.exp()
    return (pi * q).sum(-1) + alpha * torch.special.entr(pi).sum(-1)


@right("soft_value")
def as_a_product(log_pi, q, alpha):
    return torch.einsum("ba,ba->b", torch.exp(log_pi), q - alpha * log_pi)


@wrong("soft_value")
def a_drawn_action(log_pi, q, alpha):
    drawn = torch.multinomial(log_pi.exp(), 1)
    return (q - alpha * log_pi).gather(1, drawn)[:, 0]


@wrong("soft_value")
def log_sum_exp(log_pi, q, alpha):
    return (alpha + 1e-6) * torch.logsumexp(q / (alpha + 1e-6), -1)


# actor_loss -----------------------------------------------------------------------------------------


@right("actor_loss")
def mean_cost(log_pi, q, alpha):
    return (log_pi.exp() * (alpha * log_pi - q.detach())).sum(-1).mean()


@right("actor_loss")
def without_a_graph(log_pi, q, alpha):
    with torch.no_grad():
        worth = q.clone()
    pi = log_pi.exp()
    entropy = -(pi * log_pi).sum(-1)
    return -torch.mean((pi * worth).sum(-1) + alpha * entropy)


@wrong("actor_loss")
def weights_detached(log_pi, q, alpha):
    return (log_pi.exp().detach() * (alpha * log_pi - q.detach())).sum(-1).mean()


@wrong("actor_loss")
def summed_over_the_batch(log_pi, q, alpha):
    return (log_pi.exp() * (alpha * log_pi - q.detach())).sum() * 2


# temperature_loss -----------------------------------------------------------------------------------


@right("temperature_loss")
def two_means(log_alpha, state_entropy, target_entropy):
    gap = torch.mean(state_entropy.detach() - target_entropy)
    return torch.exp(log_alpha) * gap


@right("temperature_loss")
def gap_as_a_number(log_alpha, state_entropy, target_entropy):
    gap = state_entropy.mean().item() - target_entropy.item()
    return gap * log_alpha.exp()


@wrong("temperature_loss", "add the target")
def plus_target(log_alpha, state_entropy, target_entropy):
    return log_alpha.exp() * (state_entropy.detach() + target_entropy).mean()


@wrong("temperature_loss")
def squared(log_alpha, state_entropy, target_entropy):
    return log_alpha.exp() * (state_entropy.detach().mean() - target_entropy) ** 2
