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
        ratio = torch.exp((one_hot * log_pi).sum(-1)) / torch.exp(old_log_pi)
        good = (advantage - advantage.mean()) / advantage.std()
        paid = torch.stack([ratio * good, ratio.clamp(1 - clip, 1 + clip) * good]).amin(0)
        (0.5 * (returns - values) ** 2 - paid + entropy_weight * (p * log_pi).sum(-1)).mean()
""")  # noqa: E501

wrong_lines("""ppo_loss
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
