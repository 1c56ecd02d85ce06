"""Clones of a driver, and DAgger: what the lesson trains and tests."""

from collections import Counter
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
from bootcourse.road.observation import Y_SCALE
from bootcourse.road.state import EGO, Accident, Y
from bootcourse.scenario import ACTION_NAMES, DEFAULT

SIZE = DEFAULT.observation_size
ACTION, RULE_ACTION = 2 * SIZE, 2 * SIZE + 3  # columns of a transition
OF_Y = 2  # the column with the car's place across the road
UPDATES, ROADS = 1500, held_out_seeds(6, 100)  # of a clone's training, and where it is measured
ADDED = {"anywhere else": "others", "at the band's rim": "near the edge", "beyond the band": "from the edge"}
# kinds of rows to add, and what the clones of the rule's drives with them are called where they ship


def side_by_side(tables: Sequence[Tensor], seeds: Sequence[Sequence[int]], loss=cloning_loss) -> list[list[Agent]]:
    """For each table of transitions its clones, one for each of its seeds; all of them are trained together."""
    settings = [replace(settings_for("bc"), seed=seed) for of_one in seeds for seed in of_one]
    learner, table = BCLearner(settings, SIZE), torch.cat([*tables])
    states, actions = table[:, :SIZE].contiguous(), table[:, ACTION].long()
    clones, sizes = [len(of_one) for of_one in seeds], [len(rows) for rows in tables]
    first = np.repeat(np.cumsum([0, *sizes[:-1]]), clones)[:, None]  # of each clone's rows
    draws = np.stack([np.random.default_rng(each.seed).random((UPDATES, 64)) for each in settings], axis=1)
    rows = first + (draws * np.repeat(sizes, clones)[:, None]).astype(np.int64)  # (updates, clones, 64)
    for batch in torch.from_numpy(rows):
        drawn = states.index_select(0, batch.flatten()).view(*batch.shape, SIZE)  # faster than states[batch]
        log_pi = log_policy(mlp(learner.actor, drawn))  # (clones, 64, 9)
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


def get_out(agents: Sequence[Agent], roads: int = 40) -> str:
    """In which share of the clones' drives, each on so many of the held-out roads, the car ends ahead of the traps."""
    drives = record(all_at_once(agents), [*ROADS[:roads]] * len(agents))
    return f"{100 * np.mean([drive.success for drive in drives]):.0f} %"


def alone(agents: Sequence[Agent]) -> list[Rollout]:
    """All the clones' own drives, each on the 60 roads of the two demonstrators."""
    return record(all_at_once(agents), [*range(60)] * len(agents))


def accidents(drives: Sequence[Rollout]) -> str:
    """How many of the drives end in an accident, in which, and how many decisions are errors."""
    ended = Counter(Accident(each.accident) for each in drives if each.accident)
    left = sum(off_on_the_left(each) for each in drives)
    kinds = {
        "off the left edge": left,
        "off the right edge": ended[Accident.ROAD_DEPARTURE] - left,
        "stopped": ended[Accident.STOPPAGE],
        "into another car": ended[Accident.COLLISION],
    }
    said = ", ".join(f"{count} {kind}" for kind, count in kinds.items() if count)
    wrong = np.concatenate([each.actions != each.rule_actions for each in drives])
    return (
        f"{sum(ended.values())} of {len(drives)} drives end in an accident: {said}.\n"
        f"Of all decisions {100 * wrong.mean():.0f} % are errors."
    )


def never_beyond(drives: Sequence[Rollout], of_rule: Tensor, roads: int = 60) -> str:
    """How many drives off the left edge each clone has in which the car was never left of all of the rule's rows."""
    high = left_in(of_rule).max().item()
    kinds = [off_on_the_left(each) and not (metres_left(each) > high).any() for each in drives]
    counts = [sum(kinds[k : k + roads]) for k in range(0, len(kinds), roads)]
    each = ", ".join(map(str, counts))
    return f"Off the left edge, but never left of the band before: {sum(counts)} (each clone's: {each})."


STEER = ["steer as the rule (%)", "are left of the band (%)", "steer as the rule there (%)"]


def steering(drives: Sequence[Rollout], of_rule: Tensor) -> list[str]:
    """In which share of these drives' decisions the clones do what the columns `STEER` say.

    An action steers left, straight or right.
    """
    to = np.array([name.split()[-1] for name in ACTION_NAMES])
    alike = np.concatenate([to[each.actions] == to[each.rule_actions] for each in drives])
    beyond = np.concatenate([metres_left(each) for each in drives]) > left_in(of_rule).max().item()
    return [f"{100 * alike.mean():.0f}", f"{100 * beyond.mean():.1f}", f"{100 * alike[beyond].mean():.0f}"]


def off_on_the_left(drive: Rollout) -> bool:
    """Whether this drive ends beyond the left edge of the road."""
    return drive.accident == Accident.ROAD_DEPARTURE and drive.states[-1, EGO, Y] < 0


def metres_left(drive: Rollout) -> np.ndarray:
    """How far left of the middle of the left lane the car is, at each decision (m); right of it, below 0."""
    return -drive.states[:: drive.scenario.clock.steps][: len(drive.actions), EGO, Y]


def left_in(rows: Tensor) -> Tensor:
    """The same for each transition of a data set: the state holds the car's place in lanes."""
    return -rows[:, OF_Y] * Y_SCALE


def rows_to_add(of_rule: Tensor, labelled: Tensor) -> dict[str, Tensor]:
    """The kinds `ADDED` of the stochastic rule's rows, which have the rule's labels; equally many of each.

    The band ends where the rule's rows end on the left. Fewest are those left of this place, and all are taken.
    """
    beyond = beyond_in(of_rule, labelled)
    kinds = dict(zip(ADDED, (~beyond, (left_in(labelled) > 1) & ~beyond, beyond), strict=True))
    count = int(beyond.sum())
    return {name: labelled[kind][:: int(kind.sum()) // count][:count] for name, kind in kinds.items()}


def beyond_in(of_rule: Tensor, rows: Tensor) -> Tensor:
    """Which rows are from a place left of all of the rule's rows."""
    return left_in(rows) > left_in(of_rule).max()


def with_added(rows: Tensor, more: Tensor, copies: int = 5) -> Tensor:
    """These rows, and each of the others so many times."""
    return torch.cat([rows] + copies * [more])


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
