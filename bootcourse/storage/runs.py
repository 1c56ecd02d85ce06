"""A run: one trained agent in a folder, written completely or not at all, and checked when it is read.

config.json          settings, environment, scenario, episodes
weights.safetensors  actor, critics
curves.npz           the curves of the training episodes (`bootcourse.learn.curves`)
provenance.json      versions, git commit, seconds, the hash of the three files above, and its own
"""

import os
import shutil
import subprocess
import tempfile
from contextlib import nullcontext
from dataclasses import asdict, dataclass
from itertools import pairwise
from pathlib import Path
from typing import Annotated, Any, ClassVar, Literal

import numpy as np
import torch
from msgspec import Meta, Struct, convert
from safetensors.torch import save
from torch import Tensor

from bootcourse.episodes.place import TRAP_ID, Place
from bootcourse.errors import BootcourseError
from bootcourse.files import (
    TEMPORARY,
    check_arrays,
    decoding,
    provenance,
    read_arrays,
    read_json,
    read_tensors,
    sha256,
    write_arrays,
    write_bytes,
    write_json,
)
from bootcourse.learn.agent import Agent
from bootcourse.learn.curves import NAMES
from bootcourse.learn.protocol import Learner
from bootcourse.learn.settings import Settings, stored_settings
from bootcourse.learn.teachers import Rule, default_teacher, teacher_name, teacher_of
from bootcourse.learn.training import Result
from bootcourse.methods import METHODS, method_of, own_method
from bootcourse.scenario import N_ACTIONS, Scenario
from bootcourse.storage.sealed import amiss, read_sealed, write_sealed

UNFINISHED = "unfinished"  # the folder of a training that is not over, beside the runs
HASHED = ("config.json", "weights.safetensors", "curves.npz")
KIT = Path(__file__).resolve().parents[2]  # of a clone the top folder
TRAIN_AGAIN = "train this run again, or restore it from a copy"


class Config(Struct, forbid_unknown_fields=True):
    """config.json."""

    FORMAT: ClassVar[str] = "bootcourse run 1"
    format: str
    settings: dict[str, Any]  # checked by `Settings`
    scenario: Scenario | None  # None off the trap
    episodes: Annotated[int, Meta(ge=1)]
    alpha: Annotated[float, Meta(ge=0)]
    environment: str = TRAP_ID  # the name of a `Place`


class Provenance(Struct):
    """The entries of provenance.json that are read; the others, such as the packages' versions, are for people."""

    sha256: dict[Literal[HASHED], Annotated[str, Meta(pattern="^[0-9a-f]{64}$")]]
    seed: Annotated[int, Meta(ge=0)]
    seconds: Annotated[float, Meta(ge=0)]
    agents: Annotated[int, Meta(ge=1)]
    stopped_at_decision: Annotated[int, Meta(ge=0)] | None
    teacher: str  # see `teacher_name`


@dataclass(frozen=True)
class Run:
    """A trained agent with its training curves."""

    agent: Agent
    curves: dict[str, np.ndarray]  # each (episodes,)
    scenario: Scenario | None  # None off the trap
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
    config = {
        "format": Config.FORMAT,
        "settings": asdict(agent.settings),
        "scenario": result.scenario and asdict(result.scenario),
        "episodes": len(curves["return"]),
        "alpha": agent.alpha,
        "environment": result.environment,
    }
    weights = {f"actor.{i}": tensor for i, tensor in enumerate(agent.actor)}
    weights |= {f"critics.{i}": tensor for i, tensor in enumerate(agent.critics)}
    path.parent.mkdir(parents=True, exist_ok=True)
    temporary = Path(tempfile.mkdtemp(dir=path.parent, prefix=f".{path.name}.", suffix=TEMPORARY))
    try:
        write_json(temporary / "config.json", config)
        write_bytes(temporary / "weights.safetensors", save(weights))
        write_arrays(temporary / "curves.npz", curves)
        record = provenance(
            seed=agent.settings.seed,
            seconds=round(result.seconds, 1),
            agents=len(result.agents),
            commit=_commit(),
            stopped_at_decision=stopped,  # the decision at which its loss was not finite, or None
            teacher=result.teacher,
            learner=result.learner,
            sha256={name: sha256(temporary / name) for name in HASHED},
        )
        write_sealed(temporary / "provenance.json", record)
        temporary.chmod(0o755)
        os.rename(temporary, path)
    except BaseException:
        shutil.rmtree(temporary, ignore_errors=True)
        raise


def load_run(
    path: Path, teacher: Rule | None = None, environment: str = TRAP_ID, learner: type[Learner] | None = None
) -> Run:
    """Read and check a run: its folder, or the file that the page that learns saved of an agent.

    teacher: its teacher in training, which the agents of some methods need to drive. environment: the id of the
    environment that it trained in. learner: the class that it trained with, if that is your own. Raises
    BootcourseError, with the file and the remedy, if a file is missing or damaged, or for another teacher, environment
    or learner.
    """
    path = Path(path)
    if path.is_file() and path.suffix == ".safetensors":
        from bootcourse.storage.page_run import read_page_run

        return read_page_run(path)
    if not (path / "provenance.json").is_file():
        raise BootcourseError(f"{path} is not a run: train one with `bootcourse train --out {path}`.")
    record = read_sealed(path / "provenance.json", remedy=TRAIN_AGAIN)
    with decoding(path / "provenance.json", TRAIN_AGAIN):
        stored = convert(record, Provenance)
    for name in HASHED:
        if sentence := amiss(path / name, stored.sha256.get(name, ""), TRAIN_AGAIN):
            raise BootcourseError(sentence)
    config = read_json(path / "config.json", Config, TRAIN_AGAIN)
    if (method := config.settings.get("method")) not in METHODS and (learner is None or learner.__name__ != method):
        own = "add the --learner FILE.py:CLASS that it was trained with, or learner= to load_run"
        raise BootcourseError(
            f"{path} was trained with {method!r:.80}, which is no method here: if it is a learner of your own, {own}."
        )
    if (there := config.environment) != environment:
        raise BootcourseError(
            f"{path} was trained in {there:.80}, not in {environment}: give environment={there!r:.80}."
        )
    known = nullcontext() if method in METHODS else own_method(method, method_of(learner))
    with known, decoding(path / "config.json", TRAIN_AGAIN):
        settings = stored_settings(config.settings)
    curves = read_arrays(path / "curves.npz", TRAIN_AGAIN)
    shapes = dict.fromkeys(curves.keys() & set(NAMES), (config.episodes,))
    check_arrays(curves, shapes, path / "curves.npz", TRAIN_AGAIN)
    kind = learner or METHODS[method].learner_class()
    weights = path / "weights.safetensors"
    actor, critics = networks_of(read_tensors(weights, TRAIN_AGAIN), settings, config.scenario, weights, kind)
    teacher = default_teacher(Place(config.scenario)) if teacher is None else teacher
    taught = None if teacher is None else teacher_of(teacher, config.scenario, actor[-1].shape[2])
    agent = Agent(settings, actor, critics, config.alpha, taught, learner)
    if agent.needs_teacher and stored.teacher != teacher_name(teacher):
        raise BootcourseError(
            f"{path} drives with the teacher '{stored.teacher}', not '{teacher_name(teacher)}': give the same teacher."
        )
    return Run(agent, curves, config.scenario, record)


def networks_of(
    weights: dict[str, np.ndarray],
    settings: Settings,
    scenario: Scenario | None,
    path: Path,
    kind: type[Learner],
    remedy: str = TRAIN_AGAIN,
) -> tuple[list[Tensor], list[Tensor]]:
    """The actor and the critics of a file, of the shapes of networks.py. Raises BootcourseError for others."""
    with decoding(path, remedy):
        inputs, outputs = weights["actor.0"].shape[1], weights[f"actor.{2 * len(settings.hidden)}"].shape[2]
    if scenario:
        inputs, outputs = scenario.observation_size, N_ACTIONS
    layers = list(pairwise((inputs, *settings.hidden, outputs)))
    rows = [(inputs, outputs) for n_in, outputs in layers for inputs in (n_in, 1)]
    networks = (("actor", 1), ("critics", kind.n_critics(settings)))
    shapes = {f"{name}.{i}": (n, *row) for name, n in networks if n for i, row in enumerate(rows)}
    check_arrays(weights, shapes, path, remedy)
    if not all(np.isfinite(values).all() for values in weights.values()):
        raise BootcourseError(f"{path} holds NaN or infinity: {remedy}.")
    tensors = {name: torch.from_numpy(weights[name]) for name in shapes}
    return tuple([tensor for key, tensor in tensors.items() if key.startswith(name)] for name, _ in networks)


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
    if runs := sorted(path.parent for path in folder.glob("[!.]*/config.json")):
        return runs
    if deeper := sorted(folder.glob("[!.]*/[!.]*/config.json")):
        raise BootcourseError(f"{folder} holds no run itself: name a folder in it, such as {deeper[0].parents[1]}.")
    raise BootcourseError(f"{folder} holds no run: train one with `bootcourse train --out {folder}`.")


def _commit(kit: Path = KIT) -> str:
    """The git commit of this code, "unknown" where its folder is no clone, also inside somebody else's repository."""
    here = [f"--git-dir={kit / '.git'}", f"--work-tree={kit}"]
    command = ["git", *here, "describe", "--always", "--dirty", "--abbrev=12"]
    try:
        return subprocess.run(command, capture_output=True, text=True, timeout=5, check=True).stdout.strip()
    except (OSError, subprocess.SubprocessError):
        return "unknown"
