"""Jobs of a study: never computed twice, never half done, and never believed when damaged."""

import json
import os
import shutil
import signal
import subprocess
import sys
import threading
import time
from dataclasses import replace
from functools import partial

import numpy as np
import pytest
import typer.testing

import bootcourse as bc
from bootcourse.cli import app
from bootcourse.episodes.evaluate import drive_episodes, held_out_seeds
from bootcourse.errors import BootcourseError
from bootcourse.files import read_json
from bootcourse.learn.settings import settings_for, with_seeds
from bootcourse.research import cells as cells_module
from bootcourse.research.cells import results_of, train_and_test
from bootcourse.research.experiment import EXPERIMENTS, chosen, experiment_named, folder
from bootcourse.research.jobs import Job, asked, finished, read_job, run_job
from bootcourse.research.planner import Search
from bootcourse.research.results import Results, agent_entries, load_jobs, load_results, save_results, weights_of
from bootcourse.research.runner import run_jobs, seconds_of, time_needed
from bootcourse.research.studies import STUDIES, search_bound
from bootcourse.research.teachers import TEACHERS
from bootcourse.scenario import DEFAULT
from bootcourse.storage.assets import FOLDER
from bootcourse.storage.runs import load_run
from bootcourse.storage.sealed import write_sealed

TINY = {"learning_starts": 16, "hidden": (8,), "buffer_size": 2000}


def job(name: str = "default/sac-0-1", method: str = "sac", episodes: int = 6, seeds: int = 2, **changes) -> Job:
    settings = tuple(with_seeds(settings_for(method, **TINY, **changes), seeds))
    arguments = {"settings": settings, "scenario": DEFAULT, "episodes": episodes, "tests": 5, "teacher": "rule"}
    return Job(name, partial(train_and_test, keep_runs=True), arguments)


BOTH = [job(), job("default/soft-0-1", "soft")]


@pytest.fixture(scope="module")
def study(tmp_path_factory):
    """A finished study of two jobs."""
    root = tmp_path_factory.mktemp("study")
    assert run_jobs(BOTH, root, workers=1) == []
    return root


@pytest.fixture
def root(tmp_path):
    """The folder of a study that was begun."""
    (tmp_path / "study.json").write_text("{}")
    return tmp_path


def test_a_job_holds_scores_and_curves_of_every_agent_and_their_runs(study):
    results = load_results(study / "jobs/default/sac-0-1/results.npz")
    assert [agent["seed"] for agent in results.agents] == [0, 1] and results.sizes == (5, 6)
    run = load_run(study / "jobs/default/sac-0-1/runs/sac-1")
    again = drive_episodes(run.agent.as_policy(), held_out_seeds(1, 5))
    np.testing.assert_allclose(results.of("sac").episodes("returns")[1], again.returns, rtol=1e-6)
    np.testing.assert_array_equal(results.tested["accident"][1], again.accident)


def test_a_finished_job_is_not_computed_again_and_another_question_is_refused(study, monkeypatch):
    monkeypatch.setattr("bootcourse.research.runner._compute", lambda *args: pytest.fail("computed"))
    assert run_jobs(BOTH, study) == []
    for other, name in ((job(episodes=7), "episodes"), (job(gamma=0.9), "settings")):
        with pytest.raises(BootcourseError, match=f"computed with other {name}: choose another folder"):
            run_jobs([other], study)


@pytest.mark.parametrize("name", ["results.npz", "job.json", "runs/sac-0/weights.safetensors"])
def test_a_damaged_job_is_named_and_computed_again_when_it_is_deleted(study, tmp_path, name):
    root = shutil.copytree(study, tmp_path / "study")
    path, other = root / "jobs/default/sac-0-1" / name, root / "jobs/default/soft-0-1/results.npz"
    path.write_bytes(path.read_bytes()[:-20])
    before = other.stat().st_mtime_ns
    with pytest.raises(BootcourseError, match="sac-0-1.* is damaged.*delete .*sac-0-1, and start"):
        run_jobs(BOTH, root, workers=1)
    shutil.rmtree(root / "jobs/default/sac-0-1")
    assert run_jobs(BOTH, root, workers=1) == []
    assert finished(job(), root) and path.exists()
    assert other.stat().st_mtime_ns == before


def test_a_job_that_was_interrupted_goes_on_as_if_it_never_was(study, root, monkeypatch):
    calls = iter([False] * 3 + [True] * 10**6)
    with monkeypatch.context() as patch:
        patch.setattr(cells_module, "orphaned", lambda: next(calls))
        assert run_job(job(), root) == "default/sac-0-1: interrupted" and not finished(job(), root)
    checkpoint = root / "unfinished/default/sac-0-1/checkpoint.npz"
    whole = checkpoint.read_bytes()
    checkpoint.write_bytes(b"half")
    assert "To begin this job again, delete" in run_job(job(), root)
    checkpoint.write_bytes(whole)
    assert run_job(job(), root) == ""
    straight, resumed = (load_results(each / "jobs/default/sac-0-1/results.npz") for each in (study, root))
    np.testing.assert_array_equal(straight.curves["return"], resumed.curves["return"])
    np.testing.assert_array_equal(straight.tested["returns"], resumed.tested["returns"])


def noted(seeds: int) -> Results:
    """What a function of a lesson returns."""
    agents = agent_entries(with_seeds(settings_for("sac"), seeds))
    notes, weights = {"escapes": np.zeros((seeds, 3))}, {"actor.0": np.ones((1, 2, 4))}
    return Results(agents, np.full(seeds, -1), notes=notes, measured={"xi": np.arange(seeds)}, weights=weights)


def test_the_planner_s_bound_and_a_lesson_s_function_are_jobs_too_and_a_job_that_fails_stops_no_other(root):
    short = replace(DEFAULT, clock=replace(DEFAULT.clock, decisions=5))
    bound, lesson = (
        Job("bound-default/0000", search_bound, {"scenario": short, "first": 3, "episodes": 2, "search": Search(5)}),
        Job("mine/two", results_of(noted), {"seeds": 2}),
    )
    broken = job("default/broken", episodes=1, seeds=1)
    broken.arguments["settings"] *= 2  # two runs of one name
    (problem,) = run_jobs([broken, bound, lesson], root, workers=1)
    assert "default/broken" in problem and finished(bound, root) and finished(lesson, root)
    with np.load(root / "jobs/bound-default/0000/results.npz") as arrays:
        assert arrays["first"] == 3 and arrays["returns"].shape == (2,)
    results = load_results(root / "jobs/mine/two/results.npz").pick([1])
    assert results.measured["xi"].tolist() == [1] and results.notes["escapes"].shape == (1, 3)
    with pytest.raises(BootcourseError, match="other seeds"):
        finished(replace(lesson, arguments={"seeds": 3}), root)


@pytest.mark.parametrize("stored", [{"function": "module:function", "arguments": {"seeds": 2}}, {"cell": {"seeds": 2}}])
def test_a_finished_job_of_an_earlier_version_counts(root, stored):
    lesson = Job("mine/two", results_of(noted), {"seeds": 2})
    assert run_job(lesson, root) == ""
    description = read_job(root / "jobs/mine/two") | {"asked": stored}
    write_sealed(root / "jobs/mine/two/job.json", description)
    assert finished(lesson, root)
    with pytest.raises(BootcourseError, match="other seeds"):
        finished(replace(lesson, arguments={"seeds": 3}), root)


def test_a_study_says_how_long_it_takes_if_such_jobs_were_timed(study, tmp_path):
    ours = tmp_path / "jobs/mine"
    shutil.copytree(study / "jobs/default/sac-0-1", ours / "sac-0-1")
    known, unknown = job("mine/sac-2-3"), Job("none/alone", results_of(noted), {})
    seconds = read_json(ours / "sac-0-1/job.json")["provenance"]["seconds"]
    assert seconds_of(job("mine/sac-2-3", episodes=12), tmp_path) == pytest.approx(2 * seconds)
    assert "About 1 minute(s) on 1 core" in time_needed([known], tmp_path, 2)
    assert "and 1 that nobody has timed" in time_needed([known, unknown], tmp_path, 2)
    assert time_needed([unknown], tmp_path, 2).startswith("No such job has been timed")


def test_an_experiment_in_a_new_folder_ends_with_its_table(bootcourse, tmp_path):
    arguments = ("study", "longer-view", "--seeds", 2, "--episodes", 2, "--tests", 3, "--out", tmp_path, "--workers", 1)
    answer = bootcourse(*arguments)
    assert answer.status == 0, answer.err
    assert "1 job in" in answer.out and "About" in answer.out
    table = (tmp_path / "longer-view.md").read_text(encoding="utf-8").partition("\n\n")[2]
    assert table.count("γ = 0.95") == 1 and "returns" in table and table in answer.out


@pytest.mark.skipif(os.name == "nt", reason="Windows has no SIGKILL to send")
def test_a_killed_study_goes_on_where_it_was(tmp_path, unrendered):
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


@pytest.mark.skipif(os.name == "nt", reason="Windows has no SIGKILL to send")
def test_a_study_on_a_dask_cluster_survives_the_death_of_a_worker(root):
    distributed = pytest.importorskip("distributed", reason="dask is an extra: pip install 'bootcourse[dask]'")
    jobs = [job(f"default/sac-{gamma}", episodes=60, gamma=gamma) for gamma in (0.6, 0.7, 0.8, 0.9)]
    with distributed.LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=None) as cluster:

        def kill_a_busy_worker():
            while not list(root.glob("jobs/default/*/job.json")):
                time.sleep(0.01)
            os.kill(next(iter(cluster.workers.values())).pid, signal.SIGKILL)

        killer = threading.Thread(target=kill_a_busy_worker, daemon=True)
        killer.start()
        assert run_jobs(jobs, root, "dask", cluster.scheduler_address) == []
    killer.join(5)
    assert not killer.is_alive() and all(finished(each, root) for each in jobs)


def test_results_of_several_jobs_join_and_read_back_and_each_agent_counts_once(study, tmp_path):
    root = shutil.copytree(study, tmp_path / "study")
    assert run_job(job("default/sac-0-0", seeds=1), root) == ""
    results = load_jobs(root, "default")
    assert results.methods == ["sac", "soft"] and len(results) == 4 and len(results.of("soft")) == 2
    save_results(results, tmp_path / "all.npz", {})
    again = load_results(tmp_path / "all.npz")
    assert again.agents == results.agents and np.isfinite(again.seconds).all()
    np.testing.assert_array_equal(again.scores("returns"), results.scores("returns"))
    kinds = [results.episodes(kind) for kind in ("collision", "road_departure", "stoppage")]
    np.testing.assert_array_equal(results.episodes("accident"), sum(kinds))
    with pytest.raises(BootcourseError, match="Measure 'return' is unknown: did you mean 'returns'"):
        results.scores("return")


# The plan ------------------------------------------------------------------------------------------------


def test_a_study_s_plan_has_every_method_with_every_seed_once():
    jobs = STUDIES["default"].jobs()
    agents = [(s.method, s.seed) for each in jobs for s in each.arguments.get("settings", ())]
    assert len(agents) == len(set(agents)) and {seed for _, seed in agents} == set(range(10))
    bounds = [each.arguments["episodes"] for each in jobs if each.run is search_bound]
    assert sum(bounds) == 1000 and len({each.name for each in jobs}) == len(jobs)


@pytest.mark.parametrize("name", EXPERIMENTS)
def test_every_variation_of_an_experiment_asks_something_else(name):
    jobs = experiment_named(name).jobs()  # without Box2D, those of Lunar lander are left out
    questions = {json.dumps(asked(each), sort_keys=True) for each in jobs}
    assert len(questions) == len(jobs) > 0


def test_an_experiment_may_be_run_in_part_by_the_names_of_its_methods_teachers_and_variations():
    def named(name: str, only: str) -> set[str]:
        return set(chosen(experiment_named(name).cells(), only))

    assert named("teachers", "planner") == {"planner, dagger", "planner, ppo_cloned", "planner, rlpd"}
    assert named("teachers", "dagger") == {f"{teacher}, dagger" for teacher in TEACHERS}
    assert named("teachers", "late-soft, planner-dagger") == {"late, soft", "planner, dagger"}
    assert named("sensitivity", "gamma-0.9") == {"γ = 0.9"} and named("students", "racer-long") == {"racer, long"}
    with pytest.raises(BootcourseError, match="Part 'planer' is unknown: did you mean 'planner'"):
        named("teachers", "planer")
    with pytest.raises(BootcourseError, match="leave out --seeds"):
        experiment_named("students").jobs(seeds=3)


def test_the_help_says_of_each_experiment_what_it_asks(bootcourse):
    words = " ".join(bootcourse("study", "--help").out.split())
    assert all(f"{name}: " in words for name in EXPERIMENTS)
    assert "sensitivity: What the paper leaves open" in words and "teachers: What is a teacher worth?" in words


@pytest.mark.parametrize("name", EXPERIMENTS)
def test_an_experiment_is_found_under_its_own_name_and_every_cell_ships_under_its_folder(name):
    experiment = experiment_named(name)
    assert experiment.name == name
    folders = {folder(cell) for cell in experiment.cells()}
    assert len(folders) == len(experiment.cells()) and {path.stem for path in FOLDER.glob(f"{name}/*")} <= folders


# Agents ---------------------------------------------------------------------------------------------------


def test_agents_come_back_from_results_with_their_own_weights(root):
    agents = [bc.Training([one], 1).agent(0) for one in with_seeds(settings_for("sac", **TINY), 3)]
    kept = Results(
        agent_entries([agent.settings for agent in agents]),
        np.full(3, -1),
        measured={"alpha": np.array([0.1, 0.2, 0.3])},
        weights=weights_of(agents[:2], "actor", "critics"),
    )
    save_results(kept, root / "some.npz", {})
    again, seen = load_results(root / "some.npz"), np.random.default_rng(0).normal(size=(5, 26)).astype(np.float32)
    for i in range(2):
        agent = again.agent(i)
        assert agent.settings == agents[i].settings and agent.alpha == [0.1, 0.2][i]
        np.testing.assert_array_equal(agent.probabilities(seen), agents[i].probabilities(seen))
        np.testing.assert_array_equal(agent.q_values(seen), agents[i].q_values(seen))
    with pytest.raises(BootcourseError, match="Of agent 2 no weights were kept: there are those of 2 agents"):
        again.agent(2)
