"""Clones of a driver, and DAgger: what the lesson trains and tests."""

from collections.abc import Callable, Sequence
from functools import cache

import numpy as np
import torch
from torch import Tensor

from bootcourse.episodes.evaluate import Episodes, drive_episodes, held_out_seeds
from bootcourse.episodes.record import record
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
ACTION, TERMINATED, RULE_ACTION = 2 * SIZE, 2 * SIZE + 2, 2 * SIZE + 3  # columns of a transition


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


@cache
def rule_s_drives() -> Episodes:
    """The rule, where the clones are measured."""
    return drive_episodes(rule_policy(DEFAULT), held_out_seeds(6, 200))


def measure(agents: Sequence[Agent], rows: Tensor) -> np.ndarray:
    """Of each clone: agreement with its data, success, accidents (shares) and return on held-out roads, (clones, 4)."""
    scores, batch = [], decode_transitions(rows, SIZE, torch.zeros(len(rows)))
    for agent in agents:
        driven = drive_episodes(agent.as_policy(), held_out_seeds(6, 200))
        agrees = agent.probabilities(batch.states.numpy()).argmax(1) == batch.actions.numpy()
        scores.append((agrees.mean(), driven.success.mean(), (driven.accident > 0).mean(), driven.returns.mean()))
    return np.array(scores)


def compared(agents: Sequence[Agent], rows: Tensor) -> np.ndarray:
    """Of each clone: agreement with the rule in these rows and in its own states, accidents and return, (clones, 4)."""
    agreement, _, accidents, returns = measure(agents, rows).T
    return np.column_stack([agreement, [own_agreement(agent) for agent in agents], accidents, returns])


class RuleBetween:
    """A policy: the rule decides from one second to another, the clone before and after."""

    def __init__(self, agent: Agent, first: int, last: int):
        self.rule, self.clone, self.decided = rule_policy(DEFAULT), agent.as_policy(), 0
        self.first, self.last = first, last

    def reset(self, roads: int) -> None:
        """Begin anew."""
        self.decided = 0

    def __call__(self, observations: np.ndarray, cars: np.ndarray) -> PolicyOutput:
        driver = self.rule if self.first <= self.decided < self.last else self.clone
        self.decided += 1
        return PolicyOutput(driver(observations, cars).actions)


def with_the_rule(agents: Sequence[Agent], first: int, last: int) -> list[Rollout]:
    """All the clones' drives on 20 roads, in which the rule decides from one second to another."""
    return [each for agent in agents for each in record(RuleBetween(agent, first, last), range(20))]


def alone(agents: Sequence[Agent]) -> list[Rollout]:
    """All the clones' own drives on 60 roads."""
    return [each for agent in agents for each in record(agent.as_policy(), range(60))]


def unlike_the_rule(drives: Sequence[Rollout]) -> np.ndarray:
    """Where the driver differed from the rule: (drives, decisions of the longest), 1 or 0, NaN after a drive's end."""
    longest = max(len(each.actions) for each in drives)
    wrong = [(each.actions != each.rule_actions).astype(float) for each in drives]
    return np.array([np.pad(each, (0, longest - len(each)), constant_values=np.nan) for each in wrong])


def slow_seconds(drives: Sequence[Rollout]) -> float:
    """How many seconds of a drive the car is in the free lane at 9 m/s or less, on average, up to the drive's end."""
    cars = [each.states[:: each.scenario.clock.steps][: len(each.actions), EGO] for each in drives]
    return float(np.mean([((car[:, LANE] == 0) & (car[:, SPEED] < 9.5)).sum() for car in cars]))


def slowness(of_rule: Sequence[Rollout], of_clones: Sequence[Rollout]) -> str:
    """How long both are slow in the free lane, and how often the clones keep a speed that the rule would raise."""
    pairs = [(each.actions[10:40] // 3, each.rule_actions[10:40] // 3) for each in of_clones]
    kept = np.concatenate([(wanted == 2) & (did == 1) for did, wanted in pairs]).mean()
    seconds = f"the rule {slow_seconds(of_rule):.0f} s of a drive, the clones {slow_seconds(of_clones):.0f} s"
    return (
        f"In the free lane at 9 m/s or less: {seconds}.\n"
        f"From 10 to 40 s: in {100 * kept:.0f} % the rule would accelerate, and the clone keeps its speed."
    )


def unlike(agent: Agent, drives: Sequence[Rollout]) -> np.ndarray:
    """Where the clone would decide unlike the driver in these drives of equal length: (drives, decisions) bool."""
    return np.array([agent.probabilities(each.observations[:-1]).argmax(1) != each.actions for each in drives])


def own_agreement(agent: Agent, roads: int = 60) -> float:
    """The share of the clone's decisions, in its own drives on roads that no data have, that the rule would take."""
    rows = collect(roads, policy=agent.as_policy(), first_seed=0)
    return float((rows[:, ACTION] == rows[:, RULE_ACTION]).float().mean())


def trainer(loss: Callable[[Tensor, Tensor], Tensor], seed: int) -> Callable[[Tensor], Agent]:
    """train(rows): a clone with this seed, trained from the beginning."""
    return lambda rows: clone(rows, loss, seeds=1, first=seed)[0]


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
