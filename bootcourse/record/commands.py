"""`bootcourse train`: what the command line does with a training, its folder and its interrupts."""

import sys
import time
from pathlib import Path

from bootcourse.errors import BootcourseError
from bootcourse.learn.settings import settings_for, with_seeds
from bootcourse.learn.train import Training
from bootcourse.record.runs import load_checkpoint, save_checkpoint, save_runs
from bootcourse.scenario import named

CHECKPOINT = "checkpoint.npz"
SECONDS_BETWEEN = 20.0
INTERRUPTED = 130


def train(method: str, seeds: int, first: int, episodes: int, out: Path, scenario: str, progress: bool) -> int:
    """Start a training in a new folder; returns the exit status."""
    settings = with_seeds(settings_for(method), seeds, first)
    road = named(scenario)
    if (out / CHECKPOINT).exists():
        raise BootcourseError(f"{out} holds an unfinished training: add --resume to go on with it, or choose another.")
    if out.exists() and (not out.is_dir() or any(out.iterdir())):
        raise BootcourseError(f"{out} exists already and is not empty: choose another folder.")
    training = Training(settings, episodes, road)
    save_checkpoint(training, out / CHECKPOINT)  # before an hour is spent: can this folder be written?
    return _finish(training, out, progress)


def resume(out: Path, progress: bool) -> int:
    """Go on with the training of a folder; returns the exit status."""
    if not (out / CHECKPOINT).exists():
        raise BootcourseError(f"{out} holds no unfinished training: leave --resume away to start one.")
    return _finish(load_checkpoint(out / CHECKPOINT), out, progress)


def _finish(training: Training, out: Path, progress: bool) -> int:
    last = time.monotonic()

    def checkpoint_now_and_then(training: Training) -> None:
        nonlocal last
        if time.monotonic() - last > SECONDS_BETWEEN:
            save_checkpoint(training, out / CHECKPOINT)
            last = time.monotonic()

    result = training.run(progress, checkpoint_now_and_then)
    if result.interrupted:
        save_checkpoint(training, out / CHECKPOINT)
        print(f"Interrupted. Nothing is lost: go on with `bootcourse train --out {out} --resume`.", file=sys.stderr)
        return INTERRUPTED
    for path in save_runs(result, out):
        print(path)
    (out / CHECKPOINT).unlink()
    return 0
