"""The compiled update as a learner of `Training`: the same agents as `SACLearner`'s, in a part of the time.

It starts with the same weights and is given the same batches, and its slopes are the same but for rounding. ReLU, min
and max amplify rounding, so after a few hundred updates the weights of the two differ in their second digit, as they do
between two processors.
"""

from collections.abc import Sequence

import numpy as np
import torch
from torch import Tensor

from bootcourse.learn import records
from bootcourse.learn.agent import Agent
from bootcourse.learn.bootstrap import constraint_strength
from bootcourse.learn.compiled import update_all
from bootcourse.learn.protocol import Learner, check_shared
from bootcourse.learn.records import LOSSES, SEEN
from bootcourse.learn.replay_buffer import Batch
from bootcourse.learn.settings import Settings
from bootcourse.learn.vectorised import announce
from bootcourse.scenario import N_ACTIONS


class CompiledLearner(Learner):
    """Actors, twin critics and temperatures of several agents, as records, one after the other in each update.

    settings: one for each agent; the settings that are `shared` must be equal. Raises BootcourseError for settings that
    the compiled code does not have (see `records.refusal`), and for agents whose shared settings differ.
    """

    def __init__(self, settings: Sequence[Settings], observation_size: int = SEEN, n_actions: int = N_ACTIONS):
        for each in settings:
            records.check_accepted(each, observation_size, n_actions)
        self.settings, self.agents = check_shared(settings), len(settings)
        self.records = records.first_agents(self.settings)
        self.given = np.concatenate([records.coefficients(each) for each in settings])
        self.batches, self.work = np.zeros(self.agents, records.BATCHES), np.zeros(self.agents, records.WORK)
        announce(update_all, 15)
        self.actor = records.parameters(self.records["actor"])  # views, as all tensors here

    @staticmethod
    def n_critics(settings: Settings) -> int:
        """Two critics, whose smaller value counts."""
        return 2

    def change(self, settings: Sequence[Settings], names: Sequence[str]) -> None:
        """Take other values of these settings from the next update on."""
        self.settings = list(settings)
        self.given = np.concatenate([records.coefficients(each) for each in settings])

    def coefficients(self) -> dict[str, np.ndarray]:
        """The present α and ξ of each agent, (agents,)."""
        alpha = np.exp(self.records["log_alpha"])
        given = (torch.from_numpy(self.given[name]) for name in ("xi_multiplier", "xi_fixed", "xi_min"))
        return {"alpha": alpha, "xi": constraint_strength(torch.from_numpy(alpha), *given).numpy()}

    def update(self, batch: Batch) -> dict[str, Tensor]:
        """One gradient step of all agents. Returns the numbers of `SACLearner.losses` before the step, (agents,)."""
        records.fill(self.batches, batch)
        update_all(self.records, self.batches, self.given, self.work)
        return {name: torch.from_numpy(self.work[name].copy()) for name in LOSSES}

    def agent(self, i: int) -> Agent:
        """A snapshot of agent i: it stays as it is when the learner goes on."""
        return records.agent_of(self.settings[i], self.records, i)

    def tensors(self) -> dict[str, list[Tensor]]:
        """The whole state, also Adam's: the records' bytes."""
        return {"records": [torch.from_numpy(self.records.view(np.uint8))]}
