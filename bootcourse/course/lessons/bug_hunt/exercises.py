"""Exercises of the bug hunt."""

import numpy as np

from bootcourse.course.exercise import MANY_ROWS, exercise
from bootcourse.course.lessons.bug_hunt import target_probe


def end_cases(rng):
    """No accident at all, only accidents, one row; then 40 at random, half of them on a road with other rewards.

    In every fourth case Q is far beyond any return, as without the stop-gradient. The last has 130 rows and rewards in
    the thousands.
    """
    shares = [0.0, 1.0, 1.0, *rng.uniform(0.2, 0.8, 40)]
    for number, share in enumerate(shares):
        n = 1 if number == 2 else rng.integers(3, 9)
        terminated = (rng.random(n) < share).astype(float)
        rewards = rng.uniform(-10, 5, n) if number % 2 else np.where(terminated > 0, -10.0, rng.uniform(0, 1, n))
        yield rng.normal(-10, 300 if number % 4 == 3 else 6, (n, 9)), rng.integers(0, 9, n), rewards, terminated
    ended = (rng.random(MANY_ROWS) < 0.5).astype(float)
    yield rng.normal(0, 3000, (MANY_ROWS, 9)), rng.integers(0, 9, MANY_ROWS), rng.normal(0, 3000, MANY_ROWS), ended


@exercise(
    "mean of Q(s, a) - r over the decisions that ended an episode", minutes=6, difficulty=2, cases=end_cases,
    worked=[
        # two accidents: Q(s, a) is -8 and -9, both should be -10; the third row goes on
        ((np.array([[-8.0] + [0] * 8, [5, -9] + [5] * 7, range(9)]), np.array([0, 1, 2]), np.array([-10.0, -10, 0.5]),
          np.array([1.0, 1, 0])),
         1.5),
        ((np.array([[4.0, 2.0] + [1] * 7]), np.array([1]), np.array([0.3]), np.array([0.0])), 0.0),
    ],
    hints=(
        "Where an episode ended there is no next state: y = r, without any network. Keep the rows with "
        "`terminated > 0`; if there are none, return 0.",
        "`q[np.arange(len(actions)), actions]` is the Q of the action taken in each row.",
    ),
    mistakes={
        "terminated > 0 -> terminated >= 0":
            "You use every row. The right Q is known exactly only where the episode ended: it is r.",
        "q[np.arange(len(actions)), actions] -> q.max(-1)":
            "You take the best action's Q. The accident followed the action that was *taken*: pick that one.",
        "return (taken[ended] - rewards[ended]).sum() / len(q)":
            "You divide by the number of rows. Divide by the number of accidents among them.",
        "taken[ended] - rewards[ended] -> rewards[ended] - taken[ended]":
            "Your sign is wrong: a Q that is too high should give a positive error.",
        "q[np.arange(len(actions)), actions] -> q.mean(-1)":
            "You average over the nine actions. Only one of them was taken.",
    },
)  # fmt: skip
def end_error(q, actions, rewards, terminated):
    taken = q[np.arange(len(actions)), actions]
    ended = terminated > 0
    if not ended.any():
        return 0.0
    return (taken[ended] - rewards[ended]).mean()


BUGS = ("flipped_kl", "no_end", "sampled", "no_stop", "bonus_for_all", "shifted_labels")


def explain_hunt(cases, answers):
    """That not all verdicts are right; neither how many nor which, so that guessing does not help."""
    unknown = [answer for answer in answers if answer not in BUGS]
    if unknown:
        return f"Your function returns {str(unknown[0])[:40]!r}: the six names are {', '.join(BUGS)}."
    last = {agent: answer for (agent,), answer in zip(cases, answers, strict=True)}
    if last == {agent: diagnose(agent) for agent in "ABCDEF"}:
        return "Your function answers the same question differently each time: it must not draw at random or remember."
    return "Not all six verdicts are right. Write beside each the picture that decides it: each agent has one."


@exercise(
    "six bugs, six agents", minutes=8, difficulty=2, explain=explain_hunt,
    cases=lambda rng: [(letter,) for _ in range(4) for letter in rng.permutation(list("ABCDEF")).tolist()],
    worked=[(("A",), "flipped_kl"), (("F",), "no_stop")],
    hints=(
        "Begin with agents that are far in just one column. For one agent look at Round 3's lines, too: its peak "
        "decides. One agent is far in none: look at the fourth probe, early. Rounds 2 and 3 name three: at its "
        "accidents one is too low, and two "
        "promise too much. Two share a symptom in Round 4, and differ in their return.",
        "What each bug shows: without an end, Q is wrong by many points where episodes end. With a drawn action Q does "
        "not reach the actor: its rarest action stays likely and its return low. A flipped KL keeps the rarest action "
        "likelier, too. Without the stop-gradient the promise is for a time far beyond any return. A bonus for all "
        "adds up to c / (1 - γ) = 10 to it. Shifted labels draw the policy to the rule's next action.",
    ),
    mistakes={
        "return {**bugs, 'A': bugs['C'], 'C': bugs['A']}[agent]":
            "You swapped the two agents whose bug concerns the rule. One follows the grey lines in Rounds 2 to 4; "
            "the other keeps its rarest action far likelier.",
        "return {**bugs, 'D': bugs['E'], 'E': bugs['D']}[agent]":
            "You swapped two agents whose critics are wrong: one critic is wrong everywhere by about the "
            "same amount, the other only where episodes end.",
        "return {**bugs, 'B': bugs['F'], 'F': bugs['B']}[agent]":
            "You swapped the two that drive worst: for a time one promises more than any possible return; the other "
            "has a modest promise, and keeps its rarest action likely.",
    },
)  # fmt: skip
def diagnose(agent):
    bugs = {
        "A": "flipped_kl",
        "B": "sampled",
        "C": "shifted_labels",
        "D": "no_end",
        "E": "bonus_for_all",
        "F": "no_stop",
    }
    return bugs[agent]


unmasks = target_probe.unmasks
