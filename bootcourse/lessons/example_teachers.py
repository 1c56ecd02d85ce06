"""Four example teachers, good and bad, and an exam that tests whether a function is a rule, and how it drives."""

from dataclasses import dataclass

import numpy as np

from bootcourse.episodes.evaluate import Episodes, drive_episodes, held_out_seeds
from bootcourse.errors import BootcourseError
from bootcourse.learn.teachers import Rule, ahead, teacher_of, teacher_policy, toward
from bootcourse.road.state import EGO, LANE, Accident, Y
from bootcourse.road.vector_env import TrapVectorEnv
from bootcourse.scenario import DEFAULT, Scenario

EXAM = 13  # the evaluation seed of its roads


# Four teachers ---------------------------------------------------------------------------------------


def careful(cars: np.ndarray, scenario: Scenario) -> int:
    """Falls back, goes left as soon as there is room, and drives 15 m/s on the free lane."""
    lane = int(cars[EGO, LANE])
    gap, v = ahead(cars, lane, scenario)
    if lane == 0:  # the free lane: 0.5 m/s slower than a car that is near
        return toward(cars, 15.0 if gap > 25 else min(15.0, v - 0.5), 0, scenario)
    left_gap, left_v = ahead(cars, lane - 1, scenario)
    settled = abs(cars[EGO, Y] - lane * scenario.road.lane_width) < 0.5
    goal = lane - 1 if settled and left_gap > 4 else lane
    return toward(cars, min(v, left_v, 14.0) - 1.5, goal, scenario)


def timid(cars: np.ndarray, scenario: Scenario) -> int:
    """Follows trap 1 to the end: keeps straight."""
    return 4


def reckless(cars: np.ndarray, scenario: Scenario) -> int:
    """Always accelerates, also towards a car."""
    return 7


def racer(cars: np.ndarray, scenario: Scenario) -> int:
    """Gets out as `careful` does, then aims for 20 m/s and ignores the other cars."""
    return toward(cars, 20.0, 0, scenario) if cars[EGO, LANE] == 0 else careful(cars, scenario)


# The exam --------------------------------------------------------------------------------------------


@dataclass(frozen=True)
class Exam:
    """What `examine` found; `problems` is empty if the function is a rule."""

    problems: tuple[str, ...]
    episodes: Episodes | None = None

    def __repr__(self) -> str:
        if self.episodes is None:
            return "Not a rule yet. " + " ".join(self.problems)
        e = self.episodes
        kinds = ", ".join(f"{np.mean(e.accident == kind):.0%} {kind.name.lower().replace('_', ' ')}"
                          for kind in Accident if kind)  # fmt: skip
        return (
            f"{len(e.success)} roads: gets out on {e.success.mean():.0%}; {kinds}; "
            f"return {e.returns.mean():.1f}, {e.speed.mean():.1f} m/s"
        )


def examine(my_rule: Rule, roads: int = 100, scenario: Scenario = DEFAULT) -> Exam:
    """Ask the rule about some roads, twice, then let it drive. Problems are returned as sentences, not raised."""
    env = TrapVectorEnv(min(roads, 20), scenario)
    env.reset(seed=held_out_seeds(EXAM, env.num_envs)[0])
    problems = []
    try:
        teacher = teacher_of(my_rule, scenario)
        first, again = teacher(env.cars), teacher(env.cars)
        if not np.array_equal(first, again):
            problems.append("It answers the same road differently each time.")
        road = env.cars[0].copy()
        my_rule(road[None] if getattr(my_rule, "answers_for_all_roads", False) else road, scenario)
        if not np.array_equal(road, env.cars[0]):
            problems.append("It writes into `cars`: compute new values instead.")
        if problems:
            return Exam(tuple(problems))
        episodes = drive_episodes(teacher_policy(my_rule, scenario), held_out_seeds(EXAM, roads), scenario)
    except BootcourseError as error:
        return Exam((str(error),))
    except Exception as error:  # a student's rule may raise anything
        return Exam((f"It raises {type(error).__name__}: {error}.",))
    return Exam((), episodes)
