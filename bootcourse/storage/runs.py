"""A run: one trained agent in a folder, written completely or not at all, and checked when it is read.

config.json          settings, scenario, episodes
weights.safetensors  actor, critics
curves.npz           the curves of the training episodes (`bootcourse.learn.curves`)
provenance.json      versions, git commit, seconds, and the hash of the three files above
"""

import json
import os
import shutil
import subprocess
import tempfile
from dataclasses import asdict, dataclass
from pathlib import Path

import numpy as np
import torch
from safetensors import SafetensorError
from safetensors.torch import load, save

from bootcourse.errors import BootcourseError
from bootcourse.files import (
    TEMPORARY,
    provenance,
    read_arrays,
    read_bytes,
    read_json,
    sha256,
    write_arrays,
    write_bytes,
    write_json,
)
from bootcourse.learn.agent import Agent
from bootcourse.learn.settings import Settings, renamed
from bootcourse.learn.teachers import Rule, course_rule, teacher_name
from bootcourse.learn.training import Result, Training
from bootcourse.scenario import Scenario
from bootcourse.storage.checkpoint import DamagedCheckpoint, restored, state_of

FORMAT = "bootcourse run 1"
CHECKPOINT_FORMAT = "bootcourse checkpoint 2"
UNFINISHED = "unfinished"  # the folder of a training that is not over, beside the runs
HASHED = ("config.json", "weights.safetensors", "curves.npz")


@dataclass(frozen=True)
class Run:
    """A trained agent with its training curves."""

    agent: Agent
    curves: dict[str, np.ndarray]  # each (episodes,)
    scenario: Scenario
    provenance: dict


def save_runs(result: Result, folder: Path) -> list[Path]:
    """Write each agent of a training to folder/METHOD-SEED; returns these folders.

    Raises BootcourseError if one of them exists already or cannot be written, or if two would have the same name.
    """
    folders = [Path(folder) / f"{agent.settings.method}-{agent.settings.seed}" for agent in result.agents]
    if len(set(folders)) < len(folders):
        raise BootcourseError("Two agents have the same method and seed, which name a run's folder: save them apart.")
    try:
        for path in folders:
            if path.exists():
                raise BootcourseError(f"{path} exists already: choose another folder, or move it away.")
        for i, path in enumerate(folders):
            curves = {name: values[i] for name, values in result.curves.items()}
            _save_run(path, result.agents[i], curves, result, result.stopped.get(i))
    except BootcourseError:
        raise
    except (OSError, ValueError) as error:  # ValueError: a null character in the name
        reason = getattr(error, "strerror", None) or error
        raise BootcourseError(f"Cannot write {str(folder)!r}: {reason}. Choose another folder.") from None
    return folders


def _save_run(path: Path, agent: Agent, curves: dict[str, np.ndarray], result: Result, stopped: int | None) -> None:
    episodes = len(curves["return"])
    config = {
        "format": FORMAT,
        "settings": asdict(agent.settings),
        "scenario": json.loads(result.scenario.to_json()),
        "episodes": episodes,
        "alpha": agent.alpha,
    }
    weights = {f"actor.{i}": tensor for i, tensor in enumerate(agent.actor)}
    weights |= {f"critics.{i}": tensor for i, tensor in enumerate(agent.critics)}
    path.parent.mkdir(parents=True, exist_ok=True)
    temporary = Path(tempfile.mkdtemp(dir=path.parent, prefix=f".{path.name}.", suffix=TEMPORARY))
    try:
        write_json(temporary / "config.json", config)
        write_bytes(temporary / "weights.safetensors", save(weights))
        write_arrays(temporary / "curves.npz", curves)
        made = provenance(
            seed=agent.settings.seed,
            seconds=round(result.seconds, 1),
            agents=len(result.agents),
            commit=_commit(),
            stopped_at_decision=stopped,  # the decision at which its loss was not finite, or None
            teacher=result.teacher,
            sha256={name: sha256(temporary / name) for name in HASHED},
        )
        write_json(temporary / "provenance.json", made)
        temporary.chmod(0o755)
        os.rename(temporary, path)
    except BaseException:
        shutil.rmtree(temporary, ignore_errors=True)
        raise


def load_run(path: Path) -> Run:
    """Read and check a run. Raises BootcourseError, with the file and the remedy, if it is missing or damaged."""
    path = Path(path)
    if not (path / "provenance.json").is_file():
        raise BootcourseError(f"{path} is not a run: train one with `bootcourse train --out {path}`.")
    made = read_json(path / "provenance.json")
    for name in HASHED:
        if made.get("sha256", {}).get(name) != sha256(path / name):
            raise BootcourseError(f"{path / name} is damaged: its hash has changed. Train this run again.")
    config = read_json(path / "config.json")
    if config.get("format") != FORMAT:
        raise BootcourseError(f"{path} has the format {config.get('format')!r}, this version reads {FORMAT!r}.")
    settings = Settings(**renamed(config["settings"]))
    try:
        weights = load(read_bytes(path / "weights.safetensors"))
    except SafetensorError:
        raise BootcourseError(f"{path / 'weights.safetensors'} is damaged: train this run again.") from None
    layers = 2 * (len(settings.hidden) + 1)
    try:
        actor, critics = ([weights[f"{name}.{i}"] for i in range(layers)] for name in ("actor", "critics"))
    except KeyError as error:
        raise BootcourseError(f"{path / 'weights.safetensors'} lacks {error}: train this run again.") from None
    if not all(bool(torch.isfinite(tensor).all()) for tensor in (*actor, *critics)):
        raise BootcourseError(f"{path / 'weights.safetensors'} holds NaN or infinity: train this run again.")
    agent = Agent(settings, actor, critics, config["alpha"])
    return Run(agent, read_arrays(path / "curves.npz"), Scenario.from_json(json.dumps(config["scenario"])), made)


def find_runs(folder: Path) -> list[Path]:
    """The folder itself if it is a run, otherwise its sub-folders that are, by name. Raises BootcourseError if none."""
    folder = Path(folder)
    if not folder.is_dir():
        raise BootcourseError(f"{folder} is not a folder: name one that `bootcourse train --out` wrote.")
    if (folder / "provenance.json").exists() or (folder / "config.json").exists():
        return [folder]
    if (folder / UNFINISHED).exists():
        raise BootcourseError(
            f"{folder} has an unfinished training: continue it with `bootcourse train --out {folder} --resume`."
        )
    found = sorted(path.parent for path in folder.glob("[!.]*/config.json"))
    if not found:
        raise BootcourseError(f"{folder} holds no run: train one with `bootcourse train --out {folder}`.")
    return found


def save_checkpoint(training: Training, path: Path) -> None:
    """Write a training in progress to one file. Raises BootcourseError off the trap, or if it cannot be written."""
    config = {
        "format": CHECKPOINT_FORMAT,
        "settings": [asdict(settings) for settings in training.settings],
        "episodes": training.episodes,
        "scenario": json.loads(training.scenario.to_json()),
        "teacher": teacher_name(training.teacher),
    }
    write_arrays(path, {**state_of(training), "config": np.array(json.dumps(config))}, compress=False)


def load_checkpoint(path: Path, teacher: Rule = course_rule) -> Training:
    """The training that `save_checkpoint` wrote, to be continued with the same teacher.

    Raises DamagedCheckpoint if the file cannot be read, BootcourseError for another teacher.
    """
    try:
        arrays = read_arrays(path)
        config = json.loads(str(arrays.pop("config")))
        if config["format"] != CHECKPOINT_FORMAT:
            raise DamagedCheckpoint(f"its format is {config['format']!r}")
        settings = [Settings(**renamed(stored)) for stored in config["settings"]]
        scenario, began_with = Scenario.from_json(json.dumps(config["scenario"])), config["teacher"]
        if teacher_name(teacher) == began_with:
            return restored(settings, config["episodes"], scenario, teacher, arrays)
    except (KeyError, TypeError, AttributeError, ValueError) as error:  # BootcourseError is a ValueError
        raise DamagedCheckpoint(f"{path} is no checkpoint of this version, or damaged ({error}).") from None
    raise BootcourseError(
        f"{path} began with the teacher '{began_with}', not '{teacher_name(teacher)}': give the same teacher."
    )


def _commit() -> str:
    """The git commit of this code, "unknown" outside a clone."""
    command = ["git", "-C", str(Path(__file__).parent), "describe", "--always", "--dirty", "--abbrev=12"]
    try:
        return subprocess.run(command, capture_output=True, text=True, timeout=5, check=True).stdout.strip()
    except (OSError, subprocess.SubprocessError):
        return "unknown"
