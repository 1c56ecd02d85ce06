"""The same study on a cluster: real processes of dask, one of which is killed half-way."""

import os
import signal
import threading
import time

import pytest

from bootcourse.learn.settings import settings_for, with_seeds
from bootcourse.research.jobs import Job, finished
from bootcourse.research.runner import run_jobs
from bootcourse.scenario import DEFAULT

distributed = pytest.importorskip("distributed", reason="dask is an extra: pip install 'bootcourse[dask]'")
SETTINGS = settings_for("sac", learning_starts=16, hidden=(8,), buffer_size=2000)
JOBS = [Job(f"default/sac-{seed}", tuple(with_seeds(SETTINGS, 1, seed)), DEFAULT, 60, 5) for seed in range(4)]


@pytest.mark.skipif(os.name == "nt", reason="Windows has no SIGKILL to send")
def test_a_study_on_a_dask_cluster_survives_the_death_of_a_worker(tmp_path):
    with distributed.LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=None) as cluster:

        def kill_a_busy_worker():
            while not list(tmp_path.glob("jobs/default/*/job.json")):
                time.sleep(0.01)
            os.kill(next(iter(cluster.workers.values())).pid, signal.SIGKILL)

        killer = threading.Thread(target=kill_a_busy_worker, daemon=True)
        killer.start()
        assert run_jobs(JOBS, tmp_path, "dask", cluster.scheduler_address) == []
    killer.join(5)
    assert not killer.is_alive() and all(finished(each, tmp_path) for each in JOBS)
