"""What the numbers and claims in this lesson's text are computed from, beside tools/course/known.py."""

from functools import cache

import numpy as np

from bootcourse.course import shipped
from bootcourse.course.lessons.bug_hunt import bugs, figures
from bootcourse.course.lessons.bug_hunt.exercises import end_error
from bootcourse.course.lessons.bug_hunt.target_probe import unmasks
from bootcourse.episodes.evaluate import drive_episodes
from bootcourse.episodes.record import record
from bootcourse.episodes.rollout import Rollout
from bootcourse.learn.replay_buffer import Batch
from bootcourse.policies import rule_policy, stochastic_rule_policy
from bootcourse.road.state import EGO, SPEED, Y
from bootcourse.scenario import DEFAULT
from tools.course.known import fisher

hunt = cache(bugs.Hunt)  # the agents of the bug hunt


@cache
def drives() -> list[Rollout]:
    """The stochastic rule's drives, of which the lesson takes accidents and labels."""
    return record(stochastic_rule_policy(DEFAULT, np.random.default_rng(1)), range(50))


@cache
def agree(bug: str) -> np.ndarray:
    """Where a learner's labels are the rule's action before the step, in these drives: (decisions,) bool."""
    return np.concatenate([bugs.labels(bug, drive) == drive.rule_actions for drive in drives()])


def ends(name: str) -> float:
    """An agent's return in its last 30 training episodes, as a share of the healthy one's: the mean of two seeds."""
    returns = hunt().at_the_end("return")
    return returns[name].mean() / returns["healthy"].mean()


def late(name: str, what: str) -> list[int]:
    """In how many of its last 30 training episodes each of an agent's two seeds had a success or an accident."""
    return [round(30 * share) for share in hunt().at_the_end(what)[name]]


@cache
def driven(name: str) -> float:
    """The share of new roads on which an agent crashes, by its likeliest actions."""
    return float(np.mean(drive_episodes(hunt().agent(name).as_policy(), figures.ROADS).accident > 0))


@cache
def seen() -> Batch:
    """The transitions of the drives whose accidents the student's probe asks about."""
    return bugs.transitions(drives())


def ended() -> np.ndarray:
    """Which of these transitions ended in an accident."""
    return seen().terminated > 0


def asked(name: str) -> float:
    """What the student's probe says of an agent."""
    q = hunt().agent(name).q_values(seen().states)
    return float(end_error(q, seen().actions, seen().rewards, seen().terminated))


@cache
def in_left_lane(name: str) -> tuple[int, float]:
    """In the drives that the lesson plays: from which second on a car is in the left lane, its median speed there."""
    policy = rule_policy(DEFAULT) if name == "rule" else hunt().agent(name).as_policy()
    cars = shipped.beginning(record(policy, [10])[0], 50).states[:: DEFAULT.clock.steps, EGO]
    inside = cars[:, Y] < DEFAULT.road.lane_width / 2
    return int(inside.argmax()), float(np.median(cars[inside, SPEED]))


def line_end(name: str) -> float:
    """The Q at its own accidents where an agent's line ends, the mean of two seeds."""
    return float(figures.last(hunt(), "end")[name].mean())


def promised(name: str) -> np.ndarray:
    """What the critic of each of an agent's two seeds promises where its line ends, (2,)."""
    return figures.last(hunt(), "promise")[name]


def peaks(name: str) -> np.ndarray:
    """The most that the critic of each of an agent's two seeds promises in training, (2,)."""
    return hunt().probe(name, "promise").max(axis=1)


def after_the_end(name: str) -> float:
    """The mean value Σ π Q that an agent gives to a car that has just crashed."""
    agent, states = hunt().agent(name), seen().next_states[ended()]
    return float((agent.probabilities(states) * agent.q_values(states)).sum(-1).mean())


def alike(name: str, first: int, last: int) -> float:
    """How often an agent's likeliest action is the rule's, between two updates: the mean of both seeds."""
    during = (hunt().updates >= first) & (hunt().updates <= last)
    return float(hunt().probe(name, "alike")[:, during].mean())


def now_not_next(name: str) -> np.ndarray:
    """How much more often an agent's likeliest action is the rule's of now than of the next second, (2, points)."""
    return figures.now_not_next(hunt())[name][1]


def more_crashes(name: str) -> float:
    """Fisher's two-sided p of the accidents of an agent and of the healthy one on the new roads."""
    crashed = [round(driven(each) * len(figures.ROADS)) for each in (name, "healthy")]
    return fisher(*crashed, len(figures.ROADS))


@cache
def found() -> set[str]:
    """The bugs that the test of the target finds in untrained learners."""
    return {bug for bug in bugs.LEARNERS if unmasks(bugs.target_of(bug))}
