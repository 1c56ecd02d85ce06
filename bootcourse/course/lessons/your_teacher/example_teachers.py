"""Example teachers, good and bad, and an exam that tests whether a function is a rule, and how it drives."""

from dataclasses import dataclass, replace

import numpy as np

from bootcourse.episodes.evaluate import Episodes, drive_episodes, held_out_seeds
from bootcourse.errors import BootcourseError
from bootcourse.learn.teachers import Rule, ahead, marked, teacher_of, teacher_policy, toward
from bootcourse.road.state import EGO, LANE, SPEED, TARGET_LANE, TRAFFIC, Accident, X, Y
from bootcourse.road.vector_env import TrapVectorEnv
from bootcourse.scenario import DEFAULT, Scenario

EXAM = 13  # the evaluation seed of its roads


# The teachers --------------------------------------------------------------------------------------


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


def slower_racer(cars: np.ndarray, scenario: Scenario) -> int:
    """The racer with one number changed: 15 m/s in place of 20."""
    return toward(cars, 15.0, 0, scenario) if cars[EGO, LANE] == 0 else careful(cars, scenario)


def two_speeds(slow: float, fast: float) -> Rule:
    """A rule that looks at no other car: `slow` (m/s) and one lane to the left, and `fast` on the free lane."""

    def blind(cars: np.ndarray, scenario: Scenario) -> int:
        lane = int(cars[EGO, LANE])
        return toward(cars, fast if lane == 0 else slow, max(0, lane - 1), scenario)

    return blind


# A harder road --------------------------------------------------------------------------------------

DENSE = replace(DEFAULT, name="dense left lane", traffic=replace(DEFAULT.traffic, cars=10))


def dense_road(seed: int) -> np.ndarray:
    """A road of `DENSE` as it begins: all ten traffic cars drive in the left lane, in a queue of about 180 m.

    Its last car is 25 to 185 m behind the ego. So there is no place, and no second, at which all queues have passed.
    """
    env, rng = TrapVectorEnv(1, DENSE), np.random.default_rng(seed)
    env.reset(seed=int(seed))
    cars = env.cars[0].copy()
    queue = cars[TRAFFIC:]
    queue[:, X] = -50 - rng.uniform(0, 150) + np.cumsum(rng.uniform(14, 26, len(queue)))
    queue[:, [LANE, TARGET_LANE, Y]] = 0.0
    queue[:, SPEED] = rng.uniform(10.5, 11.5, len(queue))
    return cars


def watchful(cars: np.ndarray, scenario: Scenario) -> int:
    """Changes to the left only where there is room ahead and behind; waits in its lane for a gap."""
    lane, v = int(cars[EGO, LANE]), cars[EGO, SPEED]
    gap, front = ahead(cars, lane, scenario)
    if lane == 0:  # the free lane
        return toward(cars, 15.0 if gap > 40 else min(15.0, front - 0.5), 0, scenario)
    left_gap, left_front = ahead(cars, lane - 1, scenario)
    behind = cars[(cars[:, LANE] == lane - 1) & (cars[:, X] <= cars[EGO, X])]
    last = behind[behind[:, X].argmax()] if len(behind) else None
    back, closing = (np.inf, 0.0) if last is None else (cars[EGO, X] - last[X] - 5, last[SPEED] - v)
    room = left_gap > 4 + max(0.0, 2 * (v - left_front)) and back > 4 + max(0.0, 3 * closing)
    arrived = cars[EGO, Y] - lane * scenario.road.lane_width < 0.5
    speed = min(front, left_front, 14.0) - 1.5
    if lane == 1:  # beside the queue: stay behind trap 2
        speed = min(front - 0.5, 14.0) if gap > 12 else front - 1
    return toward(cars, max(6.5, speed), lane - 1 if room and arrived else lane, scenario)


# The exam -------------------------------------------------------------------------------------------


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
        my_rule(road[None] if marked(my_rule).answers_all_roads else road, scenario)
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
