"""Answers to the exercises of the lesson on demonstrations and behaviour cloning."""

import numpy as np
import torch

from tests.answers import right, wrong


def rows(observations, actions, rewards, terminated):
    return np.concatenate([observations[:-1], observations[1:], np.stack([actions, rewards, terminated], 1)], axis=1)


@right("transitions")
def row_by_row(observations, actions, rewards, accident):
    found = []
    for t in range(len(actions)):
        ended = 1.0 if accident and t == len(actions) - 1 else 0.0
        found.append([*observations[t], *observations[t + 1], actions[t], rewards[t], ended])
    return np.array(found)


@right("transitions")
def by_comparison(observations, actions, rewards, accident):
    ended = (np.arange(len(actions)) == len(actions) - 1) & (accident != 0)
    return rows(observations, actions, rewards, ended)


@wrong("transitions", "time ran out")
def always_ended(observations, actions, rewards, accident):
    return rows(observations, actions, rewards, np.arange(len(actions)) == len(actions) - 1)


@wrong("transitions", "whole drive")
def all_ended(observations, actions, rewards, accident):
    return rows(observations, actions, rewards, [accident > 0] * len(actions))


@wrong("transitions", "no end at all")
def never_ended(observations, actions, rewards, accident):
    return rows(observations, actions, rewards, [0] * len(actions))


@wrong("transitions", "accident's number")
def with_the_number(observations, actions, rewards, accident):
    return rows(observations, actions, rewards, [0] * (len(actions) - 1) + [accident])


@wrong("transitions", "swapped")
def backwards(observations, actions, rewards, accident):
    right_rows, n = row_by_row(observations, actions, rewards, accident), observations.shape[1]
    return np.concatenate([right_rows[:, n : 2 * n], right_rows[:, :n], right_rows[:, 2 * n :]], axis=1)


@wrong("transitions", "s again")
def not_shifted(observations, actions, rewards, accident):
    right_rows, n = row_by_row(observations, actions, rewards, accident), observations.shape[1]
    right_rows[:, n : 2 * n] = right_rows[:, :n]
    return right_rows


@wrong("transitions", "shape")
def without_the_end(observations, actions, rewards, accident):
    return row_by_row(observations, actions, rewards, accident)[:, :-1]


@wrong("transitions")
def reward_before_action(observations, actions, rewards, accident):
    return rows(observations, rewards, actions, [0] * (len(actions) - 1) + [accident > 0])


@right("return_to_go")
def as_a_table(rewards, gamma):
    t = np.arange(len(rewards))
    later = t[None, :] - t[:, None]
    return np.where(later >= 0, gamma ** np.maximum(later, 0), 0.0) @ rewards


@right("return_to_go")
def from_the_end(rewards, gamma):
    total, found = 0.0, []
    for reward in rewards[::-1]:
        total = reward + gamma * total
        found.append(total)
    return np.array(found[::-1])


@wrong("return_to_go", "without a discount")
def all_that_comes(rewards, gamma):
    return np.array([rewards[t:].sum() for t in range(len(rewards))])


@wrong("return_to_go", "clock of its own")
def by_the_drive_s_clock(rewards, gamma):
    return np.array([sum(gamma**k * rewards[k] for k in range(t, len(rewards))) for t in range(len(rewards))])


@wrong("return_to_go", "so far")
def up_to_now(rewards, gamma):
    return np.array([sum(gamma**k * rewards[k] for k in range(t + 1)) for t in range(len(rewards))])


@wrong("return_to_go", "forwards in time")
def turned(rewards, gamma):
    total, found = 0.0, []
    for reward in rewards:
        total = reward + gamma * total
        found.append(total)
    return np.array(found)


@wrong("return_to_go", "next *value*")
def the_next_second(rewards, gamma):
    rest = np.append(rewards[1:], 0.0)
    return rewards + gamma * rest


@wrong("return_to_go", "shape")
def of_the_first_second(rewards, gamma):
    return from_the_end(rewards, gamma)[:1]


@wrong("return_to_go")
def left_in_reverse(rewards, gamma):
    return from_the_end(rewards, gamma)[::-1]


@right("agreement")
def counted(pi, actions):
    return sum(int(np.argmax(row)) == action for row, action in zip(pi, actions, strict=True)) / len(actions)


@right("agreement")
def nothing_is_larger(pi, actions):
    return (pi[np.arange(len(pi)), actions] >= pi.max(axis=1)).mean()


@wrong("agreement", "mean probability")
def mean_probability(pi, actions):
    return np.take_along_axis(pi, actions[:, None], axis=1).mean()


@wrong("agreement", "share of them")
def hits(pi, actions):
    return (pi.argmax(1) == actions).sum()


@wrong("agreement", "*disagreement*")
def errors(pi, actions):
    return 1 - (pi.argmax(1) == actions).mean()


@wrong("agreement", "one half")
def more_than_half(pi, actions):
    return (np.take_along_axis(pi, actions[:, None], axis=1) > 0.5).mean()


@wrong("agreement", "NumPy array")
def each_state(pi, actions):
    return pi.argmax(1) == actions


@wrong("agreement")
def over_the_wrong_axis(pi, actions):
    return float(np.mean(np.isin(pi.argmax(0), actions)))


@wrong("agreement")
def least_probable(pi, actions):
    return np.mean(pi.argmin(axis=1) == actions)


@right("cloning_loss")
def torch_s_own(log_pi, expert_actions):
    return torch.nn.functional.nll_loss(log_pi, expert_actions)


@right("cloning_loss")
def by_index(log_pi, expert_actions):
    return -log_pi[torch.arange(len(log_pi)), expert_actions].mean()


@right("cloning_loss")
def with_one_hot(log_pi, expert_actions):
    own = torch.nn.functional.one_hot(expert_actions, log_pi.shape[-1])
    return -(own * log_pi).sum(-1).mean()


@wrong("cloning_loss", "*descent*")
def without_a_minus(log_pi, expert_actions):
    return log_pi[torch.arange(len(log_pi)), expert_actions].mean()


@wrong("cloning_loss", "add up over the batch")
def summed(log_pi, expert_actions):
    return torch.nn.functional.nll_loss(log_pi, expert_actions, reduction="sum")


@wrong("cloning_loss", "not its logarithm")
def probability(log_pi, expert_actions):
    return -log_pi.exp()[torch.arange(len(log_pi)), expert_actions].mean()


@wrong("cloning_loss", "all nine actions")
def all_actions(log_pi, expert_actions):
    return -log_pi.mean(-1).mean()


@wrong("cloning_loss", "surer of what it prefers")
def own_preference(log_pi, expert_actions):
    return -log_pi.max(-1).values.mean()


@wrong("cloning_loss", "loss of each state")
def each_state_s(log_pi, expert_actions):
    return -log_pi[torch.arange(len(log_pi)), expert_actions]


@wrong("cloning_loss")
def one_hot_mean(log_pi, expert_actions):
    own = torch.nn.functional.one_hot(expert_actions, log_pi.shape[-1])
    return -(own * log_pi).mean()


@wrong("cloning_loss")
def share_of_errors(log_pi, expert_actions):
    return (log_pi.argmax(-1) != expert_actions).double().mean()


@right("any_error")
def complement(error_rate, decisions):
    no_error = 1.0
    for _ in range(decisions):
        no_error *= 1 - error_rate
    return 1 - no_error


@right("any_error")
def added_up(error_rate, decisions):
    return sum(error_rate * (1 - error_rate) ** t for t in range(decisions))


@wrong("any_error", "*nothing* goes wrong")
def no_error(error_rate, decisions):
    return (1 - error_rate) ** decisions


@wrong("any_error", "*number* of errors")
def expected_number(error_rate, decisions):
    return error_rate * decisions


@wrong("any_error", "cut off at 1")
def cut_off(error_rate, decisions):
    return min(error_rate * decisions, 1)


@wrong("any_error", "*every* decision")
def all_wrong(error_rate, decisions):
    return error_rate**decisions


@wrong("any_error", "not *everything*")
def not_all_wrong(error_rate, decisions):
    return 1 - error_rate**decisions


@wrong("any_error")
def the_last_one(error_rate, decisions):
    return error_rate * (1 - error_rate) ** (decisions - 1)


@wrong("any_error")
def exponential(error_rate, decisions):
    return 1 - np.exp(-error_rate * decisions)
