"""Who asks the teacher when: a student that drives alone, when two students disagree, or at random seconds."""

import numpy as np

from bootcourse.episodes.evaluate import drive_episodes
from bootcourse.learn.agent import Agent
from bootcourse.learn.teachers import Rule, teacher_policy
from bootcourse.policies import Policy, PolicyOutput

HEADINGS = ["the worse student drives, and asks", "seconds it asks in, %", "gets out, %", "accidents, %", "return"]


class Asks:
    """A policy that drives, and leaves the seconds that `when` marks to the teacher.

    when: (actions of each student, (students, roads)) -> bool (roads,).
    """

    def __init__(self, students: list[Policy], teacher: Policy, when):
        self.students, self.teacher, self.when = students, teacher, when
        self.asked: list[float] = []  # of each second: the share of the roads on which it asks

    def __call__(self, observations: np.ndarray, cars: np.ndarray) -> PolicyOutput:
        own = np.stack([student(observations, cars).actions for student in self.students])
        asks = self.when(own)
        self.asked.append(float(asks.mean()))
        return PolicyOutput(np.where(asks, self.teacher(observations, cars).actions, own[0]))


def compared(agents: list[Agent], teacher: Rule, seeds: list[int]) -> list[list[str]]:
    """A row for each way in which the first agent, which drives, asks: never, when they disagree, at random seconds."""
    students, taught, rng = [agent.as_policy() for agent in agents], teacher_policy(teacher), np.random.default_rng(0)
    share, rows = 0.0, []
    ways = {
        "never": lambda own: np.zeros(own.shape[1], dtype=bool),
        "when the two disagree": lambda own: (own != own[0]).any(axis=0),
        "as often, at random": lambda own: rng.random(own.shape[1]) < share,
    }
    for name, when in ways.items():
        driver = Asks(students, taught, when)
        ends = drive_episodes(driver, seeds)
        share = float(np.mean(driver.asked))
        shares = 100 * share, 100 * ends.success.mean(), 100 * np.mean(ends.accident > 0)
        rows.append([name, *(f"{each:.0f}" for each in shares), f"{ends.returns.mean():.0f}"])
    return rows
