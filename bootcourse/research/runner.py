"""Compute jobs on this machine's cores, through joblib, or on a dask cluster."""

from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from functools import partial
from pathlib import Path

import joblib
import numpy as np

from bootcourse.errors import BootcourseError, check_known
from bootcourse.files import write_json
from bootcourse.processes import check_semaphores, usable_processors
from bootcourse.research.jobs import Job, finished, run_job
from bootcourse.research.results import Results, load_job, load_results
from bootcourse.storage.assets import FOLDER
from bootcourse.storage.work import locked, remove_empty

BACKENDS = ("loky", "dask")
CONNECT = 10.0  # s until a scheduler must answer
Answers = Callable[[list, Path], Iterator[str]]  # runs jobs in a folder: what went wrong with each that ends, or ""


def run_jobs(
    jobs: Sequence,
    root: Path,
    backend: str = "loky",
    scheduler: str | None = None,
    workers: int | None = None,
    after: Callable[[list[str]], None] = lambda problems: None,
) -> list[str]:
    """Compute the jobs that are not done yet. Returns what went wrong, a sentence each.

    backend: one of `BACKENDS`; loky uses this machine's cores. scheduler: the address of a dask scheduler; without one,
    dask starts its own on this machine. workers: processes, by default one for each core that may be used. after:
    called with what went wrong, while the folder is still locked. Raises BootcourseError, before anything is computed,
    for a mistyped argument, where processes cannot work together, for a folder in use or with the runs of a training,
    and for a damaged job.
    """
    check_known("Backend", backend, BACKENDS)
    if scheduler and backend == "loky":
        raise BootcourseError("--scheduler needs --backend dask: loky uses this machine's cores.")
    if backend == "loky":
        check_semaphores()
    if any(root.glob("*/provenance.json")):
        raise BootcourseError(f"{root} holds runs of `bootcourse train`: choose another folder for a study.")
    with locked(root):
        waiting = [job for job in jobs if not finished(job, root)]
        done, listed = len(jobs) - len(waiting), f"{len(jobs)} job{'s' * (len(jobs) != 1)}"
        print(f"{listed} in {root}: {done} done already, {len(waiting)} to compute.")
        problems = []
        if waiting:
            print(time_needed(waiting, root, workers))
            write_json(root / "study.json", {"jobs": [job.name for job in jobs]})
            with connected(backend, scheduler, workers) as answers:
                problems = _compute(waiting, root.resolve(), answers)
            remove_empty(root / "unfinished")
        after(problems)
        return problems


def _compute(waiting: list, root: Path, answers: Answers) -> list[str]:
    from bootcourse.progress import progress_bar

    try:
        bar = progress_bar(answers(waiting, root), total=len(waiting), unit="job", smoothing=0)
        return [answer for answer in bar if answer]
    except joblib.externals.loky.process_executor.TerminatedWorkerError:
        return ["A process was killed, perhaps for lack of memory: start the same command again, with fewer --workers."]


@contextmanager
def connected(backend: str, scheduler: str | None, workers: int | None) -> Iterator[Answers]:
    """What runs jobs: loky's processes on this machine, or those of a dask cluster."""
    if backend == "loky":
        with joblib.parallel_config("loky", n_jobs=workers or usable_processors(), inner_max_num_threads=1):
            yield _by_loky
    else:
        with _dask_client(scheduler, workers) as client:
            yield partial(_by_dask, client)


def _by_loky(waiting: list, root: Path) -> Iterator[str]:
    calls = (joblib.delayed(run_job)(job, root) for job in waiting)
    return joblib.Parallel(batch_size=1, pre_dispatch="all", return_as="generator_unordered")(calls)


def _by_dask(client, waiting: list, root: Path) -> Iterator[str]:
    """Tasks that hold their jobs: after a worker's death another one runs them, whatever else the dead one kept."""
    from distributed import as_completed

    for future in as_completed([client.submit(run_job, job, root, pure=False) for job in waiting]):
        yield future.result()


def _dask_client(scheduler: str | None, workers: int | None):
    try:
        from distributed import Client
    except ModuleNotFoundError:
        raise BootcourseError("dask is not installed: pip install 'bootcourse[dask]'.") from None
    if not scheduler:
        return Client(n_workers=workers or usable_processors(), threads_per_worker=1, dashboard_address=None)
    try:
        return Client(scheduler, timeout=CONNECT)
    except (OSError, ValueError):
        raise BootcourseError(f"No dask scheduler answers at {scheduler}: start one, or check the address.") from None


def time_needed(jobs: Sequence[Job], root: Path, workers: int | None) -> str:
    """A sentence about jobs that wait. root: the study's folder, whose finished jobs count, too."""
    known = [each for each in (seconds_of(job, root) for job in jobs) if not np.isnan(each)]
    if not known:
        return "No such job has been timed: what is left is shown after the first."
    cores = min(workers or usable_processors(), len(jobs))
    others = len(jobs) - len(known)
    also = f", and {others} that nobody has timed" * (others > 0)
    return f"About {duration(sum(known) / cores)} on {cores} core{'s' * (cores > 1)} without other work{also}."


def duration(seconds: float) -> str:
    """ "40 minutes", "3.5 hours"."""
    return f"{seconds / 3600:.1f} hours" if seconds >= 5400 else f"{max(1, round(seconds / 60))} minute(s)"


def seconds_of(job: Job, root: Path) -> float:
    """The seconds that a job will take on one core; NaN where no such job has been timed."""
    part = job.name.partition("/")[0]
    shipped = [path for path in (FOLDER / f"{job.name}.npz", FOLDER / f"study-{part}.npz") if path.exists()]
    trains = "settings" in job.arguments  # and jobs that trained others of these methods tell how long it takes
    done = [path.parent for path in sorted((root / "jobs" / part).glob("*/results.npz"))] if trains else []
    for load, paths in ((load_results, shipped), (load_job, done)):
        for path in paths:
            if not np.isnan(seconds := of_agents(job, load(path))):
                return seconds
    return np.nan


def of_agents(job: Job, alike: Results) -> float:
    """The seconds of a job, from those of agents that were trained alike."""
    if "settings" not in job.arguments:  # what ships is the same job
        return float(alike.seconds.sum())
    trained, methods = alike.sizes[1], [settings.method for settings in job.arguments["settings"]]
    times = [alike.of(method).seconds.mean() if method in alike.methods else np.nan for method in methods]
    return float(sum(times)) * job.arguments["episodes"] / trained if trained else np.nan
