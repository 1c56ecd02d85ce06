"""Answers to the exercises of the lesson on demonstrations and behaviour cloning."""

import numpy as np
import torch

from bootcourse.lessons import cloning
from bootcourse.lessons.cloning import ACTION, RULE_ACTION
from tests.answers import equivalent, right, wrong

PICKED = "log_pi.gather(-1, expert_actions.unsqueeze(-1)).squeeze(-1)"
equivalent("cloning_loss", f"{PICKED}.mean(-1)  ->  {PICKED}.mean(0)", "the batch is the only axis left")
equivalent(
    "return_to_go", "togo = np.array(rewards, dtype=float)  ->  togo = np.array(rewards)", "the rewards are floats"
)


def rows(observations, actions, rewards, terminated):
    return np.concatenate([observations[:-1], observations[1:], np.stack([actions, rewards, terminated], 1)], axis=1)


@right("transitions")
def row_by_row(observations, actions, rewards, accident):
    found = []
    for t in range(len(actions)):
        ended = 1.0 if accident and t == len(actions) - 1 else 0.0
        found.append([*observations[t], *observations[t + 1], actions[t], rewards[t], ended])
    return found


@right("transitions")
def by_comparison(observations, actions, rewards, accident):
    ended = (np.arange(len(actions)) == len(actions) - 1) & (accident != 0)
    return rows(observations, actions, rewards, ended)


@wrong("transitions", "shape")
def without_the_end(observations, actions, rewards, accident):
    return rows(observations, actions, rewards, [0] * len(actions))[:, :-1]


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
    return found[::-1]


@wrong("return_to_go", "without a discount")
def all_that_comes(rewards, gamma):
    return np.array([rewards[t:].sum() for t in range(len(rewards))])


@wrong("return_to_go", "clock of its own")
def by_the_drive_s_clock(rewards, gamma):
    return np.array([sum(gamma**k * rewards[k] for k in range(t, len(rewards))) for t in range(len(rewards))])


@wrong("return_to_go", "so far")
def up_to_now(rewards, gamma):
    return np.array([sum(gamma**k * rewards[k] for k in range(t + 1)) for t in range(len(rewards))])


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


@wrong("cloning_loss", "no gradient reaches `log_pi`")
def as_a_number(log_pi, expert_actions):
    return by_index(log_pi, expert_actions).item()


@wrong("cloning_loss", "no gradient reaches `log_pi`")
def detached(log_pi, expert_actions):
    return by_index(log_pi.detach(), expert_actions)


@wrong("cloning_loss", "use torch's functions")
def in_numpy(log_pi, expert_actions):
    return torch.tensor(-np.mean(log_pi.numpy()[np.arange(len(log_pi)), expert_actions]))


@wrong("cloning_loss", "all nine actions")
def all_actions(log_pi, expert_actions):
    return -log_pi.mean(-1).mean()


@wrong("cloning_loss")
def one_hot_mean(log_pi, expert_actions):
    own = torch.nn.functional.one_hot(expert_actions, log_pi.shape[-1])
    return -(own * log_pi).mean()


@wrong("cloning_loss")
def share_of_errors(log_pi, expert_actions):
    return (log_pi.argmax(-1) != expert_actions).double().mean()


# dagger ---------------------------------------------------------------------------------------------


@right("dagger")
def with_a_list_of_rows(rows, train, drive, rounds):
    everything, drivers = [rows], [train(rows)]
    for number in range(rounds):
        own = drive(drivers[number])
        relabelled = torch.cat([own[:, :ACTION], own[:, RULE_ACTION : RULE_ACTION + 1], own[:, ACTION + 1 :]], dim=1)
        everything.append(relabelled)
        drivers.append(train(torch.cat(everything)))
    return drivers


@right("dagger")
def by_recursion(rows, train, drive, rounds):
    driver = train(rows)
    if rounds == 0:
        return [driver]
    own = drive(driver)
    own[:, ACTION] = own[:, RULE_ACTION]
    return [driver, *by_recursion(torch.vstack((rows, own)), train, drive, rounds - 1)]


@right("dagger")
def relabelled_row_by_row(rows, train, drive, rounds):
    drivers = []
    for number in range(rounds + 1):
        drivers.append(train(rows))
        if number < rounds:
            for row in drive(drivers[-1]):
                row = row.clone()
                row[ACTION] = row[RULE_ACTION]
                rows = torch.cat([rows, row[None]])
    return drivers


@wrong("dagger", "one driver too many")
def one_round_too_many(rows, train, drive, rounds):
    return cloning.dagger(rows, train, drive, rounds + 1)


@wrong("dagger")
def always_three_rounds(rows, train, drive, rounds):
    return cloning.dagger(rows, train, drive, 3)


@wrong("dagger")
def labels_that_do_not_match_the_state(rows, train, drive, rounds):
    def backwards(driver):
        own = drive(driver)
        own[:, RULE_ACTION] = own[:, RULE_ACTION].flip(0)
        return own

    return cloning.dagger(rows, train, backwards, rounds)


@wrong("dagger")
def with_half_of_the_rows(rows, train, drive, rounds):
    return cloning.dagger(rows, train, lambda driver: drive(driver)[::2], rounds)


@wrong("dagger")
def relabelled_after_the_training(rows, train, drive, rounds):
    drivers = [train(rows)]
    for _ in range(rounds):
        own = drive(drivers[-1])
        rows = torch.cat([own, rows])
        drivers.append(train(rows))
    return drivers


@wrong("dagger")
def without_the_rule_s_own_rows(rows, train, drive, rounds):
    drivers, collected = [train(rows)], rows[:0]
    for _ in range(rounds):
        own = drive(drivers[-1])
        own[:, ACTION] = own[:, RULE_ACTION]
        collected = torch.cat([collected, own])
        drivers.append(train(collected))
    return drivers


@wrong("dagger")
def a_number_of_drivers(rows, train, drive, rounds):
    return len(cloning.dagger(rows, train, drive, rounds))


@right("cloning_loss")
def a_row_of_nine_marks(log_pi, expert_actions):
    return -(torch.nn.functional.one_hot(expert_actions, 9) * log_pi).sum(-1).mean()


@wrong("dagger", "the last driver alone")
def the_newest_alone(rows, train, drive, rounds):
    return cloning.dagger(rows, train, drive, rounds)[-1]


@wrong("dagger", "a list of drivers")
def the_rows(rows, train, drive, rounds):
    return rows
