"""A training in progress as one file: networks, optimiser, replay buffer, roads, generators, curves.

A training that is resumed from it gives the same results as an uninterrupted one.
"""

import json
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import asdict, replace
from pathlib import Path
from typing import Annotated, Any, ClassVar, Literal

import numpy as np
import torch
from msgspec import Meta, Struct
from torch import Tensor

from bootcourse.errors import BootcourseError, RuleFailed
from bootcourse.files import decoding, parse, read_arrays, write_arrays
from bootcourse.learn.agent import Agent
from bootcourse.learn.running import device_named
from bootcourse.learn.settings import stored_settings
from bootcourse.learn.teachers import Rule, course_rule, teacher_name
from bootcourse.learn.training import Training
from bootcourse.methods import METHODS
from bootcourse.scenario import Scenario

BEGIN_AGAIN = "begin again in a new folder, or restore it from a copy"
Count = Annotated[int, Meta(ge=0)]


class DamagedCheckpoint(BootcourseError):
    """A checkpoint that cannot be read: the training must begin again."""


class Header(Struct, forbid_unknown_fields=True):
    """What a checkpoint holds beside its arrays."""

    FORMAT: ClassVar[str] = "bootcourse checkpoint 3"
    format: str
    settings: list[dict[str, Any]]  # checked by `Settings`
    scenario: Scenario
    episodes: Annotated[int, Meta(ge=1)]
    teacher: str
    rngs: list[dict[str, Any]]  # checked by NumPy
    decisions: Count
    updates: Count
    seconds: Annotated[float, Meta(ge=0)]
    snapshots: dict[Literal["finished", "last_finite"], list[Count]]  # the agents that have one
    stopped: list[tuple[Count, Count]]  # (agent, the decision at which its loss was not finite)
    learner: Literal["torch", "compiled"] = "torch"  # a name of `training.LEARNERS`


def save_checkpoint(training: Training, path: Path) -> None:
    """Write a training in progress to one file.

    Raises BootcourseError off the trap, for a learner of your own, which no file can hold, or if it cannot be written.
    """
    if not training.place.is_trap:
        raise BootcourseError("Only a training on the trap can be saved and resumed: let this one run to its end.")
    if training.learner_name is None:
        raise BootcourseError("A training with a learner of your own cannot be saved: let this one run to its end.")
    header = {
        "format": Header.FORMAT,
        "settings": [asdict(settings) for settings in training.settings],
        "scenario": asdict(training.scenario),
        "episodes": training.episodes,
        "teacher": teacher_name(training.teacher),
        "learner": training.learner_name,
        "rngs": [rng.bit_generator.state for rng in _generators(training)],
        "decisions": training.decisions,
        "updates": training.updates,
        "seconds": training.seconds,
        "snapshots": {name: sorted(agents) for name, agents in _snapshots(training).items()},
        "stopped": sorted(training.stopped.items()),
    }
    arrays = {name: _numpy(values) for name, values in _in_place(training).items()}
    arrays |= {f"replay.{name}": values for name, values in training.replay.state().items()}
    for i, moments in _moments(training).items():
        arrays |= {f"optimiser.{i}.{name}": _numpy(values) for name, values in moments.items()}
    for name, agents in _snapshots(training).items():
        for i, agent in agents.items():
            parts = [*agent.actor, *agent.critics, torch.tensor(agent.alpha, dtype=torch.float64)]
            arrays |= {f"{name}.{i}.{k}": part.numpy() for k, part in enumerate(parts)}
    write_arrays(path, {**arrays, "header": np.array(json.dumps(header))}, compress=False)


def load_checkpoint(path: Path, teacher: Rule = course_rule, device: str = "cpu") -> Training:
    """The training that `save_checkpoint` wrote, to be continued with the same teacher, on any device.

    Raises DamagedCheckpoint if the file cannot be read, BootcourseError for another teacher, for a method that is not
    known here, for a device that torch does not find, and, as RuleFailed, for a teacher that fails.
    """
    device_named(device)
    with _reading(path):
        arrays = read_arrays(path, BEGIN_AGAIN)
        header = parse(str(arrays.pop("header")), Header, path, BEGIN_AGAIN)
    if unknown := sorted({str(stored.get("method")) for stored in header.settings} - METHODS.keys()):
        own = "add the --learner FILE.py:CLASS it began with"
        raise BootcourseError(f"{path} learns with {unknown[0]!r:.80}: {own}.")
    if (name := teacher_name(teacher)) != header.teacher:
        raise BootcourseError(f"{path} began with the teacher '{header.teacher}', not '{name}': give the same teacher.")
    with _reading(path):
        settings = [stored_settings(stored) for stored in header.settings]
        rows = torch.from_numpy(arrays["replay.demonstrations"])
        demonstrations = rows if len(rows) else None
        training = Training(
            settings,
            header.episodes,
            header.scenario,
            teacher,
            demonstrations,
            device=device,
            learner=header.learner,
        )
        _restore(training, header, arrays)
    return training


@contextmanager
def _reading(path: Path) -> Iterator[None]:
    """Whatever the block raises on a checkpoint becomes a DamagedCheckpoint, apart from a teacher's failure."""
    try:
        with decoding(path, BEGIN_AGAIN):
            yield
    except RuleFailed:
        raise
    except BootcourseError as error:
        raise DamagedCheckpoint(str(error)) from None


def _restore(training: Training, header: Header, arrays: dict[str, np.ndarray]) -> None:
    with torch.no_grad():
        for name, values in _in_place(training).items():
            values[...] = _like(arrays[name], values)
    training.replay.restore({name.removeprefix("replay."): arrays[name] for name in arrays if "replay." in name})
    moments = {}  # of Adam, {parameter's number: {name: tensor}}
    for name, values in arrays.items():
        if name.startswith("optimiser."):
            _, i, moment = name.split(".")
            moments.setdefault(int(i), {})[moment] = torch.from_numpy(values)
    if moments:
        optimiser = training.learner.optimiser
        optimiser.load_state_dict(optimiser.state_dict() | {"state": moments})
    for rng, state in zip(_generators(training), header.rngs, strict=True):
        rng.bit_generator.state = state
    training.decisions, training.updates, training.seconds = header.decisions, header.updates, header.seconds
    training.stopped = dict(header.stopped)
    for name, agents in _snapshots(training).items():
        for i in header.snapshots[name]:
            present = training.agent(i)
            like = [*present.actor, *present.critics]
            parts = [_like(arrays[f"{name}.{i}.{k}"], part).clone() for k, part in enumerate(like)]
            layers, alpha = len(present.actor), float(arrays[f"{name}.{i}.{len(like)}"])
            agents[i] = replace(present, actor=parts[:layers], critics=parts[layers:], alpha=alpha)
    training.states, training.rule_actions = training.env.observe(), training.taught()


def _in_place(training: Training) -> dict[str, Tensor | np.ndarray]:
    """The learner's tensors and the arrays of the roads and the curves, which are written back where they are."""
    env, curves = training.env, training.curves
    tensors = training.learner.tensors().items()
    values = {f"learner.{name}.{i}": tensor for name, many in tensors for i, tensor in enumerate(many)}
    values |= {f"curves.{name}": numbers for name, numbers in curves.values.items()}
    roads = {"env.cars": env.cars, "env.decisions": env.decisions}
    return values | roads | {"curves.finished": curves.finished, "curves.running": curves.running}


def _snapshots(training: Training) -> dict[str, dict[int, Agent]]:
    return {"finished": training.finished_agents, "last_finite": training.last_finite}


def _generators(training: Training) -> list[np.random.Generator]:
    return [*training.act_rngs, *training.sample_rngs, *training.env._generators]


def _moments(training: Training) -> dict[int, dict[str, Tensor]]:
    """Adam's moving averages by parameter; none for the compiled learner, whose tensors contain them."""
    return {} if training.learner_name == "compiled" else training.learner.optimiser.state_dict()["state"]


def _numpy(values: Tensor | np.ndarray) -> np.ndarray:
    return values.detach().cpu().numpy() if isinstance(values, Tensor) else values


def _like(stored: np.ndarray, present: Tensor | np.ndarray) -> Tensor | np.ndarray:
    """An array of the checkpoint as what it replaces. Raises ValueError if shape or type differ."""
    values = torch.from_numpy(stored) if isinstance(present, Tensor) else stored
    if values.shape != present.shape or values.dtype != present.dtype:
        raise ValueError(f"{tuple(values.shape)} {values.dtype} instead of {tuple(present.shape)} {present.dtype}")
    return values
