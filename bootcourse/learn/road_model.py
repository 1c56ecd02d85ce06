"""A model of the road that is learned from drives: what a decision does to the numbers that the agent observes.

Five small networks learn from the same transitions, each from first weights and batches of its own: how the
observation changes, the reward, and whether an accident ends the drive. Where the drives say little, they disagree
(Chua et al. 2018, "Deep Reinforcement Learning in a Handful of Trials", arXiv 1805.12114; their networks give
distributions, these give means). `ImaginedAhead` looks ahead in them. In contrast to `episodes/lookahead.py` it needs
neither the true state nor a simulator.
"""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
import torch
from torch import Tensor
from torch.nn.functional import binary_cross_entropy_with_logits

from bootcourse.episodes.driving import one_episode_each, steps
from bootcourse.episodes.lookahead import HORIZON, worth_of_speed
from bootcourse.errors import check_known
from bootcourse.learn.agent import Agent
from bootcourse.learn.networks import init_mlp, mlp
from bootcourse.policies import Policy, PolicyOutput
from bootcourse.road.observation import EGO_NAMES, V_LON_SCALE, bounds
from bootcourse.scenario import DEFAULT, N_ACTIONS

MEMBERS, HIDDEN, UPDATES, BATCH, RATE = 5, (128, 128), 2000, 256, 1e-3  # networks, neurons, Adam's steps and step size
V_LON = EGO_NAMES.index("v_lon")
FORMS = ("mean of five", "worst of five", "shield")  # see `ImaginedAhead`


class Transitions(NamedTuple):
    """Decisions of some drives, in any order; each has n rows."""

    states: Tensor  # (n, 26)
    actions: Tensor  # (n,) int64
    rewards: Tensor  # (n,)
    accidents: Tensor  # (n,) 0 or 1: an accident ended the drive here
    next_states: Tensor  # (n, 26)

    def and_also(self, others: "Transitions") -> "Transitions":
        """These, and others after them."""
        return Transitions(*(torch.cat(pair) for pair in zip(self, others, strict=True)))


def transitions_of(policy: Policy, roads: Sequence[int]) -> Transitions:
    """Every decision of a policy's drives on some roads."""
    columns: list[tuple[np.ndarray, ...]] = []
    for step in steps(policy, one_episode_each(len(roads), DEFAULT, None), roads):
        hurt = step.infos["accident"] > 0
        each = step.observations, step.output.actions, step.rewards, hurt, step.next_observations
        columns.append(tuple(np.asarray(column)[step.running] for column in each))
    states, actions, rewards, hurt, reached = (torch.from_numpy(np.concatenate(c)) for c in zip(*columns, strict=True))
    return Transitions(states.float(), actions.long(), rewards.float(), hurt.float(), reached.float())


class RoadModel(NamedTuple):
    """Networks that imagine: (state, action) -> change of the state, reward, logit of an accident."""

    layers: list[Tensor]  # with the networks as the first axis
    scale: Tensor  # (26,) how much each number changes in a decision (its standard deviation in the drives)

    @torch.no_grad()
    def step(self, states: Tensor, actions: Tensor) -> tuple[Tensor, Tensor, Tensor]:
        """What each network expects of a decision.

        states (networks, n, 26), actions (networks, n) -> next states (networks, n, 26), rewards and the probability
        that an accident ends the drive, both (networks, n).
        """
        change, rewards, logits = _parts(self.layers, states, actions)
        low, high = map(torch.from_numpy, bounds(DEFAULT))
        return (states + change * self.scale).clamp(low, high), rewards, logits.sigmoid()


def _parts(layers: list[Tensor], states: Tensor, actions: Tensor) -> tuple[Tensor, Tensor, Tensor]:
    one_hot = torch.nn.functional.one_hot(actions, N_ACTIONS).float()
    out = mlp(layers, torch.cat([states, one_hot], -1))
    return out[..., :-2], out[..., -2], out[..., -1]


def learned_from(drives: Transitions, seed: int = 0, updates: int = UPDATES) -> RoadModel:
    """Fit the networks to the drives, with Adam; the last weights are kept.

    The loss is the mean square error of the scaled change and of the reward, and the cross entropy of the accident.
    """
    size, change = drives.states.shape[1], drives.next_states - drives.states
    scale = change.std(0).clamp_min(1e-3)
    sizes = (size + N_ACTIONS, *HIDDEN, size + 2)
    generators = [torch.Generator().manual_seed(MEMBERS * seed + member) for member in range(MEMBERS)]
    layers = [layer.requires_grad_() for layer in init_mlp(sizes, generators)]
    optimiser = torch.optim.Adam(layers, RATE)
    for _ in range(updates):
        rows = torch.stack([torch.randint(len(change), (BATCH,), generator=each) for each in generators])
        expected, rewards, logits = _parts(layers, drives.states[rows], drives.actions[rows])
        loss = (expected - change[rows] / scale).square().mean() + (rewards - drives.rewards[rows]).square().mean()
        loss = loss + binary_cross_entropy_with_logits(logits, drives.accidents[rows])
        optimiser.zero_grad()
        (MEMBERS * loss).backward()
        optimiser.step()
    return RoadModel([layer.detach() for layer in layers], scale)


@torch.no_grad()
def imagine(
    model: RoadModel, agent: Agent, states: Tensor, first: Tensor, horizon: int = HORIZON
) -> tuple[Tensor, Tensor]:
    """From each of some first actions the agent drives on in each network.

    states (roads, 26), first (roads, branches) -> the values of the first actions and the probabilities of an accident
    within the horizon, both (networks, roads, branches). After the horizon, as in the simulator, W(v) follows.
    """
    members, (roads, branches) = len(model.layers[0]), first.shape
    seen = states.repeat_interleave(branches, 0).expand(members, -1, -1)
    actions, alive = first.reshape(-1).expand(members, -1), torch.ones(members, roads * branches)
    values = torch.zeros_like(alive)
    for decision in range(horizon):
        if decision > 0:
            actions = mlp(agent.actor, seen.reshape(1, -1, seen.shape[-1])).argmax(-1).reshape(members, -1)
        seen, rewards, accident = model.step(seen, actions)
        values += alive * rewards
        alive = alive * (1 - accident)
    speeds = (V_LON_SCALE * seen[..., V_LON]).numpy()
    values += alive * torch.from_numpy(np.interp(speeds, *worth_of_speed(DEFAULT))).float()
    return values.reshape(members, roads, branches), (1 - alive).reshape(members, roads, branches)


class ImaginedAhead:
    """An agent that looks ahead in a learned model, in one of three forms.

    "mean of five": the action whose value is the highest on average over the networks; "worst of five": by its lowest
    value; "shield": the agent's own action, unless the networks give it on average more than an even chance of an
    accident: then the first form's. `overruled` (roads,) says where the last decision was not the agent's own.
    Raises BootcourseError for another form.
    """

    def __init__(self, agent: Agent, model: RoadModel, form: str = FORMS[0], horizon: int = HORIZON):
        check_known("Form", form, FORMS)
        self.agent, self.model, self.form, self.horizon = agent, model, form, horizon
        self.overruled = np.zeros(0, dtype=bool)

    def __call__(self, observations: np.ndarray, cars: np.ndarray) -> PolicyOutput:
        pi = self.agent.probabilities(observations)
        own, nine = pi.argmax(-1), torch.arange(N_ACTIONS).expand(len(pi), -1)
        states = torch.from_numpy(observations).float()
        values, hurt = imagine(self.model, self.agent, states, nine, self.horizon)
        q = (values.amin(0) if self.form == FORMS[1] else values.mean(0)).numpy()
        actions = q.argmax(-1)
        if self.form == "shield":
            danger = hurt.mean(0).numpy()[np.arange(len(own)), own] > 0.5
            actions = np.where(danger, actions, own)
        self.overruled = actions != own
        return PolicyOutput(actions, pi, q)
