"""The replay buffer: one table of transitions for the demonstrations and for all agents.

A row is s, s', a, r, terminated, μ(s) and μ(s'). The KL needs the rule's actions, which cannot be computed from an
observation.
"""

from typing import NamedTuple

import numpy as np
import torch
from torch import Tensor

from bootcourse.errors import BootcourseError

REWARD = -4  # the column of a row that holds the reward


class Batch(NamedTuple):
    """One batch for each agent."""

    states: Tensor  # (agents, batch, observation)
    next_states: Tensor  # (agents, batch, observation)
    actions: Tensor  # (agents, batch) int64
    rewards: Tensor  # (agents, batch)
    terminated: Tensor  # (agents, batch) 0 or 1; 0 at a time limit
    rule_actions: Tensor  # (agents, batch) int64, μ(s)
    next_rule_actions: Tensor  # (agents, batch) int64, μ(s')
    is_demonstration: Tensor  # (agents, batch) 0 or 1


class ReplayBuffer:
    """The last `buffer_size` transitions of each agent, and demonstrations that all agents share.

    demonstrations: rows made by `encode_transitions`, (n, row), or None. device: where the table is.
    """

    def __init__(
        self,
        agents: int,
        buffer_size: int,
        observation_size: int,
        demonstrations: Tensor | None = None,
        device: torch.device | None = None,
    ):
        self.agents, self.buffer_size, self.observation_size = agents, buffer_size, observation_size
        self.demonstrations = 0 if demonstrations is None else len(demonstrations)
        shape = self.demonstrations + agents * buffer_size, 2 * observation_size + 5
        self.table = torch.zeros(shape, dtype=torch.float32, device=device)
        if demonstrations is not None:
            self.table[: self.demonstrations] = demonstrations
        self.first = self.demonstrations + np.arange(agents) * buffer_size  # each agent's first row
        self.size = 0  # filled rows of each agent
        self.next = 0  # the row that is written next, counted from `first`

    def add(self, rows: Tensor, ended: np.ndarray | None = None) -> None:
        """Store rows made by `encode_transitions`, (agents, roads, row). Where episodes ended makes no difference."""
        roads = rows.shape[1]
        where = self.first[:, None] + (self.next + np.arange(roads)) % self.buffer_size
        self._write(where, rows.reshape(self.agents * roads, -1))
        self.next = (self.next + roads) % self.buffer_size
        self.size = min(self.size + roads, self.buffer_size)

    def sample(self, batch: int, beta: np.ndarray, generators: list[np.random.Generator]) -> Batch:
        """Draw a batch for each agent: a share beta (agents,) of demonstrations, the rest from its own transitions.

        Raises BootcourseError if beta is above 0 without demonstrations.
        """
        share = np.rint(beta * batch).astype(np.int64)
        if share.any() and not self.demonstrations:
            raise BootcourseError("beta is above 0 but there are no demonstrations: collect some, or set beta to 0.")
        draws = np.stack([generator.random(batch) for generator in generators])
        is_demonstration = np.arange(batch) < share[:, None]
        own = self.first[:, None] + (draws * self.size).astype(np.int64)
        rows = np.where(is_demonstration, (draws * self.demonstrations).astype(np.int64), own)
        picked = self._read(rows).view(self.agents, batch, -1)
        demonstrated = torch.from_numpy(is_demonstration).float().to(self.table.device)
        return decode_transitions(picked, self.observation_size, demonstrated)

    def _read(self, rows: np.ndarray) -> Tensor:
        """The rows of these numbers, of any shape: (numbers, row)."""
        return self.table.index_select(0, torch.from_numpy(rows.ravel()).to(self.table.device))

    def _write(self, rows: np.ndarray, values: Tensor) -> None:
        """Set the rows of these numbers; values (numbers, row)."""
        self.table[torch.from_numpy(rows.ravel()).to(self.table.device)] = values.to(self.table.device)

    def state(self) -> dict[str, np.ndarray]:
        """What a checkpoint keeps: all filled rows, and the place of the next."""
        own, demonstrations = self._read(self.first[:, None] + np.arange(self.size)), self.table[: self.demonstrations]
        arrays = {"own": own.cpu().numpy(), "demonstrations": demonstrations.cpu().numpy()}
        return arrays | {"place": np.array([self.size, self.next])}

    def restore(self, state: dict[str, np.ndarray]) -> None:
        """Set a new buffer to a state. Raises ValueError or RuntimeError if it does not fit."""
        self.size, self.next = (int(number) for number in state["place"])
        self._write(self.first[:, None] + np.arange(self.size), torch.from_numpy(state["own"]))


def encode_transitions(states, next_states, actions, rewards, terminated, rule_actions, next_rule_actions) -> Tensor:
    """Rows for a `ReplayBuffer`: arrays (..., observation) and (...) -> (..., row) float32."""
    numbers = np.stack([actions, rewards, terminated, rule_actions, next_rule_actions], axis=-1)
    return torch.from_numpy(np.concatenate([states, next_states, numbers], axis=-1).astype(np.float32))


def decode_transitions(rows: Tensor, observation_size: int, is_demonstration: Tensor) -> Batch:
    """The `Batch` of rows made by `encode_transitions`, (..., row); is_demonstration (...)."""
    n = observation_size
    actions, _, _, rule_actions, next_rule_actions = rows[..., 2 * n :].long().unbind(-1)
    return Batch(
        rows[..., :n],
        rows[..., n : 2 * n],
        actions,
        rows[..., 2 * n + 1],
        rows[..., 2 * n + 2],
        rule_actions,
        next_rule_actions,
        is_demonstration,
    )
