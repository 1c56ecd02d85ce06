"""The learner: gradient steps of SAC with the paper's additions, for many agents at once.

Read `textbook.py` first: it is the same for one agent, in plain torch. Here every parameter has a leading agents axis,
so that one batched matrix product computes all agents. `batch` is a `Batch`, with fields (agents, batch, ...).

Your own method overrides the parts that differ: `losses` as a whole, or `critic_target`, `critic_loss` (or its parts),
`actor_loss`, `temperature_loss`, `kl`, `soft_value`; and how agents decide: `acting_policy` while they train,
`driving_policy` in general. See cql.py, gail.py, jsrl.py, rlpd.py, ibrl.py. protocol.py says what a training asks of
any learner.
"""

from collections.abc import Sequence
from typing import Any

import numpy as np
import torch
from torch import Tensor

from bootcourse.errors import BootcourseError
from bootcourse.learn import bootstrap, sac
from bootcourse.learn.agent import Agent
from bootcourse.learn.networks import init_mlp, mlp
from bootcourse.learn.protocol import Learner, adam, check_shared, generators_of, of_agent, per_agent, total_loss
from bootcourse.learn.replay_buffer import Batch
from bootcourse.learn.settings import Settings
from bootcourse.methods import METHODS
from bootcourse.scenario import N_ACTIONS


class SACLearner(Learner):
    """Actors, twin critics and temperatures of several agents, and their update.

    settings: one for each agent; the settings that are `shared` must be equal. `alpha` and `xi` (ξ), each (agents, 1),
    are those of the present update. Raises BootcourseError for agents whose shared settings differ.
    """

    def __init__(self, settings: Sequence[Settings], observation_size: int, n_actions: int = N_ACTIONS):
        self.settings, self.agents = check_shared(settings), len(settings)
        shared, generators = self.settings[0], generators_of(settings)
        sizes = (observation_size, *shared.hidden, n_actions)
        self.actor = init_mlp(sizes, generators)
        each = [init_mlp(sizes, generators) for _ in range(self.n_critics(shared))]
        self.critics = [torch.cat(parts) for parts in zip(*each, strict=True)]  # (2 x agents, ...), first critics first
        self.target_critics = [parameter.clone() for parameter in self.critics]
        self.log_alpha = torch.tensor([s.alpha_init for s in settings], dtype=torch.float32).log()  # (agents,)
        self.optimiser = adam(
            (self.actor, shared.actor_lr), (self.critics, shared.critic_lr), ([self.log_alpha], shared.alpha_lr)
        )
        self.gamma = per_agent(settings, "gamma")  # (agents, 1), as all that follow
        self.target_entropy = per_agent(settings, "target_entropy")
        self.xi_multiplier = per_agent(settings, "xi_multiplier")
        self.xi_fixed = per_agent(settings, "xi_fixed")  # NaN where ξ follows α
        self.xi_min = per_agent(settings, "xi_min")
        self.kl_in_target = per_agent(settings, "kl_in_target")
        self.rule_p = per_agent(settings, "rule_p")
        self.bonus = per_agent(settings, "bonus")
        self.margin = per_agent(settings, "margin")
        self.paper_q_filter = per_agent(settings, "paper_q_filter")
        self.cql_weight = per_agent(settings, "cql_weight")
        self.note_temperature()

    @staticmethod
    def n_critics(settings: Settings) -> int:
        """Two critics, whose smaller value counts."""
        return 2

    def note_temperature(self) -> None:
        """Set `alpha` and `xi` (Equation 15), each (agents, 1), from the present `log_alpha`."""
        self.alpha = self.log_alpha.detach().exp()[:, None]
        self.xi = bootstrap.constraint_strength(self.alpha, self.xi_multiplier, self.xi_fixed, self.xi_min)

    def coefficients(self) -> dict[str, np.ndarray]:
        """The present α and ξ of each agent, (agents,)."""
        self.note_temperature()
        return {"alpha": self.alpha[:, 0].cpu().numpy(), "xi": self.xi[:, 0].cpu().numpy()}

    def update(self, batch: Batch) -> dict[str, Tensor]:
        """One gradient step of all agents. Returns `losses` before the step, each (agents,).

        Critics, actor and temperature step together: each loss is computed before any of them changes.
        """
        self.note_temperature()
        terms = self.losses(batch)
        self.optimiser.zero_grad()
        total_loss(terms).backward()
        self.optimiser.step()
        with torch.no_grad():  # polyak averaging
            torch._foreach_lerp_(self.target_critics, self.critics, self.settings[0].tau)
        return {name: values.detach() for name, values in terms.items()}

    def losses(self, batch: Batch) -> dict[str, Tensor]:
        """The losses to minimise, with names that end in "loss", and other numbers for curves: each (agents,)."""
        with torch.no_grad():
            target = self.critic_target(batch)  # (agents, batch)
        q_pair = self.q_pair(self.critics, batch.states)  # (2, agents, batch, 9)
        log_pi = sac.log_policy(mlp(self.actor, batch.states))  # (agents, batch, 9)
        kl = self.kl(log_pi, batch.rule_actions)  # (agents, batch)
        entropy = sac.entropy(log_pi)  # (agents, batch)
        return {
            "critic_loss": self.critic_loss(q_pair, target, log_pi.detach(), batch),
            "actor_loss": self.actor_loss(log_pi, self.one_q(q_pair), kl),
            "temperature_loss": self.temperature_loss(entropy),
            "entropy": entropy.detach().mean(-1),
            "kl": kl.detach().mean(-1),
            "alpha": self.alpha[:, 0],
            "xi": self.xi[:, 0],
        }

    def critic_target(self, batch: Batch) -> Tensor:
        """y = r + c + γ (V(s') - ξ KL(s')), Equations 6, 15 and 20: (agents, batch). Call it without gradients."""
        next_log_pi = sac.log_policy(mlp(self.actor, batch.next_states))  # (agents, batch, 9)
        next_q = self.target_q(batch.next_states)  # (agents, batch, 9)
        next_kl = self.kl(next_log_pi, batch.next_rule_actions)  # (agents, batch)
        next_value = self.soft_value(next_log_pi, next_q, self.alpha, self.kl_in_target * self.xi * next_kl)
        reward = bootstrap.augmented_reward(batch.rewards, batch.is_demonstration, self.bonus)
        return sac.critic_target(reward, batch.terminated, next_value, self.gamma)

    def critic_loss(self, q_pair: Tensor, target: Tensor, log_pi: Tensor, batch: Batch) -> Tensor:
        """The critics' squared errors, with the margin and the conservative terms if their weights are set: (agents,).

        q_pair (2, agents, batch, 9), target (agents, batch), log_pi (agents, batch, 9) without gradient.
        """
        loss = self.squared_error(q_pair, batch.actions, target)
        if self.margin.any():
            loss = loss + self.margin[:, 0] * self.margin_loss(q_pair, log_pi, batch)
        if self.cql_weight.any():
            loss = loss + self.cql_weight[:, 0] * self.conservative_loss(q_pair, batch.actions)
        return loss

    def squared_error(self, q_pair: Tensor, actions: Tensor, target: Tensor) -> Tensor:
        """The critics' mean (Q(s,a) - y)², summed: (2, agents, batch, 9), (agents, batch) twice -> (agents,)."""
        actions = actions.expand(len(q_pair), -1, -1)
        q_taken = q_pair.gather(-1, actions.unsqueeze(-1)).squeeze(-1)  # (2, agents, batch)
        return sac.critic_loss(q_taken, target).sum(0)

    def conservative_loss(self, q_pair: Tensor, actions: Tensor) -> Tensor:
        """CQL's term, summed over critics: (2, agents, batch, 9), (agents, batch) -> (agents,)."""
        return sac.conservative_loss(q_pair, actions.expand(len(q_pair), -1, -1)).sum(0)

    def margin_loss(self, q_pair: Tensor, log_pi: Tensor, batch: Batch) -> Tensor:
        """The filtered large-margin loss of the demonstrations (Equations 17 to 19), summed over critics: (agents,)."""
        total: Any = 0.0
        for q in q_pair:  # (agents, batch, 9)
            loss = bootstrap.large_margin_loss(q, batch.actions)
            printed = bootstrap.paper_q_filter(q.detach(), batch.actions)
            usual = bootstrap.q_filter(q.detach(), batch.actions, log_pi)
            keep = torch.where(self.paper_q_filter > 0, printed, usual)
            total = total + (loss * keep * batch.is_demonstration).mean(-1)
        return total

    def actor_loss(self, log_pi: Tensor, q: Tensor, kl: Tensor) -> Tensor:
        """Minus the mean soft value with -ξ KL: log_pi, q (agents, batch, 9), kl (agents, batch) -> (agents,)."""
        return sac.actor_loss(log_pi, q, self.alpha, self.xi * kl)

    def temperature_loss(self, entropy: Tensor) -> Tensor:
        """α (H - η): entropy (agents, batch) -> (agents,)."""
        return sac.temperature_loss(self.log_alpha, entropy, self.target_entropy[:, 0])

    def kl(self, log_pi: Tensor, rule_actions: Tensor) -> Tensor:
        """D_KL(π ‖ π̃) in each state: (agents, batch, 9), (agents, batch) -> (agents, batch)."""
        return bootstrap.kl_to_rule(log_pi, rule_actions, self.rule_p[:, 0])

    soft_value = staticmethod(sac.soft_value)  # of the next state, in the critic's target

    one_q = staticmethod(sac.min_q)  # the value that the actor maximises: (2, ..., batch, 9) -> (..., batch, 9)
    critic_network = staticmethod(mlp)

    @classmethod
    def q_pair(cls, critics: list[Tensor], states: Tensor) -> Tensor:
        """Q(s,a) of both critics: (agents, batch, observation) -> (2, agents, batch, actions)."""
        agents = len(states)
        n = len(critics[0]) // agents
        q = cls.critic_network(critics, states.repeat(n, 1, 1))
        return q.view(n, agents, *q.shape[1:])

    def target_q(self, states: Tensor) -> Tensor:
        """The target critics' Q(s,a): (agents, batch, observation) -> (agents, batch, actions)."""
        return sac.min_q(self.q_pair(self.target_critics, states))

    @classmethod
    def q_values(cls, critics: list[Tensor], states: Tensor) -> Tensor:
        """The smaller of the two critics' Q(s,a): (agents, batch, observation) -> (agents, batch, actions)."""
        return cls.one_q(cls.q_pair(critics, states))

    def agent(self, i: int) -> Agent:
        """A snapshot of agent i: it stays as it is when the learner goes on."""
        actor, critics = (of_agent(parameters, i, self.agents) for parameters in (self.actor, self.critics))
        return Agent(self.settings[i], actor, critics, float(self.log_alpha[i].detach().exp()))

    def tensors(self) -> dict[str, list[Tensor]]:
        """The networks and the temperatures."""
        networks = {"actor": self.actor, "critics": self.critics, "targets": self.target_critics}
        return networks | {"log_alpha": [self.log_alpha]}


def learner_for(settings: Sequence[Settings], observation_size: int, n_actions: int = N_ACTIONS) -> Learner:
    """The learner of the agents' methods; settings: one for each agent.

    Raises BootcourseError if the methods have different learners, or the shared settings differ.
    """
    classes = {METHODS[s.method].learner_class() for s in settings}
    if len(classes) > 1:
        methods = ", ".join(sorted({s.method for s in settings}))
        raise BootcourseError(f"{methods} cannot train side by side: their learners differ. Train these apart.")
    return classes.pop()(settings, observation_size, n_actions)
