"""`bootcourse train`: agents of one method, side by side, with a checkpoint now and then."""

import importlib.util
import sys
import time
from pathlib import Path

import typer

from bootcourse.errors import BootcourseError

INTERRUPTED = 130  # exit status
CHECKPOINT, SECONDS_BETWEEN = "checkpoint.npz", 20.0  # a training's checkpoint file, and the time between two (s)


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
