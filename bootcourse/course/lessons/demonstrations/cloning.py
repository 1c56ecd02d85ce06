"""Clones of a driver, and DAgger: what the lesson trains and tests."""

from collections.abc import Callable, Sequence
from dataclasses import replace
from functools import cache
from itertools import islice

import numpy as np
import torch
from torch import Tensor, nn

from bootcourse.episodes.evaluate import Episodes, drive_episodes, held_out_seeds
from bootcourse.episodes.record import record
from bootcourse.episodes.rollout import Rollout
from bootcourse.learn.agent import Agent
from bootcourse.learn.bc import BCLearner, cloning_loss
from bootcourse.learn.demonstrations import collect
from bootcourse.learn.networks import mlp
from bootcourse.learn.replay_buffer import REWARD, Batch, decode_transitions
from bootcourse.learn.sac import log_policy
from bootcourse.learn.settings import Settings, settings_for
from bootcourse.policies import Policy, PolicyOutput, rule_policy
from bootcourse.road.state import EGO, LANE, SPEED
from bootcourse.scenario import DEFAULT

SIZE = DEFAULT.observation_size
ACTION, TERMINATED, RULE_ACTION = 2 * SIZE, 2 * SIZE + 2, 2 * SIZE + 3  # columns of a transition
UPDATES, ROADS = 1500, held_out_seeds(6, 100)  # of a clone's training, and where it is measured


class Cloner(BCLearner):
    """Clones, trained with the loss that is given: (batch, actions) and (batch,) -> a mean."""

    def __init__(self, settings: Sequence[Settings], loss: Callable[[Tensor, Tensor], Tensor]):
        super().__init__(settings, SIZE)
        self.loss = loss

    def losses(self, batch: Batch) -> dict[str, Tensor]:
        """The sum of all clones' losses, in one call: each has as many rows."""
        log_pi = log_policy(mlp(self.actor, batch.states))  # (clones, batch, 9)
        return {"actor_loss": self.agents * self.loss(log_pi.flatten(0, 1), self.labels(batch).flatten())}


def side_by_side(tables: Sequence[Tensor], seeds: Sequence[Sequence[int]], loss=cloning_loss) -> list[list[Agent]]:
    """For each table of transitions its clones, one for each of its seeds; all of them are trained together."""
    settings = [replace(settings_for("bc"), seed=seed) for of_one in seeds for seed in of_one]
    cloner, table = Cloner(settings, loss), torch.cat([*tables])
    clones, sizes = [len(of_one) for of_one in seeds], [len(rows) for rows in tables]
    first = np.repeat(np.cumsum([0, *sizes[:-1]]), clones)[:, None]  # of each clone's rows
    size, marks = np.repeat(sizes, clones)[:, None], torch.ones(len(settings), 64)
    generators = [np.random.default_rng(each.seed) for each in settings]
    for _ in range(UPDATES):
        draws = np.stack([generator.random(64) for generator in generators])  # for each clone 64 demonstrations
        rows = table[torch.from_numpy(first + (draws * size).astype(np.int64))]
        cloner.update(decode_transitions(rows, SIZE, marks))
    agents = (
        Agent(each, [layer.detach()[i : i + 1] for layer in cloner.actor], [], alpha=0.0)
        for i, each in enumerate(settings)
    )
    return [list(islice(agents, each)) for each in clones]


def clone(rows: Tensor, loss=cloning_loss, seed: int = 0) -> Agent:
    """A clone of what is in the rows (transitions, row), trained with this loss."""
    return side_by_side([rows], [[seed]], loss)[0][0]


def clones(data: dict[str, Tensor], loss=cloning_loss, seeds: Sequence[int] = range(8)) -> dict[str, list[Agent]]:
    """Clones of each data set, by its name, with these seeds."""
    return dict(zip(data, side_by_side([*data.values()], [seeds] * len(data), loss), strict=True))


@cache
def rule_s_drives() -> Episodes:
    """The rule, where the clones are measured."""
    return drive_episodes(rule_policy(DEFAULT), ROADS)


def all_at_once(agents: Sequence[Agent]) -> Policy:
    """A policy on as many equal parts of the roads as there are clones: each drives on its own part."""
    actor = [torch.cat(layers) for layers in zip(*(agent.actor for agent in agents), strict=True)]

    @torch.no_grad()
    def drive(observations: np.ndarray, cars: np.ndarray) -> PolicyOutput:
        states = torch.from_numpy(observations).view(len(agents), -1, SIZE)
        return PolicyOutput(mlp(actor, states).argmax(-1).flatten().numpy())

    return drive


def measure(agents: Sequence[Agent], rows: Tensor) -> np.ndarray:
    """Of each clone: agreement with its data, success, accidents (shares) and return on held-out roads, (clones, 4)."""
    roads = [*ROADS] * len(agents)
    driven = drive_episodes(all_at_once(agents), roads, together=len(roads))
    states, actions = rows[:, :SIZE].numpy(), rows[:, ACTION].numpy()
    agreement = [(agent.probabilities(states).argmax(1) == actions).mean() for agent in agents]
    scores = driven.success, driven.accident > 0, driven.returns
    return np.column_stack([agreement, *(each.reshape(len(agents), -1).mean(1) for each in scores)])


def compared(agents: Sequence[Agent], rows: Tensor) -> np.ndarray:
    """Of each clone: agreement with the rule in these rows and in its own states, accidents and return, (clones, 4)."""
    return np.array([_compared(agent, rows) for agent in agents])


def _compared(agent: Agent, rows: Tensor) -> tuple[float, ...]:
    own = collect(len(ROADS), policy=agent.as_policy(), first_seed=ROADS[0])
    agrees = agent.probabilities(rows[:, :SIZE].numpy()).argmax(1) == rows[:, RULE_ACTION].numpy()
    in_its_own = (own[:, ACTION] == own[:, RULE_ACTION]).float().mean()
    accidents, returns = own[:, TERMINATED].sum() / len(ROADS), own[:, REWARD].sum() / len(ROADS)
    return agrees.mean(), float(in_its_own), float(accidents), float(returns)


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
