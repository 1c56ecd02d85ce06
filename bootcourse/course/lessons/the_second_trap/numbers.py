"""What the numbers and claims in this lesson's text are computed from, beside tools/course/known.py."""

from functools import cache

import numpy as np

from bootcourse.course.lessons.the_second_trap import ppo_kinds, second_trap
from bootcourse.course.lessons.your_teacher.example_teachers import careful
from bootcourse.episodes.evaluate import Episodes, drive_episodes, held_out_seeds
from bootcourse.episodes.record import record
from bootcourse.learn.settings import settings_for, with_seeds
from bootcourse.learn.teachers import teacher_policy
from bootcourse.learn.training import Training
from bootcourse.research.teachers import teacher_named
from bootcourse.road.state import EGO, SPEED, TRAP_1, X
from bootcourse.statistics import ESCAPES
from tools.course.known import ROAD, shipped_teachers


def ppo(kind: str) -> dict:
    """What ships of the second trap's agents of a kind: "alone", "shaped" or "cloned"."""
    return ppo_kinds.reference()[kind]


def ppo_agents() -> int:
    """How many agents of each kind ship."""
    return len(ppo("alone")["success"])


def ppo_escapes(kind: str) -> int:
    """How many of them escape."""
    return int((ppo(kind)["success"] >= ESCAPES).sum())


@cache
def ppo_drive(kind: str = "alone", road: int = ROAD):
    """The first of these agents on one road."""
    return record(ppo_kinds.agent_of(kind).as_policy(), [road])[0]


def ppo_speeds(kind: str = "alone") -> np.ndarray:
    """Its speed (m/s) after each decision, (decisions,)."""
    return ppo_drive(kind).states[2::2, EGO, SPEED]


def ppo_gap(kind: str = "alone") -> np.ndarray:
    """How far (m) it is ahead of trap 1 then, (decisions,)."""
    cars = ppo_drive(kind).states[2::2]
    return cars[:, EGO, X] - cars[:, TRAP_1, X]


@cache
def clones(teacher: str, seeds: int = 5) -> list[Episodes]:
    """How clones of one of the study's teachers drive 100 roads by drawn actions, before PPO begins."""
    training = Training(with_seeds(settings_for("ppo_cloned"), seeds), 1, teacher=teacher_named(teacher))
    agents = [training.agent(i) for i in range(seeds)]
    return [drive_episodes(each.as_policy(np.random.default_rng(0)), held_out_seeds(1, 100)) for each in agents]


def clones_ahead(teacher: str) -> str:
    """On how many of the 100 roads each of them ends ahead of trap 1: "3 to 6"."""
    ahead = [100 * each.success.mean() for each in clones(teacher)]
    return f"{min(ahead):.0f} to {max(ahead):.0f}"


def cloned_escape(teacher: str) -> int:
    """How many of the study's ten agents of PPO after cloning this teacher escape."""
    return shipped_teachers()[teacher, "ppo_cloned"].escapers("ppo_cloned")


@cache
def careful_drive(road: int = ROAD):
    """The drive of the example teacher `careful` on one road."""
    return record(teacher_policy(careful), [road])[0]


def paid_concavely(drive) -> float:
    """What a drive without an accident is worth at its start with the concave reward and PPO's discount."""
    cars, rewards = drive.states[::2], np.asarray(drive.rewards)
    paid = second_trap.concave_pay(rewards, cars[:-1], cars[1:], np.zeros(len(rewards), dtype=bool))
    return float(settings_for("ppo").gamma ** np.arange(len(paid)) @ paid)
