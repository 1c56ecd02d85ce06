"""What a cell of an experiment runs: agents that are trained side by side and tested, or a function of its own."""

import shutil
from collections.abc import Callable, Sequence
from functools import partial

import numpy as np
from gymnasium.vector import VectorEnv

from bootcourse.episodes.evaluate import drive_episodes, held_out_seeds
from bootcourse.errors import BootcourseError
from bootcourse.files import write_arrays
from bootcourse.learn.agent import Agent
from bootcourse.learn.settings import Settings, settings_for, with_seeds
from bootcourse.learn.training import Result, Training
from bootcourse.research.jobs import CHECKPOINT, HELD_OUT, Interrupted, Run, Workplace, orphaned
from bootcourse.research.results import Results, agent_entries, as_arrays
from bootcourse.research.teachers import RULE, teacher_named
from bootcourse.scenario import DEFAULT, Scenario
from bootcourse.storage.checkpoint import load_checkpoint, save_checkpoint
from bootcourse.storage.runs import save_runs
from bootcourse.storage.work import Checkpoints

VARIED = ("sac", "soft", "demos", "bootstrapped")  # the paper's ablation
TESTS = 1000  # held-out episodes of each agent
SHIPPED_CURVES = ("success", "return", "xi", "decisions")  # of trained agents that ship
SECONDS_BETWEEN = 60.0  # of checkpoints


def results_of(function: Callable[..., Results]) -> Run:
    """What a cell runs if a function makes its results, mostly in a few minutes and without checkpoints."""
    return partial(_write_results, function)


def _write_results(function: Callable[..., Results], at: Workplace, **arguments) -> None:
    write_arrays(at.job / "results.npz", as_arrays(function(**arguments)))


def trained(
    seeds: int,
    episodes: int,
    tests: int = TESTS,
    methods: Sequence[str] = VARIED,
    scenario: Scenario = DEFAULT,
    teacher: str = RULE,
    **changes,
) -> dict:
    """The arguments of `train_and_test` for so many agents of each method. changes: of their settings."""
    agents = [agent for method in methods for agent in with_seeds(settings_for(method, **changes), seeds)]
    teacher_named(teacher)
    numbers = {"episodes": episodes, "tests": tests}
    return {"settings": tuple(agents), "scenario": scenario, **numbers, "teacher": teacher}


def train_and_test(
    at: Workplace,
    settings: Sequence[Settings],
    scenario: Scenario,
    episodes: int,
    tests: int,
    teacher: str = RULE,
    keep_runs: bool = False,
) -> float:
    """Train agents side by side, or continue their training, and test them. Returns the seconds of earlier attempts.

    tests: held-out episodes, the same for all. teacher: a name of `teachers.TEACHERS`. keep_runs: each agent's weights
    too; needs agents that differ in method or seed. Raises Interrupted, after a checkpoint.
    """
    training = _begun(at, settings, scenario, episodes, teacher)
    earlier, checkpoint = training.seconds, at.job / CHECKPOINT
    result = training.run(progress=False, callback=Checkpoints(checkpoint, SECONDS_BETWEEN), stop=orphaned)
    if result.interrupted:
        save_checkpoint(training, checkpoint)
        raise Interrupted
    write_arrays(at.job / "results.npz", as_arrays(tested_results(result, tests, teacher)))
    if keep_runs:
        shutil.rmtree(at.job / "runs", ignore_errors=True)  # left by an attempt that was killed while it wrote
        save_runs(result, at.job / "runs")
    return earlier


def _begun(at: Workplace, settings: Sequence[Settings], scenario: Scenario, episodes: int, teacher: str) -> Training:
    rule = teacher_named(teacher)
    if not (at.job / CHECKPOINT).exists():
        return Training(settings, episodes, scenario, rule)
    training = load_checkpoint(at.job / CHECKPOINT, rule)
    if (training.settings, training.episodes, training.scenario) != ([*settings], episodes, scenario):
        raise BootcourseError(f"{at.job} was begun with other settings: choose another folder, or delete this one.")
    return training


def tested_results(
    result: Result, tests: int, teacher: str, make_env: Callable[[int], VectorEnv] | None = None
) -> Results:
    """The agents of a training, their curves, and their drives in held-out episodes, as they are stored.

    tests: of each agent, by its most probable actions. teacher: its name. make_env: see `Training`.
    """
    driven = drives(result.agents, held_out_seeds(HELD_OUT, tests), result.scenario, make_env)
    return Results(
        agent_entries([agent.settings for agent in result.agents], teacher),
        np.array([result.stopped.get(i, -1) for i in range(len(result.agents))]),
        {name: smaller(values) for name, values in driven.items()},
        {name: values.astype(np.float32) for name, values in result.curves.items()},
    )


def drives(
    agents: Sequence[Agent], seeds: Sequence[int], scenario: Scenario | None = DEFAULT, make_env=None
) -> dict[str, np.ndarray]:
    """The fields of `Episodes` of every agent in the episodes of these seeds, each (agents, episodes)."""
    each = [drive_episodes(agent.as_policy(), seeds, scenario, make_env=make_env) for agent in agents]
    return {name: np.stack([getattr(one, name) for one in each]) for name in vars(each[0])}


def smaller(values: np.ndarray) -> np.ndarray:
    """The results of tests as they are stored: float32, and int8 for what is counted."""
    return values.astype(np.float32) if values.dtype == np.float64 else values.astype(np.int8)
