"""What stands around a student's `update` and `train`: one agent's networks and optimisers, and rows of its buffer.

`bootcourse.learn.textbook` has the same for the road, with what the paper adds. The two functions at the end say what
the exercises' answers did.
"""

import copy
from typing import NamedTuple

import numpy as np
import torch
from torch import Tensor, nn

from bootcourse.course.exercise import NotAsAsked
from bootcourse.learn import sac
from bootcourse.learn.textbook import mlp
from bootcourse.policies import Policy, PolicyOutput
from bootcourse.research.experiments import checks

SIZES, HIDDEN = (4, 2), (64, 64)  # the pole's observations and actions


class Batch(NamedTuple):
    """Rows of the buffer: states and next_states (batch, 4), the others (batch,)."""

    states: Tensor
    actions: Tensor
    rewards: Tensor
    terminated: Tensor  # 0 or 1
    next_states: Tensor


def row(state, action, reward, terminated, next_state) -> Tensor:
    """One transition as a row of the buffer, (11,)."""
    return torch.tensor([*state, action, reward, terminated, *next_state], dtype=torch.float32)


def batch_of(rows: Tensor) -> Batch:
    """Rows (batch, 11) as a `Batch`."""
    return Batch(rows[:, :4], rows[:, 4].long(), rows[:, 5], rows[:, 6], rows[:, 7:])


class SAC:
    """An actor, two critics, their slow copies and log α, with an optimiser for each of the three.

    rates: of the critics, the actor and log α. The last is three times the paper's: with that the entropy reaches its
    target within the lesson's 1,936 updates (on four seeds), with the paper's it was still below (on three).
    """

    gamma, tau, target_entropy = 0.99, 0.05, 0.3 * float(np.log(2))

    def __init__(self, seed: int = 0, optimiser: type = torch.optim.Adam, rates: tuple = (1e-3, 5e-4, 3e-3)):
        torch.manual_seed(seed)
        self.actor = mlp(*SIZES, HIDDEN)
        self.critics = nn.ModuleList([mlp(*SIZES, HIDDEN) for _ in range(2)])
        self.copies = copy.deepcopy(self.critics)
        self.log_alpha = nn.Parameter(torch.tensor(0.01).log())
        parameters = self.critics.parameters(), self.actor.parameters(), [self.log_alpha]
        self.optimisers = [optimiser(list(each), lr=rate) for each, rate in zip(parameters, rates, strict=True)]

    def log_pi(self, states: Tensor) -> Tensor:
        """log π(a|s): (batch, 4) -> (batch, 2)."""
        return sac.log_policy(self.actor(states))

    def q(self, states: Tensor) -> Tensor:
        """Q of both critics: (batch, 4) -> (2, batch, 2)."""
        return torch.stack([critic(states) for critic in self.critics])

    def slow_q(self, states: Tensor) -> Tensor:
        """Q of both copies: (batch, 4) -> (2, batch, 2)."""
        return torch.stack([critic(states) for critic in self.copies])

    @torch.no_grad()
    def draw(self, state: np.ndarray, rng: np.random.Generator) -> int:
        """An action from π(·|s); state (4,)."""
        return int(rng.random() < self.log_pi(torch.from_numpy(state)[None])[0, 1].exp())


def policy(agent: SAC) -> Policy:
    """The agent's most probable actions, as a policy."""

    @torch.no_grad()
    def drive(observations, cars):
        return PolicyOutput(agent.log_pi(torch.from_numpy(observations).float()).argmax(-1).numpy())

    return drive


def balanced(agent: SAC, episodes: int = 10) -> float:
    """For how many pushes the agent balances the pole, with its most probable actions: a mean."""
    env, pushes = checks.cartpole(), 0
    for episode in range(episodes):
        state, _ = env.reset(seed=checks.TEST_SEED + episode)
        over = False
        while not over:
            with torch.no_grad():
                action = int(agent.log_pi(torch.from_numpy(state)[None]).argmax())
            state, _, terminated, truncated, _ = env.step(action)
            over, pushes = terminated or truncated, pushes + 1
    return pushes / episodes


class Watched:
    """An update that notes the policy's entropy in the batch (nats) and α, after each update.

    And after each `every` updates, for how many pushes the agent balances the pole.
    """

    def __init__(self, update, every: int = 250):
        self.update, self.every, self.balanced, self.entropy, self.alpha = update, every, [], [], []

    def __call__(self, agent: SAC, batch: Batch) -> None:
        self.update(agent, batch)
        with torch.no_grad():
            self.entropy.append(float(sac.entropy(agent.log_pi(batch.states)).mean()))
            self.alpha.append(float(agent.log_alpha.exp()))
        if len(self.alpha) % self.every == 0:
            self.balanced.append(balanced(agent))


class WithoutEnds:
    """A buffer that is told of no end: terminated is 0 in all rows.

    fallen_too: each fallen state gets a row for either push, which leads back to it and pays 1.
    """

    def __init__(self, buffer, fallen_too: bool):
        self.buffer, self.fallen_too = buffer, fallen_too

    def add(self, kept: Tensor) -> None:
        if kept[6] and self.fallen_too:
            for action in (0, 1):
                self.buffer.add(row(kept[7:], action, 1.0, False, kept[7:]))
        self.buffer.add(torch.cat([kept[:6], torch.zeros(1), kept[7:]]))

    def sample(self, batch: int, rng: np.random.Generator) -> Tensor:
        return self.buffer.sample(batch, rng)


# What an answer did ------------------------------------------------------------------------------------


class Descent:
    """Plain gradient descent, in which each factor of a gradient counts; loading torch's own takes seconds."""

    def __init__(self, parameters: list[Tensor], lr: float):
        self.parameters, self.lr = parameters, lr

    def zero_grad(self) -> None:
        for parameter in self.parameters:
            parameter.grad = None

    @torch.no_grad()
    def step(self) -> None:
        for parameter in self.parameters:
            if parameter.grad is not None:
                parameter -= self.lr * parameter.grad


def after_updates(update, zeros: bool, times: int, seed: int) -> tuple[np.ndarray, ...]:
    """An agent after some updates, each on a batch of its own: log π, Q, Q̄ in a few states, and log α.

    zeros: all networks are 0, and so are the states.
    """
    agent, draw = SAC(seed, Descent, (0.1, 0.1, 0.1)), torch.Generator().manual_seed(seed)
    with torch.no_grad():
        agent.log_alpha.fill_(np.log(0.5))
        for parameter in agent.copies.parameters():  # copies that lag behind
            parameter.add_(0.1 * torch.randn(parameter.shape, generator=draw))
        for parameter in [*agent.actor.parameters(), *agent.critics.parameters(), *agent.copies.parameters()] * zeros:
            parameter.zero_()
    for _ in range(times):
        states, next_states = (1 - zeros) * torch.randn(2, 16, 4, generator=draw)
        actions = torch.randint(2, (16,), generator=draw) * (1 - zeros)
        ended = torch.ones(16) if zeros else (torch.rand(16, generator=draw) < 0.4).float()
        rewards = torch.ones(16) if zeros else torch.randn(16, generator=draw)
        update(agent, Batch(states, actions, rewards, ended, next_states))
    probe = torch.zeros(1, 4) if zeros else torch.randn(5, 4, generator=draw)
    with torch.no_grad():
        looked_up = agent.log_pi(probe), agent.q(probe), agent.slow_q(probe), agent.log_alpha.detach().reshape(1)
    return tuple(each.detach().double().numpy() for each in looked_up)


class Road:
    """A world of numbered states for the loop: (episode, push, 0, 0).

    asked: the pushes of the training; after many more it raises NotAsAsked. falls, timeouts: pushes that end an
    episode.
    """

    def __init__(self, asked: int, falls: tuple[int, ...], timeouts: tuple[int, ...]):
        self.asked, self.falls, self.timeouts, self.episode, self.push, self.pushes = asked, falls, timeouts, -1, 0, 0

    def state(self) -> np.ndarray:
        return np.array([self.episode, self.push, 0, 0], dtype=np.float32)

    def reset(self, seed=None):
        self.episode, self.push = self.episode + 1, 0
        return self.state(), {}

    def step(self, action):
        if self.pushes > self.asked + 10:
            raise NotAsAsked("Your loop goes on after the last push: `pushes` counts single pushes, not episodes.")
        ends = self.pushes in self.falls, self.pushes in self.timeouts
        self.push, self.pushes = self.push + 1, self.pushes + 1
        return self.state(), 1.0, *ends, {}


def after_training(train, pushes: int, falls: tuple[int, ...], timeouts: tuple[int, ...]) -> tuple:
    """What a loop did in a world of numbered states: its rows; episodes begun; whether the updates came as asked.

    Of the updates: whether none came too early, whether about every fourth push had one (else minus their number),
    whether each got the agent and a batch of 64 rows. Raises NotAsAsked where there is not one row for each push.
    """
    stored, updates, road = [], [], Road(pushes, falls, timeouts)

    class Agent(SAC):
        def draw(self, state, rng):
            return int(sum(state)) % 2

    drawn, generator = [], np.random.default_rng(0)

    class Buffer:
        rows, size = stored, 10**6  # as in the notebook's

        def add(self, new):
            stored.append(new)

        def sample(self, size, rng):
            drawn.append((rng, torch.stack([stored[i] for i in rng.integers(len(stored), size=size)])))
            return drawn[-1][1]

    def update(agent, batch):
        right = agent is mine and isinstance(batch, Batch) and len(batch.states) == 64 and bool(drawn)
        if right:
            by, rows = drawn.pop()
            right = by is generator and torch.equal(batch.next_states, rows[:, 7:])
        updates.append((len(stored), right))

    mine = Agent(optimiser=Descent)
    train(mine, road, Buffer(), update, pushes, generator)
    if len(stored) != pushes:
        raise NotAsAsked(f"In {pushes} pushes your loop keeps {len(stored)} rows: one transition for each push.")
    rows = torch.stack(stored).numpy().astype(float)
    asked = max(0, pushes - 256) / 4
    early = any(rows < 250 for rows, _ in updates)
    often = 1 if abs(len(updates) - asked) <= 2 else -len(updates)
    judged = not early, often, all(right for _, right in updates)
    return rows, float(road.episode), *map(float, judged)
