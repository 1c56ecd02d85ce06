"""The command line, `bootcourse` or `python -m bootcourse`: a command is a function with `@app.command()`.

Commands import their modules themselves, so that `bootcourse --help` is fast. A training and a study can be stopped by
Ctrl-C (exit status 130) and resumed.
"""

import contextlib
import importlib.util
import json
import sys
import threading
import time
import webbrowser
from pathlib import Path

import typer

from bootcourse.errors import BootcourseError, did_you_mean

INTERRUPTED = 130  # exit status
CHECKPOINT, SECONDS_BETWEEN = "checkpoint.npz", 20.0  # a training's checkpoint file, and the time between two (s)
BUILT_IN = ("rule", "idle", "random")  # drivers that need no training
MEASURES = {
    "success": "success %",
    "returns": "return",
    "speed": "speed m/s",
    "distance": "distance m",
    "collision": "collision %",
    "road_departure": "road departure %",
    "stoppage": "stoppage %",
}
ACROSS = 4  # columns of `evaluate`'s table side by side in a terminal

app = typer.Typer(
    help="A trap on the highway, and how an imperfect driver pulls a learner out of it.",
    no_args_is_help=True,
    add_completion=False,
    rich_markup_mode=None,  # plain text, on every terminal
    pretty_exceptions_enable=False,
)


def main() -> None:
    """Run a command. Exit status: 2, after one sentence, for a user mistake; 130 for Ctrl-C."""
    try:
        app(prog_name="bootcourse")
    except BootcourseError as error:
        print(error, file=sys.stderr)
        sys.exit(2)


def show_version(wanted: bool) -> None:
    """Print the version and exit, if wanted."""
    if wanted:
        from bootcourse import __version__

        print(f"bootcourse {__version__}")
        raise typer.Exit()


@app.callback()
def options(
    version: bool = typer.Option(False, "--version", callback=show_version, is_eager=True, help="Print the version."),
) -> None:
    """The options of `bootcourse` itself."""


@app.command()
def doctor() -> None:
    """Check the installation and this machine, and print a remedy for each problem."""
    from bootcourse import doctor

    raise typer.Exit(doctor.main())


@app.command()
def train(
    method: str = typer.Option(
        "bootstrapped", help="sac, soft, demos, bootstrapped, margin, margin_soft, bc, cql, cql_sac or gail."
    ),
    seeds: int = typer.Option(4, min=1, max=64, help="How many agents, side by side, each with its own seed."),
    first_seed: int = typer.Option(0, min=0, help="The first training seed."),
    episodes: int = typer.Option(1000, min=1, help="Training episodes of each agent."),
    out: Path = typer.Option(..., help="A new folder for the runs."),
    scenario: str = typer.Option("default", help="default or calibrated."),
    teacher: str = typer.Option("", help="A rule of your own as the teacher: FILE.py:FUNCTION."),
    resume: bool = typer.Option(False, "--resume", help="Resume a training that was interrupted or killed."),
    quiet: bool = typer.Option(False, "--quiet", help="No progress bar."),
) -> None:
    """Train agents and write a run of each."""
    from bootcourse.learn.settings import settings_for, with_seeds
    from bootcourse.learn.training import Training
    from bootcourse.scenario import named
    from bootcourse.storage.runs import load_checkpoint, save_checkpoint

    unfinished, rule = out / CHECKPOINT, teacher_from(teacher)
    if resume:
        if not unfinished.exists():
            raise BootcourseError(f"{out} has no unfinished training: leave out --resume to start one.")
        training = load_checkpoint(unfinished, rule)
    else:
        settings, road = with_seeds(settings_for(method), seeds, first_seed), named(scenario)
        if unfinished.exists():
            raise BootcourseError(
                f"{out} has an unfinished training: add --resume to continue it, or choose another folder."
            )
        if out.exists() and (not out.is_dir() or any(out.iterdir())):
            raise BootcourseError(f"{out} exists already and is not empty: choose another folder.")
        training = Training(settings, episodes, road, rule)
        save_checkpoint(training, unfinished)  # raises now, not after the training, if the folder is not writable
    raise typer.Exit(finish_training(training, out, progress=not quiet))


def teacher_from(place: str):
    """The rule "FILE.py:FUNCTION"; the course's for "". Raises BootcourseError if it does not exist."""
    from bootcourse.learn.teachers import course_rule

    if not place:
        return course_rule
    file, _, function = place.rpartition(":")
    if not Path(file).is_file():
        raise BootcourseError(f"--teacher {place}: give a file and a function in it, such as my_rule.py:my_rule.")
    spec = importlib.util.spec_from_file_location(Path(file).stem, file)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    if not callable(getattr(module, function, None)):
        raise BootcourseError(f"{file} has no function '{function}': write it there, or give another name.")
    return getattr(module, function)


def finish_training(training, out: Path, progress: bool) -> int:
    """Train, with a checkpoint every 20 s, and write the runs. Returns the exit status."""
    from bootcourse.storage.runs import save_checkpoint, save_runs

    last = time.monotonic()

    def checkpoint_now_and_then(training) -> None:
        nonlocal last
        if time.monotonic() - last > SECONDS_BETWEEN:
            save_checkpoint(training, out / CHECKPOINT)
            last = time.monotonic()

    result = training.run(progress, checkpoint_now_and_then)
    if result.interrupted:
        save_checkpoint(training, out / CHECKPOINT)
        print(f"Interrupted. To continue, run `bootcourse train --out {out} --resume`.", file=sys.stderr)
        return INTERRUPTED
    for path in save_runs(result, out):
        print(path)
    (out / CHECKPOINT).unlink()
    return 0


@app.command()
def evaluate(
    who: str = typer.Argument(..., help="rule, idle, or a folder that `bootcourse train` wrote."),
    episodes: int = typer.Option(1000, min=1, help="Held-out episodes."),
    seed: int = typer.Option(1, min=0, help="The block of held-out roads."),
    scenario: str = typer.Option("", help="default or calibrated; by default the scenario that a run trained on."),
    sample: bool = typer.Option(False, "--sample", help="Draw an agent's actions instead of taking the most probable."),
    as_json: bool = typer.Option(False, "--json", help="Print JSON."),
) -> None:
    """Drive held-out episodes and print success, return, speed, distance and accidents with 95 % intervals."""
    from bootcourse.episodes.evaluate import drive_episodes, held_out_seeds, over_seeds, summarise

    seeds = held_out_seeds(seed, episodes)
    found = {
        label: summarise(drive_episodes(policy, seeds, road))
        for label, policy, road in policies_of(who, scenario, sample, seed)
    }
    if as_json:
        everything = {label: each.to_dict() for label, each in found.items()}
        if len(found) > 1:
            everything["over seeds"] = {name: e._asdict() for name, e in over_seeds(list(found.values())).items()}
        print(json.dumps(everything, indent=2))
        return
    print(f"{episodes} held-out episodes, block {seed}: value [95 % interval]")
    columns = {label: {name: getattr(each, name) for name in MEASURES} for label, each in found.items()}
    if len(found) > 1:
        columns["mean over seeds"] = over_seeds(list(found.values()))
    labels = list(columns)
    for first in range(0, len(labels), ACROSS):
        print_table({label: columns[label] for label in labels[first : first + ACROSS]})


def policies_of(who: str, scenario: str, sample: bool, seed: int) -> list[tuple]:
    """(label, policy, scenario) of a built-in driver, or of each run in a folder."""
    import numpy as np

    from bootcourse.policies import idle_policy, random_policy, rule_policy
    from bootcourse.scenario import DEFAULT, named

    if who in BUILT_IN:
        road = named(scenario) if scenario else DEFAULT
        built_in = {
            "rule": rule_policy(road),
            "idle": idle_policy,
            "random": random_policy(np.random.default_rng(seed)),
        }
        return [(who, built_in[who], road)]
    if not Path(who).exists():
        raise BootcourseError(f"Driver {did_you_mean(who, BUILT_IN)}, or give a folder that `bootcourse train` wrote.")
    from bootcourse.storage.runs import find_runs, load_run

    found = []
    for path in find_runs(Path(who)):
        run = load_run(path)
        rng = np.random.default_rng(seed) if sample else None
        road = named(scenario) if scenario else run.scenario
        found.append((path.name, run.agent.as_policy(rng, with_q=True), road))
    return found


def print_table(columns: dict[str, dict]) -> None:
    """Print a table of value [low, high]: one column for each driver, one row for each measure."""
    print("\n" + " " * 18 + "".join(f"{label:>26}" for label in columns))
    for name, heading in MEASURES.items():
        scale = 100 if "%" in heading else 1
        each = [tuple(scale * number for number in column[name]) for column in columns.values()]
        print(f"{heading:18}" + "".join(f"{f'{v:.1f} [{low:.1f}, {high:.1f}]':>26}" for v, low, high in each))


@app.command()
def drive(
    who: str = typer.Argument(..., help="rule, idle, random, or a run's folder."),
    out: Path = typer.Option(..., help="The rollout to write, such as drive.npz."),
    seed: int = typer.Option(0, min=0, help="The road."),
    scenario: str = typer.Option("", help="default or calibrated; by default the scenario that a run trained on."),
    png: Path | None = typer.Option(None, help="Also draw the top view and the traces to this picture."),
) -> None:
    """Record one drive for figures and replays."""
    from bootcourse.episodes.record import record

    if out.exists():
        raise BootcourseError(f"{out} exists already: choose another name.")
    label, policy, road = policies_of(who, scenario, False, seed)[0]
    label = label.rsplit("-", 1)[0] if label not in BUILT_IN else label
    rollout = record(policy, [seed], road, label)[0]
    print(rollout.save(out))
    if png is not None:
        from bootcourse.plots.drive_figure import save_drive

        print(save_drive(rollout, png))


@app.command()
def replay(
    files: list[Path] = typer.Argument(..., help="Rollouts of `bootcourse drive`; several of one road are compared."),
    export: Path | None = typer.Option(None, help="Write one HTML file that plays anywhere, such as out.html."),
    gif: Path | None = typer.Option(None, help="Write an animation for slides, such as out.gif."),
    png: Path | None = typer.Option(None, help="Write a picture, such as out.png."),
    text: bool = typer.Option(False, "--text", help="Print each drive in words."),
    port: int = typer.Option(0, min=0, max=65535, help="The server's port; 0: any free one."),
    browser: bool = typer.Option(True, help="Open the browser, or print only the address."),
) -> None:
    """Show drives in 3D in the browser until Ctrl-C, or write them to a file, or print them in words."""
    from bootcourse.episodes.rollout import Rollout

    rollouts = [Rollout.load(file) for file in files]
    if not (export or gif or png or text):
        from bootcourse.replay3d import viewer

        with viewer.replay(rollouts, port=port) as shown, contextlib.suppress(KeyboardInterrupt):
            print(f"Replay at {shown.url} (Ctrl-C ends it)", flush=True)
            if browser:
                webbrowser.open(shown.url)
            threading.Event().wait()
        return
    from bootcourse.episodes.words import transcripts
    from bootcourse.replay3d import pictures, recorder

    for path, write in ((export, recorder.export), (gif, pictures.write_gif), (png, pictures.write_png)):
        if path is not None:
            print(f"{write(rollouts, path)} ({path.stat().st_size / 1e6:.1f} MB)")
    if text:
        print(transcripts(rollouts))


@app.command()
def study(
    name: str = typer.Argument("default", help="default, calibrated or paper; sensitivity, clocks or ablations."),
    out: Path = typer.Option(..., help="The study's folder: new, or that of a study to continue; all may share one."),
    seeds: int = typer.Option(0, min=0, help="Training seeds of each method; 0: the study's own number."),
    episodes: int = typer.Option(0, min=0, help="Training episodes of each agent; 0: the study's own number."),
    tests: int = typer.Option(1000, min=1, help="Held-out episodes that each agent is tested on."),
    only: str = typer.Option("", help="Only these methods, such as sac,bootstrapped; planner is the bound."),
    backend: str = typer.Option("loky", help="loky (this machine), dask or ray."),
    scheduler: str = typer.Option("", help="The address of a dask or ray cluster that you have."),
    workers: int = typer.Option(0, min=0, help="Jobs at once; 0: one for each core."),
    recompute: bool = typer.Option(False, "--recompute", help="Compute damaged jobs again."),
) -> None:
    """Train and test every method with many seeds; write tables, figures and the fidelity report.

    default, calibrated and paper: all methods. sensitivity, clocks and ablations: the paper's ablation, varied.
    """
    from bootcourse.study import plan
    from bootcourse.study.report import write_report
    from bootcourse.study.results import in_study

    methods = plan.methods_named(only)
    if name not in plan.STUDIES and name not in plan.EXPERIMENTS:
        raise BootcourseError(f"Study {did_you_mean(name, (*plan.STUDIES, *plan.EXPERIMENTS))}.")
    if name in plan.STUDIES:
        wanted = plan.study_jobs(name, methods, seeds or plan.SEEDS, tests, episodes)
    elif only:
        raise BootcourseError(f"The study '{name}' has its own methods: leave out --only.")
    else:
        wanted = plan.EXPERIMENTS[name].jobs(name, seeds, episodes, tests)
    status = compute(wanted, out, backend=backend, scheduler=scheduler, workers=workers, recompute=recompute)
    found = in_study(out)
    if found.results:
        print(write_report(found, out))
    raise typer.Exit(status)


@app.command()
def sweep(
    out: Path = typer.Option(..., help="The folder: new, a study's, or that of a sweep to continue."),
    seeds: int = typer.Option(4, min=1, help="Training seeds of each setting."),
    episodes: int = typer.Option(1500, min=1, help="Training episodes of each agent."),
    tests: int = typer.Option(1000, min=1, help="Held-out episodes that each agent is tested on."),
    backend: str = typer.Option("loky", help="loky (this machine), dask or ray."),
    scheduler: str = typer.Option("", help="The address of a dask or ray cluster that you have."),
    workers: int = typer.Option(0, min=0, help="Jobs at once; 0: one for each core."),
    recompute: bool = typer.Option(False, "--recompute", help="Compute damaged jobs again."),
) -> None:
    """Train the paper's method with many settings of p, ξ and c; write one file of results."""
    from bootcourse.files import provenance
    from bootcourse.study.plan import sweep_jobs
    from bootcourse.study.results import load_jobs, save_results
    from bootcourse.study.sweep import sweep_table

    wanted = sweep_jobs(seeds, episodes, tests)
    status = compute(wanted, out, backend=backend, scheduler=scheduler, workers=workers, recompute=recompute)
    if status == 0:
        found = load_jobs(out, "sweep")
        made = provenance(command=f"bootcourse sweep --seeds {seeds} --episodes {episodes}")
        save_results(found, out / "sweep.npz", made)
        print(sweep_table(found))
        print(out / "sweep.npz")
    raise typer.Exit(status)


def compute(wanted: list, out: Path, **how) -> int:
    """Compute the missing jobs; print failures and how to continue. Returns the exit status."""
    from bootcourse.study.runner import run_jobs

    started = time.monotonic()
    try:
        problems = run_jobs(wanted, out, **how)
    except KeyboardInterrupt:
        print("Interrupted. Finished jobs are kept: start the same command again to continue.", file=sys.stderr)
        return INTERRUPTED
    minutes = (time.monotonic() - started) / 60
    print(f"{len(wanted) - len(problems)} of {len(wanted)} jobs are done, after {minutes:.1f} minutes.")
    for problem in problems:
        print(problem)
    if problems:
        print("Finished jobs are kept: start the same command again to continue.")
    return 1 if problems else 0


@app.command()
def assets(
    what: str = typer.Argument(..., help="verify: check the shipped files. build: make them from a study's folder."),
    study: Path | None = typer.Option(None, help="The study's folder, for build."),
) -> None:
    """Check the files that ship with the course, or make them again."""
    if what not in ("verify", "build"):
        raise BootcourseError(f"Action {did_you_mean(what, ('verify', 'build'))}.")
    if what == "build":
        if study is None:
            raise BootcourseError(
                "build needs --study DIR, a folder that `bootcourse study` and `bootcourse sweep` wrote."
            )
        from bootcourse.study.ship import build

        build(study)
    from bootcourse.storage.assets import FOLDER

    raise typer.Exit(report_assets(FOLDER))


def report_assets(folder: Path) -> int:
    """Print the shipped files that are damaged or older than the code. Returns the exit status."""
    from bootcourse.files import read_json
    from bootcourse.storage.assets import MANIFEST, verify
    from bootcourse.study.fingerprint import older

    problems, old = verify(folder), older(folder)
    for sentence in (*problems, *old):
        print(sentence)
    entries = read_json(folder / MANIFEST)["files"]
    size = sum(entry["bytes"] for entry in entries) / 1e6
    print(f"{len(entries)} files, {size:.1f} MB: {len(problems)} wrong, {len(old)} made by older code.")
    return 1 if problems else 0
