"""Answers to the exercises of the lesson on the second trap."""

import math

import numpy as np
import torch

import bootcourse as bc
from tests.answers import equivalent, right, wrong

PAIR = "(torch.empty_like(delta), torch.zeros_like(delta[0]))"
equivalent(
    "advantages", f"{PAIR}  ->  (delta, torch.zeros_like(delta[0]))", "each surprise is read before it is replaced"
)
equivalent("advantages", "delta[0]  ->  delta[-1]", "only its shape")
PAID = "torch.minimum(ratio * advantage, ratio.clamp(1 - clip, 1 + clip) * advantage)"
equivalent("clipped_loss", f"{PAID}.mean(-1)  ->  {PAID}.mean(0)", "one agent's batch has one axis")

# advantages -------------------------------------------------------------------------------------------


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


@right("advantages")
def as_a_list(rewards, values, next_values, terminated, ended, gamma, lam):
    delta = rewards - values + torch.where(terminated > 0, torch.zeros_like(values), gamma * next_values)
    found = [delta[-1]]
    for surprise, end in zip(reversed(delta[:-1]), reversed(ended[:-1]), strict=True):
        found.append(surprise + torch.where(end > 0, torch.zeros_like(surprise), lam * gamma * found[-1]))
    return torch.stack(found[::-1])


@wrong("advantages")
def returns_to_go(rewards, values, next_values, terminated, ended, gamma, lam):
    found, following = torch.zeros_like(rewards), next_values[-1]
    for t in reversed(range(len(rewards))):
        following = rewards[t] + gamma * (1 - terminated[t]) * following
        found[t] = following - values[t]
    return found


@wrong("advantages")
def stopped_a_row_late(rewards, values, next_values, terminated, ended, gamma, lam):
    delta = rewards + gamma * (1 - terminated) * next_values - values
    found, following = torch.zeros_like(delta), torch.zeros_like(delta[0])
    for t in reversed(range(len(delta))):
        going_on = 1 - ended[t + 1] if t + 1 < len(delta) else 1.0
        found[t] = following = delta[t] + gamma * lam * going_on * following
    return found


@wrong("advantages")
def with_the_values_added(rewards, values, next_values, terminated, ended, gamma, lam):
    return as_sums(rewards, values, next_values, terminated, ended, gamma, lam) + values


@wrong("advantages")
def normalised(rewards, values, next_values, terminated, ended, gamma, lam):
    found = as_sums(rewards, values, next_values, terminated, ended, gamma, lam)
    return (found - found.mean()) / (found.std() + 1e-8)


@wrong("advantages")
def with_the_next_row_s_value(rewards, values, next_values, terminated, ended, gamma, lam):
    shifted = torch.cat([values[1:], next_values[-1:]])
    return as_sums(rewards, values, shifted, terminated, ended, gamma, lam)


# clipped_loss -----------------------------------------------------------------------------------------


@right("clipped_loss")
def by_cases(ratio, advantage, clip):
    limit = torch.where(advantage > 0, torch.full_like(ratio, 1 + clip), torch.full_like(ratio, 1 - clip))
    beyond = torch.where(advantage > 0, ratio > limit, ratio < limit)
    return -(torch.where(beyond, limit, ratio) * advantage).mean()


@right("clipped_loss")
def as_a_maximum_of_losses(ratio, advantage, clip):
    both = torch.stack([-ratio * advantage, -torch.clip(ratio, 1 - clip, 1 + clip) * advantage])
    return both.amax(0).mean()


@right("clipped_loss")
def one_by_one(ratio, advantage, clip):
    total = 0.0
    for r, a in zip(ratio, advantage, strict=True):
        total = total + torch.minimum(r * a, torch.clamp(r, min=1 - clip, max=1 + clip) * a)
    return -total / len(ratio)


@wrong("clipped_loss", "gradient")
def as_a_number(ratio, advantage, clip):
    return as_a_maximum_of_losses(ratio, advantage, clip).item()


@wrong("clipped_loss", "gradient")
def with_numpy(ratio, advantage, clip):
    r, a = ratio.detach().numpy(), advantage.numpy()
    return torch.tensor(-np.minimum(r * a, np.clip(r, 1 - clip, 1 + clip) * a).mean())


@wrong("clipped_loss")
def with_a_number_for_epsilon(ratio, advantage, clip):
    return as_a_maximum_of_losses(ratio, advantage, 0.2)


@wrong("clipped_loss")
def clipped_above_only(ratio, advantage, clip):
    return -torch.minimum(ratio * advantage, ratio.clamp(max=1 + clip) * advantage).mean()


@wrong("clipped_loss")
def of_each_decision(ratio, advantage, clip):
    return -torch.minimum(ratio * advantage, ratio.clamp(1 - clip, 1 + clip) * advantage)


@wrong("clipped_loss")
def of_the_logarithm(ratio, advantage, clip):
    return as_a_maximum_of_losses(ratio.log(), advantage, clip)


# jensen_gap -------------------------------------------------------------------------------------------


@right("jensen_gap")
def second_by_second(speeds):
    total = sum(bc.formulas.speed_reward(v) for v in speeds)
    return total / len(speeds) - bc.formulas.speed_reward(sum(speeds) / len(speeds))


@right("jensen_gap")
def with_the_formula_written_out(speeds):
    def pays(v):
        below = np.where(v > 12.5, 8 / 25 * v - 19 / 5, np.where(v > 5, 2 / 75 * v - 2 / 15, 0.0))
        return np.where(v > 15, np.exp(-((v - 15) ** 2)), below)

    return float(pays(np.asarray(speeds)).mean() - pays(np.mean(speeds)))


@right("jensen_gap")
def as_a_mean_of_differences(speeds):
    steady = bc.formulas.speed_reward(float(np.mean(speeds)))
    return np.mean([bc.formulas.speed_reward(float(v)) - steady for v in speeds])


@wrong("jensen_gap")
def with_the_root_mean_square(speeds):
    steady = bc.formulas.speed_reward(math.sqrt(np.mean(np.square(speeds))))
    return np.mean([bc.formulas.speed_reward(v) for v in speeds]) - steady


@wrong("jensen_gap")
def as_a_ratio(speeds):
    return np.mean([bc.formulas.speed_reward(v) for v in speeds]) / (1e-9 + bc.formulas.speed_reward(np.mean(speeds)))


@wrong("jensen_gap")
def without_the_fall_above_15(speeds):
    def pays(v):
        return 8 / 25 * v - 19 / 5 if v > 12.5 else max(0.0, 2 / 75 * v - 2 / 15)

    return np.mean([pays(v) for v in speeds]) - pays(np.mean(speeds))


@wrong("jensen_gap")
def of_the_first_speed(speeds):
    return np.mean([bc.formulas.speed_reward(v) for v in speeds]) - bc.formulas.speed_reward(speeds[0])


# shaping_reward ---------------------------------------------------------------------------------------


@right("shaping_reward")
def with_where(phi, next_phi, terminated, gamma):
    return np.where(terminated > 0, 0.0, gamma * next_phi) - phi


@right("shaping_reward")
def one_road_after_the_other(phi, next_phi, terminated, gamma):
    return np.array([(0.0 if t else gamma * n) - p for p, n, t in zip(phi, next_phi, terminated, strict=True)])


@right("shaping_reward")
def with_a_list(phi, next_phi, terminated, gamma):
    return [gamma * n * (1 - t) - p for p, n, t in zip(phi, next_phi, terminated, strict=True)]


@wrong("shaping_reward")
def with_both_discounted_by_hand(phi, next_phi, terminated, gamma):
    return 0.99 * next_phi * (1 - terminated) - phi


@wrong("shaping_reward")
def at_the_end_alone(phi, next_phi, terminated, gamma):
    return (gamma * next_phi - phi) * terminated


@wrong("shaping_reward")
def as_a_sum(phi, next_phi, terminated, gamma):
    return (gamma * next_phi * (1 - terminated) - phi).sum()


@wrong("shaping_reward")
def relative(phi, next_phi, terminated, gamma):
    return (gamma * next_phi * (1 - terminated) - phi) / np.maximum(np.abs(phi), 1e-9)
