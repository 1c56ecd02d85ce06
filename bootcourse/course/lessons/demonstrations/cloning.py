"""Clones of a driver, and DAgger: what the lesson trains and tests."""

from collections.abc import Callable, Sequence

import numpy as np
import torch
from torch import Tensor

from bootcourse.episodes.evaluate import Episodes, drive_episodes, held_out_seeds
from bootcourse.episodes.rollout import Rollout
from bootcourse.learn.agent import Agent
from bootcourse.learn.bc import BCLearner, cloning_loss
from bootcourse.learn.demonstrations import collect
from bootcourse.learn.networks import mlp
from bootcourse.learn.replay_buffer import Batch, ReplayBuffer, decode_transitions
from bootcourse.learn.sac import log_policy
from bootcourse.learn.settings import Settings, settings_for, with_seeds
from bootcourse.policies import PolicyOutput, rule_policy
from bootcourse.road.state import EGO, LANE, SPEED
from bootcourse.scenario import DEFAULT

SIZE = DEFAULT.observation_size
ACTION, RULE_ACTION = 2 * SIZE, 2 * SIZE + 3  # columns of a transition


class Cloner(BCLearner):
    """Clones, trained with the loss that is given: (batch, actions) and (batch,) -> a mean."""

    def __init__(self, settings: Sequence[Settings], loss: Callable[[Tensor, Tensor], Tensor]):
        super().__init__(settings, SIZE)
        self.loss = loss

    def losses(self, batch: Batch) -> dict[str, Tensor]:
        """The sum of all clones' losses, in one call: each has as many rows."""
        log_pi = log_policy(mlp(self.actor, batch.states))  # (clones, batch, 9)
        return {"actor_loss": self.agents * self.loss(log_pi.flatten(0, 1), self.labels(batch).flatten())}


def clone(rows: Tensor, loss=cloning_loss, seeds: int = 12, updates: int = 1500, first: int = 0) -> list[Agent]:
    """Clones of what is in the rows (transitions, row), one for each seed, trained with this loss."""
    settings = with_seeds(settings_for("bc"), seeds, first)
    cloner, replay = Cloner(settings, loss), ReplayBuffer(seeds, 64, SIZE, rows)
    generators = [np.random.default_rng(each.seed) for each in settings]
    for _ in range(updates):
        cloner.update(replay.sample(64, np.ones(seeds), generators))  # for each clone 64 demonstrations
    weights = [[layer.detach()[i : i + 1] for layer in cloner.actor] for i in range(seeds)]
    return [Agent(s, actor, [], alpha=0.0) for s, actor in zip(settings, weights, strict=True)]


def tested(agents: Sequence[Agent], roads: int = 200) -> list[Episodes]:
    """Each clone's drives on held-out roads."""
    return [drive_episodes(agent.as_policy(), held_out_seeds(6, roads)) for agent in agents]


def measure(agents: Sequence[Agent], rows: Tensor, drives: Sequence[Episodes] | None = None) -> np.ndarray:
    """Of each clone: agreement with its data, success, accidents (shares) and return on held-out roads, (clones, 4)."""
    scores, batch = [], decode_transitions(rows, SIZE, torch.zeros(len(rows)))
    for agent, driven in zip(agents, drives or tested(agents), strict=True):
        agrees = agent.probabilities(batch.states.numpy()).argmax(1) == batch.actions.numpy()
        scores.append((agrees.mean(), driven.success.mean(), (driven.accident > 0).mean(), driven.returns.mean()))
    return np.array(scores)


def danger(drives: Sequence[Episodes], start: float, end: float) -> tuple[float, float]:
    """Of all accidents the share in these seconds, and the risk of one in a second that is driven there."""
    lasted, crashed = np.hstack([_lasted(each) for each in drives]), np.hstack([each.accident > 0 for each in drives])
    there = np.sum(crashed & (lasted > start) & (lasted <= end))
    return there / crashed.sum(), there / np.clip(lasted - start, 0, end - start).sum()


def typical_accidents(drives: Sequence[Episodes]) -> list[float]:
    """When (s) the median accident of each clone happens, in order; without the clones that have none."""
    return sorted(float(np.median(_lasted(each)[each.accident > 0])) for each in drives if (each.accident > 0).any())


def _lasted(drives: Episodes) -> np.ndarray:
    """How long each drive was (s): the way over the mean speed."""
    return np.round(drives.distance / drives.speed, 1)


class RuleFirst:
    """A policy: the rule decides in so many first seconds, then the clone."""

    def __init__(self, agent: Agent, seconds: int):
        self.rule, self.clone, self.seconds, self.decided = rule_policy(DEFAULT), agent.as_policy(), seconds, 0

    def reset(self, roads: int) -> None:
        """Begin anew."""
        self.decided = 0

    def __call__(self, observations: np.ndarray, cars: np.ndarray) -> PolicyOutput:
        driver = self.rule if self.decided < self.seconds else self.clone
        self.decided += 1
        return PolicyOutput(driver(observations, cars).actions)


def slow(drives: Sequence[Rollout]) -> np.ndarray:
    """In which seconds the car is in the free lane at 9 m/s or less: (drives, decisions) bool, drives of one length."""
    cars = np.array([each.states[: -1 : each.scenario.clock.steps, EGO] for each in drives])
    return (cars[:, :, LANE] == 0) & (cars[:, :, SPEED] < 9.5)


def unlike(agent: Agent, drives: Sequence[Rollout]) -> np.ndarray:
    """Where the clone would decide unlike the driver in these drives of equal length: (drives, decisions) bool."""
    return np.array([agent.probabilities(each.observations[:-1]).argmax(1) != each.actions for each in drives])


def own_agreement(agent: Agent, roads: int = 60) -> float:
    """The share of the clone's decisions, in its own drives on roads that no data have, that the rule would take."""
    rows = collect(roads, policy=agent.as_policy(), first_seed=0)
    return float((rows[:, ACTION] == rows[:, RULE_ACTION]).float().mean())


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
