"""The paper's algorithm for one agent, in plain torch. Start reading here.

    python -m bootcourse.learn.textbook

trains an agent of each of two methods in a few minutes, and prints how often it escapes. `learner.py` does the same for
many agents at once; a test compares the two. Shapes: `batch` is the batch size (64), 26 the observation, 9 the actions.
"""

import copy
import random

import numpy as np
import torch
import torch.nn.functional as F
from torch import Tensor, nn

from bootcourse.learn.demonstrations import collect
from bootcourse.learn.replay_buffer import Batch, decode_transitions, encode_transitions
from bootcourse.learn.settings import Settings, settings_for
from bootcourse.policies import PolicyOutput
from bootcourse.road.vector_env import TrapVectorEnv
from bootcourse.rule import rule
from bootcourse.scenario import DEFAULT


def mlp(inputs: int, outputs: int, hidden: tuple[int, int]) -> nn.Sequential:
    """A network with two hidden layers: (batch, inputs) -> (batch, outputs)."""
    first, second = hidden
    layers = nn.Linear(inputs, first), nn.ReLU(), nn.Linear(first, second), nn.ReLU(), nn.Linear(second, outputs)
    return nn.Sequential(*layers).float()


class TextbookSAC:
    """An actor, two critics with target critics, a temperature, and an optimiser for each."""

    def __init__(self, settings: Settings, observation_size: int = 26, n_actions: int = 9):
        self.s, self.n_actions = settings, n_actions
        self.actor = mlp(observation_size, n_actions, settings.hidden)  # (batch, 26) -> logits (batch, 9)
        self.critics = [mlp(observation_size, n_actions, settings.hidden) for _ in range(2)]  # -> Q(s, .) (batch, 9)
        self.targets = [copy.deepcopy(critic) for critic in self.critics]
        self.log_alpha = nn.Parameter(torch.tensor(settings.alpha_init, dtype=torch.float32).log())
        self.actor_optimiser = torch.optim.Adam(self.actor.parameters(), lr=settings.actor_lr)
        both = [*self.critics[0].parameters(), *self.critics[1].parameters()]
        self.critic_optimiser = torch.optim.Adam(both, lr=settings.critic_lr)
        self.alpha_optimiser = torch.optim.Adam([self.log_alpha], lr=settings.alpha_lr)

    def kl(self, log_pi: Tensor, rule_actions: Tensor) -> Tensor:
        """D_KL(π ‖ π̃) to the stochastic rule (Equations 15, 16): (batch, 9), (batch,) -> (batch,)."""
        pi_rule = torch.full_like(log_pi, (1 - self.s.rule_p) / (self.n_actions - 1))  # (batch, 9)
        pi_rule.scatter_(1, rule_actions[:, None], self.s.rule_p)
        return (log_pi.exp() * (log_pi - pi_rule.log())).sum(1)

    def critic_target(self, batch: Batch, alpha: float, xi: float) -> Tensor:
        """y = r + c + γ V(s'), with the entropy and the KL in V (Equations 6, 15, 20): (batch,)."""
        log_pi = F.log_softmax(self.actor(batch.next_states), dim=1)  # (batch, 9)
        q = torch.min(*(target(batch.next_states) for target in self.targets))  # (batch, 9)
        value = (log_pi.exp() * (q - alpha * log_pi)).sum(1)  # (batch,), an exact expectation over 9 actions
        if self.s.kl_in_target:
            value = value - xi * self.kl(log_pi, batch.next_rule_actions)
        reward = batch.rewards + self.s.bonus * batch.is_demonstration  # Equation 20: c for demonstrations
        return reward + self.s.gamma * (1 - batch.terminated) * value

    def critic_loss(self, q: Tensor, target: Tensor, log_pi: Tensor, batch: Batch) -> Tensor:
        """One critic's squared error, plus the filtered margin (Equations 17 to 19) if its weight is above 0."""
        q_taken = q.gather(1, batch.actions[:, None]).squeeze(1)  # (batch,)
        loss = F.mse_loss(q_taken, target)
        if self.s.margin > 0:
            margins = torch.ones_like(q).scatter_(1, batch.actions[:, None], 0.0)  # l(a_E, a), (batch, 9)
            printed = q_taken >= q.max(1).values
            usual = q_taken > (log_pi.exp() * q).sum(1)
            keep = (printed if self.s.paper_q_filter else usual) * batch.is_demonstration
            loss = loss + self.s.margin * (((q + margins).max(1).values - q_taken) * keep.detach()).mean()
        return loss

    def actor_loss(self, log_pi: Tensor, q: Tensor, alpha: float, xi: float, batch: Batch) -> Tensor:
        """Minus the objective of the policy, Q + α H - ξ KL (Equation 15)."""
        constraint = xi * self.kl(log_pi, batch.rule_actions)  # (batch,)
        return ((log_pi.exp() * (alpha * log_pi - q)).sum(1) + constraint).mean()

    def temperature_loss(self, log_pi: Tensor) -> Tensor:
        """α (H - η): minimising it lowers α while the entropy is above its target η."""
        entropy = -(log_pi.exp() * log_pi).sum(1).mean()
        return self.log_alpha.exp() * (entropy - self.s.target_entropy)

    def update(self, batch: Batch) -> None:
        """One gradient step of critics, actor and temperature; all losses are computed before the first step."""
        alpha = self.log_alpha.exp().item()
        xi = self.s.xi_multiplier * alpha if self.s.xi_fixed is None else self.s.xi_fixed  # ξ = 200 α
        xi = max(xi, self.s.xi_min)
        with torch.no_grad():
            target = self.critic_target(batch, alpha, xi)  # (batch,)
        log_pi = F.log_softmax(self.actor(batch.states), dim=1)  # (batch, 9)
        values = [critic(batch.states) for critic in self.critics]  # two of (batch, 9)
        one, other = (self.critic_loss(q, target, log_pi.detach(), batch) for q in values)
        actor_loss = self.actor_loss(log_pi, torch.min(*values).detach(), alpha, xi, batch)
        minimise(self.critic_optimiser, one + other)
        minimise(self.actor_optimiser, actor_loss)
        minimise(self.alpha_optimiser, self.temperature_loss(log_pi.detach()))
        with torch.no_grad():  # Polyak averaging
            for critic, target_critic in zip(self.critics, self.targets, strict=True):
                for new, old in zip(critic.parameters(), target_critic.parameters(), strict=True):
                    old.lerp_(new, self.s.tau)


def minimise(optimiser: torch.optim.Optimizer, loss: Tensor) -> None:
    """One step of an optimiser."""
    optimiser.zero_grad()
    loss.backward()
    optimiser.step()


def train(settings: Settings, episodes: int) -> tuple[TextbookSAC, list[bool]]:
    """Train an agent; returns it, and whether each training episode ended ahead of trap 1."""
    torch.manual_seed(settings.seed)
    agent, escaped, memory = TextbookSAC(settings), [], []
    demonstrations = collect(settings.demonstration_episodes) if settings.beta_start > 0 else []  # (n, row)
    env = TrapVectorEnv(settings.envs_per_agent)
    states, _ = env.reset(seed=settings.seed)  # (envs, 26)
    while len(escaped) < episodes:
        with torch.no_grad():
            pi = agent.actor(torch.from_numpy(states)).softmax(1)  # (envs, 9)
        actions, mu = torch.multinomial(pi, 1).squeeze(1).numpy(), rule(env.cars, DEFAULT).actions  # a ~ π, and μ(s)
        next_states, rewards, terminated, truncated, infos = env.step(actions)
        reached, reached_cars, ended = next_states.copy(), env.cars.copy(), terminated | truncated
        if ended.any():  # these roads were reset in the same step: s' is the old episode's last state
            reached[ended], reached_cars[ended] = np.stack(infos["final_obs"][ended]), env.final_cars[ended]
            escaped += infos["final_info"]["is_success"][ended].tolist()
        next_mu = rule(reached_cars, DEFAULT).actions  # μ(s')
        memory += encode_transitions(states, reached, actions, rewards, terminated, mu, next_mu)  # one row each
        del memory[: -settings.buffer_size]
        states = next_states
        if len(memory) >= settings.learning_starts:
            beta = settings.beta_start * max(0, 1 - len(escaped) / settings.beta_episodes)  # Section IV-B: β decreases
            n = round(beta * settings.batch)  # demonstrations in this batch
            rows = [*random.choices(demonstrations, k=n), *random.choices(memory, k=settings.batch - n)]
            agent.update(decode_transitions(torch.stack(rows), 26, (torch.arange(settings.batch) < n).float()))
    return agent, escaped


if __name__ == "__main__":
    from bootcourse.episodes.evaluate import evaluate

    torch.set_num_threads(1)
    random.seed(0)
    for method in ("sac", "bootstrapped"):
        agent, escaped = train(settings_for(method), episodes=400)
        greedy = lambda observations, cars, actor=agent.actor: PolicyOutput(  # noqa: E731
            actor(torch.from_numpy(observations)).argmax(1).numpy()
        )
        print(f"{method}: escaped in {sum(escaped[-100:])} of its last 100 training episodes,", end=" ")
        print(f"and in {100 * evaluate(greedy, 200).success.value:.0f} % of 200 held-out roads")
