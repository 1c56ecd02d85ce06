"""Answers to the exercises of the lesson on the second trap."""

import torch

from tests.answers import equivalent, right, right_lines, wrong_lines

PAIR = "(torch.empty_like(delta), torch.zeros_like(delta[0]))"
equivalent(
    "advantages", f"{PAIR}  ->  (delta, torch.zeros_like(delta[0]))", "each surprise is read before it is replaced"
)
equivalent("advantages", "delta[0]  ->  delta[-1]", "only its shape")
PAID = "torch.minimum(ratio * advantage, ratio.clamp(1 - clip, 1 + clip) * advantage)"
equivalent("clipped_loss", f"{PAID}.mean(-1)  ->  {PAID}.mean(0)", "one agent's batch has one axis")


@right("advantages")
def as_sums(rewards, values, next_values, terminated, ended, gamma, lam):
    """Equation 16 as it is printed: for each decision a sum over the later surprises of its episode."""
    found = torch.zeros_like(rewards)
    for t in range(len(rewards)):
        weight = torch.ones_like(rewards[0])
        for later in range(t, len(rewards)):
            surprise = rewards[later] + gamma * (1 - terminated[later]) * next_values[later] - values[later]
            found[t] = found[t] + weight * surprise
            weight = weight * gamma * lam * (1 - ended[later])
    return found


wrong_lines("""advantages
    with the next row's value: shifted = torch.cat([values[1:], next_values[-1:]])
        as_sums(rewards, values, shifted, terminated, ended, gamma, lam)
""")

right_lines("""clipped_loss
    by cases: limit = torch.where(advantage > 0, torch.full_like(ratio, 1 + clip), torch.full_like(ratio, 1 - clip))
        beyond = torch.where(advantage > 0, ratio > limit, ratio < limit)
        -(torch.where(beyond, limit, ratio) * advantage).mean()
    as a maximum of losses: both = torch.stack([-ratio * advantage, -torch.clip(ratio, 1 - clip, 1 + clip) * advantage])
        both.amax(0).mean()
""")

wrong_lines("""clipped_loss
    with numpy: r, a = ratio.detach().numpy(), advantage.numpy()
        torch.tensor(-np.minimum(r * a, np.clip(r, 1 - clip, 1 + clip) * a).mean())  # gradient
    clipped above only: -torch.minimum(ratio * advantage, ratio.clamp(max=1 + clip) * advantage).mean()
""")

right_lines("""ppo_loss
    row by row: rows = torch.arange(len(actions))
        ratio = torch.exp(log_pi[rows, actions] - old_log_pi)
        good = (advantage - advantage.mean()) / (torch.std(advantage) + 1e-8)
        policy = -torch.minimum(ratio * good, ratio.clamp(1 - clip, 1 + clip) * good).mean()
        policy + 0.5 * torch.nn.functional.mse_loss(values, returns) + entropy_weight * (log_pi.exp() * log_pi).sum(-1).mean()
    as a sum of rows: p = log_pi.exp()
        one_hot = torch.nn.functional.one_hot(actions, log_pi.shape[-1])
        ratio = torch.exp((one_hot * log_pi).sum(-1) - old_log_pi)
        good = (advantage - advantage.mean()) / advantage.std()
        paid = torch.stack([ratio * good, ratio.clamp(1 - clip, 1 + clip) * good]).amin(0)
        (0.5 * (returns - values) ** 2 - paid + entropy_weight * (p * log_pi).sum(-1)).mean()
    with a distribution: now = torch.distributions.Categorical(logits=log_pi)
        good = (advantage - advantage.mean()) / (advantage.std() + 1e-5)
        ratio = (now.log_prob(actions) - old_log_pi).exp()
        policy_loss = -torch.min(ratio * good, ratio.clamp(1 - clip, 1 + clip) * good).mean()
        policy_loss + functional.mse_loss(values, returns) / 2 - entropy_weight * now.entropy().mean()
""")  # noqa: E501

wrong_lines("""ppo_loss
    a ratio of two probabilities: p = log_pi.exp(); ratio = p.gather(-1, actions[:, None])[:, 0] / old_log_pi.exp()
        good = (advantage - advantage.mean()) / (advantage.std() + 1e-8)
        paid = torch.minimum(ratio * good, ratio.clamp(1 - clip, 1 + clip) * good)
        (0.5 * (returns - values) ** 2 - paid + entropy_weight * (p * log_pi).sum(-1)).mean()  # right on paper
    an entropy without a slope: ratio = (log_pi.gather(-1, actions[:, None])[:, 0] - old_log_pi).exp()
        good = (advantage - advantage.mean()) / (advantage.std() + 1e-8)
        paid = torch.minimum(ratio * good, ratio.clamp(1 - clip, 1 + clip) * good)
        entropy = torch.special.entr(log_pi.exp()).sum(-1)
        (0.5 * (returns - values) ** 2 - paid - entropy_weight * entropy).mean()  # the slope of p log p
    a capped error: value_loss = (values - returns).clamp(-10, 10).square().mean() - (values - returns).square().mean()
        solution(log_pi, values, actions, old_log_pi, advantage, returns, clip, entropy_weight) + value_loss / 2
    nothing clipped: solution(log_pi, values, actions, old_log_pi, advantage, returns, 1e9, entropy_weight)
""")


SCALED = "(advantage - advantage.mean()) / (advantage.std() {})"
for _change, _why in {
    f"{SCALED.format('+ 1e-08')}  ->  {SCALED.format('- 1e-08')}": "the deviation is far larger",
    "advantage.std() + 1e-08  ->  advantage.std() + -1e-08": "the deviation is far larger",
    "advantage.std() + 1e-08  ->  advantage.std() + 1.0100000000000001e-08": "the deviation is far larger",
    "(:, 0)  ->  (:, -1)": "there is one column",
}.items():
    equivalent("ppo_loss", _change, _why)

wrong_lines("""advantages
    capped: solution(rewards, values, next_values, terminated, ended, gamma, lam).clamp(-50, 50)
    twenty decisions ahead: found = rewards + gamma * (1 - terminated) * next_values - values
        delta, weight = found.clone(), torch.ones_like(found)
        for k in range(1, min(20, len(delta))):
            weight = weight[: len(delta) - k] * gamma * lam * (1 - ended[k - 1 : len(delta) - 1])
            found[: len(delta) - k] += weight * delta[k:]
        found
""")

wrong_lines("""clipped_loss
    the dual clip: paid = torch.minimum(ratio * advantage, ratio.clamp(1 - clip, 1 + clip) * advantage)
        -torch.where(advantage < 0, torch.maximum(paid, 10 * advantage), paid).mean()
    small advantages: solution(ratio, advantage.clamp(-20, 20), clip)
""")

equivalent(
    "ppo_loss",
    "log_pi.exp() * log_pi  ->  log_pi.exp() * log_pi.detach()",
    "the slope that is lost is that of Σ π = 1, which is 0 in the logits",
)
