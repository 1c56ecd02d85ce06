"""The whole state of a training as named arrays: networks, optimiser, replay buffer, roads, generators, curves.

A training that is resumed from it gives the same results as an uninterrupted one. `runs.py` writes the files.
"""

import json

import numpy as np
import torch

from bootcourse.errors import BootcourseError
from bootcourse.learn.agent import Agent
from bootcourse.learn.training import Training


def state_of(training: Training) -> dict[str, np.ndarray]:
    """The state of a training as named arrays. Raises BootcourseError off the trap, where roads cannot be saved."""
    if not training.on_the_trap:
        raise BootcourseError("Only a training on the trap can be saved and resumed: let this one run to its end.")
    learner, replay, env, curves = training.learner, training.replay, training.env, training.curves
    arrays = {f"learner.{name}": tensor.detach().numpy() for name, tensor in _tensors(learner).items()}
    for i, parameter in enumerate(_parameters(learner)):
        for key, value in learner.optimiser.state.get(parameter, {}).items():
            arrays[f"optimiser.{i}.{key}"] = value.detach().numpy()
    filled = replay.first[:, None] + np.arange(replay.size)
    arrays["replay.own"] = replay.table[torch.from_numpy(filled.ravel())].numpy()
    arrays["replay.demonstrations"] = replay.table[: replay.demonstrations].numpy()
    arrays |= {"env.cars": env.cars, "env.decisions": env.decisions}
    arrays |= {f"curves.{name}": values for name, values in curves.values.items()}
    arrays |= {"curves.finished": curves.finished, "curves.running": curves.running}
    for i, agent in training.finished_agents.items():
        parts = [*agent.actor, *agent.critics, torch.tensor(agent.alpha, dtype=torch.float64)]
        arrays |= {f"finished.{i}.{k}": part.numpy() for k, part in enumerate(parts)}
    rngs = [*training.act_rngs, *training.sample_rngs, *env._generators]
    numbers = {
        "rngs": [rng.bit_generator.state for rng in rngs],
        "replay": [replay.size, replay.next],
        "decisions": training.decisions,
        "seconds": training.seconds,
        "finished": sorted(training.finished_agents),
        "stopped": sorted(training.stopped.items()),
    }
    return arrays | {"numbers": np.array(json.dumps(numbers))}


def restore(training: Training, arrays: dict[str, np.ndarray]) -> None:
    """Set a new `Training` with the same settings to a state. Raises BootcourseError if the arrays do not fit it."""
    try:
        _restore(training, arrays)
    except (KeyError, ValueError, IndexError, RuntimeError) as error:
        raise BootcourseError(
            f"This checkpoint does not fit the training's settings ({error}): start again in a new folder."
        ) from None


def _restore(training: Training, arrays: dict[str, np.ndarray]) -> None:
    learner, replay, env, curves = training.learner, training.replay, training.env, training.curves
    numbers = json.loads(str(arrays["numbers"]))
    with torch.no_grad():
        for name, tensor in _tensors(learner).items():
            tensor.copy_(torch.from_numpy(arrays[f"learner.{name}"]))
    for i, parameter in enumerate(_parameters(learner)):
        prefix = f"optimiser.{i}."
        state = {k.removeprefix(prefix): torch.from_numpy(v.copy()) for k, v in arrays.items() if k.startswith(prefix)}
        if state:
            learner.optimiser.state[parameter] = state
    replay.size, replay.next = numbers["replay"]
    replay.table[: replay.demonstrations] = torch.from_numpy(arrays["replay.demonstrations"])
    filled = replay.first[:, None] + np.arange(replay.size)
    replay.table[torch.from_numpy(filled.ravel())] = torch.from_numpy(arrays["replay.own"])
    env.cars[:], env.decisions[:] = arrays["env.cars"], arrays["env.decisions"]
    for name, values in curves.values.items():
        values[:] = arrays[f"curves.{name}"]
    curves.finished[:], curves.running[:] = arrays["curves.finished"], arrays["curves.running"]
    rngs = [*training.act_rngs, *training.sample_rngs, *env._generators]
    for rng, state in zip(rngs, numbers["rngs"], strict=True):
        rng.bit_generator.state = state
    training.decisions, training.seconds = numbers["decisions"], numbers["seconds"]
    training.stopped = dict(numbers["stopped"])
    layers = len(learner.actor)
    for i in numbers["finished"]:
        parts = [torch.from_numpy(arrays[f"finished.{i}.{k}"].copy()) for k in range(2 * layers + 1)]
        training.finished_agents[i] = Agent(
            training.settings[i], parts[:layers], parts[layers : 2 * layers], float(parts[-1])
        )
    training.states, training.rule_actions = env.observe(), training.taught()


def _parameters(learner) -> list[torch.Tensor]:
    return [parameter for group in learner.optimiser.param_groups for parameter in group["params"]]


def _tensors(learner) -> dict[str, torch.Tensor]:
    return {f"{name}.{i}": tensor for name, tensors in learner.tensors().items() for i, tensor in enumerate(tensors)}
