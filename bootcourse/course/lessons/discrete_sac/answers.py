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
    filled: reward + (gamma * next_value).masked_fill(terminated > 0.5, 0.0)
""")

wrong_lines("""critic_target
    in place: reward += gamma * (1 - terminated) * next_value; reward  # changes its argument `reward`
    at most 20: solution(reward, terminated, next_value, gamma).clamp(-20, 20)
    values at most 100: solution(reward, terminated, next_value.clamp(-100, 100), gamma)
    rewards at most 10: solution(reward.clamp(-10, 10), terminated, next_value, gamma)
    an end is a low reward: reward + gamma * (reward > -5) * next_value
    a column: (reward + gamma * (1 - terminated) * next_value)[:, None]  # shape
""")

right_lines("""soft_value
    a distribution: policy = torch.distributions.Categorical(logits=log_pi)
        (policy.probs * q).sum(1) + alpha * policy.entropy()
    where it is not 0: pi = log_pi.exp()
        (pi * q).sum(-1) - alpha * torch.where(pi > 0, pi * log_pi, 0.0).sum(-1)
    a tiny number in the logarithm: pi = log_pi.exp(); (pi * (q - alpha * (pi + 1e-8).log())).sum(-1)
    value and entropy: pi = log_pi.exp(); (pi * q).sum(-1) + alpha * torch.special.entr(pi).sum(-1)
    as a product: torch.einsum("ba,ba->b", torch.exp(log_pi), q - alpha * log_pi)
""")

wrong_lines("""soft_value
    a drawn action: drawn = torch.multinomial(log_pi.exp(), 1); (q - alpha * log_pi).gather(1, drawn)[:, 0]
    the logarithm of pi: pi = log_pi.exp(); (pi * (q - alpha * pi.log())).sum(-1)  # Use `log_pi` itself
    too much in the logarithm: pi = log_pi.exp(); (pi * (q - alpha * (pi + 1e-6).log())).sum(-1)
    q at most 20: solution(log_pi, q.clamp(-20, 20), alpha)
    alpha at most 1: solution(log_pi, q, alpha.clamp(max=1))
    alpha at least 0.001: solution(log_pi, q, alpha.clamp(min=0.001))
    log sum exp: (alpha + 1e-6) * torch.logsumexp(q / (alpha + 1e-6), -1)
""")

right_lines("""actor_loss
    a distribution: policy = torch.distributions.Categorical(logits=log_pi)
        -((policy.probs * q.detach()).sum(-1) + alpha * policy.entropy()).mean()
    as a cost: torch.einsum("ba,ba->", log_pi.exp(), alpha * log_pi - q.detach()) / len(q)
    log pi detached in the bracket: -(log_pi.exp() * (q.detach() - alpha * log_pi.detach())).sum(-1).mean()
""")


@right("actor_loss")
def without_a_graph(log_pi, q, alpha):
    with torch.no_grad():
        worth = q.clone()
    pi = log_pi.exp()
    entropy = -(pi * log_pi).sum(-1)
    return -torch.mean((pi * worth).sum(-1) + alpha * entropy)


wrong_lines("""actor_loss
    the logarithm of pi: pi = log_pi.exp()
        -(pi * (q.detach() - alpha * pi.log())).sum(-1).mean()  # Use `log_pi` itself
    pi at least 1e-4: pi = log_pi.exp(); -(pi * (q.detach() - alpha * pi.clamp(min=1e-4).log())).sum(-1).mean()
    q at most 20: solution(log_pi, q.clamp(-20, 20), alpha)
    alpha at least 0.01: solution(log_pi, q, alpha.clamp(min=0.01))
    the entropy detached: entropy = -(log_pi.exp() * log_pi).sum(-1).detach()
        -((log_pi.exp() * q.detach()).sum(-1) + alpha * entropy).mean()
""")

right_lines("""temperature_loss
    two means: gap = torch.mean(state_entropy.detach() - target_entropy); torch.exp(log_alpha) * gap
    gap as a number: gap = state_entropy.mean().item() - target_entropy.item(); gap * log_alpha.exp()
""")


wrong_lines("""temperature_loss
    alpha at least 0.00005: solution(log_alpha.clamp(min=-10), state_entropy, target_entropy)
    alpha at most 2: solution(log_alpha.clamp(max=0.7), state_entropy, target_entropy)
    on target is near enough: gap = state_entropy.detach().mean() - target_entropy
        log_alpha.exp() * gap * (gap.abs() > 0.01)
""")


right_lines("""critic_loss
    taken along: q = torch.take_along_dim(q_pair, action[None, :, None], dim=2)[..., 0]
        (q - target.data).square().mean(-1).sum()
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
    errors at most 10: q = q_pair[:, torch.arange(len(action)), action]
        (q - target.detach()).clamp(-10, 10).square().mean(-1).sum()
    huber: q = q_pair[:, torch.arange(len(action)), action]
        2 * sum(functional.huber_loss(each, target.detach(), delta=20.0) for each in q)
    targets at most 20: solution(q_pair, action, target.clamp(-20, 20))
    q at most 50: solution(q_pair.clamp(-50, 50), action, target)
    the second detached: q1, q2 = q_pair[:, torch.arange(len(action)), action]
        (q1 - target.detach()).square().mean() + (q2.detach() - target.detach()).square().mean()
    a broadcast: sum(((q.gather(1, action[:, None]) - target.detach()) ** 2).mean() for q in q_pair)
""")
