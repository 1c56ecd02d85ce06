"""Answers to the exercises of the lesson on discrete SAC."""

import torch

from tests.answers import equivalent, right, right_lines, wrong_lines

equivalent("actor_loss", "alpha * log_pi  ->  alpha * log_pi.detach()", "its slope, -α, is the same for all actions")
MEAN = "state_entropy.detach().mean"
equivalent("temperature_loss", f"{MEAN}(-1)  ->  {MEAN}(0)", "the batch is the only axis")

right_lines("""critic_target
    with where: torch.where(terminated.bool(), reward, reward + gamma * next_value)
    one by one: targets = []
        for r, t, v in zip(reward, terminated, next_value, strict=True):
            targets.append(r if t else r + gamma * v)
        torch.stack(targets)
""")

wrong_lines("""critic_target
    in place: reward += gamma * (1 - terminated) * next_value; reward  # changes its argument `reward`
    a column: (reward + gamma * (1 - terminated) * next_value)[:, None]  # shape
""")

right_lines("""soft_value
    value and entropy: pi = log_pi.exp(); (pi * q).sum(-1) + alpha * torch.special.entr(pi).sum(-1)
    as a product: torch.einsum("ba,ba->b", torch.exp(log_pi), q - alpha * log_pi)
""")

wrong_lines("""soft_value
    a drawn action: drawn = torch.multinomial(log_pi.exp(), 1); (q - alpha * log_pi).gather(1, drawn)[:, 0]
    log sum exp: (alpha + 1e-6) * torch.logsumexp(q / (alpha + 1e-6), -1)
""")

right_lines("""actor_loss
    log pi detached in the bracket: -(log_pi.exp() * (q.detach() - alpha * log_pi.detach())).sum(-1).mean()
""")


@right("actor_loss")
def without_a_graph(log_pi, q, alpha):
    with torch.no_grad():
        worth = q.clone()
    pi = log_pi.exp()
    entropy = -(pi * log_pi).sum(-1)
    return -torch.mean((pi * worth).sum(-1) + alpha * entropy)


right_lines("""temperature_loss
    two means: gap = torch.mean(state_entropy.detach() - target_entropy); torch.exp(log_alpha) * gap
    gap as a number: gap = state_entropy.mean().item() - target_entropy.item(); gap * log_alpha.exp()
""")


right_lines("""critic_loss
    one critic after the other: rows, y = torch.arange(len(action)), target.detach()
        sum(torch.nn.functional.mse_loss(q[rows, action], y) for q in q_pair)
""")


@right("critic_loss")
def with_a_one_hot_mask(q_pair, action, target):
    taken = torch.nn.functional.one_hot(action, q_pair.shape[-1])
    with torch.no_grad():
        y = target.clone()
    return (((q_pair * taken).sum(-1) - y) ** 2).mean(dim=1).sum()


wrong_lines("""critic_loss
    a broadcast: sum(((q.gather(1, action[:, None]) - target.detach()) ** 2).mean() for q in q_pair)
""")
