"""Answers to the exercises of the bug hunt."""

import itertools

import numpy as np
import torch

from tests.answers import equivalent, right, wrong

# end_error ------------------------------------------------------------------------------------------


@right("end_error")
def row_by_row(q, actions, rewards, terminated):
    errors = [row[a] - r for row, a, r, over in zip(q, actions, rewards, terminated, strict=True) if over]
    return sum(errors) / len(errors) if errors else 0


@right("end_error")
def with_weights(q, actions, rewards, terminated):
    taken = np.take_along_axis(q, actions[:, None], 1)[:, 0]
    return ((taken - rewards) * terminated).sum() / max(terminated.sum(), 1)


@wrong("end_error", "NaN")
def nan_without_accidents(q, actions, rewards, terminated):
    with np.errstate(invalid="ignore"):
        return ((q[np.arange(len(q)), actions] - rewards) * terminated).sum() / terminated.sum()


@wrong("end_error")
def absolute(q, actions, rewards, terminated):
    return abs(row_by_row(q, actions, rewards, terminated))


@wrong("end_error")
def without_the_reward(q, actions, rewards, terminated):
    return row_by_row(q, actions, 0 * rewards, terminated)


# diagnose -------------------------------------------------------------------------------------------

TRUE = {
    "A": "flipped_kl",
    "B": "sampled",
    "C": "shifted_labels",
    "D": "no_end",
    "E": "bonus_for_all",
    "F": "no_stop",
}
CALLS = itertools.count()


@right("diagnose")
def with_a_dictionary(agent):
    return TRUE[agent]


@right("diagnose")
def with_branches(agent):
    if agent in "ABC":
        return ("flipped_kl", "sampled", "shifted_labels")["ABC".index(agent)]
    if agent == "D":
        return "no_end"
    return "bonus_for_all" if agent == "E" else "no_stop"


@wrong("diagnose", "Not all six verdicts are right")
def one_twice(agent):
    return {**TRUE, "D": "sampled"}[agent]


@wrong("diagnose", "Not all six verdicts are right")
def all_turned(agent):
    return dict(zip("ABCDEF", [TRUE[letter] for letter in "BCDEFA"], strict=True))[agent]


@wrong("diagnose", "Not all six verdicts are right")
def one_for_all(agent):
    return "no_stop"


@wrong("diagnose", "the six names are")
def in_words(agent):
    return TRUE[agent].replace("_", " ")


@wrong("diagnose", "raises an error")
def five_of_them(agent):
    return {letter: bug for letter, bug in TRUE.items() if letter != "F"}[agent]


@wrong("diagnose")
def another_answer_each_time(agent):
    return list(TRUE.values())[next(CALLS) % 6]


# fixed_target ---------------------------------------------------------------------------------------


@right("fixed_target")
def with_where(reward, is_demonstration, bonus, terminated, next_value, gamma):
    future = torch.where(terminated > 0, 0.0, gamma * next_value)
    return torch.where(is_demonstration > 0, reward + bonus, reward) + future


@right("fixed_target")
def in_three_lines(reward, is_demonstration, bonus, terminated, next_value, gamma):
    y = gamma * next_value - gamma * next_value * terminated
    y = y + reward
    return y + is_demonstration * bonus


@wrong("fixed_target")
def bonus_for_the_others(reward, is_demonstration, bonus, terminated, next_value, gamma):
    return reward + bonus * (1 - is_demonstration) + gamma * (1 - terminated) * next_value


@wrong("fixed_target")
def without_a_discount(reward, is_demonstration, bonus, terminated, next_value, gamma):
    return reward + bonus * is_demonstration + (1 - terminated) * next_value


# fixed_value ----------------------------------------------------------------------------------------


@right("fixed_value")
def entropy_apart(log_pi, q, alpha):
    pi = log_pi.exp()
    return (pi * q).sum(-1) + alpha * -(pi * log_pi).sum(-1)


@right("fixed_value")
def with_einsum(log_pi, q, alpha):
    return torch.einsum("na,na->n", log_pi.exp(), q - alpha * log_pi)


@wrong("fixed_value", "differently each time")
def still_sampled(log_pi, q, alpha):
    action = torch.multinomial(log_pi.exp(), 1)
    return (q - alpha * log_pi).gather(-1, action)[:, 0]


@wrong("fixed_value")
def greedy_in_q(log_pi, q, alpha):
    return q.max(-1).values


@wrong("fixed_value", "shape")
def not_summed(log_pi, q, alpha):
    return log_pi.exp() * (q - alpha * log_pi)


# fixed_loss -----------------------------------------------------------------------------------------


@right("fixed_loss")
def in_one_line(log_pi, q, log_rule, alpha, xi):
    return (log_pi.exp() * ((alpha + xi) * log_pi - q.detach() - xi * log_rule)).sum(-1).mean()


@right("fixed_loss")
def with_no_grad(log_pi, q, log_rule, alpha, xi):
    fixed = q.clone().detach()
    pi = log_pi.exp()
    value = torch.einsum("na,na->n", pi, fixed) - alpha * (pi * log_pi).sum(1)
    kl = (pi * log_pi).sum(1) - (pi * log_rule).sum(1)
    return (xi * kl - value).mean()


FLAT = "the mean of a change of log π under π is 0"
equivalent("fixed_loss", "alpha * log_pi  ->  alpha * log_pi.detach()", FLAT)
equivalent("fixed_value", "alpha * log_pi  ->  alpha * log_pi.detach()", FLAT)
equivalent("fixed_loss", "log_pi - log_rule  ->  log_pi.detach() - log_rule", FLAT)


@right("fixed_loss")
def with_torch_s_own(log_pi, q, log_rule, alpha, xi):
    policy = torch.distributions.Categorical(logits=log_pi)
    kl = torch.distributions.kl_divergence(policy, torch.distributions.Categorical(logits=log_rule))
    return -((policy.probs * q.detach()).sum(-1) + alpha * policy.entropy() - xi * kl).mean()


@wrong("fixed_loss", "no gradient reaches `log_pi`")
def everything_detached(log_pi, q, log_rule, alpha, xi):
    return in_one_line(log_pi.detach(), q, log_rule, alpha, xi)


@wrong("fixed_loss")
def summed_over_the_batch(log_pi, q, log_rule, alpha, xi):
    return in_one_line(log_pi, q, log_rule, alpha, xi) * (len(q) + 1)


@wrong("fixed_loss")
def the_value_itself(log_pi, q, log_rule, alpha, xi):
    return -in_one_line(log_pi, q, log_rule, alpha, xi)


# label_pairs ----------------------------------------------------------------------------------------


@right("label_pairs")
def with_a_loop(asked):
    return np.array([[asked[t], asked[t + 1]] for t in range(len(asked) - 1)])


@right("label_pairs")
def with_windows(asked):
    return np.lib.stride_tricks.sliding_window_view(asked, 2).copy()


@wrong("label_pairs", "shape")
def in_rows(asked):
    return np.stack([asked[:-1], asked[1:]])


@wrong("label_pairs")
def around_the_end(asked):
    return np.stack([np.roll(asked, 1)[:-1], asked[:-1]], axis=1)


# unmasks ----------------------------------------------------------------------------------------------


def right_y(reward, demo, bonus, end, value, gamma):
    return reward + bonus * demo + gamma * (1 - end) * value


@right("unmasks")
def at_random(target):
    rng = np.random.default_rng(1)
    rows = [rng.normal(0, 3, 20), rng.integers(0, 2, 20), 1.7, rng.integers(0, 2, 20), rng.normal(0, 3, 20), 0.6]
    return bool((abs(target(*rows) - right_y(*rows)) > 1e-9).any())


@right("unmasks")
def four_questions(target):
    """One transition after the other, each with a partner, so that a mean over the batch shows."""
    for demo in (0.0, 1.0):
        for end in (0.0, 1.0):
            for reward in (-2.0, 3.0):
                rows = (
                    np.array([reward, 1.0]),
                    np.array([demo, 0.0]),
                    5.0,
                    np.array([end, 0.0]),
                    np.array([4.0, 9.0]),
                    0.3,
                )
                if any(abs(a - b) > 1e-6 for a, b in zip(target(*rows), right_y(*rows), strict=True)):
                    return True
    return False


@wrong("unmasks", "bonus of 2")
def with_the_paper_s_numbers(target):
    rng = np.random.default_rng(1)
    rows = [rng.normal(0, 3, 20), rng.integers(0, 2, 20), 2.0, rng.integers(0, 2, 20), rng.normal(0, 3, 20), 0.8]
    return not np.allclose(target(*rows), right_y(*rows))


@wrong("unmasks")
def equal_next_values(target):
    rng = np.random.default_rng(1)
    rows = [rng.normal(0, 3, 20), rng.integers(0, 2, 20), 1.7, rng.integers(0, 2, 20), np.full(20, 4.0), 0.6]
    return not np.allclose(target(*rows), right_y(*rows))


@wrong("unmasks")
def positive_rewards_only(target):
    rng = np.random.default_rng(1)
    rows = [rng.uniform(0, 3, 20), rng.integers(0, 2, 20), 1.7, rng.integers(0, 2, 20), rng.normal(0, 3, 20), 0.6]
    return not np.allclose(target(*rows), right_y(*rows))


@wrong("unmasks", "accuses a target function that is right")
def the_answers_inverted(target):
    return not at_random(target)


@wrong("fixed_value", "no gradient")
def in_numpy(log_pi, q, alpha):
    log, values = log_pi.detach().numpy(), q.detach().numpy()
    return torch.tensor((np.exp(log) * (values - alpha * log)).sum(-1))


# Nine actions, one after the other -------------------------------------------------------------------


@right("fixed_value")
def action_by_action(log_pi, q, alpha):
    value = 0
    for a in range(9):
        value = value + log_pi[:, a].exp() * (q[:, a] - alpha * log_pi[:, a])
    return value


@right("fixed_value")
def with_q_held_fixed(log_pi, q, alpha):  # as the actor needs it
    return (log_pi.exp() * (q.detach() - alpha * log_pi)).sum(-1)


@wrong("fixed_value", "no gradient")
def with_the_policy_held_fixed(log_pi, q, alpha):
    pi = torch.distributions.Categorical(logits=log_pi.detach())
    return (pi.probs * q).sum(-1) + alpha * pi.entropy()


@right("fixed_loss")
def loss_action_by_action(log_pi, q, log_rule, alpha, xi):
    loss = 0
    for a in range(9):
        price = alpha * log_pi[:, a] + xi * (log_pi[:, a] - log_rule[:, a])
        loss = loss + (log_pi[:, a].exp() * (price - q[:, a].detach())).mean()
    return loss


@right("end_error")
def q_action_by_action(q, actions, rewards, terminated):
    errors = [q[i, a] - rewards[i] for a in range(9) for i in range(len(q)) if actions[i] == a and terminated[i]]
    return sum(errors) / max(1, len(errors))


@wrong("end_error")
def minus_ten_by_heart(q, actions, rewards, terminated):
    taken = q[np.arange(len(actions)), actions]
    return np.sum((taken + 10) * terminated) / max(1, terminated.sum())


@wrong("end_error")
def where_the_reward_is_minus_ten(q, actions, rewards, terminated):
    crashed = rewards == -10
    return np.sum((q[np.arange(len(actions)), actions] + 10)[crashed]) / max(1, crashed.sum())
