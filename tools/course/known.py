"""What an expression in a lesson's text may name: numpy, the library, and a few short cuts to what ships.

What takes long to load or to drive is kept for the next expression.
"""
# ruff: noqa: F401 (what is imported here is for the expressions)

import dataclasses
import math
import re
from functools import cache

import gymnasium as gym
import numpy as np
import torch
from scipy import stats

from bootcourse.course import shipped
from bootcourse.course.lessons import LESSONS, registry
from bootcourse.course.lessons.bug_hunt import bugs
from bootcourse.course.lessons.the_second_trap import ppo_kinds, second_trap
from bootcourse.course.lessons.values import chain
from bootcourse.course.lessons.values.chain import leaving
from bootcourse.course.lessons.your_teacher import example_teachers, taught_agents
from bootcourse.episodes.evaluate import Episodes, drive_episodes, held_out_seeds
from bootcourse.episodes.record import record
from bootcourse.files import read_arrays
from bootcourse.learn import bootstrap, sac
from bootcourse.learn.bootstrap import demonstration_share
from bootcourse.learn.settings import settings_for
from bootcourse.methods import METHODS
from bootcourse.policies import idle_policy, plan_policy, rule_policy
from bootcourse.research import report
from bootcourse.research.experiments import clocks as study_clocks
from bootcourse.research.experiments.clocks import pattern
from bootcourse.research.paper import EPISODES, PRINTED
from bootcourse.research.results import KINDS, Results
from bootcourse.research.teachers import LATE
from bootcourse.road import formulas, observation
from bootcourse.road.formulas import centring_reward, speed_reward
from bootcourse.road.state import EGO, SPEED, TRAP_1, TRAP_2, Accident, X, Y
from bootcourse.rule import Reason, target_speed
from bootcourse.scenario import ACTION_NAMES, DEFAULT, N_ACTIONS, RULE_P
from bootcourse.statistics import ESCAPES, escapes, improvement, interval, iqm, rate
from bootcourse.statistics import fisher as fisher
from bootcourse.storage.assets import FOLDER
from tools.course import numbering
from tools.course.source import lesson_of, read, sources

shipped_results = cache(shipped.shipped_results)
shipped_runs = cache(shipped.shipped_runs)
shipped_drive = cache(shipped.shipped_drive)
shipped_experiment = cache(shipped.shipped_experiment)
shipped_teachers = cache(shipped.shipped_teachers)
ROAD = 10  # the road that most lessons show
SETTINGS = settings_for("bootstrapped")  # the paper's


def roads() -> int:
    """How many held-out roads each agent of the study has driven."""
    return shipped_results().sizes[0]


def minutes(*lessons: str) -> int:
    """The time of these lessons together, as they state it at their top."""
    return sum(map(numbering.minutes, lessons))


def talk(*lessons: str) -> int:
    """The minutes that the instructor's pages of these lessons have for talk."""
    return sum(cell.metadata.get("minutes", 0) for path in sources(lessons) for cell in read(path))


def boards() -> str:
    """A table of what stands on the board at the end of each lesson, and what is to discuss, as its text says."""
    rows = ["| lesson | on the board | to discuss |", "|---|---|---|"]
    for path in sources():
        text = "\n\n".join(cell.text for cell in read(path) if cell.for_instructor)
        said = re.findall(r"^\*\*(?:On the board|To discuss)\.\*\* (.+?)(?=\n\n|\Z)", text, re.M | re.S)
        if said:
            rows.append(f"| [[{lesson_of(path)}]] | {' | '.join(' '.join(each.split()) for each in said)} |")
    return "\n".join(rows)


def work(*names: str) -> int:
    """The minutes of these exercises."""
    return sum(registry()[name].minutes for name in names)


@cache
def bound() -> np.ndarray:
    """The best return that the planner found on each of those roads."""
    return read_arrays(FOLDER / "bound-default.npz")["returns"]


@cache
def by_rule(road: int = ROAD):
    """The rule's drive on one road."""
    return record(rule_policy(DEFAULT), [road])[0]


@cache
def idle(road: int = ROAD):
    """Nobody's drive on one road: 4, "keep straight", for ever."""
    return record(idle_policy, [road])[0]


@cache
def rule_seeing(sight: float) -> Episodes:
    """The rule with another sight (m), on the held-out roads of the study."""
    seen = dataclasses.replace(DEFAULT.sight, distance=sight)
    return drive_episodes(rule_policy(dataclasses.replace(DEFAULT, sight=seen)), held_out_seeds(1, roads()))


@cache
def of(method: str) -> Results:
    """The study's agents of a method; "rule" is a method, too."""
    return report.rule_results(DEFAULT, roads()) if method == "rule" else shipped_results().of(method)


def escaped(method: str, scenario: str = "default") -> int:
    """How many agents of a method escape."""
    return escapers(of(method) if scenario == "default" else shipped_results(scenario), method)


def varied() -> dict[str, Results]:
    """The study's agents with one number changed, by what was changed."""
    return shipped_experiment("sensitivity")


def escaped_with(change: str, method: str) -> int:
    """How many of the few agents of a method escape with a number changed."""
    return escapers(varied()[change], method)


@cache
def clocks() -> dict[tuple[str, str], Results]:
    """The four methods' ten agents each, by (updates per decision, who drives the demonstrations): ("2", "π̃")."""
    return study_clocks.choices(shipped_experiment("clocks"))


escapers = Results.escapers  # (results, method): how many of a method's agents in these results escape


def accidents(method: str) -> float:
    """The share of a method's held-out episodes that end in an accident of any kind."""
    return float(of(method).episodes("accident").mean())


def code_of(lesson: str) -> str:
    """The source of a lesson."""
    return sources([lesson])[0].read_text(encoding="utf-8")


def second_pays(speed: float, offset: float = 0.0) -> float:
    """The reward of a second at a speed (m/s), offset metres off the lane's centre, without steering."""
    w = DEFAULT.reward
    return formulas.weighted_reward(speed_reward(speed), centring_reward(offset), 0.0, w.w_v, w.w_y, w.w_theta)


def discounted(drive, gamma: float) -> float:
    """What a drive is worth at its start."""
    return float(gamma ** np.arange(len(drive.rewards)) @ drive.rewards)


def in_training(method: str, first: int, last: int | None) -> np.ndarray:
    """Each agent's success in some of its training episodes, (agents,)."""
    return of(method).curves["success"][:, first:last].mean(axis=1)


def others(kind: str) -> Results:
    """Ten other agents of a kind of experiments/stress.py, such as "soft": other seeds, another implementation of the
    learner, twice the episodes.
    """
    return shipped_experiment("stress")[kind]
