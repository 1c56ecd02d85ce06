"""What ships with the course, loaded for a lesson: the study's results, its trained agents and recorded drives."""

from dataclasses import replace
from typing import TYPE_CHECKING

from bootcourse.episodes.rollout import BY_RULE, OPTIONAL, Rollout
from bootcourse.errors import BootcourseError
from bootcourse.storage.assets import FOLDER, shipped

if TYPE_CHECKING:  # loads torch, for which the course's first road need not wait
    from bootcourse.learn.agent import Agent
    from bootcourse.research.experiments.teacher_worth import Cells
    from bootcourse.research.results import Results
    from bootcourse.storage.runs import Run


def shipped_results(study: str = "default") -> "Results":
    """A study's results, every method's agents: "default", "calibrated" (faster traps) or "paper" (more updates).

    `.of(method).scores("success")` is (agents,), their share of held-out roads with success.
    Raises BootcourseError if that part does not ship.
    """
    from bootcourse.research.results import load_results

    files = {path.stem.removeprefix("study-"): path for path in sorted(shipped().glob("study-*.npz"))}
    if study not in files:
        raise BootcourseError(f"No results of the study '{study}' ship: there are {', '.join(files) or 'none'}.")
    return load_results(files[study])


def shipped_runs(method: str) -> "list[Run]":
    """The trained agents of a method with their training curves, by seed. Raises BootcourseError if there are none."""
    from bootcourse.storage.runs import find_runs, load_run

    paths = [path for path in find_runs(shipped("runs")) if path.name.rpartition("-")[0] == method]
    if not paths:
        raise BootcourseError(f"No agents of the method '{method}' ship in {FOLDER.name}/runs.")
    return sorted(map(load_run, paths), key=lambda run: run.agent.settings.seed)


def shipped_agents(method: str) -> "list[Agent]":
    """The trained agents of a method, by seed. Raises BootcourseError if there are none."""
    return [run.agent for run in shipped_runs(method)]


def shipped_experiment(name: str) -> "dict[str, Results]":
    """The agents of an experiment, such as "sensitivity" or "clocks": {what was changed: results}.

    Raises BootcourseError if it does not ship.
    """
    from bootcourse.research.computed import experiment

    shipped()
    results = experiment(name)
    if not results:
        raise BootcourseError(f"No results of the experiment '{name}' ship: copy {FOLDER.name} from the course again.")
    return results


def shipped_teachers() -> "Cells":
    """What agents of several methods learned from teachers from bad to perfect: {(teacher, method): results}."""
    from bootcourse.research.experiments.teacher_worth import by_teacher

    return by_teacher(shipped_experiment("teachers"))


def shipped_drive(name: str) -> Rollout:
    """One of the recorded drives: "escape", "crash", "rule" or "trapped-sac".

    Raises BootcourseError for any other name.
    """
    return Rollout.load(shipped("rollouts") / f"{name}.npz")


def beginning(drive: Rollout, seconds: int) -> Rollout:
    """The first seconds of a drive, as a drive of its own; a drive that is shorter is returned unchanged."""
    clock = drive.scenario.clock
    decisions = int(seconds * clock.decision_rate)
    if decisions >= len(drive.actions):
        return drive
    each = {name: getattr(drive, name) for name in ("actions", "rewards", "terms", *BY_RULE, *OPTIONAL)}
    cut = {name: values[:decisions] for name, values in each.items() if values is not None}
    states = drive.states[: decisions * clock.steps + 1]
    return replace(drive, states=states, observations=drive.observations[: decisions + 1], accident=0, **cut)
