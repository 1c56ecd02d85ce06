"""Where an agent of the lesson learns besides the pole: small worlds whose right Q one can work out, rows in which no
fall is marked, rows of fallen poles, and targets in which a fallen pole's value stays as it was.
"""

import copy
from collections.abc import Callable
from functools import cache
from typing import NamedTuple

import gymnasium as gym
import numpy as np
import torch
from torch import Tensor

from bootcourse.course.lessons.update_and_loop import by_hand
from bootcourse.research.experiments import checks


class World(NamedTuple):
    """What a small world pays in each push, (left, right), whether it ends in a fall or by time, and what it shows."""

    pays: tuple[tuple[int, int], ...]
    falls: bool
    right: str  # what Q, and in the last world π, should be at the start, γ = 0.8


GAMMA = 0.8
WORLDS = {
    "A push pays 1, then the pole falls": World(((1, 1),), True, "1"),
    "Two pushes pay 1 each, then it falls": World(((1, 1), (1, 1)), True, f"1 + γ = {1 + GAMMA:g}"),
    "A push pays 1, then the time is up; s' = s": World(((1, 1),), False, f"1 / (1 − γ) = {1 / (1 - GAMMA):.0f}"),
    "Left pays 0, right pays 1, then it falls": World(((0, 1),), True, "0 and 1; π(right) near 1"),
}


class Small(gym.Env):
    """A small world. After the last push the state is a new one if the pole fell, and the same if the time is up."""

    observation_space, action_space = gym.spaces.Box(0, 1, (4,), np.float32), gym.spaces.Discrete(2)

    def __init__(self, world: World):
        self.world = world

    def state(self) -> np.ndarray:
        return np.eye(4, dtype=np.float32)[self.push]

    def reset(self, *, seed=None, options=None):
        super().reset(seed=seed)
        self.push = 0
        return self.state(), {}

    def step(self, action):
        reward, last = float(self.world.pays[self.push][action]), self.push + 1 == len(self.world.pays)
        self.push += self.world.falls or not last
        return self.state(), reward, last and self.world.falls, last and not self.world.falls, {}


class Learned(NamedTuple):
    """What an agent has learned of the start of a small world: Q and π of a push to the left and to the right, (2,)."""

    q: Tensor
    pi: Tensor


def learn(loop, update, buffer) -> dict[str, Learned]:
    """What a new agent learns in each of the small worlds. loop, update, buffer: the exercises' answers."""
    return {words: learned_in(world, loop, update, buffer) for words, world in WORLDS.items()}


def learned_in(world: World, loop, update, buffer) -> Learned:
    """What a new agent learns in one world."""
    agent, env = by_hand.SAC(), Small(world)
    agent.gamma, agent.tau = GAMMA, 0.5  # so that 75 updates are enough
    loop(agent, env, buffer(1_000), update, 556, np.random.default_rng(0))
    start = torch.from_numpy(env.reset()[0])[None]
    with torch.no_grad():
        return Learned(agent.q(start).mean((0, 1)), agent.log_pi(start)[0].exp())


class Unmarked:
    """A buffer in whose rows no fall is marked: terminated is 0 in all."""

    def __init__(self, buffer):
        self.buffer = buffer

    def add(self, row: Tensor) -> None:
        self.buffer.add(torch.cat([row[:6], torch.zeros(1), row[7:]]))

    def sample(self, batch: int, rng: np.random.Generator) -> Tensor:
        return self.buffer.sample(batch, rng)


class WithFallen(Unmarked):
    """No fall is marked, but after each there are two rows more: a push to either side leaves the fallen pole as it is.

    paid: what such a push pays.
    """

    def __init__(self, buffer, paid: float):
        super().__init__(buffer)
        self.paid = paid

    def add(self, row: Tensor) -> None:
        super().add(row)
        if row[6]:
            for push in (0.0, 1.0):
                self.buffer.add(torch.cat([row[7:], torch.tensor([push, self.paid, 0]), row[7:]]))


class FrozenGuess(by_hand.SAC):
    """An agent whose targets take a fallen pole's value from critics that never learn: those of the start."""

    def __init__(self, seed: int = 0):
        super().__init__(seed)
        self.untrained = copy.deepcopy(self.copies)

    def guess(self, states: Tensor) -> Tensor:
        """Q of both untrained critics: (batch, 4) -> (2, batch, 2)."""
        return torch.stack([critic(states) for critic in self.untrained])

    def slow_q(self, states: Tensor) -> Tensor:
        """Q of both copies, and the guess where the pole has fallen: (batch, 4) -> (2, batch, 2)."""
        return torch.where(fallen(states)[:, None], self.guess(states), super().slow_q(states))


def frozen_at(worth: float) -> type[FrozenGuess]:
    """A kind of agent whose targets say that a fallen pole is worth so much, whatever it learns."""

    class FrozenAt(FrozenGuess):
        def guess(self, states: Tensor) -> Tensor:
            """The same for each: (batch, 4) -> (2, batch, 2)."""
            return torch.full((2, len(states), by_hand.SIZES[1]), float(worth))

    return FrozenAt


FrozenAt30 = frozen_at(30)


def held(kind: type[by_hand.SAC], alpha: float) -> type[by_hand.SAC]:
    """Agents of that kind whose temperature stays at `alpha`."""

    class Held(kind):
        def __init__(self, seed: int = 0):
            super().__init__(seed)
            torch.nn.init.constant_(self.log_alpha, float(np.log(alpha)))
            self.optimisers[-1].param_groups[0]["lr"] = 0.0

    return Held


@cache
def furthest() -> Tensor:
    """How far a pole may go, as the agent sees its state, (4,): the cart (m), and how much it leans."""
    env = checks.cartpole().unwrapped
    far = np.array([env.x_threshold, np.inf, env.theta_threshold_radians, np.inf]) / checks.CARTPOLE_SCALES
    return torch.from_numpy(far).float()


def fallen(states: Tensor) -> Tensor:
    """In which states the pole has fallen: (batch, 4) -> (batch,)."""
    return (states.abs() > furthest()).any(-1)


def taught(loop, update, buffer, pushes: int, seed: int, kind: Callable = by_hand.SAC) -> by_hand.SAC:
    """A new agent of that kind that has learned from the pole. loop, update, buffer: as `learn` has them."""
    agent = kind(seed)
    loop(agent, checks.cartpole(), buffer, update, pushes, np.random.default_rng(seed))
    return agent


def taught_on(loop, update, agent: by_hand.SAC, buffer, pushes: int, seed: int) -> by_hand.SAC:
    """The agent, and its rows in the buffer, that many pushes later: a copy of both trains, and the agent stays."""
    later, rows = copy.deepcopy((agent, buffer))
    loop(later, checks.cartpole(), rows, update, pushes, np.random.default_rng(seed))
    return later


# A fall, state by state ---------------------------------------------------------------------------------

BEFORE = 8  # pushes before the fall from which a fall is shown


@cache
def to_one_side() -> list[np.ndarray]:
    """The states (T + 1, 4) of poles that are pushed to one side only until they fall, 20 to each side."""
    found = []
    for push in (0, 1):
        for seed in range(20):
            env, ended = checks.cartpole(), False
            states = [env.reset(seed=seed)[0]]
            while not ended:
                state, _, ended, *_ = env.step(push)
                states.append(state)
            found.append(np.array(states, dtype=np.float32))
    return found


@torch.no_grad()
def along_falls(agent: by_hand.SAC) -> np.ndarray:
    """What an agent's critics expect in the last states of a fall, a mean of 40 falls and of both pushes: (9,)."""
    states = torch.from_numpy(np.stack([states[-BEFORE - 1 :] for states in to_one_side()]))
    return agent.q(states.flatten(0, 1)).mean((0, 2)).view(states.shape[:2]).mean(0).numpy()


def most_possible(agent: by_hand.SAC) -> float:
    """More than this no Q can be: each push pays 1 and at most α log 2 for its entropy, without an end."""
    return (1 + agent.log_alpha.exp().item() * float(np.log(2))) / (1 - agent.gamma)
