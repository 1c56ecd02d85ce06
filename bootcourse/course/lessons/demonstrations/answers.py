"""Answers to the exercises of the lesson on demonstrations and behaviour cloning."""

import torch

from bootcourse.course.lessons.demonstrations.cloning import ACTION, RULE_ACTION
from tests.answers import equivalent, right, right_lines, wrong_lines

PICKED = "log_pi.gather(-1, expert_actions.unsqueeze(-1)).squeeze(-1)"
equivalent("cloning_loss", f"{PICKED}.mean(-1)  ->  {PICKED}.mean(0)", "the batch is the only axis left")


right_lines("""cloning_loss
    by index: -log_pi[torch.arange(len(log_pi)), expert_actions].mean()
    with one hot: own = torch.nn.functional.one_hot(expert_actions, log_pi.shape[-1]); -(own * log_pi).sum(-1).mean()
""")

right_lines("""cloning_loss
    cross entropy: functional.cross_entropy(log_pi, expert_actions)
    a distribution: -torch.distributions.Categorical(logits=log_pi).log_prob(expert_actions).mean()
    row by row: -sum(row[action] for row, action in zip(log_pi, expert_actions, strict=True)) / len(log_pi)
""")

wrong_lines("""cloning_loss
    the logarithm of the probability: pi = log_pi.exp()
        -pi[torch.arange(len(pi)), expert_actions].log().mean()  # exp(-120) is 0 in float32
    a distribution of probabilities: policy = torch.distributions.Categorical(probs=log_pi.exp())
        -policy.log_prob(expert_actions).mean()
    at most 100 nats: functional.nll_loss(log_pi.clamp(min=-100), expert_actions)
    smoothed: functional.cross_entropy(log_pi, expert_actions, label_smoothing=0.01)
    the wrong ones alone: chosen = log_pi.gather(1, expert_actions[:, None])[:, 0]
        -(chosen * (log_pi.argmax(1) != expert_actions)).mean()
    detached: solution(log_pi.detach(), expert_actions)  # no gradient reaches `log_pi`
    in numpy: torch.tensor(-np.mean(log_pi.numpy()[np.arange(len(log_pi)), expert_actions]))  # use torch's functions
    one hot mean: own = torch.nn.functional.one_hot(expert_actions, log_pi.shape[-1]); -(own * log_pi).mean()
""")


@right("dagger")
def with_a_list_of_rows(rows, train, drive, rounds):
    everything, drivers = [rows], [train(rows)]
    for number in range(rounds):
        own = drive(drivers[number])
        relabelled = torch.cat([own[:, :ACTION], own[:, RULE_ACTION : RULE_ACTION + 1], own[:, ACTION + 1 :]], dim=1)
        everything.append(relabelled)
        drivers.append(train(torch.cat(everything)))
    return drivers


wrong_lines("""dagger
    states and labels exchanged: drivers = [train(rows)]
        for _ in range(rounds):
            own = drive(drivers[-1]).clone()
            own[:, 0], own[:, ACTION] = own[:, RULE_ACTION].clone(), own[:, 0].clone()
            rows = torch.cat([rows, own])
            drivers.append(train(rows))
        drivers  # column `ACTION` alone
    labels in order: drivers = [train(rows)]
        for _ in range(rounds):
            own = drive(drivers[-1]).clone()
            own[:, ACTION] = own[:, RULE_ACTION].sort().values
            rows = torch.cat([rows, own])
            drivers.append(train(rows))
        drivers
    labels of other rows: drivers = [train(rows)]
        for _ in range(rounds):
            own = drive(drivers[-1]).clone()
            own[:, ACTION] = own[:, RULE_ACTION].flip(0)
            rows = torch.cat([rows, own])
            drivers.append(train(rows))
        drivers
    an accident is forgotten: drivers = [train(rows)]
        for _ in range(rounds):
            own = drive(drivers[-1]).clone()
            own[:, ACTION], own[:, ACTION + 2] = own[:, RULE_ACTION], 0
            rows = torch.cat([rows, own])
            drivers.append(train(rows))
        drivers  # column `ACTION` alone
    the errors alone: drivers = [train(rows)]
        for _ in range(rounds):
            own = drive(drivers[-1])
            own = own[own[:, ACTION] != own[:, RULE_ACTION]]
            own[:, ACTION] = own[:, RULE_ACTION]
            rows = torch.cat([rows, own])
            drivers.append(train(rows))
        drivers
    a number of drivers: len(cloning.dagger(rows, train, drive, rounds))
    all columns from the action on: drivers = [train(rows)]
        for _ in range(rounds):
            own = drive(drivers[-1])
            own[:, ACTION:] = own[:, RULE_ACTION, None]
            rows = torch.cat([rows, own])
            drivers.append(train(rows))
        drivers  # column `ACTION` alone
    labels of 0 are taken for none: drivers = [train(rows)]
        for _ in range(rounds):
            own = drive(drivers[-1]).clone()
            labelled = own[:, RULE_ACTION] > 0
            own[labelled, ACTION] = own[labelled, RULE_ACTION]
            rows = torch.cat([rows, own])
            drivers.append(train(rows))
        drivers
    without the rule's own rows: drivers, collected = [train(rows)], rows[:0]
        for _ in range(rounds):
            own = drive(drivers[-1])
            own[:, ACTION] = own[:, RULE_ACTION]
            collected = torch.cat([collected, own])
            drivers.append(train(collected))
        drivers
""")
