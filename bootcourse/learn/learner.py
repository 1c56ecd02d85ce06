"""One gradient step for every agent: where SAC's losses and the paper's additions meet."""

from collections.abc import Sequence

import torch
from torch import Tensor

from bootcourse.errors import BootcourseError
from bootcourse.learn import bootstrap, sac
from bootcourse.learn.networks import init_mlp, mlp
from bootcourse.learn.replay_buffer import Batch
from bootcourse.learn.settings import SHARED, Settings
from bootcourse.methods import METHODS
from bootcourse.scenario import N_ACTIONS


class SACLearner:
    """Actors, twin critics and temperatures of several agents, and their update.

    settings: one for each agent; the fields in `settings.SHARED` must be equal.
    """

    def __init__(self, settings: Sequence[Settings], observation_size: int, n_actions: int = N_ACTIONS):
        self.settings = list(settings)
        for name in SHARED:
            if len({getattr(s, name) for s in settings}) > 1:
                raise BootcourseError(f"Agents that train side by side need the same {name}: train these apart.")
        shared, self.agents = self.settings[0], len(self.settings)
        generators = [torch.Generator().manual_seed(s.seed) for s in settings]
        sizes = (observation_size, *shared.hidden, n_actions)
        self.actor = init_mlp(sizes, generators)
        pair = [init_mlp(sizes, generators) for _ in range(2)]
        self.critics = [torch.cat(two) for two in zip(*pair, strict=True)]  # (2 x agents, ...), first critics first
        self.target_critics = [parameter.clone() for parameter in self.critics]
        self.log_alpha = self._per_agent("alpha_init").log()
        groups = [
            {"params": self.actor, "lr": shared.actor_lr},
            {"params": self.critics, "lr": shared.critic_lr},
            {"params": [self.log_alpha], "lr": shared.alpha_lr},
        ]
        for group in groups:
            for parameter in group["params"]:
                parameter.requires_grad_()
        self.optimiser = torch.optim.Adam(groups, fused=True)
        names = ("gamma", "target_entropy", "xi_multiplier", "xi_fixed", "kl_in_target", "rule_p", "bonus", "margin")
        self.of_agent = {name: self._per_agent(name) for name in (*names, "paper_q_filter", "cql_weight")}

    def _per_agent(self, name: str) -> Tensor:
        return torch.tensor([float(getattr(s, name)) for s in self.settings])

    def update(self, batch: Batch) -> dict[str, Tensor]:
        """One step on every agent's own batch. Returns what a curve shows, each (agents,).

        Critics, actor and temperature step together, each from where the others stood before.
        """
        its = {name: value[:, None] for name, value in self.of_agent.items()}  # (agents, 1), against (agents, batch)
        alpha = self.log_alpha.detach().exp()[:, None]
        xi = bootstrap.constraint_strength(alpha, its["xi_multiplier"], its["xi_fixed"])

        with torch.no_grad():
            next_log_pi = sac.log_policy(mlp(self.actor, batch.next_states))
            next_q = sac.min_q(self._both(self.target_critics, batch.next_states))
            next_kl = bootstrap.kl_to_rule(next_log_pi, batch.next_rule_actions, self.of_agent["rule_p"])
            next_value = sac.soft_value(next_log_pi, next_q, alpha, its["kl_in_target"] * xi * next_kl)
            reward = bootstrap.augmented_reward(batch.rewards, batch.is_demonstration, its["bonus"])
            target = sac.critic_target(reward, batch.terminated, next_value, its["gamma"])

        q_pair = self._both(self.critics, batch.states)
        q_taken = q_pair.gather(-1, batch.actions.expand(2, -1, -1).unsqueeze(-1)).squeeze(-1)
        critic_loss = sac.critic_loss(q_taken, target).sum(0)

        log_pi = sac.log_policy(mlp(self.actor, batch.states))
        kl = bootstrap.kl_to_rule(log_pi, batch.rule_actions, self.of_agent["rule_p"])
        q = sac.min_q(q_pair)
        actor_loss = sac.actor_loss(log_pi, q, alpha, xi * kl)
        state_entropy = sac.entropy(log_pi)
        temperature_loss = sac.temperature_loss(self.log_alpha, state_entropy, self.of_agent["target_entropy"])
        if self.of_agent["margin"].any():
            critic_loss = critic_loss + self.of_agent["margin"] * self._margin_loss(q_pair, log_pi.detach(), batch)
        if self.of_agent["cql_weight"].any():
            pessimism = sac.conservative_loss(q_pair, batch.actions.expand(2, -1, -1)).sum(0)
            critic_loss = critic_loss + self.of_agent["cql_weight"] * pessimism

        self.optimiser.zero_grad()
        (critic_loss + actor_loss + temperature_loss).sum().backward()
        self.optimiser.step()
        with torch.no_grad():
            torch._foreach_lerp_(self.target_critics, self.critics, self.settings[0].tau)
        return {
            "critic_loss": critic_loss.detach(),
            "actor_loss": actor_loss.detach(),
            "entropy": state_entropy.detach().mean(-1),
            "kl": kl.detach().mean(-1),
            "alpha": alpha[:, 0],
            "xi": xi[:, 0],
        }

    def _both(self, critics: list[Tensor], states: Tensor) -> Tensor:
        """Both critics' values: (agents, batch, observation) -> (2, agents, batch, actions)."""
        q = mlp(critics, states.repeat(2, 1, 1))
        return q.view(2, self.agents, *q.shape[1:])

    def _margin_loss(self, q_pair: Tensor, log_pi: Tensor, batch: Batch) -> Tensor:
        """The filtered large-margin loss of the demonstrations in the batch, for both critics: (agents,)."""
        total = 0.0
        for q in q_pair:
            loss = bootstrap.large_margin_loss(q, batch.actions)
            paper = bootstrap.paper_q_filter(q.detach(), batch.actions)
            usual = bootstrap.q_filter(q.detach(), batch.actions, log_pi)
            keep = torch.where(self.of_agent["paper_q_filter"][:, None] > 0, paper, usual)
            total = total + (loss * keep * batch.is_demonstration).mean(-1)
        return total

    @torch.no_grad()
    def policy(self, states: Tensor) -> Tensor:
        """π(a|s): (agents, batch, observation) -> (agents, batch, actions)."""
        return mlp(self.actor, states).softmax(-1)

    @torch.no_grad()
    def q_values(self, states: Tensor) -> Tensor:
        """The smaller of the two critics' Q(s,a): (agents, batch, observation) -> (agents, batch, actions)."""
        return sac.min_q(self._both(self.critics, states))


def learner_for(settings: Sequence[Settings], observation_size: int, n_actions: int = N_ACTIONS) -> "SACLearner":
    """The learner of these agents. Raises BootcourseError if their methods need different ones."""
    kinds = {METHODS[s.method].learner_class() for s in settings}
    if len(kinds) > 1:
        methods = ", ".join(sorted({s.method for s in settings}))
        raise BootcourseError(f"{methods} cannot train side by side: their updates differ. Train these apart.")
    return kinds.pop()(settings, observation_size, n_actions)
