"""A job is a piece of a study that is computed in one go. A finished job is not computed again.

    DIR/unfinished/NAME   while it is computed: `checkpoint.npz`, from which a killed job continues
    DIR/jobs/NAME         when it is done: `results.npz`, `runs/`, and `job.json` with what was asked for, the versions
                          that computed it, and the hash of every file

The folder is moved in one step, so every folder in `jobs` is complete.
"""

import json
import os
import shutil
import time
from collections.abc import Callable, Sequence
from dataclasses import asdict, dataclass, field
from pathlib import Path
from pkgutil import resolve_name
from typing import Annotated, Any

import numpy as np
from gymnasium.vector import VectorEnv
from msgspec import Meta, Struct, convert

from bootcourse.episodes.evaluate import drive_episodes, held_out_seeds
from bootcourse.errors import BootcourseError
from bootcourse.files import decoding, provenance, sha256, write_arrays, write_json
from bootcourse.learn.agent import Agent
from bootcourse.learn.settings import Settings
from bootcourse.learn.training import Result, Training
from bootcourse.research.planner import Search, is_staying_optimal, plan_episodes
from bootcourse.research.teachers import RULE, teacher_named
from bootcourse.scenario import DEFAULT, Scenario
from bootcourse.storage.checkpoint import DamagedCheckpoint, load_checkpoint, save_checkpoint
from bootcourse.storage.runs import save_runs
from bootcourse.storage.sealed import amiss, read_sealed, write_sealed
from bootcourse.storage.work import Checkpoints

FORMAT = "bootcourse job 3"
CHECKPOINT = "checkpoint.npz"
HELD_OUT = 1  # the block of held-out roads that every method of every study is tested on
SECONDS_BETWEEN = 60.0  # of checkpoints
PARENT = os.getppid()  # read at import: a worker may be busy compiling when the process that started it dies


class Provenance(Struct):
    """The entry of a job's provenance that is a number; the others, the packages' versions, are for people."""

    seconds: Annotated[float, Meta(ge=0)]


class Description(Struct):
    """The entries of job.json that are read."""

    asked: dict[str, Any]  # compared with what is asked for, see `finished`
    sha256: dict[str, str]  # {file: its hash}
    provenance: Provenance


class Interrupted(Exception):
    """The study was stopped. A `Job` has written a checkpoint; a `LessonJob` begins again."""


@dataclass(frozen=True)
class Job:
    """Train some agents side by side and test them on the same held-out episodes."""

    name: str  # its folder, such as "default/bootstrapped-0-4"
    settings: tuple[Settings, ...]
    scenario: Scenario
    episodes: int  # of training
    tests: int = 1000  # held-out episodes
    runs: bool = True  # keep each agent's weights too; needs agents that differ in method or seed
    teacher: str = RULE  # a name of `teachers.TEACHERS`

    def __post_init__(self):
        teacher_named(self.teacher)

    def compute(self, folder: Path) -> float:
        """Train, or continue a training, and test. Returns the seconds of earlier attempts. Raises Interrupted."""
        training, checkpoint = self._training(folder), folder / CHECKPOINT
        earlier = training.seconds
        result = training.run(progress=False, callback=Checkpoints(checkpoint, SECONDS_BETWEEN), stop=orphaned)
        if result.interrupted:
            save_checkpoint(training, checkpoint)
            raise Interrupted(self.name)
        write_arrays(folder / "results.npz", tested_arrays(result, self.tests, self.teacher))
        if self.runs:
            shutil.rmtree(folder / "runs", ignore_errors=True)  # left by an attempt that was killed while it wrote
            save_runs(result, folder / "runs")
        return earlier

    def _training(self, folder: Path) -> Training:
        teacher = teacher_named(self.teacher)
        if not (folder / CHECKPOINT).exists():
            return Training(self.settings, self.episodes, self.scenario, teacher)
        training = load_checkpoint(folder / CHECKPOINT, teacher)
        wanted = ([*self.settings], self.episodes, self.scenario)
        if (training.settings, training.episodes, training.scenario) != wanted:
            raise BootcourseError(f"{folder} was begun with other settings: choose another folder, or delete this one.")
        return training


@dataclass(frozen=True)
class LessonJob:
    """Let a function train and test its agents, mostly for a lesson, in a few minutes and without checkpoints."""

    name: str
    function: str  # "module:function", which returns the arrays of `results.npz` (see `results.as_arrays`)
    arguments: dict = field(default_factory=dict)

    def compute(self, folder: Path) -> None:
        write_arrays(folder / "results.npz", resolve_name(self.function)(**self.arguments))


@dataclass(frozen=True)
class BoundJob:
    """Search for the best return on some of the held-out roads."""

    name: str
    scenario: Scenario
    first: int  # held-out episode
    episodes: int
    search: Search = Search()

    def compute(self, folder: Path) -> None:
        seeds = held_out_seeds(HELD_OUT, self.first + self.episodes)[self.first :]
        plans = plan_episodes(seeds, self.scenario, self.search)
        returns, success = np.array([plan.value for plan in plans]), np.array([plan.success for plan in plans])
        write_arrays(folder / "results.npz", {"first": np.array(self.first), "returns": returns, "success": success})


@dataclass(frozen=True)
class StayingJob:
    """Ask the planner: at this γ, is staying behind the trap the best that a driver can do?"""

    name: str
    scenario: Scenario
    gamma: float = 0.8  # the paper's
    roads: int = 50  # of the held-out ones
    beam: int = 200

    def compute(self, folder: Path) -> None:
        staying = is_staying_optimal(held_out_seeds(HELD_OUT, self.roads), self.scenario, self.gamma, self.beam)
        write_json(folder / "staying.json", vars(staying))


AnyJob = Job | LessonJob | BoundJob | StayingJob


def asked(job: AnyJob) -> dict:
    """All fields that determine the job's result, as JSON reads them back."""
    fields = {name: value for name, value in asdict(job).items() if name not in ("name", "runs")}
    return json.loads(json.dumps(fields))


def tested_arrays(
    result: Result, tests: int, teacher: str, make_env: Callable[[int], VectorEnv] | None = None
) -> dict[str, np.ndarray]:
    """The arrays of a file of results (see `results.Results`): agents, curves, and their drives in held-out episodes.

    tests: of each agent, by its most probable actions. teacher: its name. make_env: see `Training`.
    """
    tested = drives(result.agents, held_out_seeds(HELD_OUT, tests), result.scenario, make_env)
    return {
        "agents": np.array(json.dumps([asdict(a.settings) | {"teacher": teacher} for a in result.agents])),
        "stopped": np.array([result.stopped.get(i, -1) for i in range(len(result.agents))]),
        **{f"tested.{name}": smaller(values) for name, values in tested.items()},
        **{f"curves.{name}": values.astype(np.float32) for name, values in result.curves.items()},
    }


def drives(
    agents: Sequence[Agent], seeds: Sequence[int], scenario: Scenario | None = DEFAULT, make_env=None
) -> dict[str, np.ndarray]:
    """The fields of `Episodes` of every agent in the episodes of these seeds, each (agents, episodes)."""
    each = [drive_episodes(agent.as_policy(), seeds, scenario, make_env=make_env) for agent in agents]
    return {name: np.stack([getattr(one, name) for one in each]) for name in vars(each[0])}


def smaller(values: np.ndarray) -> np.ndarray:
    """The results of tests as they are stored: float32, and int8 for what is counted."""
    return values.astype(np.float32) if values.dtype == np.float64 else values.astype(np.int8)


def orphaned() -> bool:
    """Has the process that started this one ended?"""
    return os.getppid() != PARENT


def finished(job: AnyJob, root: Path) -> bool:
    """Is it done? Raises BootcourseError if its folder is damaged, or holds another job."""
    folder = root / "jobs" / job.name
    if not folder.exists():
        return False
    before = read_job(folder)["asked"]
    different = [name for name, value in asked(job).items() if before.get(name) != value]
    if different:
        raise BootcourseError(
            f"{folder} was computed with other {', '.join(different)}: choose another folder for this study."
        )
    return True


def read_job(folder: Path) -> dict:
    """The `job.json` of a finished job, after a check of all its files. Raises BootcourseError if one is damaged."""
    remedy = f"delete {folder}, and start the same command again"
    description = read_sealed(folder / "job.json", FORMAT, remedy)
    with decoding(folder / "job.json", remedy):
        convert(description, Description)
    for name, digest in description["sha256"].items():
        if sentence := amiss(folder / name, digest, remedy):
            raise BootcourseError(sentence)
    return description


def run_job(job: AnyJob, root: Path) -> str:
    """Compute a job and move it to `jobs`. Returns "", or a sentence that says what went wrong."""
    try:
        if not (root / "study.json").exists():  # on a machine of a cluster that has another disk
            return f"{root} is not there for the process that should compute {job.name}: use a folder that all share."
        _run(job, root)
    except (BootcourseError, OSError) as error:
        return f"{job.name}: {error}"
    except (Interrupted, KeyboardInterrupt):
        return f"{job.name}: interrupted"
    return ""


def _run(job: AnyJob, root: Path) -> None:
    final, folder = root / "jobs" / job.name, root / "unfinished" / job.name
    if final.exists():  # another process was faster: a cluster may start a job twice
        return
    folder.mkdir(parents=True, exist_ok=True)
    started = time.perf_counter()
    try:
        earlier = job.compute(folder)
    except DamagedCheckpoint as error:
        raise BootcourseError(f"{error} To begin this job again, delete {folder}.") from None
    seconds = (earlier or 0.0) + time.perf_counter() - started
    (folder / CHECKPOINT).unlink(missing_ok=True)
    files = [path for path in sorted(folder.rglob("*")) if path.is_file() and path.name != "job.json"]
    description = {
        "format": FORMAT,
        "asked": asked(job),
        "sha256": {path.relative_to(folder).as_posix(): sha256(path) for path in files},
        "provenance": provenance(seconds=round(seconds, 1)),
    }
    write_sealed(folder / "job.json", description)
    final.parent.mkdir(parents=True, exist_ok=True)
    os.rename(folder, final)
