"""When does a sub-optimal teacher help? The paper's method on other problems, with teachers that err."""

from collections.abc import Mapping
from dataclasses import replace
from itertools import product
from pathlib import Path

import numpy as np
from torch import Tensor

from bootcourse.episodes.evaluate import drive_episodes, held_out_seeds
from bootcourse.learn.demonstrations import demonstrate
from bootcourse.learn.settings import with_seeds
from bootcourse.learn.teachers import Rule, teacher_policy
from bootcourse.learn.training import Training
from bootcourse.research.cells import results_of, tested_results
from bootcourse.research.elsewhere import ALONE, BONUSES, NOBODY, TAUGHT, WINDOW, WITHOUT_LOOPS, settings_of
from bootcourse.research.elsewhere_page import write_page
from bootcourse.research.experiment import Computed, Experiment
from bootcourse.research.jobs import HELD_OUT, Interrupted, orphaned
from bootcourse.research.problems import DOORKEY, LANDER, PROBLEMS, Problem, has_box2d
from bootcourse.research.results import Results
from bootcourse.statistics import found


def cells(seeds: int = 10, episodes: int = 0, tests: int = 100) -> dict[str, dict]:
    """{"PROBLEM, TEACHER, METHOD": the arguments of `cell`}. episodes: 0 for the problem's own number."""
    named = {}
    for problem, one in PROBLEMS.items():
        numbers = {"seeds": seeds, "episodes": episodes, "tests": tests}
        taught = TAUGHT | (BONUSES if problem == DOORKEY else {})
        extra = [("random", WITHOUT_LOOPS)] if problem == DOORKEY else []
        for teacher, method in [*product([NOBODY], ALONE), *product(one.teachers(), taught), *extra]:
            words = {"problem": problem, "teacher": teacher, "method": method}
            named[", ".join(words.values())] = words | numbers
    return named


def cell(problem: str, teacher: str, method: str, seeds: int, episodes: int, tests: int) -> Results:
    """Train and test the agents of a cell. Raises Interrupted if it is stopped.

    Tested: by the most probable action. Measured, (agents,): return and success of drawn actions, found and kept (see
    research/elsewhere.py), and return and success of the teacher itself, the same for all; NaN without one.
    """
    one = PROBLEMS[problem]
    rule = None if teacher == NOBODY else one.teachers()[teacher]
    settings = with_seeds(settings_of(one, method), seeds)
    shown = arriving(one, rule, settings[0].demonstration_episodes) if method == WITHOUT_LOOPS else None
    training = Training(settings, episodes or one.episodes, make_env=one.make_env, teacher=rule, demonstrations=shown)
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
    return replace(tested_results(result, tests, teacher, one.make_env), measured=measured)


def arriving(one: Problem, rule: Rule, count: int, tried: int = 400) -> Tensor:
    """The rows of a teacher's first `count` drives that reach the goal; the others end at the time limit, in a loop."""
    drives = demonstrate(tried, None, teacher=rule, make_env=one.make_env)
    arrived = [drive for drive in drives.drives if drives.terminated[drive.stop - 1]][:count]
    return drives.rows()[np.concatenate([np.arange(drive.start, drive.stop) for drive in arrived])]


def obstacle(arguments: Mapping) -> str:
    """Lunar lander needs box2d."""
    if arguments["problem"] != LANDER or has_box2d():
        return ""
    return "Lunar lander is left out, since box2d is not installed: `pip install bootcourse[lander]`."


def section(computed: dict[str, Computed], folder: Path) -> list[str]:
    """A link to the page, which is written beside the report."""
    if write_page(computed["elsewhere"], folder) is None:
        return []
    return ["## Other problems\n", "[When does a sub-optimal teacher help?](elsewhere.md)\n"]


EXPERIMENT = Experiment("elsewhere", cells, results_of(cell), ("success", "return"), section, obstacle=obstacle)
