"""How long a study's jobs will take, by the seconds of those that ship or are done in the same folder."""

import os
from collections.abc import Sequence
from pathlib import Path

import numpy as np

from bootcourse.research.jobs import AnyJob, Job
from bootcourse.research.results import Results, load_job, load_results
from bootcourse.storage.assets import FOLDER


def time_needed(jobs: Sequence[AnyJob], root: Path, workers: int | None) -> str:
    """A sentence about jobs that wait. root: the study's folder, whose finished jobs count, too."""
    known = [each for each in (seconds_of(job, root) for job in jobs) if not np.isnan(each)]
    if not known:
        return "No such job has been timed: what is left is shown after the first."
    cores = min(workers or os.cpu_count() or 1, len(jobs))
    others = len(jobs) - len(known)
    also = f", and {others} that nobody has timed" * (others > 0)
    return f"About {in_words(sum(known) / cores)} on {cores} core{'s' * (cores > 1)} without other work{also}."


def in_words(seconds: float) -> str:
    """ "40 minutes", "3.5 hours"."""
    return f"{seconds / 3600:.1f} hours" if seconds >= 5400 else f"{max(1, round(seconds / 60))} minute(s)"


def seconds_of(job: AnyJob, root: Path) -> float:
    """Of one core; NaN where no such job has been timed."""
    part = job.name.partition("/")[0]
    shipped = [path for path in (FOLDER / f"{job.name}.npz", FOLDER / f"study-{part}.npz") if path.exists()]
    done = [path.parent for path in sorted((root / "jobs" / part).glob("*/results.npz"))] if type(job) is Job else []
    for load, paths in ((load_results, shipped), (load_job, done)):
        for path in paths:
            if not np.isnan(seconds := of_agents(job, load(path))):
                return seconds
    return np.nan


def of_agents(job: AnyJob, found: Results) -> float:
    """The seconds of a job, from those of agents that were trained alike."""
    if type(job) is not Job:  # what ships is the same job
        return float(found.seconds.sum())
    trained = found.sizes[1]
    times = [found.of(one.method).seconds.mean() if one.method in found.methods else np.nan for one in job.settings]
    return float(sum(times)) * job.episodes / trained if trained else np.nan
