"""What this lesson's trainings are asked: what critics believe, who drives how well, and when a teacher hands over."""

from collections.abc import Iterable, Mapping, Sequence
from typing import NamedTuple

import numpy as np
import torch
from torch import Tensor

from bootcourse.episodes.evaluate import held_out_seeds
from bootcourse.episodes.record import record
from bootcourse.learn.agent import Agent
from bootcourse.learn.networks import mlp
from bootcourse.learn.rlpd import normalised_mlp
from bootcourse.learn.training import Training
from bootcourse.policies import rule_policy
from bootcourse.research.paper import earned_at
from bootcourse.scenario import DEFAULT

HEADINGS = ("24 drives on new roads", "takes the rule's action, %", "accidents, %", "return")


def worth_at_most(gamma: float) -> float:
    """What a drive that earns most in each second, for ever, is worth."""
    return earned_at(15, 1) / (1 - gamma)


def first_normalised(parameters: Sequence[Tensor], x: Tensor) -> Tensor:
    """RLPD's critics for the first of two agents, the same without normalisation for the second."""
    critics = [network([each[i::2] for each in parameters], x[i::2]) for i, network in enumerate((normalised_mlp, mlp))]
    return torch.stack(critics, 1).flatten(0, 1)


def from_drives_alone(training: Training, updates: Iterable[int]) -> dict[str, np.ndarray]:
    """The mean Q of the rule's actions on its way out, after each of these numbers of updates: {critics: (points,)}.

    training: of two agents, whose critics learn from the rule's drives alone, the second's without normalisation.
    """
    by_rule = record(rule_policy(DEFAULT), range(20), label="rule")
    way = torch.tensor(np.concatenate([drive.observations[:20] for drive in by_rule]), dtype=torch.float32)
    did = torch.tensor(np.concatenate([drive.actions[:20] for drive in by_rule]))
    learner, asked, found = training.learner, set(updates), []
    # A classmethod reads the network from the class: a class of its own changes this learner only.
    learner.__class__ = type("WithBoth", (type(learner),), {"critic_network": staticmethod(first_normalised)})
    generators = [np.random.default_rng(settings.seed) for settings in learner.settings]
    for update in range(max(asked) + 1):
        if update:
            learner.update(training.replay.sample(64, np.ones(2), generators))  # demonstrations only
        if update in asked:
            with torch.no_grad():
                q = learner.q_pair(learner.critics, way.expand(2, -1, -1)).mean(0)  # (2, states, 9)
            found.append(q[:, torch.arange(len(did)), did].mean(1).numpy())
    return dict(zip(("normalised", "not normalised"), np.array(found).T, strict=True))


def driven(agents: Mapping[str, Agent]) -> list[list[str]]:
    """A row for each agent, and for the rule, on the same roads: see `HEADINGS`."""
    policies = {words: agent.as_policy() for words, agent in agents.items()} | {"the rule": rule_policy(DEFAULT)}
    rows = []
    for words, policy in policies.items():
        drives = record(policy, held_out_seeds(16, 24), label=words)
        same = np.concatenate([drive.actions == drive.rule_actions for drive in drives])
        shares = same.mean(), np.mean([drive.accident > 0 for drive in drives])
        earns = np.mean([drive.rewards.sum() for drive in drives])
        rows.append([words, *(f"{100 * share:.0f}" for share in shares), f"{earns:.0f}"])
    return rows


class Episodes(NamedTuple):
    """The training episodes of one agent of jump-start RL, each (episodes,)."""

    h: np.ndarray  # so many decisions were the rule's
    decisions: np.ndarray  # of both
    accident: np.ndarray  # did it end in one?
    mean: np.ndarray  # return of the last `window` episodes
    needed: np.ndarray  # what it has to reach; NaN while there is no best mean


def handed_over(training: Training) -> Episodes:
    """Train one agent of jump-start RL, and say of each episode who drove how long."""
    learner, judge, h, judged = training.learner, training.learner.note_episodes, [], []
    window, tolerance = learner.settings[0].window, learner.settings[0].tolerance

    def note(ended: np.ndarray, returns: np.ndarray) -> None:
        h.extend(learner.guided[0, torch.from_numpy(ended[0])].tolist())
        judge(ended, returns)
        best = float(learner.best[0])
        judged.extend([(float(learner.returns[0].mean()), best - tolerance * abs(best))] * int(ended.sum()))

    learner.note_episodes = note
    training.run(progress=False)
    n, curves = training.episodes, training.curves.values
    mean, needed = np.array(judged[:n]).T
    mean[: window - 1] = np.nan  # too few returns
    needed = np.where(np.isfinite(needed), needed, np.nan)
    return Episodes(np.array(h[:n]), curves["decisions"][0], curves["accident"][0] > 0, mean, needed)
