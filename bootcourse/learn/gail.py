"""Generative adversarial imitation learning: the reward is computed from a discriminator.

Ho & Ermon (arXiv 1606.03476) with an off-policy generator, as in DAC (Kostrikov et al., arXiv 1809.02925) but without
its absorbing states: a discriminator learns to distinguish demonstrations from the agent's transitions, and discrete
SAC maximises a reward that is high for transitions classified as demonstrations. The road's reward is not used.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import torch
import torch.nn.functional as F
from torch import Tensor

from bootcourse.errors import BootcourseError
from bootcourse.learn.learner import SACLearner
from bootcourse.learn.networks import init_mlp, mlp
from bootcourse.learn.protocol import generators_of
from bootcourse.learn.replay_buffer import Batch
from bootcourse.learn.settings import Settings, shared
from bootcourse.scenario import N_ACTIONS


@dataclass(frozen=True)
class GAILSettings(Settings):
    """The settings of GAIL. Half of a batch must be demonstrations."""

    discriminator_lr: float = shared(3e-4, low=0)  # § learning rate of the discriminator
    gradient_penalty: float = shared(1.0, low=0)  # § weight of its gradient penalty


def discriminator_loss(expert_logits: Tensor, own_logits: Tensor) -> Tensor:
    """-E_expert[log D] - E_own[log(1 - D)] with D = σ(logit): logits (..., batch) -> (...).

    D(s,a) is the probability that the demonstrator did a in s. Equation 17 of arXiv 1606.03476, whose D is our 1 - D.
    """
    return F.softplus(-expert_logits).mean(-1) + F.softplus(own_logits).mean(-1)


def imitation_reward(own_logits: Tensor) -> Tensor:
    """r(s,a) = -log(1 - D(s,a)), any shape. It is positive, so a longer episode has a larger return."""
    return F.softplus(own_logits)


def gradient_penalty(network: Sequence[Tensor], expert: Tensor) -> Tensor:
    """E_expert[‖∇ logit‖²] / 2, the R1 penalty (Mescheder et al., arXiv 1801.04406), which smooths the discriminator.

    expert (agents, batch, inputs) -> (agents,).
    """
    expert = expert.detach().requires_grad_()
    (slope,) = torch.autograd.grad(mlp(network, expert).sum(), expert, create_graph=True)
    return slope.square().sum(-1).mean(-1) / 2


class GAILLearner(SACLearner):
    """SAC of several agents, each with a discriminator that computes its reward.

    The first half of a batch must be demonstrations, the second half the agent's transitions.
    """

    def __init__(self, settings: Sequence[GAILSettings], observation_size: int, n_actions: int = N_ACTIONS):
        super().__init__(settings, observation_size, n_actions)
        self.n_actions, shared = n_actions, self.settings[0]
        inputs = observation_size + n_actions
        self.discriminator = init_mlp((inputs, *shared.hidden, 1), generators_of(settings, 2**32))
        for parameter in self.discriminator:
            parameter.requires_grad_()
        self.optimiser.add_param_group({"params": self.discriminator, "lr": shared.discriminator_lr})

    discriminator_loss = staticmethod(discriminator_loss)
    imitation_reward = staticmethod(imitation_reward)

    def update(self, batch: Batch) -> dict[str, Tensor]:
        """One step of the discriminator, one of SAC on the agent's half. Returns losses and curves, each (agents,).

        Raises BootcourseError if the halves of the batch are not as above.
        """
        half = batch.rewards.shape[1] // 2
        if not (batch.is_demonstration[:, :half].all() and not batch.is_demonstration[:, half:].any()):
            raise BootcourseError(
                "Half of GAIL's batch must be demonstrations: leave beta_start at 0.5, with an even batch."
            )
        pairs = torch.cat([batch.states, F.one_hot(batch.actions, self.n_actions)], dim=-1)
        logits = mlp(self.discriminator, pairs).squeeze(-1)
        loss = self.discriminator_loss(logits[:, :half], logits[:, half:])
        penalty = gradient_penalty(self.discriminator, pairs[:, :half])
        self.optimiser.zero_grad()  # the actor and the critics have no gradient here, so Adam does not change them
        (loss + self.settings[0].gradient_penalty * penalty).sum().backward()
        self.optimiser.step()
        with torch.no_grad():
            rewards = self.imitation_reward(mlp(self.discriminator, pairs[:, half:]).squeeze(-1))
        own = Batch(*(column[:, half:] for column in batch))._replace(rewards=rewards)
        return super().update(own) | {"discriminator_loss": loss.detach(), "imitation_reward": rewards.mean(-1)}

    def tensors(self) -> dict[str, list[Tensor]]:
        """SAC's tensors and the discriminator's."""
        return super().tensors() | {"discriminator": self.discriminator}
