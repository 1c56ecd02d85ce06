"""What stands around a student's `update` and `train`: one agent's networks and optimisers, and rows of its buffer.

`bootcourse.learn.textbook` has the same for the road, with what the paper adds. `after_updates` says what an
answer to `update` did, `recorded.py` what a loop does.
"""

import copy
from collections.abc import Callable
from functools import partial
from typing import NamedTuple

import numpy as np
import torch
from torch import Tensor, nn

from bootcourse.learn import sac
from bootcourse.learn.textbook import mlp
from bootcourse.policies import Policy, PolicyOutput
from bootcourse.research.experiments import checks

SIZES, HIDDEN = (4, 2), (64, 64)  # the pole's observations and actions
ADAM = partial(torch.optim.Adam, fused=True)  # all weights in one call


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

    The settings are made for the pole: batches of 256, faster steps and copies than the road's. They were chosen on
    the seeds 100 to 102; `pole.py` trains the seeds 0 to 4. rates: of the critics, the actor and log α.
    """

    gamma, tau, target_entropy = 0.99, 0.1, 0.3 * float(np.log(2))

    def __init__(self, seed: int = 0, optimiser: Callable = ADAM, rates: tuple = (6e-3, 4e-3, 6e-3)):
        torch.default_generator.manual_seed(seed)  # `torch.manual_seed` seeds every device, and takes milliseconds
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
        """An action from π(·|s); state (4,). NumPy answers for one state in a tenth of torch's time."""
        for layer in self.actor:
            state = layer.weight.numpy() @ state + layer.bias.numpy() if isinstance(layer, nn.Linear) else state.clip(0)
        apart = min(state[0] - state[1], np.float32(80))  # exp overflows soon above; no draw differs
        return int(rng.random() * (1 + np.exp(apart)) < 1)  # softmax of two logits

    def as_policy(self) -> Policy:
        """The agent's most probable actions, as a policy."""

        @torch.no_grad()
        def drive(observations, cars):
            return PolicyOutput(self.log_pi(torch.from_numpy(observations).float()).argmax(-1).numpy())

        return drive


def balanced(agent: SAC, episodes: int = 10) -> float:
    """For how many pushes the agent balances the pole, with its most probable actions: a mean."""
    return float(checks.scores([agent], checks.cartpole, episodes)[0])


# What an answer did ------------------------------------------------------------------------------------


class Descent:
    """Plain gradient descent, in which each factor of a gradient counts, with the interface of torch's optimisers.

    Torch's own take more than a second to load.
    """

    def __init__(self, parameters: list[Tensor], lr: float):
        self.defaults, self.state, self.param_groups = {"lr": lr}, {}, []
        self.add_param_group({"params": list(parameters)})

    def add_param_group(self, group: dict) -> None:
        self.param_groups.append(self.defaults | group)

    def zero_grad(self, set_to_none: bool = True) -> None:
        for parameter in (each for group in self.param_groups for each in group["params"]):
            if set_to_none or parameter.grad is None:
                parameter.grad = None
            else:
                parameter.grad = torch.zeros_like(parameter)

    def step(self, closure=None):
        loss = None if closure is None else closure()
        with torch.no_grad():
            for group in self.param_groups:
                for parameter in group["params"]:
                    if parameter.grad is not None:
                        parameter -= group["lr"] * parameter.grad
        return loss

    def state_dict(self) -> dict:
        return {"state": {}, "param_groups": [{"lr": group["lr"]} for group in self.param_groups]}

    def load_state_dict(self, stored: dict) -> None:
        for group, of_it in zip(self.param_groups, stored["param_groups"], strict=True):
            group["lr"] = of_it["lr"]


def after_updates(update, kind: str, times: int, seed: int) -> tuple[np.ndarray, ...]:
    """An agent after some updates, each on a batch of its own: log π, Q, Q̄ in a few states, and log α.

    kind: "zeros", all networks are 0, and so are the states; "drawn"; "sure", the policy is so sure in some states that
    exp(log π) is 0 in float32; "large" and "huge", rewards and Q of 30 and more, and of hundreds; "one" and "wide",
    batches of one row and of 256; "other", another γ, τ and η; "cold", an α of 1e-4.
    """
    zeros, size = kind == "zeros", {"one": 1, "wide": 256}.get(kind, 64)
    scale = {"large": 300, "huge": 1500}.get(kind, 1)  # of the critics' last layer
    rate = 0.001 if scale > 1 else 0.1
    agent, draw = SAC(seed, Descent, (rate, rate, 0.1)), torch.Generator().manual_seed(seed)
    with torch.no_grad():
        agent.log_alpha.fill_(np.log(1e-4 if kind == "cold" else 0.5))
        if kind == "other":
            agent.gamma, agent.tau, agent.target_entropy = 0.7, 0.3, 0.9 * float(np.log(2))
        for parameter in agent.copies.parameters():  # copies that lag behind
            parameter.add_(0.1 * torch.randn(parameter.shape, generator=draw))
        for parameter in [*agent.actor.parameters(), *agent.critics.parameters(), *agent.copies.parameters()] * zeros:
            parameter.zero_()
        if kind == "sure":
            agent.actor[-1].weight.mul_(300)
        for critic in [*agent.critics, *agent.copies]:
            critic[-1].weight.mul_(scale)
    for _ in range(times):
        states, next_states = (1 - zeros) * torch.randn(2, size, 4, generator=draw)
        actions = torch.randint(2, (size,), generator=draw) * (1 - zeros)
        ended = torch.ones(size) if zeros else (torch.rand(size, generator=draw) < 0.4).float()
        rewards = torch.ones(size) if zeros else torch.randn(size, generator=draw) * (30 if scale > 1 else 1)
        update(agent, Batch(states, actions, rewards, ended, next_states))
    probe = torch.zeros(1, 4) if zeros else torch.randn(5, 4, generator=draw)
    with torch.no_grad():
        looked_up = agent.log_pi(probe), agent.q(probe), agent.slow_q(probe), agent.log_alpha.detach().reshape(1)
    return tuple(each.detach().double().numpy() for each in looked_up)
