"""What the numbers and claims in this lesson's text are computed from, beside tools/course/known.py."""

import gymnasium as gym
import numpy as np

from bootcourse.course.lessons import registry
from bootcourse.course.lessons.your_own_problem import explorable, loops  # noqa: F401 (for the expressions)
from bootcourse.course.lessons.your_own_problem.cells import BONUSES, THREE, cells, entries, places  # noqa: F401
from bootcourse.research import elsewhere_claims  # noqa: F401
from bootcourse.research.equal_decisions import BOARD  # noqa: F401
from bootcourse.research.problems import PROBLEMS, DoorKey

TEACHERS = ("good", "random", "systematic")
SHOWN = [(p, t) for p in THREE for t in TEACHERS]


def score(problem: str, teacher: str, method: str, measure: str = "success") -> float:
    """The mean over agents of a cell, see `elsewhere_claims.Cells.scores`."""
    return cells().mean(problem, teacher, method, measure)


def earned(teacher: str) -> float:
    """What a teacher of MountainCar earns."""
    return score("mountain-car", teacher, "the teacher", "returns")


def speed_rule_earns() -> float:
    """What the rule of CartPole earns that pushes to the side of angle + speed, as the picture of the edges has it."""
    return loops.earns(
        lambda seen: int(seen[2] + seen[3] > 0), lambda n: gym.make_vec("CartPole-v1", n, vectorization_mode="sync")
    )


def by_bonus(teacher: str) -> np.ndarray:
    """The success of both aids on DoorKey with each bonus that the table shows, by drawn actions."""
    return np.array([score("doorkey", teacher, name, "drawn_success") for name in BONUSES.values()])


def without_bonus(teacher: str) -> float:
    """The success of both aids with c = 0 on DoorKey, by most probable actions."""
    return score("doorkey", teacher, BONUSES["c = 0"])


def same_action_nearby() -> float:
    """Of the pairs of DoorKey's states that differ in one part, the share in which the good teacher does the same."""
    env, rng = DoorKey(500), np.random.default_rng(0)
    seen = [env.reset(seed=0)[0], *(env.step(rng.integers(env.actions, size=500))[0] for _ in range(100))]
    states = np.unique(np.concatenate(seen), axis=0)
    states = states[states[:, 8] == 0]  # nothing is left to do in the goal's cell
    apart = np.abs(states[:, None] - states).sum(-1)  # a part is one-hot: 2, or 1 where the key is fetched
    actions = PROBLEMS["doorkey"].teachers()["good"](states)
    return (actions[:, None] == actions)[(apart > 0) & (apart <= 2)].mean()


def drowning_bonus(*arguments: float) -> float:
    """The exercise's solution."""
    return registry()["drowning_bonus"](*arguments)
