"""A training in progress as one file: networks, optimiser, replay buffer, roads, generators, curves.

A training that is resumed from it gives the same results as an uninterrupted one.
"""

import json
from dataclasses import asdict, replace
from pathlib import Path
from typing import Annotated, Any, ClassVar, Literal

import numpy as np
import torch
from msgspec import Meta, MsgspecError, Struct

from bootcourse.errors import BootcourseError, RuleFailed
from bootcourse.files import decoding, parse, read_arrays, write_arrays
from bootcourse.learn.agent import Agent
from bootcourse.learn.learner import learner_for
from bootcourse.learn.protocol import Learner
from bootcourse.learn.settings import stored_settings
from bootcourse.learn.teachers import Rule, course_rule, teacher_name
from bootcourse.learn.training import Training, device_named
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
    scenario: dict[str, Any]  # checked by `Scenario`
    episodes: Annotated[int, Meta(ge=1)]
    teacher: str
    rngs: list[dict[str, Any]]  # checked by NumPy
    decisions: Count
    updates: Count
    seconds: Annotated[float, Meta(ge=0)]
    snapshots: dict[Literal["finished", "last_finite"], list[Count]]  # the agents that have one
    stopped: list[tuple[Count, Count]]  # (agent, the decision at which its loss was not finite)


def save_checkpoint(training: Training, path: Path) -> None:
    """Write a training in progress to one file.

    Raises BootcourseError off the trap, for a learner of your own, which no file can hold, or if it cannot be written.
    """
    if not training.on_the_trap:
        raise BootcourseError("Only a training on the trap can be saved and resumed: let this one run to its end.")
    if training.make_learner is not learner_for:
        raise BootcourseError("A training with a learner of your own cannot be saved: let this one run to its end.")
    header = {
        "format": Header.FORMAT,
        "settings": [asdict(settings) for settings in training.settings],
        "scenario": json.loads(training.scenario.to_json()),
        "episodes": training.episodes,
        "teacher": teacher_name(training.teacher),
        "rngs": [rng.bit_generator.state for rng in _generators(training)],
        "decisions": training.decisions,
        "updates": training.updates,
        "seconds": training.seconds,
        "snapshots": {name: sorted(agents) for name, agents in _snapshots(training).items()},
        "stopped": sorted(training.stopped.items()),
    }
    write_arrays(path, {**state_of(training), "header": np.array(json.dumps(header))}, compress=False)


def load_checkpoint(path: Path, teacher: Rule = course_rule, device: str = "cpu") -> Training:
    """The training that `save_checkpoint` wrote, to be continued with the same teacher, on any device.

    Raises DamagedCheckpoint if the file cannot be read, BootcourseError for another teacher, for a method that is not
    known here, for a device that torch does not find, and, as RuleFailed, for a teacher that fails.
    """
    device_named(device)
    try:
        arrays = read_arrays(path, BEGIN_AGAIN)
        with decoding(path, BEGIN_AGAIN):
            header = parse(str(arrays.pop("header")), Header, path, BEGIN_AGAIN)
            unknown = sorted({str(stored.get("method")) for stored in header.settings} - METHODS.keys())
            if teacher_name(teacher) == header.teacher and not unknown:
                return _restored(header, arrays, teacher, device)
    except RuleFailed:
        raise
    except BootcourseError as error:
        raise DamagedCheckpoint(str(error)) from None
    if unknown:
        raise BootcourseError(f"{path} learns with {unknown[0]!r:.80}: add the --learner FILE.py:CLASS it began with.")
    raise BootcourseError(
        f"{path} began with the teacher '{header.teacher}', not '{teacher_name(teacher)}': give the same teacher."
    )


def state_of(training: Training) -> dict[str, np.ndarray]:
    """The arrays of a checkpoint."""
    arrays = {f"learner.{name}": _numpy(tensor) for name, tensor in _tensors(training.learner).items()}
    for i, parameter in enumerate(_parameters(training.learner)):
        for name, values in training.learner.optimiser.state.get(parameter, {}).items():
            arrays[f"optimiser.{i}.{name}"] = _numpy(values)
    arrays |= {f"replay.{name}": values for name, values in training.replay.state().items()}
    arrays |= _driven(training)
    for name, agents in _snapshots(training).items():
        for i, agent in agents.items():
            parts = [*agent.actor, *agent.critics, torch.tensor(agent.alpha, dtype=torch.float64)]
            arrays |= {f"{name}.{i}.{k}": part.numpy() for k, part in enumerate(parts)}
    return arrays


def _restored(header: Header, arrays: dict[str, np.ndarray], teacher: Rule, device: str) -> Training:
    settings = [stored_settings(stored) for stored in header.settings]
    scenario = Scenario.from_json(json.dumps(header.scenario))
    try:
        rows = torch.from_numpy(arrays["replay.demonstrations"])
        training = Training(settings, header.episodes, scenario, teacher, rows if len(rows) else None, device=device)
        _restore(training, header, arrays)
    except RuleFailed:
        raise
    except (KeyError, ValueError, TypeError, AttributeError, IndexError, RuntimeError, MsgspecError) as error:
        raise DamagedCheckpoint(f"the state does not fit the settings: {error}") from None
    return training


def _restore(training: Training, header: Header, arrays: dict[str, np.ndarray]) -> None:
    learner = training.learner
    with torch.no_grad():
        for name, tensor in _tensors(learner).items():
            tensor.copy_(_like(arrays[f"learner.{name}"], tensor))
    for i, parameter in enumerate(_parameters(learner)):
        for name in ("step", "exp_avg", "exp_avg_sq"):  # Adam's
            if f"optimiser.{i}.{name}" in arrays:
                like = parameter if name != "step" else torch.zeros(())
                values = _like(arrays[f"optimiser.{i}.{name}"], like).clone()
                learner.optimiser.state[parameter][name] = values.to(parameter.device)
    replay = {name.partition(".")[2]: values for name, values in arrays.items() if name.startswith("replay.")}
    training.replay.restore(replay)
    for name, values in _driven(training).items():
        values[:] = _like(arrays[name], values)
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


def _driven(training: Training) -> dict[str, np.ndarray]:
    """The arrays of the roads and the curves."""
    env, curves = training.env, training.curves
    arrays = {"env.cars": env.cars, "env.decisions": env.decisions}
    arrays |= {f"curves.{name}": values for name, values in curves.values.items()}
    return arrays | {"curves.finished": curves.finished, "curves.running": curves.running}


def _snapshots(training: Training) -> dict[str, dict[int, Agent]]:
    return {"finished": training.finished_agents, "last_finite": training.last_finite}


def _generators(training: Training) -> list[np.random.Generator]:
    return [*training.act_rngs, *training.sample_rngs, *training.env._generators]


def _parameters(learner: Learner) -> list[torch.Tensor]:
    return [parameter for group in learner.optimiser.param_groups for parameter in group["params"]]


def _tensors(learner: Learner) -> dict[str, torch.Tensor]:
    return {f"{name}.{i}": tensor for name, tensors in learner.tensors().items() for i, tensor in enumerate(tensors)}


def _numpy(tensor: torch.Tensor) -> np.ndarray:
    return tensor.detach().cpu().numpy()


def _like(stored: np.ndarray, present):
    """An array of the checkpoint as what it replaces, array or tensor. Raises ValueError if shape or type differ."""
    values = torch.from_numpy(stored) if isinstance(present, torch.Tensor) else stored
    if values.shape != present.shape or values.dtype != present.dtype:
        raise ValueError(f"{tuple(values.shape)} {values.dtype} instead of {tuple(present.shape)} {present.dtype}")
    return values
