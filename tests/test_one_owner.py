"""A piece of a study has one owner at a time, also when the process that started the study was killed."""

import os
import signal
import subprocess
import sys
import threading
import time

import pytest

from bootcourse.storage import work
from bootcourse.storage.work import owned, remove_empty

OWNER = """
import sys, time
from pathlib import Path
from bootcourse.storage.work import owned
with owned(Path(sys.argv[1])):
    print("mine", flush=True)
    time.sleep(float(sys.argv[2]))
"""


def other_owner(folder, seconds: float) -> subprocess.Popen:
    """Another process, which has the folder for so long."""
    process = subprocess.Popen([sys.executable, "-c", OWNER, folder, str(seconds)], stdout=subprocess.PIPE, text=True)
    assert process.stdout.readline() == "mine\n"
    return process


def test_the_second_waits_until_the_first_has_finished_and_nothing_is_left(tmp_path):
    folder = tmp_path / "unfinished/default/sac-0"
    with other_owner(folder, 3) as first, owned(folder) as is_lost:
        assert first.poll() is not None or first.wait(10) == 0, "the first had ended"
        assert not is_lost()
    remove_empty(tmp_path / "unfinished")
    assert list(tmp_path.iterdir()) == []


def test_the_second_takes_over_from_a_killed_one_at_once(tmp_path):
    folder = tmp_path / "unfinished/sac-0"
    first = other_owner(folder, 600)
    first.kill()
    first.wait()
    began = time.monotonic()
    with owned(folder):
        assert time.monotonic() - began < work.LEASE / 2


def test_a_process_that_was_killed_before_it_wrote_its_name_does_not_keep_the_folder(tmp_path):
    (tmp_path / ".job.owner").touch()
    began = time.monotonic()
    with owned(tmp_path / "job") as is_lost:
        assert time.monotonic() - began < work.LEASE / 2 and not is_lost()
    assert list(tmp_path.iterdir()) == []


def test_a_name_that_is_written_late_is_not_taken_away(tmp_path):
    owner = tmp_path / ".job.owner"
    owner.write_text("somebody")
    work._take_away(owner)
    assert owner.read_text() == "somebody" and list(tmp_path.iterdir()) == [owner]


def test_who_waits_can_be_stopped(tmp_path):
    with other_owner(tmp_path / "job", 600) as first:
        with pytest.raises(InterruptedError), owned(tmp_path / "job", stop=lambda: True):
            pass
        first.kill()


def test_an_owner_that_showed_no_sign_of_life_is_told_that_it_lost_the_folder(tmp_path, monkeypatch):
    monkeypatch.setattr(work, "LEASE", 0.5)
    with owned(tmp_path / "job") as is_lost:
        (marker,) = tmp_path.glob(".job.owner")
        marker.unlink()  # as another machine does with a marker that is too old
        end = time.monotonic() + 20
        while not is_lost():
            assert time.monotonic() < end
            time.sleep(0.05)


def test_two_threads_of_a_worker_do_not_share_a_folder(tmp_path):
    inside = []

    def work_on_it():
        with owned(tmp_path / "job"):
            inside.append(1)
            assert sum(inside) == 1
            time.sleep(0.2)
            inside.append(-1)

    threads = [threading.Thread(target=work_on_it) for _ in range(2)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join(20)
    assert inside == [1, -1, 1, -1]


@pytest.mark.skipif(os.name == "nt", reason="Windows has no SIGKILL to send")
@pytest.mark.parametrize("backend", ["loky", "dask"])
def test_a_study_whose_client_is_killed_alone_is_finished_by_the_same_command(tmp_path, backend):
    if backend == "dask":
        pytest.importorskip("distributed", reason="dask is an extra: pip install 'bootcourse[dask]'")
    command = [sys.executable, "-m", "bootcourse", "study", "--out", str(tmp_path / "study"), "--only", "sac"]
    command += ["--seeds", "1", "--episodes", "60", "--tests", "5", "--workers", "1", "--backend", backend]
    first = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    end = time.monotonic() + 100
    while not list(tmp_path.glob("study/unfinished/default/sac-0-0")):
        assert time.monotonic() < end and first.poll() is None, "the job did not begin"
        time.sleep(0.02)
    os.kill(first.pid, signal.SIGKILL)  # its workers live on for a while
    first.wait()
    again = subprocess.run(command, capture_output=True, text=True, timeout=200)
    assert again.returncode == 0 and "1 of 1 jobs are done" in again.stdout, again.stdout + again.stderr
    assert not (tmp_path / "study/unfinished").exists()
