"""Exercises of the lesson on demonstrations and behaviour cloning."""

import numpy as np
import torch

from bootcourse.course.exercise import Exercise, Mistake, logits, refuse
from bootcourse.course.lessons.demonstrations import cloning
from bootcourse.learn import bc


def transitions_solution(observations, actions, rewards, accident):
    terminated = np.zeros(len(actions))
    terminated[-1] = accident > 0
    return np.column_stack([observations[:-1], observations[1:], actions, rewards, terminated])


def rows(observations, next_observations, actions, rewards, terminated):
    return np.column_stack([observations, next_observations, actions, rewards, terminated])


def last(actions, value):
    ended = np.zeros(len(actions))
    ended[-1] = value
    return ended


def transitions_cases(rng):
    """Each ending, a drive of one decision; then 30 at random."""
    for k, accident in enumerate([0, 1, 2, 3, *rng.integers(0, 4, 30)]):
        decisions = 1 if k == 4 else rng.integers(2, 6)
        observations = rng.normal(size=(decisions + 1, rng.integers(2, 4)))
        yield observations, rng.integers(0, 9, decisions), rng.normal(size=decisions), accident


transitions = Exercise(
    "transitions(observations, actions, rewards, accident)", solution=transitions_solution, cases=transitions_cases,
    worked=(
        ((np.array([[1.0], [2.0], [3.0]]), np.array([4, 7]), np.array([0.5, -10.0]), 2),
         np.array([[1, 2, 4, 0.5, 0], [2, 3, 7, -10.0, 1]])),
        ((np.array([[1.0], [2.0]]), np.array([4]), np.array([0.5]), 0), np.array([[1, 2, 4, 0.5, 0]])),
    ),
    mistakes=(
        Mistake(lambda o, a, r, accident: rows(o[:-1], o[1:], a, r, last(a, 1.0)),
            "You mark an end in every drive. A drive whose time ran out was not terminated: its last state has a "
            "future.",
            "The last row of a drive is its end."),
        Mistake(lambda o, a, r, accident: rows(o[:-1], o[1:], a, r, np.full(len(a), float(accident > 0))),
            "You mark every row of the drive. Only the transition with the accident is terminated.",
            "The accident is a property of the drive."),
        Mistake(lambda o, a, r, accident: rows(o[:-1], o[1:], a, r, np.zeros(len(a))),
            "You mark no end. Nothing follows an accident, so the last row must hold 1.",
            "The reward of -10 marks the accident already."),
        Mistake(lambda o, a, r, accident: rows(o[:-1], o[1:], a, r, last(a, accident)),
            "Your mark is the accident's number, 0 to 3. It has to be 0 or 1, because the critic multiplies by it.",
            "A flag may be any number."),
        Mistake(lambda o, a, r, accident: rows(o[1:], o[:-1], a, r, last(a, accident > 0)),
            "Your s and s' are swapped: the action leads from the earlier observation to the later one.",
            "`[1:]` holds the first observations."),
        Mistake(lambda o, a, r, accident: rows(o[:-1], o[:-1], a, r, last(a, accident > 0)),
            "Your s' equals s: the next observation is one row further down.",
            "Each decision has one observation."),
    ),
    hints=(
        "There is one observation more than there are actions. Which ones are s, and which are s'?",
        "`observations[:-1]` and `observations[1:]`; the last column is zero but for an accident in the last row.",
        "`np.column_stack([observations[:-1], observations[1:], actions, rewards, terminated])`",
    ),
    minutes=6, difficulty=2, equation="(s, a, r, s'), Section IV-B, and whether the episode ended there",
)  # fmt: skip


def return_to_go_solution(rewards, gamma):
    togo = np.array(rewards, dtype=float)
    for t in range(len(togo) - 2, -1, -1):
        togo[t] += gamma * togo[t + 1]
    return togo


def forwards(rewards, gamma):
    """The recursion in the wrong direction of time."""
    togo = np.array(rewards, dtype=float)
    for t in range(1, len(togo)):
        togo[t] += gamma * togo[t - 1]
    return togo


return_to_go = Exercise(
    "return_to_go(rewards, gamma)", solution=return_to_go_solution,
    # γ of 0 and of 1, one reward, a late reward; then 40 at random
    cases=lambda rng: [(np.array([1.0, 2.0, 3.0]), 0.0), (np.array([1.0, 2.0, 3.0]), 1.0), (np.array([2.0]), 0.8),
                       (np.array([0.0, 0.0, 0.0, 10.0]), 0.8),
                       *((rng.normal(size=rng.integers(2, 20)), rng.uniform(0.3, 0.99)) for _ in range(40))],
    worked=(
        ((np.array([1.0, 1.0, 1.0]), 0.5), np.array([1.75, 1.5, 1.0])),
        ((np.array([0.0, 0.0, 10.0]), 0.8), np.array([6.4, 8.0, 10.0])),
    ),
    mistakes=(
        Mistake(lambda rewards, gamma: return_to_go_solution(rewards, 1.0),
            "This is the return to go without a discount: multiply the next second's value by γ.",
            "Return and discounted return are the same."),
        Mistake(lambda rewards, gamma: np.cumsum((gamma ** np.arange(len(rewards)) * rewards)[::-1])[::-1],
            "You discount from the start of the drive. Each second has a clock of its own: its own reward has the "
            "weight 1.",
            "The discount counts from the start of the drive."),
        Mistake(lambda rewards, gamma: np.cumsum(gamma ** np.arange(len(rewards)) * rewards),
            "This is what was earned *so far*. A value is what comes from this second on.",
            "A cumulative sum in either direction will do."),
        Mistake(forwards,
            "You go forwards in time, so each second adds up the past. Begin at the last second.",
            "A loop over time begins at 0."),
        Mistake(lambda rewards, gamma: rewards + gamma * np.append(rewards[1:], 0.0),
            "You add γ times the next *reward*. Add γ times the next *value*, which contains all later rewards.",
            "Only the next second counts."),
    ),
    hints=(
        "The last second's value is its reward. The one before it is its reward plus γ times that.",
        "Copy the rewards into an array, and go from the last but one to the first: `range(len(togo) - 2, -1, -1)`.",
        "`togo[t] += gamma * togo[t + 1]`",
    ),
    minutes=5, difficulty=1, equation="G_t = r_t + γ G_{t+1}: what Q(s, a) of Section III stands for",
)  # fmt: skip


def agreement_solution(pi, actions):
    return np.mean(pi.argmax(axis=1) == actions)


def agreement_cases(rng):
    """Always, never, one state; then 40 at random."""
    yield np.eye(9)[[3, 5]], np.array([3, 5])
    yield np.eye(9)[[3, 5]], np.array([5, 3])
    yield np.full((1, 9), 0.05) + 0.55 * np.eye(9)[[2]], np.array([2])
    for _ in range(40):
        n = rng.integers(2, 12)
        pi = rng.dirichlet(np.full(9, 0.5), n)
        yield pi, np.where(rng.random(n) < 0.6, pi.argmax(1), rng.integers(0, 9, n))


agreement = Exercise(
    "agreement(pi, actions)", solution=agreement_solution, cases=agreement_cases,
    worked=(
        ((np.array([[0.5, 0.3, 0.2], [0.1, 0.2, 0.7]]), np.array([0, 1])), 0.5),
        ((np.array([[0.4, 0.3, 0.3]]), np.array([0])), 1.0),
    ),
    mistakes=(
        Mistake(lambda pi, actions: np.mean(pi[np.arange(len(pi)), actions]),
            "This is the mean probability of the demonstrated action. A greedy driver takes the most probable action, "
            "whether its probability is 0.4 or 0.9.",
            "A policy agrees as often as its probability says."),
        Mistake(lambda pi, actions: np.sum(pi.argmax(axis=1) == actions),
            "You return the number of states. Return their share.",
            "The number of hits is the agreement."),
        Mistake(lambda pi, actions: np.mean(pi.argmax(axis=1) != actions),
            "This is the share of *disagreement*.",
            "Agreement is the error rate."),
        Mistake(lambda pi, actions: np.mean(pi[np.arange(len(pi)), actions] > 0.5),
            "You require a probability above one half. With nine actions the most probable one may have less.",
            "Most probable means more probable than all others together."),
    ),
    hints=(
        "Which action would the policy take in each state?",
        "`pi.argmax(axis=1)` is the most probable action of each row.",
        "`np.mean(pi.argmax(axis=1) == actions)`",
    ),
    minutes=3, difficulty=1, equation="the share of states in which argmax π(·|s) = a_E",
)  # fmt: skip


def cloning_cases(rng):
    """One state, a sure policy, a uniform one; then 40 at random."""
    yield torch.full((1, 9), -np.log(9)).double(), torch.tensor([3])
    yield torch.tensor(rng.normal(0, 8, (9, 9))).log_softmax(-1), torch.tensor(rng.integers(0, 9, 9))
    for _ in range(40):
        n = rng.integers(2, 8)
        yield torch.tensor(rng.normal(0, 2, (n, 9))).log_softmax(-1), torch.tensor(rng.integers(0, 9, n))


def chosen(log_pi, actions):
    return log_pi.gather(-1, actions.unsqueeze(-1)).squeeze(-1)


cloning_loss = Exercise(
    "cloning_loss(log_pi, expert_actions)", solution=bc.cloning_loss, cases=cloning_cases, slopes=(logits("log_pi"),),
    worked=(
        ((torch.tensor([[0.5] + [0.0625] * 8, [0.2] + [0.1] * 8]).log(), torch.tensor([0, 1])),
         torch.tensor((np.log(2) + np.log(10)) / 2)),
    ),
    mistakes=(
        Mistake(lambda log_pi, actions: chosen(log_pi, actions).mean(),
            "Your sign is wrong: gradient *descent* on this makes the demonstrated actions less probable.",
            "The optimiser maximises the log-likelihood."),
        Mistake(lambda log_pi, actions: -chosen(log_pi, actions).sum(),
            "You add up over the batch. Take the mean: otherwise the gradient grows with the batch size.",
            "A sum and a mean differ by a constant only."),
        Mistake(lambda log_pi, actions: -chosen(log_pi, actions).exp().mean(),
            "You use the probability, not its logarithm: an action of probability 0.01 then has almost no gradient.",
            "The probability should grow, so it is the loss."),
        Mistake(lambda log_pi, actions: -log_pi.mean(),
            "You average over all nine actions. Only the demonstrated one of each state counts.",
            "The loss is the mean of -log π."),
        Mistake(lambda log_pi, actions: -log_pi.amax(-1).mean(),
            "You make the policy more certain of what it already prefers. The *demonstrated* action should become "
            "likely.",
            "The best action is the demonstrated one."),
        Mistake(lambda log_pi, actions: -chosen(log_pi, actions),
            "This is the loss of each state: take the mean over the batch.",
            "The optimiser takes the mean."),
    ),
    hints=(
        "For each state: the logarithm of the probability that the policy gives to the demonstrated action.",
        "`log_pi.gather(-1, expert_actions.unsqueeze(-1))` picks it out.",
        "`-log_pi.gather(-1, expert_actions.unsqueeze(-1)).mean()`",
    ),
    minutes=5, difficulty=1, equation="-E log π(a_E|s), bootcourse.learn.bc (Pomerleau 1991)",
)  # fmt: skip


def collecting(answer, rows, rounds):
    """The drivers that an answer trains, as numbers: each says on which rows with which labels it was trained."""

    def train(some):
        return float((some[:, cloning.ACTION] * some[:, 0]).sum() + len(some) / 64)  # in whatever order

    def drive(driver):
        own = torch.zeros(3, rows.shape[1])
        own[:, 0] = torch.arange(2, 5)
        own[:, cloning.ACTION] = torch.arange(3) + int(driver) % 3
        own[:, cloning.RULE_ACTION] = torch.arange(3) * 2 + int(driver) % 4
        return own

    drivers = answer(rows, train, drive, rounds)
    drivers = [drivers] if isinstance(drivers, float) else drivers  # the last one alone
    if not isinstance(drivers, (list, tuple)) or not all(isinstance(driver, float) for driver in drivers):
        return refuse(drivers, "a list of drivers, each as `train` returns it")
    return np.array(drivers)


def dagger_cases(rng):
    """No round, one round, several; from one row to many."""
    drawn = zip(rng.integers(1, 9, 20), rng.integers(1, 5, 20), strict=True)
    for n, rounds in ((4, 0), (1, 1), (4, 1), (4, 2), *drawn):
        rows = torch.zeros(n, cloning.RULE_ACTION + 2)
        rows[:, cloning.ACTION] = torch.tensor(rng.integers(0, 9, n)).float()
        rows[:, cloning.RULE_ACTION] = rows[:, cloning.ACTION]
        rows[:, 0] = torch.arange(1, n + 1)
        yield rows, rounds


def everything(first, rows, own):
    return torch.cat([rows, own])


def taught(rows, train, drive, rounds, relabel=True, keep=everything, latest=True):
    """DAgger with one thing done differently. keep(first rows, rows so far, own rows): what is trained on next."""
    first, drivers = rows, [train(rows)]
    for _ in range(rounds):
        own = drive(drivers[-1 if latest else 0]).clone()
        if relabel:
            own[:, cloning.ACTION] = own[:, cloning.RULE_ACTION]
        rows = keep(first, rows, own)
        drivers.append(train(rows))
    return drivers


def one_row(label):
    row = torch.zeros(1, cloning.RULE_ACTION + 2)
    row[0, [0, cloning.ACTION, cloning.RULE_ACTION]] = torch.tensor([1.0, label, label])
    return row


dagger = Exercise(
    "dagger(rows, train, drive, rounds)", solution=cloning.dagger, cases=dagger_cases, run=collecting,
    worked=(
        ((one_row(4), 0), np.array([4 + 1 / 64])),  # one driver; the numbers stand for what it was trained on
        ((one_row(4), 1), np.array([4 + 1 / 64, 4 + 0 * 2 + 2 * 3 + 4 * 4 + 4 / 64])),  # labels 0, 2, 4 of own drives
    ),
    mistakes=(
        Mistake(lambda *given: taught(*given, relabel=False),
            "You learn what the *clone* did in its own drives, errors included. Put the rule's action, column "
            "`RULE_ACTION`, where the clone's stands, column `ACTION`.",
            "More data of any kind help."),
        Mistake(lambda *given: taught(*given, keep=lambda first, rows, own: own),
            "You train on the newest drives alone. Keep all rows so far: DAgger means data *aggregation*.",
            "Old data are of an old policy, and so are out of date."),
        Mistake(lambda *given: taught(*given, keep=lambda first, rows, own: torch.cat([first, own])),
            "You add each round's rows to the rule's own, and lose those of the rounds before. Keep all rows so far.",
            "`torch.cat` changes its first argument."),
        Mistake(lambda *given: taught(*given, latest=False),
            "You always let the first clone drive. The states that matter are those of the newest one.",
            "A clone's states do not change much."),
        Mistake(lambda *given: taught(*given)[1:],
            "Your list begins after the first round. It begins with the clone of the rule's own rows.",
            "Round 0 is no round."),
        Mistake(lambda *given: taught(*given)[-1:],
            "You return the last driver alone. Return the list of all, so that they can be compared.",
            "What counts is the result."),
        Mistake(lambda rows, train, drive, rounds: taught(rows, train, drive, rounds + 1),
            "You train one driver too many: `rounds` rounds after the first training make `rounds + 1` drivers.",
            "`rounds + 1` drivers need as many rounds."),
    ),
    hints=(
        "Train the first driver on `rows`. In each round: drive with the newest driver, relabel, append, train again.",
        "`own = drive(drivers[-1]).clone()`, then `own[:, ACTION] = own[:, RULE_ACTION]`.",
        "`rows = torch.cat([rows, own])`, then `drivers.append(train(rows))`; return `drivers`.",
    ),
    minutes=20, difficulty=3, equation="DAgger, Algorithm 3.1 of arXiv 1011.0686; here the clone drives in each round",
)  # fmt: skip
