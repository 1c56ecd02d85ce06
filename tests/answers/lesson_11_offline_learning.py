"""Answers to the exercises of the lesson on offline learning."""

import numpy as np
import torch
from torch.nn import functional

from tests.answers import equivalent, right, wrong

# conservative_loss ------------------------------------------------------------------------------------


TERMS = "(q.logsumexp(-1) - q.gather(-1, actions.unsqueeze(-1)).squeeze(-1))"
equivalent("conservative_loss", f"{TERMS}.mean(-1)  ->  {TERMS}.mean(0)", "the batch is the only axis left")


@right("conservative_loss")
def as_a_clone_of_softmax(q, actions):
    return functional.cross_entropy(q, actions)


@right("conservative_loss")
def state_by_state(q, actions):
    total = 0.0
    for row, action in zip(q, actions, strict=True):
        total = total + torch.log(torch.exp(row).sum()) - row[action]
    return total / len(q)


@wrong("conservative_loss", "no gradient reaches `q`")
def as_a_number(q, actions):
    return functional.cross_entropy(q, actions).item()


@wrong("conservative_loss")
def only_the_others(q, actions):
    others = q.masked_fill(functional.one_hot(actions, q.shape[-1]).bool(), -torch.inf)
    return (others.logsumexp(-1) - q.gather(-1, actions.unsqueeze(-1)).squeeze(-1)).mean()


@wrong("conservative_loss")
def summed(q, actions):
    return functional.cross_entropy(q, actions, reduction="sum")


@wrong("conservative_loss", "no gradient")
def with_numpy(q, actions):
    rows = q.detach().numpy()
    return torch.tensor((np.log(np.exp(rows).sum(-1)) - rows[np.arange(len(rows)), actions.numpy()]).mean())


@wrong("conservative_loss")
def over_the_states(q, actions):
    return (q.logsumexp(0).mean() - q.gather(-1, actions.unsqueeze(-1)).squeeze(-1)).mean()


@wrong("conservative_loss")
def of_nine_actions_each_with_its_share(q, actions):
    return (q.softmax(-1) * q).sum(-1).mean() - q.gather(-1, actions.unsqueeze(-1)).mean()


# offline_loss -----------------------------------------------------------------------------------------


BEST = "next_q.argmax(-1, keepdim=True)"
equivalent("offline_loss", f"{BEST}  ->  {BEST.replace('.', '.detach().', 1)}", "an index has no gradient")
equivalent(
    "offline_loss",
    f"next_target.gather(-1, {BEST})  ->  next_target.detach().gather(-1, {BEST})",
    "the whole target is detached afterwards",
)


@right("offline_loss")
def with_no_grad(q, next_q, next_target, actions, rewards, terminated, gamma, weight):
    with torch.no_grad():
        best = next_q.argmax(dim=1)
        y = rewards + gamma * next_target[torch.arange(len(best)), best] * (1 - terminated)
    taken = q[torch.arange(len(actions)), actions]
    return functional.mse_loss(taken, y) + weight * functional.cross_entropy(q, actions)


@right("offline_loss")
def row_by_row(q, next_q, next_target, actions, rewards, terminated, gamma, weight):
    total = 0.0
    for i, action in enumerate(actions):
        after = next_target[i, next_q[i].argmax()].detach() if terminated[i] == 0 else 0.0
        total = total + (q[i, action] - rewards[i] - gamma * after) ** 2 + weight * (q[i].logsumexp(0) - q[i, action])
    return total / len(actions)


@wrong("offline_loss")
def half_squared(q, next_q, next_target, actions, rewards, terminated, gamma, weight):
    y = rewards + gamma * (1 - terminated) * next_target.gather(1, next_q.argmax(1, keepdim=True))[:, 0].detach()
    taken = q.gather(1, actions[:, None])[:, 0]
    return 0.5 * (taken - y).pow(2).mean() + weight * functional.cross_entropy(q, actions)


@wrong("offline_loss")
def summed_over_the_batch(q, next_q, next_target, actions, rewards, terminated, gamma, weight):
    return len(q) * with_no_grad(q, next_q, next_target, actions, rewards, terminated, gamma, weight)


@wrong("offline_loss")
def with_a_number_for_gamma(q, next_q, next_target, actions, rewards, terminated, gamma, weight):
    return with_no_grad(q, next_q, next_target, actions, rewards, terminated, 0.8, weight)


@wrong("offline_loss")
def with_the_data_s_next_action(q, next_q, next_target, actions, rewards, terminated, gamma, weight):
    y = rewards + gamma * (1 - terminated) * next_target.gather(1, actions[:, None])[:, 0].detach()
    return functional.mse_loss(q.gather(1, actions[:, None])[:, 0], y) + weight * functional.cross_entropy(q, actions)


@wrong("offline_loss")
def all_actions_learn(q, next_q, next_target, actions, rewards, terminated, gamma, weight):
    y = rewards + gamma * (1 - terminated) * next_target.gather(1, next_q.argmax(1, keepdim=True))[:, 0].detach()
    return (q - y[:, None]).pow(2).mean() + weight * functional.cross_entropy(q, actions)


@wrong("offline_loss", "no gradient reaches `q`")
def as_a_number_too(q, next_q, next_target, actions, rewards, terminated, gamma, weight):
    return with_no_grad(q, next_q, next_target, actions, rewards, terminated, gamma, weight).item()


@wrong("offline_loss", "slope in `q` is wrong")
def with_half_of_it_detached(q, next_q, next_target, actions, rewards, terminated, gamma, weight):
    squares = with_no_grad(q, next_q, next_target, actions, rewards, terminated, gamma, 0.0)
    return squares + weight * functional.cross_entropy(q.detach(), actions)


@wrong("offline_loss")
def with_the_smallest_next_value(q, next_q, next_target, actions, rewards, terminated, gamma, weight):
    return with_no_grad(q, -next_q, next_target, actions, rewards, terminated, gamma, weight)


# share_of_the_bound -----------------------------------------------------------------------------------


@right("share_of_the_bound")
def of_sums(returns, bound):
    return returns.sum(axis=1) / bound.sum()


@right("share_of_the_bound")
def weighted(returns, bound):
    return np.average(returns / bound, axis=1, weights=bound)


@wrong("share_of_the_bound", "share of its own")
def of_all_agents(returns, bound):
    return np.mean([row.mean() for row in returns]) / bound.mean()


@wrong("share_of_the_bound")
def upside_down(returns, bound):
    return bound.mean() / returns.mean(axis=1)


@wrong("share_of_the_bound")
def by_road(returns, bound):
    return returns.mean(axis=0) / bound


@wrong("share_of_the_bound", "clip at 1")
def not_above_the_bound(returns, bound):
    return np.array([min(1.0, row.sum() / bound.sum()) for row in returns])


@right("conservative_loss")
def a_row_of_nine_marks(q, actions):
    return (q.logsumexp(-1) - (functional.one_hot(actions, 9) * q).sum(-1)).mean()


@right("offline_loss")
def action_by_action(q, next_q, next_target, actions, rewards, terminated, gamma, weight):
    own, best = functional.one_hot(actions, 9), functional.one_hot(next_q.argmax(-1), 9)
    y = rewards + gamma * (1 - terminated) * (best * next_target.detach()).sum(-1)
    return (((own * q).sum(-1) - y) ** 2).mean() + weight * functional.cross_entropy(q, actions)


@right("share_of_the_bound")
def agent_by_agent(returns, bound):
    return [sum(row) / sum(bound) for row in returns.tolist()]


@wrong("share_of_the_bound")
def of_the_middle_road(returns, bound):
    return np.median(returns, axis=1) / np.median(bound)


@wrong("share_of_the_bound")
def in_percent(returns, bound):
    return 100 * returns.mean(axis=1) / bound.mean()
