"""Compute jobs on this machine's cores, or on a dask cluster, through joblib."""

import os
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path

import joblib

from bootcourse.errors import BootcourseError, check_known
from bootcourse.files import write_json
from bootcourse.research.estimate import time_needed
from bootcourse.research.jobs import OtherQuestion, aside, finished, run_job
from bootcourse.storage.work import locked

BACKENDS = ("loky", "dask")
CONNECT = 10.0  # s until a scheduler must answer


def run_jobs(
    jobs: Sequence,
    root: Path,
    backend: str = "loky",
    scheduler: str | None = None,
    workers: int | None = None,
    recompute: bool = False,
    after: Callable[[list[str]], None] = lambda problems: None,
) -> list[str]:
    """Compute the jobs that are not done yet. Returns what went wrong, a sentence each.

    backend: one of `BACKENDS`; loky uses this machine's cores. scheduler: the address of a dask scheduler; without one,
    dask starts its own on this machine. workers: processes, by default one for each core. recompute: compute damaged
    jobs again. after: called with what went wrong, while the folder is still locked. Raises BootcourseError, before
    anything is computed, for a mistyped argument, a folder in use or with the runs of a training, and a damaged job
    without `recompute`.
    """
    check_known("Backend", backend, BACKENDS)
    if scheduler and backend == "loky":
        raise BootcourseError("--scheduler needs --backend dask: loky uses this machine's cores.")
    if any(root.glob("*/provenance.json")):
        raise BootcourseError(f"{root} holds runs of `bootcourse train`: choose another folder for a study.")
    with locked(root):
        waiting = to_do(jobs, root, recompute)
        done, listed = len(jobs) - len(waiting), f"{len(jobs)} job{'s' * (len(jobs) != 1)}"
        print(f"{listed} in {root}: {done} done already, {len(waiting)} to compute.")
        problems = []
        if waiting:
            print(time_needed(waiting, root, workers))
            write_json(root / "study.json", {"jobs": [job.name for job in jobs]})
            with connected(backend, scheduler, workers):
                problems = _compute(waiting, root.resolve(), recompute)
        after(problems)
        return problems


def _compute(waiting: list, root: Path, recompute: bool) -> list[str]:
    from bootcourse.progress import progress_bar

    calls = (joblib.delayed(run_job)(job, root, recompute) for job in waiting)
    try:
        answers = joblib.Parallel(batch_size=1, pre_dispatch="all", return_as="generator_unordered")(calls)
        bar = progress_bar(answers, total=len(waiting), unit="job", smoothing=0)
        return [answer for answer in bar if answer]
    except joblib.externals.loky.process_executor.TerminatedWorkerError:
        return ["A process was killed, perhaps for lack of memory: start the same command again, with fewer --workers."]


def to_do(jobs: Sequence, root: Path, recompute: bool) -> list:
    """The jobs that are not done. Damaged ones are moved to `damaged` if `recompute`, otherwise an error names them."""
    waiting, damaged = [], []
    for job in jobs:
        try:
            if not finished(job, root):
                waiting.append(job)
        except OtherQuestion:
            raise
        except BootcourseError as error:
            damaged.append(str(error))
            waiting.append(job)
            if recompute:
                os.rename(root / "jobs" / job.name, aside(root, job.name))
                print(f"{error} It is computed again; the old one is in {root / 'damaged'}.")
    if damaged and not recompute:
        raise BootcourseError(" ".join(damaged) + " Add --recompute to compute it again.")
    return waiting


@contextmanager
def connected(backend: str, scheduler: str | None, workers: int | None) -> Iterator[None]:
    """joblib's processes: loky's on this machine, or those of a dask cluster."""
    if backend == "loky":
        with joblib.parallel_config("loky", n_jobs=workers or -1, inner_max_num_threads=1):
            yield
    else:
        with _dask_client(scheduler, workers), joblib.parallel_config("dask", n_jobs=workers or -1):
            yield


def _dask_client(scheduler: str | None, workers: int | None):
    try:
        from distributed import Client
    except ModuleNotFoundError:
        raise BootcourseError("dask is not installed: pip install 'bootcourse[dask]'.") from None
    if not scheduler:
        return Client(n_workers=workers or None, threads_per_worker=1, dashboard_address=None)
    try:
        return Client(scheduler, timeout=CONNECT)
    except (OSError, ValueError):
        raise BootcourseError(f"No dask scheduler answers at {scheduler}: start one, or check the address.") from None
