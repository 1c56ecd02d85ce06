"""The whole state of a training as named arrays: networks, optimiser, replay buffer, roads, generators, curves.

A training that is resumed from it gives the same results as an uninterrupted one. `runs.py` writes the files.
"""

import json
from dataclasses import replace
from typing import Annotated, Any, Literal

import numpy as np
import torch
from msgspec import Meta, MsgspecError, Struct, convert
from msgspec.structs import asdict

from bootcourse.errors import BootcourseError, RuleFailed
from bootcourse.learn.agent import Agent
from bootcourse.learn.settings import Settings
from bootcourse.learn.teachers import Rule
from bootcourse.learn.training import Training
from bootcourse.scenario import Scenario

ADAM = ("step", "exp_avg", "exp_avg_sq")  # the optimiser's state of each parameter


class DamagedCheckpoint(BootcourseError):
    """A checkpoint that cannot be read: the training must begin again."""


Count = Annotated[int, Meta(ge=0)]


class Numbers(Struct, forbid_unknown_fields=True):
    """What is not an array."""

    rngs: list[dict[str, Any]]  # checked by NumPy
    decisions: Count
    updates: Count
    seconds: Annotated[float, Meta(ge=0)]
    snapshots: dict[Literal["finished", "last_finite"], list[Count]]  # the agents that have one
    stopped: list[tuple[Count, Count]]  # (agent, the decision at which its loss was not finite)


def state_of(training: Training) -> dict[str, np.ndarray]:
    """The state of a training as named arrays. Raises BootcourseError off the trap, where roads cannot be saved."""
    if not training.on_the_trap:
        raise BootcourseError("Only a training on the trap can be saved and resumed: let this one run to its end.")
    learner, replay, env = training.learner, training.replay, training.env
    arrays = {f"learner.{name}": tensor.detach().cpu().numpy() for name, tensor in _tensors(learner).items()}
    for i, parameter in enumerate(_parameters(learner)):
        for name, values in learner.optimiser.state.get(parameter, {}).items():
            arrays[f"optimiser.{i}.{name}"] = values.detach().cpu().numpy()
    arrays |= {f"replay.{name}": values for name, values in replay.state().items()}
    arrays |= _driven(training)
    for name, agents in _snapshots(training).items():
        for i, agent in agents.items():
            parts = [*agent.actor, *agent.critics, torch.tensor(agent.alpha, dtype=torch.float64)]
            arrays |= {f"{name}.{i}.{k}": part.numpy() for k, part in enumerate(parts)}
    rngs = [*training.act_rngs, *training.sample_rngs, *env._generators]
    numbers = Numbers(
        rngs=[rng.bit_generator.state for rng in rngs],
        decisions=training.decisions,
        updates=training.updates,
        seconds=training.seconds,
        snapshots={name: sorted(agents) for name, agents in _snapshots(training).items()},
        stopped=sorted(training.stopped.items()),
    )
    return arrays | {"numbers": np.array(json.dumps(asdict(numbers)))}


def restored(
    settings: list[Settings], episodes: int, scenario: Scenario, teacher: Rule, arrays: dict, device: str = "cpu"
) -> Training:
    """The training with these arguments and the state in `arrays`.

    Raises DamagedCheckpoint if they do not fit, RuleFailed if the teacher fails in that state.
    """
    try:
        rows = torch.from_numpy(arrays["replay.demonstrations"])
        training = Training(settings, episodes, scenario, teacher, rows if len(rows) else None, device=device)
        _restore(training, arrays)
    except RuleFailed:
        raise
    except (KeyError, ValueError, TypeError, AttributeError, IndexError, RuntimeError, MsgspecError) as error:
        raise DamagedCheckpoint(f"the state does not fit the settings: {error}") from None
    return training


def _restore(training: Training, arrays: dict[str, np.ndarray]) -> None:
    learner, replay, env = training.learner, training.replay, training.env
    numbers = convert(json.loads(str(arrays["numbers"])), Numbers)
    with torch.no_grad():
        for name, tensor in _tensors(learner).items():
            tensor.copy_(_like(arrays[f"learner.{name}"], tensor))
    for i, parameter in enumerate(_parameters(learner)):
        state = {name: arrays[f"optimiser.{i}.{name}"] for name in ADAM if f"optimiser.{i}.{name}" in arrays}
        for name, values in state.items():
            like = parameter if name != "step" else torch.zeros(())
            learner.optimiser.state[parameter][name] = _like(values, like).clone().to(parameter.device)
    replay.restore({name.partition(".")[2]: each for name, each in arrays.items() if name.startswith("replay.")})
    for name, values in _driven(training).items():
        values[:] = _like(arrays[name], values)
    rngs = [*training.act_rngs, *training.sample_rngs, *env._generators]
    for rng, state in zip(rngs, numbers.rngs, strict=True):
        rng.bit_generator.state = state
    training.decisions, training.updates, training.seconds = numbers.decisions, numbers.updates, numbers.seconds
    training.stopped = dict(numbers.stopped)
    layers = len(learner.actor)
    for name, agents in _snapshots(training).items():
        for i in numbers.snapshots[name]:
            present = training.agent(i)
            like = [*present.actor, *present.critics]
            *parts, alpha = (arrays[f"{name}.{i}.{k}"] for k in range(2 * layers + 1))
            parts = [_like(part, each).clone() for part, each in zip(parts, like, strict=True)]
            agents[i] = replace(present, actor=parts[:layers], critics=parts[layers:], alpha=float(alpha))
    training.states, training.rule_actions = env.observe(), training.taught()


def _driven(training: Training) -> dict[str, np.ndarray]:
    """The arrays of the roads, the curves and, where a training has them, the restarts."""
    env, curves, restarts = training.env, training.curves, training.restarts
    arrays = {"env.cars": env.cars, "env.decisions": env.decisions}
    arrays |= {f"curves.{name}": values for name, values in curves.values.items()}
    arrays |= {"curves.finished": curves.finished, "curves.running": curves.running}
    if len(env.seen) > 1:
        arrays["env.seen"] = env.seen
    if restarts:
        arrays |= {"curves.restarted": curves.restarted, "curves.unrecorded": curves.unrecorded}
        arrays |= {f"restarts.{name}": values for name, values in restarts.arrays().items()}
    return arrays


def _snapshots(training: Training) -> dict[str, dict[int, Agent]]:
    return {"finished": training.finished_agents, "last_finite": training.last_finite}


def _like(stored: np.ndarray, present):
    """An array of the checkpoint as what it replaces, array or tensor. Raises ValueError if shape or type differ."""
    found = torch.from_numpy(stored) if isinstance(present, torch.Tensor) else stored
    if found.shape != present.shape or found.dtype != present.dtype:
        raise ValueError(f"{tuple(found.shape)} {found.dtype} instead of {tuple(present.shape)} {present.dtype}")
    return found


def _parameters(learner) -> list[torch.Tensor]:
    return [parameter for group in learner.optimiser.param_groups for parameter in group["params"]]


def _tensors(learner) -> dict[str, torch.Tensor]:
    return {f"{name}.{i}": tensor for name, tensors in learner.tensors().items() for i, tensor in enumerate(tensors)}
