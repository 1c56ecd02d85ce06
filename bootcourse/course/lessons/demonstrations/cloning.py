"""Clones of a driver, and DAgger: what the lesson trains and tests."""

from collections.abc import Callable, Sequence

import numpy as np
import torch
from torch import Tensor

from bootcourse.episodes.evaluate import drive_episodes, held_out_seeds
from bootcourse.learn.agent import Agent
from bootcourse.learn.demonstrations import collect
from bootcourse.learn.learner import learner_for
from bootcourse.learn.replay_buffer import ReplayBuffer, decode_transitions
from bootcourse.learn.settings import settings_for, with_seeds
from bootcourse.scenario import DEFAULT

SIZE = DEFAULT.observation_size
ACTION, RULE_ACTION = 2 * SIZE, 2 * SIZE + 3  # columns of a transition


def clone(rows: Tensor, updates: int = 1500, seeds: int = 4, first: int = 0) -> list[Agent]:
    """Clones of what is in the rows (transitions, row), one for each seed."""
    settings = with_seeds(settings_for("bc"), seeds, first)
    cloner, replay = learner_for(settings, SIZE), ReplayBuffer(seeds, 64, SIZE, rows)
    generators = [np.random.default_rng(each.seed) for each in settings]
    for _ in range(updates):
        cloner.update(replay.sample(64, np.ones(seeds), generators))  # 64 rows, all of them demonstrations
    weights = [[layer.detach()[i : i + 1] for layer in cloner.actor] for i in range(seeds)]
    return [Agent(s, actor, [], alpha=0.0) for s, actor in zip(settings, weights, strict=True)]


def measure(agents: Sequence[Agent], rows: Tensor, roads: int = 200) -> np.ndarray:
    """Of each clone: agreement with its data, success and accidents on held-out roads, (clones, 3) shares."""
    scores, batch = [], decode_transitions(rows, SIZE, torch.zeros(len(rows)))
    for agent in agents:
        agrees = agent.probabilities(batch.states.numpy()).argmax(1) == batch.actions.numpy()
        driven = drive_episodes(agent.as_policy(), held_out_seeds(6, roads))
        scores.append((agrees.mean(), driven.success.mean(), (driven.accident > 0).mean()))
    return np.array(scores)


def own_drives(episodes: int) -> Callable[[Agent], Tensor]:
    """drive(agent): transitions of that many episodes of its own, each time on the same roads."""
    return lambda agent: collect(episodes, policy=agent.as_policy())


def dagger(rows, train, drive, rounds):
    """rounds + 1 drivers, each trained on all transitions so far: the rule's rows, then its own drives, relabelled.

    train(rows) gives a driver, drive(driver) the transitions of its drives. Column ACTION of a transition is what was
    done, RULE_ACTION what the rule would have done there.
    """
    drivers = [train(rows)]
    for _ in range(rounds):
        own = drive(drivers[-1]).clone()
        own[:, ACTION] = own[:, RULE_ACTION]
        rows = torch.cat([rows, own])
        drivers.append(train(rows))
    return drivers
