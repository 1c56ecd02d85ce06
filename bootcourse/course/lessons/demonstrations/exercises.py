"""Exercises of the lesson on demonstrations and behaviour cloning."""

import numpy as np
import torch

from bootcourse.course.exercise import NotAsAsked, exercise, logits, refuse
from bootcourse.course.lessons.demonstrations import cloning
from bootcourse.course.lessons.demonstrations.cloning import ACTION, RULE_ACTION
from bootcourse.course.lessons.discrete_sac.exercises import OF_NOTHING
from bootcourse.learn import bc


def cloning_cases(rng):
    """One state, policies sure of the demonstrated action and of another, a uniform one; then 40 at random."""
    yield torch.full((1, 9), -np.log(9)), torch.tensor([3])
    for action in (5, 3):
        yield torch.full((1, 9), -120.0).scatter(1, torch.tensor([[5]]), 0.0), torch.tensor([action])
    for n in (9, 256):
        yield torch.tensor(rng.normal(0, 8, (n, 9))).log_softmax(-1), torch.tensor(rng.integers(0, 9, n))
    for _ in range(40):
        n = rng.integers(2, 8)
        yield torch.tensor(rng.normal(0, 2, (n, 9))).log_softmax(-1), torch.tensor(rng.integers(0, 9, n))


cloning_loss = exercise(
    "-E log π(a_E|s), bootcourse.learn.bc (Pomerleau 1991)",
    minutes=5, difficulty=1, cases=cloning_cases, slopes=[logits("log_pi")],
    worked=[
        ((torch.tensor([[0.5] + [0.0625] * 8, [0.2] + [0.1] * 8]).log(), torch.tensor([0, 1])),
         torch.tensor((np.log(2) + np.log(10)) / 2)),
    ],
    hints=(
        "For each state: the logarithm of the probability that the policy gives to the demonstrated action.",
        "`log_pi.gather(-1, expert_actions.unsqueeze(-1))` picks it out.",
    ),
    mistakes={
        "return -log_pi -> return log_pi":
            "Your sign is wrong: gradient *descent* on this makes the demonstrated actions less probable.",
        "mean -> sum":
            "You add up over the batch. Take the mean: otherwise the gradient grows with the batch size.",
        "-log_pi -> -log_pi.exp()":
            "You use the probability, not its logarithm: an action of probability 0.01 then has almost no gradient.",
        "return -log_pi.mean()":
            "You average over all nine actions. Only the demonstrated one of each state counts.",
        "return -log_pi.amax(-1).mean()":
            "You make the policy more certain of what it already prefers. The *demonstrated* action should become "
            "likely.",
        ".mean(-1) ->":
            "This is the loss of each state: take the mean over the batch.",
        "return -log_pi -> return -log_pi.exp().log()":
            f"Your loss is not finite where the policy is sure of another action: {OF_NOTHING}",
        "return -log_pi.gather(-1, expert_actions.unsqueeze(-1)).exp().add(1e-8).log().mean()":
            "Your loss stops growing where the policy gives the demonstrated action less than what you add inside the "
            "logarithm, and so does its gradient. Use `log_pi` itself, which needs no such number.",
    },
)(bc.cloning_loss)  # fmt: skip


NUMBER, REST = 0, [column for column in range(RULE_ACTION + 2) if column not in (0, ACTION, RULE_ACTION)]


def numbered(first, count):
    """Transitions in which each row has a number, and all else follows from it: see `collecting`."""
    number = torch.arange(first, first + count).float()
    rows = 1 + number[:, None] * torch.arange(1, RULE_ACTION + 3) % 11  # never 0
    rows[:, NUMBER], rows[:, RULE_ACTION] = number, 4 * number % 9  # each of the nine labels occurs, 0 as well
    rows[:, ACTION] = torch.where(number % 4 == 0, rows[:, RULE_ACTION], (rows[:, RULE_ACTION] + 1 + number % 8) % 9)
    return rows


def collecting(answer, count, rounds):
    """The drivers that an answer trains, as numbers: the sum over their rows of number² · (label + 1).

    The rule's own rows have the numbers 1 to `count`, and a driver's drives three others that follow from the driver.
    So it shows which rows a driver has learned from, how often, and with which labels; their order does not count.
    """
    rows = numbered(1, count)
    rows[:, ACTION] = rows[:, RULE_ACTION]

    def train(some):
        right = numbered(0, 30)[some[:, NUMBER].long().clamp(0, 29)]
        if some.shape[1] != rows.shape[1] or not torch.equal(some[:, REST], right[:, REST]):
            raise NotAsAsked("You change other columns of the transitions, too: change column `ACTION` alone.")
        return float((some[:, NUMBER].double() ** 2 * (some[:, ACTION].double() + 1)).sum())

    def drive(driver):
        return numbered(10 + int(driver) % 17, 1 + int(driver) % 3)

    drivers = answer(rows, train, drive, rounds)
    drivers = [drivers] if isinstance(drivers, float) else drivers  # the last one alone
    if not isinstance(drivers, (list, tuple)) or not all(isinstance(driver, float) for driver in drivers):
        return refuse(drivers, "a list of drivers, each as `train` returns it")
    return np.array(drivers)


def dagger_cases(rng):
    """No round, one round, several; from one row to nine."""
    yield from ((4, 0), (1, 1), (4, 1), (4, 2), (9, 4))
    yield from zip(rng.integers(1, 10, 20).tolist(), rng.integers(1, 5, 20).tolist(), strict=True)


dagger = exercise(
    "DAgger, Algorithm 3.1 of arXiv 1011.0686; here the clone drives in each round",
    minutes=12, difficulty=2, cases=dagger_cases, run=collecting,
    worked=[
        ((1, 0), np.array([5.0])),  # one driver, trained on row 1, whose label is 4
        # it drives rows 15, 16 and 17, which the rule labels with 6, 1 and 5
        ((1, 1), np.array([5.0, 5 + 15**2 * 7 + 16**2 * 2 + 17**2 * 6])),
    ],
    hints=(
        "Train the first driver on `rows`. In each round: drive with the newest driver, relabel, append, train again.",
        "`own = drive(drivers[-1]).clone()`, then `own[:, ACTION] = own[:, RULE_ACTION]`.",
    ),
    mistakes={
        "own[:, ACTION] = own[:, RULE_ACTION] ->":
            "You learn what the *clone* did in its own drives, errors included. Put the rule's action, column "
            "`RULE_ACTION`, where the clone's stands, column `ACTION`.",
        "rows = torch.cat([rows, own]) -> rows = own":
            "You train on the newest drives alone. Keep all rows so far: DAgger means data *aggregation*.",
        ("rows = torch.cat([rows, own]) ->", "append(train(rows)) -> append(train(torch.cat([rows, own])))"):
            "You add each round's rows to the rule's own, and lose those of the rounds before. Keep all rows so far.",
        "drivers[-1] -> drivers[0]":
            "You always let the first clone drive. The states that matter are those of the newest one.",
        "return drivers[1:]":
            "Your list begins after the first round. It begins with the clone of the rule's own rows.",
        "return drivers[-1:]":
            "You return the last driver alone. Return the list of all, so that they can be compared.",
        "range(rounds) -> range(rounds + 1)":
            "You train one driver too many: `rounds` rounds after the first training make `rounds + 1` drivers.",
    },
)(cloning.dagger)  # fmt: skip
