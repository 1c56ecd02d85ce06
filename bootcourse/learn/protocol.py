"""What a training asks of a learner, and what learners share.

A method is one file with a class, and one entry in `bootcourse/methods.py`. `SACLearner` (learner.py), `BCLearner`
(bc.py) and `PPOLearner` (ppo.py) stand beside each other; most other methods override a part of one of them. Every
parameter of a learner has a leading agents axis, so that one batched matrix product computes all agents.
"""

from collections.abc import Sequence
from typing import Any

import numpy as np
import torch
from torch import Tensor

from bootcourse.errors import BootcourseError
from bootcourse.learn.agent import Agent
from bootcourse.learn.networks import mlp
from bootcourse.learn.replay_buffer import ReplayBuffer
from bootcourse.learn.settings import Settings, shared_fields


class Learner:
    """The agents of one training, side by side: here actors alone, which learn from a replay buffer.

    A class is called with (settings, observation_size, n_actions), with the settings of each agent. It sets `settings`,
    `agents`, `actor` and `optimiser`, and has an `update`; all else it may take from here or override.
    """

    needs_teacher = False  # whether `driving_policy` depends on the teacher's actions μ(s)
    settings_class: type[Settings] | None = None  # of a learner with settings of its own, a subclass of `Settings`
    device = torch.device("cpu")  # of all tensors: see `move_to`
    settings: list[Settings]
    agents: int
    actor: list[Tensor]  # weights and biases, (agents, inputs, outputs) and (agents, 1, outputs)
    optimiser: torch.optim.Optimizer

    def update(self, batch: Any) -> dict[str, Tensor]:
        """One gradient step of all agents on a batch. Returns losses before the step and other numbers, (agents,)."""
        raise NotImplementedError

    def make_buffer(self, observation_size: int, demonstrations: Tensor | None) -> Any:
        """The buffer that the training fills and samples; demonstrations: rows (transitions, row), or None."""
        return ReplayBuffer(self.agents, self.settings[0].buffer_size, observation_size, demonstrations, self.device)

    def change(self, settings: Sequence[Settings], names: Sequence[str]) -> None:
        """Take other values of these settings from the next update on. Raises BootcourseError for one without use."""
        for name in names:
            if not hasattr(self, name):
                raise BootcourseError(f"Method '{self.settings[0].method}' does not use {name}: leave it as it is.")
            setattr(self, name, per_agent(settings, name).to(self.device))
        self.settings = list(settings)

    def updates_due(self, replay: Any, decisions: int) -> int:
        """How many updates follow a decision on every road; decisions: of each agent so far."""
        return self.settings[0].updates if decisions >= self.settings[0].learning_starts else 0

    @torch.no_grad()
    def probabilities(self, states: Tensor) -> Tensor:
        """π(a|s): (agents, batch, observation) -> (agents, batch, actions)."""
        return mlp(self.actor, states).softmax(-1)

    def acting_policy(self, states: Tensor, rule_actions: Tensor, decided: Tensor) -> Tensor:
        """The distribution from which a training draws the next actions: (agents, roads, actions).

        states (agents, roads, observation); rule_actions μ(s), (agents, roads) int64; decided (agents, roads): how
        many decisions each road's episode has lasted.
        """
        return self.probabilities(states)

    def note_episodes(self, ended: np.ndarray, returns: np.ndarray) -> None:
        """Called after each decision: which episodes it ended (agents, roads), and the sums of rewards so far."""

    def coefficients(self) -> dict[str, np.ndarray]:
        """The present `alpha` and `xi` (ξ) of each agent for the curves, (agents,): 0 where the method has none."""
        return {"alpha": np.zeros(self.agents), "xi": np.zeros(self.agents)}

    def agent(self, i: int) -> Agent:
        """A snapshot of agent i: it stays as it is when the learner goes on."""
        return Agent(self.settings[i], of_agent(self.actor, i, self.agents), critics=[], alpha=0.0)

    def tensors(self) -> dict[str, list[Tensor]]:
        """The tensors of a checkpoint: all of the learner's state apart from the optimiser's."""
        return {"actor": self.actor}

    @staticmethod
    def n_critics(settings: Settings) -> int:
        """How many critics an agent has. 0: it has no Q."""
        return 0

    @classmethod
    def driving_policy(cls, actor: list[Tensor], critics: list[Tensor], states: Tensor, rule_actions: Tensor) -> Tensor:
        """The distribution from which a trained agent's actions come: (agents, batch, actions).

        actor, critics: the agent's weights; states (agents, batch, observation); rule_actions μ(s), (agents, batch)
        int64. A method that uses them sets `needs_teacher`: its agents ask the teacher while they drive.
        """
        return mlp(actor, states).softmax(-1)

    @classmethod
    def q_values(cls, critics: list[Tensor], states: Tensor) -> Tensor:
        """Q(s,a) of these critics: (agents, batch, observation) -> (agents, batch, actions). Not for 0 critics."""
        raise NotImplementedError


def check_shared(settings: Sequence[Settings]) -> list[Settings]:
    """The settings as a list. Raises BootcourseError if the agents differ in a setting that they must share."""
    for name in shared_fields(type(settings[0])):
        if len({getattr(s, name, None) for s in settings}) > 1:
            raise BootcourseError(f"Agents that train side by side need the same {name}: train these apart.")
    return list(settings)


def generators_of(settings: Sequence[Settings], offset: int = 0) -> list[torch.Generator]:
    """A random generator for each agent's first weights. Networks that are drawn apart have different offsets."""
    return [torch.Generator().manual_seed(s.seed + offset) for s in settings]


def per_agent(settings: Sequence[Settings], name: str) -> Tensor:
    """The agents' values of a setting, (agents, 1); NaN for None."""
    values = [getattr(s, name) for s in settings]
    rows = [[float("nan") if value is None else float(value)] for value in values]
    return torch.tensor(rows, dtype=torch.float32)


def adam(*groups: tuple[list[Tensor], float]) -> torch.optim.Adam:
    """An optimiser of networks with their learning rates; their tensors get gradients from now on."""
    for parameters, _ in groups:
        for parameter in parameters:
            parameter.requires_grad_()
    return torch.optim.Adam([{"params": parameters, "lr": rate} for parameters, rate in groups], fused=True)


def total_loss(terms: dict[str, Tensor]) -> Tensor:
    """The sum of all agents' losses: of the terms whose names end in "loss"."""
    first, *others = (values for name, values in terms.items() if name.endswith("loss"))
    return sum(others, first).sum()


def of_agent(parameters: Sequence[Tensor], i: int, agents: int) -> list[Tensor]:
    """Copies of agent i's parameters on the CPU, from (networks x agents, ...): (networks, ...) each."""
    return [parameter.detach()[i::agents].clone().cpu() for parameter in parameters]


def move_to(learner: Learner, device: torch.device) -> None:
    """Move a learner's tensors to a device, before the first update. Its agents are on the CPU all the same."""
    learner.device = device
    for value in vars(learner).values():
        for tensor in value if isinstance(value, list) else [value]:
            if isinstance(tensor, Tensor):
                moved = tensor.detach().to(device).requires_grad_(tensor.requires_grad)
                torch.utils.swap_tensors(tensor, moved)  # the optimiser knows the tensor itself
