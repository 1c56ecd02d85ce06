"""Cells and what computes them: never twice, never half, and never believed when damaged."""

import json
import multiprocessing
import os
import shutil
import signal
import subprocess
import sys
import time
from dataclasses import replace

import numpy as np
import pytest
import typer.testing

from bootcourse.cli import app
from bootcourse.episodes.evaluate import drive_episodes, held_out_seeds
from bootcourse.errors import BootcourseError
from bootcourse.learn.settings import settings_for, with_seeds
from bootcourse.research import jobs as jobs_module
from bootcourse.research.jobs import BoundJob, Job, asked, finished, read_job, run_job
from bootcourse.research.plan import EXPERIMENTS, methods_named, study_jobs, sweep_jobs
from bootcourse.research.planner import Search
from bootcourse.research.results import join, load_jobs, load_results, save_results
from bootcourse.research.runner import run_jobs
from bootcourse.research.teachers import TEACHERS
from bootcourse.scenario import DEFAULT
from bootcourse.storage.runs import load_run
from bootcourse.storage.work import locked

TINY = {"learning_starts": 16, "hidden": (8,), "buffer_size": 2000}


def job(name: str = "default/sac-0-1", method: str = "sac", episodes: int = 6, **changes) -> Job:
    return Job(name, tuple(with_seeds(settings_for(method, **TINY, **changes), 2)), DEFAULT, episodes, tests=5)


@pytest.fixture(scope="module")
def study(tmp_path_factory):
    """A finished study of two jobs."""
    root = tmp_path_factory.mktemp("study")
    assert run_jobs([job(), job("default/soft-0-1", "soft")], root, workers=1) == []
    return root


def copy(study, tmp_path):
    return shutil.copytree(study, tmp_path / "study")


def test_a_cell_holds_scores_and_curves_of_every_agent_and_their_runs(study):
    results = load_results(study / "jobs/default/sac-0-1/results.npz")
    assert [agent["seed"] for agent in results.agents] == [0, 1] and results.methods == ["sac"]
    assert results.tested["returns"].shape == (2, 5) and results.curves["return"].shape == (2, 6)
    run = load_run(study / "jobs/default/sac-0-1/runs/sac-1")
    again = drive_episodes(run.agent.as_policy(), held_out_seeds(1, 5))
    np.testing.assert_allclose(results.of("sac").episodes("returns")[1], again.returns, rtol=1e-6)
    np.testing.assert_array_equal(results.tested["accident"][1], again.accident)


def test_a_finished_cell_is_never_computed_again(study, monkeypatch):
    before = {path: path.stat().st_mtime_ns for path in study.rglob("jobs/**/*")}
    monkeypatch.setattr("bootcourse.research.runner._compute", lambda *args: pytest.fail("computed"))
    assert run_jobs([job(), job("default/soft-0-1", "soft")], study) == []
    assert before == {path: path.stat().st_mtime_ns for path in study.rglob("jobs/**/*")}


def test_a_study_of_other_settings_is_refused_in_the_same_folder(study):
    with pytest.raises(BootcourseError, match="computed with other episodes: choose another folder"):
        run_jobs([job(episodes=7)], study, recompute=True)
    with pytest.raises(BootcourseError, match="other settings"):
        run_jobs([job(gamma=0.9)], study)


@pytest.mark.parametrize("name", ["results.npz", "job.json", "runs/sac-0/weights.safetensors"])
def test_a_damaged_cell_is_named_and_computed_again_only_on_request(study, tmp_path, name):
    root = copy(study, tmp_path)
    path = root / "jobs/default/sac-0-1" / name
    path.write_bytes(path.read_bytes()[:-20])
    other = root / "jobs/default/soft-0-1/results.npz"
    before = other.stat().st_mtime_ns
    with pytest.raises(BootcourseError, match="sac-0-1.* is damaged.*--recompute"):
        run_jobs([job(), job("default/soft-0-1", "soft")], root, workers=1)
    assert path.exists()
    assert run_jobs([job(), job("default/soft-0-1", "soft")], root, workers=1, recompute=True) == []
    assert finished(job(), root) and len(list((root / "damaged").iterdir())) == 1
    assert other.stat().st_mtime_ns == before


def test_a_cell_that_was_interrupted_goes_on_as_if_it_never_was(study, tmp_path, monkeypatch):
    (tmp_path / "study.json").write_text("{}")
    calls = iter([False] * 3 + [True] * 10**6)
    monkeypatch.setattr(jobs_module, "_orphaned", lambda: next(calls))
    assert run_job(job(), tmp_path) == "default/sac-0-1: interrupted"
    assert (tmp_path / "unfinished/default/sac-0-1/checkpoint.npz").exists() and not finished(job(), tmp_path)
    monkeypatch.undo()
    assert run_job(job(), tmp_path) == ""
    whole, resumed = (load_results(root / "jobs/default/sac-0-1/results.npz") for root in (study, tmp_path))
    np.testing.assert_array_equal(whole.curves["return"], resumed.curves["return"])
    np.testing.assert_array_equal(whole.tested["returns"], resumed.tested["returns"])
    assert not (tmp_path / "jobs/default/sac-0-1/checkpoint.npz").exists()


def test_a_job_with_a_damaged_checkpoint_begins_again_on_request(tmp_path):
    (tmp_path / "study.json").write_text("{}")
    folder = tmp_path / "unfinished/default/sac-0-1"
    folder.mkdir(parents=True)
    (folder / "checkpoint.npz").write_bytes(b"half")
    assert "Add --recompute" in run_job(job(), tmp_path) and folder.exists()
    assert run_job(job(), tmp_path, recompute=True) == "" and finished(job(), tmp_path)
    assert len(list(tmp_path.glob("damaged/*/job/checkpoint.npz"))) == 1


def test_a_full_disk_is_a_sentence_and_the_cell_goes_on_afterwards(tmp_path, monkeypatch):
    (tmp_path / "study.json").write_text("{}")

    def full(*args):
        raise OSError(28, "No space left on device")

    with monkeypatch.context() as patch:
        patch.setattr("os.fsync", full)
        assert "No space left on device" in run_job(job(), tmp_path)
    assert not (tmp_path / "jobs").exists()
    assert run_job(job(), tmp_path) == "" and finished(job(), tmp_path)


def test_one_cell_that_fails_does_not_stop_the_others(tmp_path):
    broken = Job(
        "default/broken", tuple(with_seeds(settings_for("sac", **TINY), 1) * 2), DEFAULT, 1, 5
    )  # the same run twice
    problems = run_jobs([broken, job()], tmp_path, workers=1)
    assert len(problems) == 1 and "default/broken" in problems[0] and finished(job(), tmp_path)


def test_a_process_without_the_folder_says_so(tmp_path):
    assert "use a folder that all share" in run_job(job(), tmp_path / "elsewhere")


def hold(root, ready):
    with locked(root):
        ready.set()
        time.sleep(60)


def test_the_second_study_in_a_folder_is_refused_and_a_killed_one_leaves_no_lock(tmp_path):
    context = multiprocessing.get_context("spawn")
    ready = context.Event()
    first = context.Process(target=hold, args=(tmp_path, ready))
    first.start()
    assert ready.wait(60)
    with pytest.raises(BootcourseError, match=f"process {first.pid} on .* is at work in"):
        run_jobs([job()], tmp_path)
    first.kill()
    first.join()
    with locked(tmp_path):
        pass


@pytest.mark.skipif(os.name == "nt", reason="Windows has no SIGKILL to send")
def test_a_killed_study_goes_on_where_it_was(tmp_path):
    arguments = ["study", "--out", str(tmp_path / "study"), "--only", "sac,soft"]
    arguments += ["--seeds", "1", "--episodes", "4", "--tests", "5", "--workers", "1"]
    command = [sys.executable, "-m", "bootcourse", *arguments]
    process = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, start_new_session=True)
    end = time.monotonic() + 100
    while not (done := list(tmp_path.glob("study/jobs/default/*/job.json"))):
        assert time.monotonic() < end and process.poll() is None, "no job was finished"
        time.sleep(0.02)
    os.killpg(process.pid, signal.SIGKILL)
    process.wait()
    before = done[0].stat().st_mtime_ns
    again = typer.testing.CliRunner().invoke(app, arguments)
    assert again.exit_code == 0, again.output
    assert "2 of 2 jobs are done" in again.stdout and done[0].stat().st_mtime_ns == before
    assert (tmp_path / "study/report.md").exists()


def test_the_planner_s_bound_is_a_cell_too(tmp_path):
    (tmp_path / "study.json").write_text("{}")
    bound = BoundJob(
        "bound-default/0000", replace(DEFAULT, clock=replace(DEFAULT.clock, decisions=5)), 3, 2, Search(beam=5)
    )
    assert run_job(bound, tmp_path) == "" and finished(bound, tmp_path)
    with np.load(tmp_path / "jobs/bound-default/0000/results.npz") as arrays:
        assert arrays["first"] == 3 and arrays["returns"].shape == (2,)


def test_results_of_several_cells_join_and_read_back(study, tmp_path):
    results = load_jobs(study, "default")
    assert results.methods == ["sac", "soft"] and len(results) == 4 and len(results.of("soft")) == 2
    save_results(results, tmp_path / "all.npz", {"made": "here"})
    back = load_results(tmp_path / "all.npz")
    assert back.agents == results.agents
    took = [read_job(study / f"jobs/default/{name}-0-1")["provenance"]["seconds"] for name in ("sac", "soft")]
    np.testing.assert_allclose(back.seconds, np.repeat(took, 2) / 2)
    np.testing.assert_array_equal(back.scores("returns"), results.scores("returns"))
    kinds = [results.episodes(kind) for kind in ("collision", "road_departure", "stoppage")]
    np.testing.assert_array_equal(sum(kinds), results.tested["accident"] > 0)
    np.testing.assert_array_equal(results.episodes("accident"), sum(kinds))


def test_an_agent_that_two_cells_hold_counts_once(study, tmp_path):
    root = copy(study, tmp_path)
    assert run_job(replace(job("default/sac-0-0"), settings=job().settings[:1]), root) == ""
    assert len(load_jobs(root, "default")) == 4


def test_results_of_different_lengths_do_not_join(study, tmp_path):
    other = load_jobs(study, "default")
    longer = replace(other, curves={name: np.repeat(values, 2, axis=1) for name, values in other.curves.items()})
    with pytest.raises(BootcourseError, match="different numbers of episodes"):
        join([other, longer])
    with pytest.raises(BootcourseError, match="no results yet"):
        load_jobs(tmp_path, "default")


def test_a_study_s_plan_has_every_method_with_every_seed_once():
    jobs = study_jobs("default", methods_named(""), 10, 1000)
    agents = [(s.method, s.seed) for each in jobs if isinstance(each, Job) for s in each.settings]
    assert len(agents) == len(set(agents)) and {seed for _, seed in agents} == set(range(10))
    bounds = [each for each in jobs if isinstance(each, BoundJob)]
    assert sum(each.episodes for each in bounds) == 1000 and len({each.name for each in jobs}) == len(jobs)


@pytest.mark.parametrize("name", EXPERIMENTS)
def test_every_variation_of_an_experiment_differs_from_the_others_in_its_question(name):
    jobs = EXPERIMENTS[name].jobs(name, seeds=2, tests=5)
    questions = {json.dumps(asked(each), sort_keys=True) for each in jobs}
    assert len(questions) == len(EXPERIMENTS[name].variations) == len({each.name for each in jobs})


def test_the_sweep_runs_every_combination_once():
    settings = [s for each in sweep_jobs(4, 10, 5) for s in each.settings]
    places = {(s.rule_p if s.xi_multiplier else 0, s.xi_multiplier, s.bonus, s.seed) for s in settings}
    assert len(places) == len(settings) == 4 * (3 * 3 * 3 + 3)


def test_an_experiment_may_be_run_in_part_by_the_names_of_its_methods_teachers_and_cells():
    def chosen(name: str, only: str) -> set[str]:
        return set(EXPERIMENTS[name].only(only).variations)

    everyone = chosen("teachers", "")
    assert chosen("teachers", "planner") == {"planner, dagger", "planner, ppo_cloned", "planner, rlpd"}
    assert chosen("teachers", "dagger") == {f"{teacher}, dagger" for teacher in TEACHERS}
    assert chosen("teachers", "late-soft, planner-dagger") == {"late, soft", "planner, dagger"} < everyone
    assert chosen("sensitivity", "gamma-0.9") == {"γ = 0.9"}
    with pytest.raises(BootcourseError, match="Part 'planer' is unknown: did you mean 'planner'"):
        chosen("teachers", "planer")
