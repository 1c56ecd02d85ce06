"""Figures of the lesson on SAC's update and loop: the pole before training, the tests, and what critics expect."""

from collections.abc import Mapping, Sequence

import numpy as np
from matplotlib.figure import Figure

from bootcourse.colours import OTHER, STRANGERS
from bootcourse.course import charts
from bootcourse.course.lessons.discrete_sac.figures import cartpole_strip
from bootcourse.course.lessons.update_and_loop import by_hand, left_out
from bootcourse.learn.teachers import teacher_policy
from bootcourse.research.experiments import checks


def before_training(agent: by_hand.SAC) -> Figure:
    """An episode of an untrained agent, by its most probable pushes, and one of the rule."""
    drivers = {"untrained": agent.as_policy(), "rule: one weighted sum": teacher_policy(checks.balance, None, 2)}
    drives = {}
    for label, driver in drivers.items():
        rows, pushes = checks.data(driver, checks.cartpole, 1, seed=0)
        drives[f"{label}: {pushes:.0f} pushes"] = rows[:, :4].numpy()
    return cartpole_strip(drives, "An untrained agent lets the pole fall at once")


def tests_in_training(tests: Sequence[float], block: int) -> Figure:
    """The tests of an agent, one before its training and one after each `block` of pushes."""
    pushes, falls = np.arange(len(tests)) * block, int((np.diff(tests) < 0).sum())
    ended = "Solved after" if min(tests[-2:]) >= 475 else "Not solved in"
    worse = "test is" if falls == 1 else "tests are"
    title = f"{ended} {pushes[-1]:,} pushes; {falls} {worse} worse than the one before"
    looks = [OTHER._replace(marker="o")]
    return charts.lines(pushes, {"your agent": np.array(tests)}, title, "pushes in training",
                        "pushes balanced, mean of 10 episodes", looks=looks)  # fmt: skip


def estimates(q: Mapping[str, np.ndarray], title: str) -> Figure:
    """What critics expect of the start while they learn: {words: (agents, points)}, see `left_out.estimates`."""
    updates = left_out.EVERY * np.arange(1, 1 + min(values.shape[1] for values in q.values()))
    return charts.lines(updates, q, title, "updates", "Q at the start, a line for each agent",
                        marks={"1 / (1 − γ) = 100": 100.0}, looks=STRANGERS)  # fmt: skip
