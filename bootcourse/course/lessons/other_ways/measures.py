"""What this lesson's trainings are asked: what critics believe, and when a teacher hands over."""

from collections.abc import Iterable, Sequence
from typing import NamedTuple

import numpy as np
import torch
from torch import Tensor

from bootcourse.episodes.record import record
from bootcourse.learn.networks import mlp
from bootcourse.learn.rlpd import normalised_mlp
from bootcourse.learn.training import Training
from bootcourse.policies import rule_policy
from bootcourse.research.paper import earned_at
from bootcourse.scenario import DEFAULT


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


class Episodes(NamedTuple):
    """The training episodes of one agent of jump-start RL, each (episodes,)."""

    h: np.ndarray  # so many decisions were the rule's
    decisions: np.ndarray  # of both
    accident: np.ndarray  # did it end in one?


def handed_over(training: Training) -> Episodes:
    """Train one agent of jump-start RL, and say of each episode who drove how long."""
    learner, judge, h = training.learner, training.learner.note_episodes, []

    def note(ended: np.ndarray, returns: np.ndarray) -> None:
        h.extend(learner.guided[0, torch.from_numpy(ended[0])].tolist())
        judge(ended, returns)

    learner.note_episodes = note
    training.run(progress=False)
    curves = training.curves.values
    return Episodes(np.array(h[: training.episodes]), curves["decisions"][0], curves["accident"][0] > 0)
