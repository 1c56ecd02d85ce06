"""Clones of a driver, and DAgger: what the lesson trains and tests."""

from collections.abc import Callable, Sequence
from dataclasses import replace
from itertools import islice

import numpy as np
import torch
from torch import Tensor, nn

from bootcourse.episodes.evaluate import held_out_seeds
from bootcourse.episodes.record import record
from bootcourse.episodes.rollout import Rollout
from bootcourse.learn.agent import Agent
from bootcourse.learn.bc import BCLearner, cloning_loss
from bootcourse.learn.demonstrations import collect, demonstrate
from bootcourse.learn.networks import mlp
from bootcourse.learn.sac import log_policy
from bootcourse.learn.settings import settings_for
from bootcourse.policies import Policy, PolicyOutput
from bootcourse.road.state import EGO, LANE, SPEED
from bootcourse.scenario import DEFAULT

SIZE = DEFAULT.observation_size
ACTION, RULE_ACTION = 2 * SIZE, 2 * SIZE + 3  # columns of a transition
UPDATES, ROADS = 1500, held_out_seeds(6, 100)  # of a clone's training, and where it is measured


def side_by_side(tables: Sequence[Tensor], seeds: Sequence[Sequence[int]], loss=cloning_loss) -> list[list[Agent]]:
    """For each table of transitions its clones, one for each of its seeds; all of them are trained together."""
    settings = [replace(settings_for("bc"), seed=seed) for of_one in seeds for seed in of_one]
    learner, table = BCLearner(settings, SIZE), torch.cat([*tables])
    states, actions = table[:, :SIZE], table[:, ACTION].long()
    clones, sizes = [len(of_one) for of_one in seeds], [len(rows) for rows in tables]
    first = np.repeat(np.cumsum([0, *sizes[:-1]]), clones)[:, None]  # of each clone's rows
    draws = np.stack([np.random.default_rng(each.seed).random((UPDATES, 64)) for each in settings], axis=1)
    rows = first + (draws * np.repeat(sizes, clones)[:, None]).astype(np.int64)  # (updates, clones, 64)
    for batch in torch.from_numpy(rows):
        log_pi = log_policy(mlp(learner.actor, states[batch]))  # (clones, 64, 9)
        learner.optimiser.zero_grad()
        (len(settings) * loss(log_pi.flatten(0, 1), actions[batch].flatten())).backward()  # the sum of all clones'
        learner.optimiser.step()
    agents = (
        Agent(each, [layer.detach()[i : i + 1] for layer in learner.actor], [], alpha=0.0)
        for i, each in enumerate(settings)
    )
    return [list(islice(agents, each)) for each in clones]


def clones(data: dict[str, Tensor], loss=cloning_loss, seeds: Sequence[int] = range(5)) -> dict[str, list[Agent]]:
    """Clones of each data set, by its name, with these seeds."""
    return dict(zip(data, side_by_side([*data.values()], [seeds] * len(data), loss), strict=True))


def all_at_once(agents: Sequence[Agent]) -> Policy:
    """A policy on as many equal parts of the roads as there are clones: each drives on its own part."""
    actor = [torch.cat(layers) for layers in zip(*(agent.actor for agent in agents), strict=True)]

    @torch.no_grad()
    def drive(observations: np.ndarray, cars: np.ndarray) -> PolicyOutput:
        states = torch.from_numpy(observations).view(len(agents), -1, SIZE)
        return PolicyOutput(mlp(actor, states).argmax(-1).flatten().numpy())

    return drive


def measure(agents: Sequence[Agent], rows: Tensor) -> np.ndarray:
    """Of each clone: agreement with the actions in these rows, and with the rule in its own states, accidents (all of
    them shares) and return on held-out roads, (clones, 4).
    """
    states, actions = rows[:, :SIZE].numpy(), rows[:, ACTION].numpy()
    driven = demonstrate(len(ROADS) * len(agents), policy=all_at_once(agents), first_seed=ROADS[0])
    found = []
    for k, agent in enumerate(agents):
        first, *_, last = driven.drives[k * len(ROADS) : (k + 1) * len(ROADS)]
        own = slice(first.start, last.stop)
        agrees = (agent.probabilities(states).argmax(1) == actions).mean()
        in_its_own = (driven.actions[own] == driven.rule_actions[own]).mean()
        ended, paid = driven.terminated[own].sum() / len(ROADS), driven.rewards[own].sum() / len(ROADS)
        found.append((agrees, in_its_own, ended, paid))
    return np.array(found)


def alone(agents: Sequence[Agent]) -> list[Rollout]:
    """All the clones' own drives, each on the same 20 roads."""
    return record(all_at_once(agents), [*range(20)] * len(agents))


def unlike_the_rule(drives: Sequence[Rollout]) -> np.ndarray:
    """Where the driver differed from the rule: (drives, decisions of the longest), 1 or 0, NaN after a drive's end."""
    longest = max(len(each.actions) for each in drives)
    wrong = [(each.actions != each.rule_actions).astype(float) for each in drives]
    return np.array([np.pad(each, (0, longest - len(each)), constant_values=np.nan) for each in wrong])


def slow(drives: Sequence[Rollout]) -> tuple[float, float]:
    """How many seconds of a drive the car is in the free lane at 9 m/s or less, on average, up to the drive's end; and
    in what share of these seconds its driver differs from the rule.
    """
    cars = [each.states[:: each.scenario.clock.steps][: len(each.actions), EGO] for each in drives]
    is_slow = [(car[:, LANE] == 0) & (car[:, SPEED] < 9.5) for car in cars]
    wrong = [(each.actions != each.rule_actions)[some] for each, some in zip(drives, is_slow, strict=True)]
    return sum(map(np.sum, is_slow)) / len(drives), float(np.concatenate(wrong).mean())


def slowness(of_rule: Sequence[Rollout], of_clones: Sequence[Rollout]) -> str:
    """A sentence: how long both are slow in the free lane, and how often the clones err there."""
    (rule, _), (clones, wrong) = slow(of_rule), slow(of_clones)
    return (
        f"In the free lane at 9 m/s or less: the rule {rule:.0f} s of a drive, the clones {clones:.0f} s.\n"
        f"In {100 * wrong:.0f} % of these seconds the clones err."
    )


def unlike(agent: Agent, drives: Sequence[Rollout]) -> np.ndarray:
    """Where the clone would decide unlike the driver in these drives of equal length: (drives, decisions) bool."""
    return np.array([agent.probabilities(each.observations[:-1]).argmax(1) != each.actions for each in drives])


class Trainings:
    """Trainings with DAgger side by side, one for each seed: one more column of a row says to which it belongs."""

    def __init__(self, loss: Callable[[Tensor, Tensor], Tensor], seeds: Sequence[int], episodes: int = 20):
        self.loss, self.seeds, self.episodes = loss, seeds, episodes

    def rows(self, tables: Sequence[Tensor]) -> Tensor:
        """One table of all trainings' rows."""
        return torch.cat([nn.functional.pad(table, (0, 1), value=k) for k, table in enumerate(tables)])

    def begin(self, rows: Tensor) -> Tensor:
        """Each training has the same rows in the beginning."""
        return self.rows([rows] * len(self.seeds))

    def train(self, rows: Tensor) -> list[Agent]:
        """A clone for each training, of its own rows, trained from the beginning."""
        tables = [rows[rows[:, -1] == k, :-1] for k in range(len(self.seeds))]
        return [agents[0] for agents in side_by_side(tables, [[seed] for seed in self.seeds], self.loss)]

    def drive(self, agents: Sequence[Agent]) -> Tensor:
        """Transitions of each clone's own drives, each time on the same roads."""
        return self.rows([collect(self.episodes, policy=agent.as_policy()) for agent in agents])


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
