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


@right("advantages")
def road_by_road(rewards, values, next_values, terminated, ended, gamma, lam):
    horizon, roads = rewards.shape
    found = torch.zeros_like(rewards)
    for road in range(roads):
        following = 0.0
        for t in range(horizon - 1, -1, -1):
            after = 0.0 if terminated[t, road] else next_values[t, road]
            following = 0.0 if ended[t, road] else following
            following = rewards[t, road] + gamma * after - values[t, road] + gamma * lam * following
            found[t, road] = following
    return found


wrong_lines("""advantages
    with the values added: as_sums(rewards, values, next_values, terminated, ended, gamma, lam) + values
    normalised: found = as_sums(rewards, values, next_values, terminated, ended, gamma, lam)
        (found - found.mean()) / (found.std() + 1e-8)
    with the next row's value: shifted = torch.cat([values[1:], next_values[-1:]])
        as_sums(rewards, values, shifted, terminated, ended, gamma, lam)
    returns to go: found, following = torch.zeros_like(rewards), next_values[-1]
        for t in reversed(range(len(rewards))):
            following = rewards[t] + gamma * (1 - terminated[t]) * following
            found[t] = following - values[t]
        found
    stopped a row late: delta = rewards + gamma * (1 - terminated) * next_values - values
        found, following = torch.zeros_like(delta), torch.zeros_like(delta[0])
        for t in reversed(range(len(delta))):
            going_on = 1 - ended[t + 1] if t + 1 < len(delta) else 1.0
            found[t] = following = delta[t] + gamma * lam * going_on * following
        found
""")

right_lines("""clipped_loss
    by cases: limit = torch.where(advantage > 0, torch.full_like(ratio, 1 + clip), torch.full_like(ratio, 1 - clip))
        beyond = torch.where(advantage > 0, ratio > limit, ratio < limit)
        -(torch.where(beyond, limit, ratio) * advantage).mean()
    as a maximum of losses: both = torch.stack([-ratio * advantage, -torch.clip(ratio, 1 - clip, 1 + clip) * advantage])
        both.amax(0).mean()
""")

wrong_lines("""clipped_loss
    as a number: solution(ratio, advantage, clip).item()  # gradient
    with numpy: r, a = ratio.detach().numpy(), advantage.numpy()
        torch.tensor(-np.minimum(r * a, np.clip(r, 1 - clip, 1 + clip) * a).mean())  # gradient
    with a number for epsilon: solution(ratio, advantage, 0.2)
    clipped above only: -torch.minimum(ratio * advantage, ratio.clamp(max=1 + clip) * advantage).mean()
    of each decision: -torch.minimum(ratio * advantage, ratio.clamp(1 - clip, 1 + clip) * advantage)
    of the logarithm: solution(ratio.log(), advantage, clip)
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
    as a number: solution(log_pi, values, actions, old_log_pi, advantage, returns, clip, entropy_weight).item()  # gradient
    without the values: solution(log_pi, returns, actions, old_log_pi, advantage, returns, clip, entropy_weight)
    nothing clipped: solution(log_pi, values, actions, old_log_pi, advantage, returns, 1e9, entropy_weight)
    shifted only: taken = log_pi.gather(-1, actions[:, None])[:, 0]
        good = advantage - advantage.mean()
        ratio = (taken - old_log_pi).exp()
        loss = -torch.minimum(ratio * good, ratio.clamp(1 - clip, 1 + clip) * good).mean()
        loss + (values - returns).square().mean() / 2 + entropy_weight * (log_pi.exp() * log_pi).sum(-1).mean()
    the values learn the advantages: solution(log_pi, values, actions, old_log_pi, advantage, advantage, clip, entropy_weight)
""")  # noqa: E501


SCALED = "(advantage - advantage.mean()) / (advantage.std() {})"
for _change, _why in {
    f"{SCALED.format('+ 1e-08')}  ->  {SCALED.format('- 1e-08')}": "the deviation is far larger",
    "advantage.std() + 1e-08  ->  advantage.std() + -1e-08": "the deviation is far larger",
    "advantage.std() + 1e-08  ->  advantage.std() + 1.0100000000000001e-08": "the deviation is far larger",
    "(:, 0)  ->  (:, -1)": "there is one column",
}.items():
    equivalent("ppo_loss", _change, _why)

wrong_lines("""advantages
    into the next episode: delta = rewards + gamma * (1 - terminated) * next_values - values
        powers = (gamma * lam) ** torch.arange(len(delta))
        torch.stack([(powers[: len(delta) - t, None] * delta[t:]).sum(0) for t in range(len(delta))])  # next episode
""")

wrong_lines("""ppo_loss
    with n below the deviation: good = advantage - advantage.mean()
        good = good / good.square().mean().sqrt()
        ratio = torch.exp(log_pi[torch.arange(len(actions)), actions] - old_log_pi)
        loss = -torch.minimum(ratio * good, ratio.clamp(1 - clip, 1 + clip) * good).mean()
        loss + (values - returns).square().mean() / 2 + entropy_weight * (log_pi.exp() * log_pi).sum(-1).mean()  # n - 1
""")
