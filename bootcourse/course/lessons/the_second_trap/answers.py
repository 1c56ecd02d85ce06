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
