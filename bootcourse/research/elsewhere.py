"""When does a sub-optimal teacher help? The experiment `elsewhere`: the paper's method on the problems of problems.py.

A cell is a problem, a teacher and a method; its seeds train side by side. Methods without a teacher have one cell for
each problem. γ, episodes and the copies driven at once are the same for all methods but PPO of a problem; SAC, soft,
demonstrations and both have the library's target entropy -1, and SAC also a usable one, 0.3 log |A|. β and, with α, ξ
fade: β over the first two thirds of the episodes. An agent has *found* the way if a window of 20 training episodes
succeeds in more than half; `kept` of the files says that the last window does.
"""

import math
from dataclasses import dataclass
from itertools import product

import numpy as np

from bootcourse.episodes.evaluate import drive_episodes, held_out_seeds
from bootcourse.learn.settings import Settings, settings_for, with_seeds
from bootcourse.learn.teachers import teacher_policy
from bootcourse.learn.training import Training
from bootcourse.research.jobs import HELD_OUT, Interrupted, LessonJob, orphaned, tested_arrays
from bootcourse.research.plan import LessonExperiment
from bootcourse.research.problems import LANDER, PROBLEMS, Problem, has_box2d
from bootcourse.research.results import found

SEEDS, TESTS, WINDOW = 10, 100, 20  # of training; held-out episodes; training episodes in a row
NOBODY = "none"  # the teacher of a method without one
USABLE = "0.3 log |A|"
ALONE = {"SAC": ("sac", {}), f"SAC, η = {USABLE}": ("sac", {"target_entropy": USABLE}), "PPO": ("ppo", {})}
TAUGHT = {
    "cloning": ("bc", {}),
    "soft": ("soft", {}),
    "demonstrations": ("demos", {}),
    "both": ("bootstrapped", {}),
    "both, c = 0": ("bootstrapped", {"bonus": 0.0}),
    "PPO after cloning": ("ppo_cloned", {}),
}
METHODS = ALONE | TAUGHT
HYPOTHESES = {  # written before any cell was run with more than two seeds; elsewhere_claims.py compares them
    "H1": "The bonus helps only where c a step is small beside the reward of success. On DoorKey (c = 2, the goal pays "
    "at most 1) both with c = 0 succeeds more often than both, with the random teacher too; on MountainCar (-1 a step) "
    "it does not matter.",
    "H2": "Cloning averages random errors away where they do not repeat (chain, MountainCar, Acrobot): with the random "
    "teacher a clone earns more than the teacher. It copies systematic errors: there it earns no more than the "
    "teacher.",
    "H3": "With the systematic teacher soft and both earn more than cloning, because ξ fades and the reward corrects "
    "the error.",
    "H4": "The longer the horizon without reward (MountainCar, Acrobot, chain; not CartPole), the more a teacher is "
    "worth: SAC with either target entropy succeeds in less than 10 % on MountainCar, and on CartPole the usable one "
    "needs no help.",
    "H5": "Soft beats demonstrations alone on every problem with the random teacher: it asks in the states that the "
    "agent reaches, and demonstrations say nothing there.",
    "H6": "PPO after cloning is at least as good as cloning on every problem, with every teacher.",
}
PPO = {"envs_per_agent": 16, "horizon": 64, "batch": 256, "actor_lr": 1e-3, "critic_lr": 1e-3}


def settings_of(problem: Problem, name: str) -> Settings:
    """The settings of one of `METHODS` on a problem."""
    method, changes = METHODS[name]
    changes = {"gamma": problem.gamma, "demonstration_episodes": 50} | changes
    if changes.get("target_entropy") == USABLE:
        changes["target_entropy"] = 0.3 * math.log(problem.actions)
    if method.startswith("ppo"):
        changes |= PPO
    elif method in ("demos", "bootstrapped"):
        changes["beta_episodes"] = 2 * problem.episodes // 3
    return settings_for(method, **changes)


def cell(problem: str, teacher: str, method: str, seeds: int, episodes: int, tests: int) -> dict[str, np.ndarray]:
    """Train and test the agents of a cell: the arrays of a file of results. Raises Interrupted if it is stopped.

    Tested: by the most probable action. Measured, (agents,): return and success of drawn actions, found and kept (see
    above), and return and success of the teacher itself, the same for all; NaN without one.
    """
    one = PROBLEMS[problem]
    rule = None if teacher == NOBODY else one.teachers()[teacher]
    settings = with_seeds(settings_of(one, method), seeds)
    training = Training(settings, episodes or one.episodes, make_env=one.make_env, teacher=rule)
    result = training.run(progress=False, stop=orphaned)
    if result.interrupted:
        raise Interrupted(method)

    def driven(policy):
        return drive_episodes(policy, held_out_seeds(HELD_OUT, tests), None, make_env=one.make_env)

    drawn = [driven(agent.as_policy(np.random.default_rng(i))) for i, agent in enumerate(result.agents)]
    taught = [] if rule is None else [driven(teacher_policy(rule, None, one.actions))]
    success = result.curves["success"]
    measured = {"found": found(success, WINDOW), "kept": found(success[:, -WINDOW:], WINDOW)}
    for who, drives in (("drawn", drawn), ("teacher", taught * seeds)):
        for measure in ("success", "returns"):
            means = [getattr(each, measure).mean() for each in drives]
            measured[f"{who}_{measure}"] = np.array(means) if means else np.full(seeds, np.nan)
    arrays = tested_arrays(result, tests, teacher, one.make_env)
    return arrays | {f"measured.{name}": values for name, values in measured.items()}


@dataclass(frozen=True)
class Elsewhere(LessonExperiment):
    """The cells: {"PROBLEM, TEACHER, METHOD": the arguments of `cell`}."""

    def jobs(self, name: str, seeds: int = 0, episodes: int = 0, tests: int = 0) -> list[LessonJob]:
        """One job for each cell; without box2d none of Lunar lander."""
        cells = self.variations
        if not has_box2d():
            cells = {each: arguments for each, arguments in cells.items() if arguments["problem"] != LANDER}
            print("Lunar lander is left out, since box2d is not installed: `pip install bootcourse[lander]`.")
        return LessonExperiment(self.function, cells).jobs(name, seeds, episodes, tests)


def _cells() -> dict[str, dict]:
    cells = {}
    for problem, one in PROBLEMS.items():
        numbers = {"seeds": SEEDS, "episodes": 0, "tests": TESTS}  # 0: the problem's own number
        for teacher, method in [*product([NOBODY], ALONE), *product(one.teachers(), TAUGHT)]:
            named = {"problem": problem, "teacher": teacher, "method": method}
            cells[f"{problem}, {teacher}, {method}"] = named | numbers
    return cells


EXPERIMENT = Elsewhere("bootcourse.research.elsewhere:cell", _cells())
