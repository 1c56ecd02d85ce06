"""The same study on a cluster: real processes of dask, one of which is killed half-way."""

import os
import signal
import threading
import time
from pathlib import Path

import numpy as np
import pytest

from bootcourse.errors import BootcourseError
from bootcourse.learn.settings import settings_for, with_seeds
from bootcourse.research.jobs import Job, finished, run_job
from bootcourse.research.results import load_jobs
from bootcourse.research.runner import run_jobs
from bootcourse.scenario import DEFAULT

distributed = pytest.importorskip("distributed", reason="dask is an extra: pip install 'bootcourse[dask]'")


def jobs(count: int) -> list[Job]:
    settings = settings_for("sac", learning_starts=16, hidden=(8,), buffer_size=2000)
    return [Job(f"default/sac-{seed}", tuple(with_seeds(settings, 1, seed)), DEFAULT, 60, 5) for seed in range(count)]


def kill_a_busy_worker(root: Path, cluster, killed: list) -> None:
    """As soon as one job is done and others are under way."""
    while not list(root.glob("jobs/default/*/job.json")):
        time.sleep(0.01)
    worker = next(iter(cluster.workers.values()))
    killed.append(worker.pid)
    os.kill(worker.pid, signal.SIGKILL)


@pytest.mark.skipif(os.name == "nt", reason="Windows has no SIGKILL to send")
def test_a_study_on_a_dask_cluster_survives_the_death_of_a_worker(tmp_path):
    killed = []
    with distributed.LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=None) as cluster:
        killer = threading.Thread(target=kill_a_busy_worker, args=(tmp_path, cluster, killed), daemon=True)
        killer.start()
        assert run_jobs(jobs(4), tmp_path, "dask", cluster.scheduler_address) == []
    killer.join(5)
    assert killed and all(finished(each, tmp_path) for each in jobs(4))
    (tmp_path / "here").mkdir()
    (tmp_path / "here" / "study.json").write_text("{}")
    assert run_job(jobs(1)[0], tmp_path / "here") == ""
    there, here = load_jobs(tmp_path, "default").pick([0]), load_jobs(tmp_path / "here", "default")
    np.testing.assert_array_equal(there.curves["return"], here.curves["return"])


@pytest.mark.parametrize("backend", ["dask", "ray"])
def test_a_scheduler_that_does_not_answer_is_a_sentence(backend, tmp_path, monkeypatch):
    monkeypatch.setattr("bootcourse.research.runner.CONNECT", 0.5)
    with pytest.raises(BootcourseError, match=f"No {backend} .* answers at tcp://127.0.0.1:9"):
        pytest.importorskip("ray") if backend == "ray" else None
        run_jobs(jobs(1), tmp_path, backend, "tcp://127.0.0.1:9")
