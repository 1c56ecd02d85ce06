"""Each method, in one short training with a seed: its numbers, its files, and how it goes on after a stop.

`python -m tests.test_behaviour` writes the numbers of today to behaviour.json. The tolerance is for other processors,
whose rounding differs; a sign that is flipped in a loss is far outside it.
"""

import json
from functools import cache
from pathlib import Path

import numpy as np
import pytest
import torch

from bootcourse.episodes.evaluate import evaluate
from bootcourse.episodes.record import record
from bootcourse.learn.agent import Agent
from bootcourse.learn.settings import Settings, settings_for, with_seeds
from bootcourse.learn.training import Training
from bootcourse.methods import METHODS
from bootcourse.storage.checkpoint import load_checkpoint, save_checkpoint
from bootcourse.storage.runs import load_run, save_runs

EXPECTED = Path(__file__).with_name("behaviour.json")
TOLERANCE = 2e-3
FAST = {"hidden": (16,), "demonstration_episodes": 2, "batch": 16, "learning_starts": 16, "actor_lr": 5e-3,
        "critic_lr": 5e-3, "alpha_lr": 5e-3}  # fmt: skip
OWN = {  # what changes within a few decisions
    "jsrl": {"guide_decisions": 6, "stages": 2, "window": 2},
    "ppo": {"envs_per_agent": 4, "horizon": 8, "epochs": 2, "anneal_decisions": 500},
    "ppo_cloned": {"envs_per_agent": 4, "horizon": 8, "epochs": 2, "cloning_updates": 20},
}
BEFORE, AFTER = 45, 15  # decisions on each road, before a stop (of PPO in the middle of a round) and after it


def two(method: str) -> list[Settings]:
    return with_seeds(settings_for(method, **FAST, **OWN.get(method, {})), 2)


def trained(method: str, checkpoint: Path | None = None) -> Training:
    training = Training(two(method), 1000)
    for decision in range(BEFORE + AFTER):
        if decision == BEFORE and checkpoint:
            save_checkpoint(training, checkpoint)
        training.step()
    return training


@cache
def once(method: str, folder: Path) -> Training:
    """The training of a method, with a checkpoint in the folder: the tests of a method share it."""
    return trained(method, folder / f"{method}.npz")


@pytest.fixture(scope="module")
def folder(tmp_path_factory) -> Path:
    return tmp_path_factory.mktemp("behaviour")


def numbers(agent: Agent) -> list[float]:
    """What an agent does in 64 states: the mean of π(a|s) and of Q(s, a), and log α."""
    states = np.random.default_rng(0).normal(size=(64, 26)).astype(np.float32)
    means = [agent.probabilities(states, np.arange(64) % 9).mean(0)]
    if agent.critics:
        means += [agent.q_values(states).mean(0), [np.log(agent.alpha)]]
    return [float(number) for number in np.concatenate(means)]


def alike(method: str, training: Training) -> bool:
    actual, expected = numbers(training.agent(1)), json.loads(EXPECTED.read_text())[method]
    return np.allclose(actual, expected, rtol=TOLERANCE, atol=TOLERANCE)


def weights(agent: Agent) -> list[torch.Tensor]:
    return [*agent.actor, *agent.critics]


def test_every_method_has_its_numbers():
    assert set(json.loads(EXPECTED.read_text())) == set(METHODS)


@pytest.mark.parametrize("method", METHODS)
def test_a_method_does_what_it_did(method, folder):
    assert alike(method, once(method, folder)), numbers(once(method, folder).agent(1))


@pytest.mark.parametrize("method", METHODS)
def test_a_training_that_was_stopped_goes_on_as_if_it_never_was(method, folder):
    whole = once(method, folder)
    resumed = load_checkpoint(folder / f"{method}.npz")
    for _ in range(AFTER):
        resumed.step()
    for i in range(2):
        pairs = zip(weights(whole.agent(i)), weights(resumed.agent(i)), strict=True)
        assert all(torch.equal(one, other) for one, other in pairs)
    for name, values in whole.curves.values.items():
        np.testing.assert_array_equal(values, resumed.curves.values[name], err_msg=name)


@pytest.mark.parametrize("method", METHODS)
def test_an_agent_is_read_back_as_it_was_saved_and_drives(method, folder, tmp_path):
    result = once(method, folder).result()
    agent, run = result.agents[1], load_run(save_runs(result, tmp_path)[1])
    back = run.agent
    np.testing.assert_array_equal(run.curves["return"], result.curves["return"][1])
    assert run.scenario == result.scenario and run.provenance["seed"] == 1
    assert back.settings == agent.settings and type(back.settings) is type(agent.settings)
    assert all(torch.equal(one, other) for one, other in zip(weights(back), weights(agent), strict=True))
    assert evaluate(back.as_policy(), 3) == evaluate(agent.as_policy(), 3)


@pytest.mark.parametrize("method", ["bc", "dagger", "ppo"])
def test_a_drive_of_a_method_without_critics_has_no_q(method, folder):
    agent = once(method, folder).agent(0)
    drive = record(agent.as_policy(with_q=True), [3])[0]
    assert agent.q_values(drive.observations) is None and drive.q_values is None and drive.policy is not None


if __name__ == "__main__":
    actual = {method: [round(number, 5) for number in numbers(trained(method).agent(1))] for method in METHODS}
    EXPECTED.write_text(json.dumps(actual) + "\n")
