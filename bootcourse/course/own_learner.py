"""A learner and a replay buffer made of functions for one agent, such as a student writes in the exercises.

A part has the name and the signature of its exercise: one agent, (batch, 9), where the library's own functions have an
agents axis in front. So each part is called for one agent after the other. A part that is not given is the exercise's
solution.
"""

from collections.abc import Callable, Mapping, Sequence

import numpy as np
import torch
from torch import Tensor

from bootcourse.course.lessons import registry
from bootcourse.errors import BootcourseError
from bootcourse.learn import bootstrap, sac
from bootcourse.learn.cql import CQLLearner
from bootcourse.learn.gail import GAILLearner
from bootcourse.learn.ibrl import IBRLLearner
from bootcourse.learn.jsrl import JSRLLearner
from bootcourse.learn.learner import SACLearner
from bootcourse.learn.networks import mlp
from bootcourse.learn.ppo import PPOLearner
from bootcourse.learn.replay_buffer import Batch, decode_transitions
from bootcourse.learn.settings import Settings
from bootcourse.methods import METHODS

Parts = Mapping[str, Callable]  # {name of the exercise: the student's function}
LATER = {"constrained_target": ("soft_value", "critic_target"), "constrained_loss": ("actor_loss",)}  # replaces these
BUFFER = ("ReplayBuffer", "mixed_batch")
ALONE = {  # the parts of a method that shares none with SAC's exercises
    "cql": ["offline_loss"],
    "gail": ["imitation_reward"],
    "rlpd": [],
    "ibrl": ["better_of_two"],
    "jsrl": ["guide_shrinks"],
}


def part(own: Parts, name: str) -> Callable:
    """The given part, or the exercise's solution."""
    return own.get(name) or registry()[name].solution


def parts_of(settings: Sequence[Settings], own: Parts) -> list[str]:
    """The names of the parts that a training with these settings is made of.

    A part of a later lesson replaces those in `LATER` as soon as it is given.
    """
    method = settings[0].method
    if method in ALONE:
        return ALONE[method]
    if METHODS[method].on_policy:
        return ["advantages", "clipped_loss"]
    names = ["soft_value", "critic_target", "critic_loss", "actor_loss", "temperature_loss", "ReplayBuffer"]
    if any(s.asks_teacher for s in settings):
        names.append("soft_constraint")
        for later, earlier in LATER.items():
            if later in own or not any(name in own for name in earlier):
                names = [later if name == earlier[-1] else name for name in names if name not in earlier[:-1]]
    if any(s.needs_demonstrations for s in settings):
        names.append("mixed_batch")
    return names


class Own:
    """Comes before a method's learner, whose parts it makes of functions of one agent."""

    def __init__(self, own: Parts, *arguments):
        self.own = own
        super().__init__(*arguments)

    def part(self, name: str) -> Callable:
        """The given part, or the exercise's solution."""
        return part(self.own, name)

    def each(self, compute: Callable[[int], Tensor]) -> Tensor:
        """The values of compute(i) for all agents i: (agents, ...), in float32 also if a part computes in float64."""
        return torch.stack([compute(i) for i in range(self.agents)]).float()


class OwnSAC(Own, SACLearner):
    """SAC with the paper's additions."""

    def change(self, settings: Sequence[Settings], names: Sequence[str]) -> None:
        if "bonus" in names and any(name in self.own for name in BUFFER):
            raise BootcourseError("Your own buffer adds the bonus c: it stays as it is while the agents train.")
        super().change(settings, names)

    def make_buffer(self, observation_size: int, demonstrations: Tensor | None):
        if not any(name in self.own for name in BUFFER):
            return super().make_buffer(observation_size, demonstrations)
        self.bonus.zero_()  # it is in the rewards of the batches
        return OwnReplay(self.own, self.settings, observation_size, demonstrations)

    def critic_target(self, batch: Batch) -> Tensor:
        next_log_pi = sac.log_policy(mlp(self.actor, batch.next_states))  # (agents, batch, 9)
        next_q = self.q_pair(self.target_critics, batch.next_states)  # (2, agents, batch, 9)
        next_kl = self.kl(next_log_pi, batch.next_rule_actions)  # (agents, batch)
        xi = self.kl_in_target * self.xi  # (agents, 1)
        reward = bootstrap.augmented_reward(batch.rewards, batch.is_demonstration, self.bonus)

        def target(i: int) -> Tensor:
            alpha, gamma = self.alpha[i, 0], float(self.gamma[i])
            if "constrained_target" in self.own:
                mine = reward[i], batch.terminated[i], next_log_pi[i], next_q[:, i], next_kl[i]
                return self.own["constrained_target"](*mine, float(alpha), float(xi[i]), gamma)
            value = self.part("soft_value")(next_log_pi[i], sac.min_q(next_q[:, i]), alpha) - xi[i] * next_kl[i]
            return self.part("critic_target")(reward[i], batch.terminated[i], value, gamma)

        return self.each(target)

    def squared_error(self, q_pair: Tensor, actions: Tensor, target: Tensor) -> Tensor:
        loss = self.part("critic_loss")
        return self.each(lambda i: loss(q_pair[:, i], actions[i], target[i]))

    def actor_loss(self, log_pi: Tensor, q: Tensor, kl: Tensor) -> Tensor:
        def loss(i: int) -> Tensor:
            if "constrained_loss" in self.own:
                return self.own["constrained_loss"](log_pi[i], q[i], float(self.alpha[i]), float(self.xi[i]), kl[i])
            return self.part("actor_loss")(log_pi[i], q[i], self.alpha[i, 0]) + self.xi[i, 0] * kl[i].mean()

        return self.each(loss)

    def temperature_loss(self, entropy: Tensor) -> Tensor:
        loss = self.part("temperature_loss")
        return self.each(lambda i: loss(self.log_alpha[i], entropy[i], self.target_entropy[i, 0]))

    def kl(self, log_pi: Tensor, rule_actions: Tensor) -> Tensor:
        if "soft_constraint" not in self.own:
            return super().kl(log_pi, rule_actions)
        kl = self.own["soft_constraint"]
        return self.each(lambda i: kl(log_pi[i], rule_actions[i], float(self.rule_p[i])))


class OwnCQL(Own, CQLLearner):
    """CQL: the student's loss is that of one critic."""

    def losses(self, batch: Batch) -> dict[str, Tensor]:
        loss, q_pair = self.part("offline_loss"), self.q_pair(self.critics, batch.states)  # (2, agents, batch, 9)
        next_q = self.q_pair(self.critics, batch.next_states)[0].detach()
        next_target = sac.min_q(self.q_pair(self.target_critics, batch.next_states)).detach()

        def of_agent(i: int) -> Tensor:
            rows = next_q[i], next_target[i], batch.actions[i], batch.rewards[i], batch.terminated[i]
            return sum(loss(q[i], *rows, float(self.gamma[i]), float(self.cql_weight[i])) for q in q_pair)

        return {"critic_loss": self.each(of_agent)}


class OwnGAIL(Own, GAILLearner):
    """GAIL: the reward."""

    def imitation_reward(self, own_logits: Tensor) -> Tensor:
        return self.each(lambda i: self.part("imitation_reward")(own_logits[i]))


class OwnPPO(Own, PPOLearner):
    """PPO: the advantages, and the clipped objective."""

    def advantages(self, *columns: Tensor) -> Tensor:
        compute, lam = self.part("advantages"), self.settings[0].gae_lambda
        each = [compute(*(column[:, i] for column in columns), float(self.gamma[i]), lam) for i in range(self.agents)]
        return torch.stack(each, dim=1)

    def clipped_loss(self, ratio: Tensor, advantage: Tensor) -> Tensor:
        loss, clip = self.part("clipped_loss"), self.settings[0].clip
        return self.each(lambda i: loss(ratio[i], advantage[i], clip))


class OwnIBRL(Own, IBRLLearner):
    """IBRL: the choice between the rule's action and the agent's own."""

    def choice(self, states: Tensor, rule_actions: Tensor) -> tuple[Tensor, Tensor]:
        q, pi = self.target_q(states), mlp(self.actor, states).softmax(-1)
        better = self.part("better_of_two")
        return self.each(lambda i: better(pi[i], q[i], rule_actions[i])), q


class OwnJSRL(Own, JSRLLearner):
    """Jump-start RL: how the guide shrinks with one agent's returns."""

    def shrinks(self, agent: int) -> bool:
        returns, best, shared = self.returns[agent].tolist(), float(self.best[agent]), self.settings[0]
        return bool(self.part("guide_shrinks")(returns, best, shared.window, shared.tolerance))


LEARNERS = {
    SACLearner: OwnSAC,
    CQLLearner: OwnCQL,
    GAILLearner: OwnGAIL,
    PPOLearner: OwnPPO,
    IBRLLearner: OwnIBRL,
    JSRLLearner: OwnJSRL,
}  # the library's learner -> the one that is made of parts


def own_learner(own: Parts, settings: Sequence[Settings], observation_size: int, n_actions: int) -> SACLearner:
    """The learner of the settings' method, made of these parts. Raises BootcourseError for a method without parts."""
    base = METHODS[settings[0].method].learner_class()
    if base not in LEARNERS:
        raise BootcourseError(f"Method '{settings[0].method}' has no parts that an exercise writes.")
    return LEARNERS[base](own, settings, observation_size, n_actions)


class OwnReplay:
    """In place of `bootcourse.learn.replay_buffer.ReplayBuffer`: one `ReplayBuffer(size)` for each agent.

    `mixed_batch` adds the bonus itself: the learner must have none.
    """

    def __init__(self, own: Parts, settings: Sequence[Settings], observation_size: int, demonstrations: Tensor | None):
        self.observation_size, self.demonstrations = observation_size, demonstrations
        self.own, self.bonuses = own, [s.bonus for s in settings]
        self.buffers = [part(own, "ReplayBuffer")(settings[0].buffer_size) for _ in settings]

    def add(self, rows: Tensor, ended: np.ndarray | None = None) -> None:
        """Store rows of transitions, (agents, roads, row). Where episodes ended makes no difference."""
        for buffer, own in zip(self.buffers, rows, strict=True):
            for row in own:
                buffer.add(row)

    def sample(self, batch: int, beta: np.ndarray, generators: list[np.random.Generator]) -> Batch:
        """A batch for each agent, with a share beta (agents,) of demonstrations, whose rewards contain the bonus."""
        drawn = [self.draw(i, batch, float(beta[i]), generators[i]) for i in range(len(self.buffers))]
        rows, is_demonstration = (torch.stack(parts) for parts in zip(*drawn, strict=True))
        return decode_transitions(rows, self.observation_size, is_demonstration.float())

    def draw(self, i: int, batch: int, beta: float, rng: np.random.Generator) -> tuple[Tensor, Tensor]:
        """Agent i's rows (batch, row), and which of them are demonstrations (batch,).

        Raises BootcourseError for rows that are not float32.
        """
        name, marks = "ReplayBuffer", torch.zeros(batch)
        if self.demonstrations is None:
            rows = self.buffers[i].sample(batch, rng)
        else:
            name, mixed_batch = "mixed_batch", part(self.own, "mixed_batch")
            rows, marks = mixed_batch(self.buffers[i], self.demonstrations, batch, beta, self.bonuses[i], rng)
        if rows.dtype != torch.float32:
            kind = str(rows.dtype).removeprefix("torch.")
            raise BootcourseError(f"Your `{name}` gives rows in {kind}: training needs float32, as the rows came.")
        return rows, marks
