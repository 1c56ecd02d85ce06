"""What the numbers and claims in this lesson's text are computed from, beside tools/course/known.py."""

from functools import cache

import numpy as np
from torch import Tensor

from bootcourse.course.lessons.demonstrations.cloning import UPDATES as UPDATES
from bootcourse.course.lessons.demonstrations.cloning import (
    all_at_once,
    left_in,
    metres_left,
)
from bootcourse.course.shipped import shipped_agents, shipped_experiment, shipped_results
from bootcourse.episodes.record import record
from bootcourse.learn.agent import Agent
from bootcourse.learn.demonstrations import collect
from bootcourse.policies import stochastic_rule_policy
from bootcourse.research.results import Results
from bootcourse.scenario import DEFAULT


@cache
def rows() -> dict[str, Tensor]:
    """The rows of 200 drives of the rule, and of 200 of the stochastic rule."""
    unsure = stochastic_rule_policy(DEFAULT, np.random.default_rng(0))
    return {"the rule": collect(200), "the stochastic rule": collect(200, policy=unsure)}


def beyond_the_band() -> int:
    """How many of the stochastic rule's rows are farther left than all of the rule's."""
    return int((left_in(rows()["the stochastic rule"]) > left_in(rows()["the rule"]).max()).sum())


@cache
def fifteen_clones() -> dict[str, Results]:
    """Fifteen clones of each kind, with other seeds than the lesson's."""
    return shipped_experiment("clones")


def others_crash(kind: str, after: int = -1) -> np.ndarray:
    """The share of accidents of each of the fifteen clones of a kind; of DAgger's, after so many rounds."""
    return fifteen_clones()[kind].notes["accidents"][:, after]


def others_agree(kind: str, where: str, after: int = -1) -> float:
    """How often they agree with the rule, on average: "agrees", in its states for DAgger's, or in their "own"."""
    return float(fifteen_clones()[kind].notes[where][:, after].mean())


@cache
def bc_shipped() -> list[Agent]:
    """The study's clones of the rule whose weights ship."""
    return shipped_agents("bc")


@cache
def long_beyond() -> float:
    """In how many of these clones' drives on 20 roads the car is at any time left of all of the rule's rows."""
    drives = record(all_at_once(bc_shipped()), [*range(20)] * len(bc_shipped()))
    high = float(left_in(rows()["the rule"]).max())
    return float(np.mean([(metres_left(drive) > high).any() for drive in drives]))


def by_chance() -> Results:
    """The ten clones of the stochastic rule, trained with more updates than the study's clones of the rule."""
    return shipped_results("paper").of("bc")


@cache
def stochastic_crashes() -> float:
    """In which share of its drives the stochastic rule has an accident, on 100 roads."""
    return float(
        np.mean(
            [
                drive.accident > 0
                for drive in record(stochastic_rule_policy(DEFAULT, np.random.default_rng(0)), range(100))
            ]
        )
    )


def updates_of(results: Results) -> float:
    """About how many updates each of these agents had: so many follow each decision on all of its roads."""
    agent, curves = results.agents[0], results.curves
    decisions = (curves["distance"] / curves["speed"]).sum(axis=1)  # one a second
    return float(((decisions - agent["learning_starts"]) * agent["updates"] / agent["envs_per_agent"]).mean())
