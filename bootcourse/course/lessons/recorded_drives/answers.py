"""Answers to the exercises of the lesson on learning from recorded drives."""

import torch
from torch.nn import functional

from tests.answers import equivalent, right, right_lines, wrong_lines

right_lines("""imitation_reward
    log of a sum: torch.logaddexp(own_logits, torch.zeros_like(own_logits))
    by symmetry: -functional.logsigmoid(-own_logits)
""")

wrong_lines("""imitation_reward
    cut at zero: torch.relu(own_logits)
    with numpy: np.logaddexp(0, own_logits.numpy())  # training needs one
    one for the batch: functional.softplus(own_logits).mean()  # shape
""")


TERMS = "(q.logsumexp(-1) - q.gather(-1, actions.unsqueeze(-1)).squeeze(-1))"
equivalent("conservative_loss", f"{TERMS}.mean(-1)  ->  {TERMS}.mean(0)", "the batch is the only axis left")


right_lines("""conservative_loss
    as a clone of softmax: functional.cross_entropy(q, actions)
    state by state: total = 0.0
        for row, action in zip(q, actions, strict=True):
            total = total + torch.logsumexp(row, 0) - row[action]
        total / len(q)
""")

wrong_lines("""conservative_loss
    the sum of exponentials: total = 0.0
        for row, action in zip(q, actions, strict=True):
            total = total + torch.log(torch.exp(row).sum()) - row[action]
        total / len(q)  # right on paper
    clamped first: (q.clamp(-50, 50).exp().sum(-1).log() - q.gather(-1, actions[:, None])[:, 0]).mean()
    less the largest of the batch: top = q.max()
        (top + (q - top).exp().sum(-1).log() - q.gather(-1, actions[:, None])[:, 0]).mean()
    as a number: functional.cross_entropy(q, actions).item()  # no gradient reaches `q`
    only the others: others = q.masked_fill(functional.one_hot(actions, q.shape[-1]).bool(), -torch.inf)
        (others.logsumexp(-1) - q.gather(-1, actions.unsqueeze(-1)).squeeze(-1)).mean()
""")


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


wrong_lines("""offline_loss
    with the data's next action:
        y = rewards + gamma * (1 - terminated) * next_target.gather(1, actions[:, None])[:, 0].detach()
        functional.mse_loss(q.gather(1, actions[:, None])[:, 0], y) + weight * functional.cross_entropy(q, actions)
    with half of it detached: squares = with_no_grad(q, next_q, next_target, actions, rewards, terminated, gamma, 0.0)
        squares + weight * functional.cross_entropy(q.detach(), actions)  # slope in `q` is wrong
""")

wrong_lines("""offline_loss
    a capped target: next_value = next_target.gather(-1, next_q.argmax(-1, keepdim=True))[:, 0]
        target = (rewards + gamma * (1 - terminated) * next_value).clamp(-20, 20).detach()
        taken = q.gather(-1, actions[:, None])[:, 0]
        (taken - target).square().mean() + weight * (q.logsumexp(-1) - taken).mean()
    a softer square: next_value = next_target.gather(-1, next_q.argmax(-1, keepdim=True))[:, 0]
        target, taken = (rewards + gamma * (1 - terminated) * next_value).detach(), q.gather(-1, actions[:, None])[:, 0]
        2 * functional.huber_loss(taken, target, delta=25.0) + weight * (q.logsumexp(-1) - taken).mean()
    the sum of exponentials: taken = q.gather(-1, actions[:, None])[:, 0]
        solution(q, next_q, next_target, actions, rewards, terminated, gamma, 0.0) + weight * (
            q.exp().sum(-1).log() - taken).mean()  # right on paper
""")
