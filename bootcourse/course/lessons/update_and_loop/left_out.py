"""SAC with one part left out: some agents of each kind learn to balance the pole side by side."""

from collections.abc import Sequence

import torch
from torch import Tensor

from bootcourse.learn import sac
from bootcourse.learn.learner import SACLearner
from bootcourse.learn.replay_buffer import Batch
from bootcourse.learn.settings import Settings, with_seeds
from bootcourse.learn.training import Training
from bootcourse.research.experiments import checks
from bootcourse.research.experiments.checks import several

WHOLE = "nothing: the whole agent"
KINDS = (WHOLE, "the entropy", "the second critic", "the slow copies", "(1 − terminated)")


class LeftOut(SACLearner):
    """A learner whose agents each leave out a part: kinds, one of `KINDS` for each agent."""

    def __init__(self, kinds: Sequence[str], *arguments):
        super().__init__(*arguments)
        self.kinds = kinds

    def without(self, part: str) -> Tensor:
        """Which agents leave this part out, (agents, 1, 1)."""
        return torch.tensor([kind == part for kind in self.kinds])[:, None, None]

    def note_temperature(self) -> None:
        super().note_temperature()
        if hasattr(self, "kinds"):  # not yet while the base makes its parts
            self.alpha[self.without("the entropy")[:, 0]] = 0.0

    def one_q(self, q_pair: Tensor) -> Tensor:
        return torch.where(self.without("the second critic"), q_pair[0], sac.min_q(q_pair))

    def target_q(self, states: Tensor) -> Tensor:
        slow, now = (self.one_q(self.q_pair(critics, states)) for critics in (self.target_critics, self.critics))
        return torch.where(self.without("the slow copies"), now, slow)

    def critic_target(self, batch: Batch) -> Tensor:
        goes_on = torch.where(self.without("(1 − terminated)")[:, 0], 0.0, batch.terminated)
        return super().critic_target(batch._replace(terminated=goes_on))


def training(settings: Settings, seeds: int, pushes: int, kinds: Sequence[str] = KINDS) -> Training:
    """A training of `seeds` agents of each kind, in the order of `kinds`. Run it until `pushes` decisions each."""
    agents = with_seeds(settings, seeds) * len(kinds)
    each = [kind for kind in kinds for _ in range(seeds)]
    return Training(agents, pushes, make_env=several(checks.cartpole),
                    make_learner=lambda *arguments: LeftOut(each, *arguments))  # fmt: skip
