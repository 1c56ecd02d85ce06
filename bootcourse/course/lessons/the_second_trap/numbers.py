"""What the numbers and claims in this lesson's text are computed from, beside tools/course/known.py."""

from functools import cache

import numpy as np

from bootcourse.course.lessons.the_second_trap import (
    explorable,  # noqa: F401 (the text names it)
    ppo_kinds,
    second_trap,
)
from bootcourse.course.lessons.your_teacher import example_teachers
from bootcourse.episodes.record import record
from bootcourse.episodes.rollout import Rollout
from bootcourse.learn.teachers import teacher_policy, toward
from bootcourse.policies import rule_policy
from bootcourse.research.tables import markdown
from bootcourse.road.state import EGO, LANE, TRAP_1, X
from bootcourse.scenario import DEFAULT
from bootcourse.statistics import ESCAPES
from tools.course.known import ROAD, discounted, idle, shipped_teachers

SHOWN = 3  # the agent of PPO alone whose drive the lesson shows
DRIVES = ("keeping straight", "this agent", "the rule", "careful")  # on road 10, see `worth`


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
def drivers() -> dict[str, tuple[float, float]]:
    """{"the rule", "keeping straight"}: return, and share ahead in the end, on the roads of these agents."""
    return {name: (returns.item(), ahead.item()) for name, (returns, ahead) in ppo_kinds.compared({}).items()}


@cache
def ppo_drive(kind: str = "alone", seed: int = SHOWN):
    """The drive of one of these agents on the road that most lessons show."""
    return record(ppo_kinds.agent_of(kind, seed).as_policy(), [ROAD])[0]


def ppo_speeds(kind: str = "alone", seed: int = SHOWN) -> np.ndarray:
    """Its speed (m/s) after each decision, (decisions,)."""
    return second_trap.speeds(ppo_drive(kind, seed))


def ppo_gap() -> np.ndarray:
    """How far (m) the agent of PPO alone that is shown is ahead of trap 1 after each decision, (decisions,)."""
    cars = ppo_drive().states[2::2]
    return cars[:, EGO, X] - cars[:, TRAP_1, X]


@cache
def worth(driver: str, gamma: float) -> float:
    """The discounted return of a drive on road 10."""
    drives = {
        "keeping straight": idle,
        "this agent": ppo_drive,
        "the rule": lambda: record(rule_policy(DEFAULT), [ROAD])[0],
        "careful": lambda: record(teacher_policy(example_teachers.careful), [ROAD])[0],
    }
    return discounted(drives[driver](), gamma)


def drives_worth() -> str:
    """The worth of these drives with PPO's γ, as Markdown."""
    names = {"this agent": "this agent's sprints", "the rule": "the rule's way out", "careful": "`careful`'s way out"}
    rows = [[names.get(each, each), f"{worth(each, ppo_kinds.GAMMA):.0f}"] for each in DRIVES]
    return markdown(["drive", "discounted return"], rows)


def worths() -> list[float]:
    """What the drives of the ten agents of PPO alone on this road are worth with PPO's γ."""
    return [discounted(ppo_drive(seed=seed), ppo_kinds.GAMMA) for seed in range(ppo_agents())]


def turning_points() -> list[tuple[int, int]]:
    """From when to when (s) the shown drive is below the traps' speed, then above, ...: each stretch that ends."""
    turns = np.flatnonzero(np.diff(ppo_speeds() < DEFAULT.traps.speed))
    return [*zip(turns[:-1], turns[1:], strict=True)]


@cache
def drives_of_ten(kind: str, roads: int = len(second_trap.TWELVE)) -> list:
    """The drives of the ten agents of a kind on the first of the twelve roads."""
    policies = [ppo_kinds.agent_of(kind, seed).as_policy() for seed in range(ppo_agents())]
    return [drive for policy in policies for drive in record(policy, second_trap.TWELVE[:roads])]


@cache
def steady(speed: float) -> float:
    """The mean worth, on the twelve roads, of `careful`'s way out and then a steady speed (m/s) in the free lane."""

    def rule(cars, scenario):
        free = cars[EGO, LANE] == 0
        return toward(cars, float(speed), 0, scenario) if free else example_teachers.careful(cars, scenario)

    return float(
        np.mean([discounted(each, ppo_kinds.GAMMA) for each in record(teacher_policy(rule), second_trap.TWELVE)])
    )


def steadies() -> str:
    """Cells of `steady`, for 11 to 15 m/s."""
    return " | ".join(f"{steady(speed):.0f}" for speed in range(11, 16))


@cache
def sprints_worth() -> float:
    """The mean worth, on the same roads, of the drive of the agent of PPO alone that is shown."""
    drives = record(ppo_kinds.agent_of("alone", SHOWN).as_policy(), second_trap.TWELVE)
    return float(np.mean([discounted(each, ppo_kinds.GAMMA) for each in drives]))


def way(drive: Rollout) -> float:
    """How far (m) a drive goes."""
    return float(np.ptp(drive.states[:, EGO, X]))


def cloned_escape(teacher: str) -> int:
    """How many of the study's ten agents of PPO after cloning this teacher escape."""
    return shipped_teachers()[teacher, "ppo_cloned"].escapers("ppo_cloned")
