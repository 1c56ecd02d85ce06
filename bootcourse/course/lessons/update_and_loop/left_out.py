"""SAC with one part left out: agents of each kind side by side, and an agent of the lesson's that is told of no end."""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
import torch
from torch import Tensor

from bootcourse.course.lessons.update_and_loop import by_hand
from bootcourse.learn import sac
from bootcourse.learn.learner import SACLearner
from bootcourse.learn.replay_buffer import Batch
from bootcourse.learn.settings import with_seeds
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


def scores(seeds: int, pushes: int) -> np.ndarray:
    """Train `seeds` agents of each kind for `pushes` each; for how many pushes each then balances: (kinds, seeds).

    They have the road's learning rates and batches of 64 rows. Of the seeds 0 to 8, after 1,500 to 4,000 pushes, each
    without (1 − terminated) balances for 9 pushes; all others are above after 2,500.
    """
    settings = checks.usual("sac", 2, **checks.SAC)
    kinds = [kind for kind in KINDS for _ in range(seeds)]
    training = Training(with_seeds(settings, seeds) * len(KINDS), pushes, make_env=several(checks.cartpole),
                        make_learner=lambda *arguments: LeftOut(kinds, *arguments))  # fmt: skip
    training.run(progress=False, stop=lambda: training.decisions >= pushes * len(kinds))
    return checks.scores(training.result().agents, checks.cartpole, 10).reshape(-1, seeds)


# A buffer that is told of no end ------------------------------------------------------------------------

EVERY = 20  # updates from one look at Q to the next


class WithoutEnds:
    """A buffer that is told of no end: terminated is 0 in all rows.

    also: a state that gets a row for either push at each fall, which leads back to it and pays 1: "fallen", the one
    after the fall; "upright", all zeros; or "" for none.
    """

    def __init__(self, buffer, also: str = ""):
        self.buffer, self.also = buffer, also

    def add(self, kept: Tensor) -> None:
        if kept[6] and self.also:
            state = kept[7:] if self.also == "fallen" else torch.zeros(4)
            for action in (0, 1):
                self.buffer.add(by_hand.row(state, action, 1.0, False, state))
        self.buffer.add(torch.cat([kept[:6], torch.zeros(1), kept[7:]]))

    def sample(self, batch: int, rng: np.random.Generator) -> Tensor:
        return self.buffer.sample(batch, rng)


class Watched:
    """An update that notes the mean Q of some states, of both critics and for both pushes, after each 20th update."""

    def __init__(self, update, states: Tensor):
        self.update, self.states, self.updates, self.q = update, states, 0, []

    def __call__(self, agent: by_hand.SAC, batch: by_hand.Batch) -> None:
        self.update(agent, batch)
        self.updates += 1
        if self.updates % EVERY == 0:
            with torch.no_grad():
                self.q.append(float(agent.q(self.states).mean()))


class Learned(NamedTuple):
    """Agents after training, and what their critics expected of the start: q (agents, points), `Watched`.

    pushes: for how many each balances, by the most probable ones, (agents,).
    """

    agents: list[by_hand.SAC]
    q: np.ndarray
    pushes: np.ndarray


def learn(
    loop, update, buffer, also: str = "", ends: bool = False, seeds: int = 2, pushes: int = 1_300, tau: float = 0.15
) -> Learned:
    """Train agents that are told of no end. loop, update, buffer: the exercises' answers. also: see `WithoutEnds`.

    ends: for comparison, the buffer keeps its rows with their ends.

    α is held, so that entropy cannot raise Q, and the copies follow faster than in the lesson's other agents. Of the
    seeds 0 to 7 each is above 100 in the end, but for those with rows of fallen states, which are all below. So it is
    with τ = 0.1 after 2,000 pushes. With τ = 0.5 rows of fallen states do not keep the estimates low. Of the same seeds
    each balances for 9 pushes, those with rows of fallen states, too; told of the ends, for 171 to 316.
    """
    starts = torch.from_numpy(np.stack([checks.cartpole().reset(seed=seed)[0] for seed in range(50)]))
    agents, noted = [], []
    for seed in range(seeds):
        agent, step = by_hand.SAC(seed, rates=(3e-3, 2e-3, 0)), Watched(update, starts)  # α stays at 0.01
        agent.tau = tau
        rows = buffer(50_000) if ends else WithoutEnds(buffer(50_000), also)
        rng = np.random.default_rng(seed)
        loop(agent, checks.cartpole(), rows, step, pushes, rng)
        agents.append(agent)
        noted.append(step.q)
    return Learned(agents, np.array(noted), checks.scores(agents, checks.cartpole, 10))


# A fall, state by state ---------------------------------------------------------------------------------

BEFORE = 8  # pushes before the fall from which a fall is shown


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
def along_falls(agents: Sequence[by_hand.SAC]) -> np.ndarray:
    """What critics expect in the last states of a fall, a mean of 40 falls, both critics, both pushes: (agents, 9).

    Of the agents of `learn` that get no more rows (seeds 0 to 7) each expects most of the fallen state; told of the
    ends, each expects least of it.
    """
    states = torch.from_numpy(np.stack([states[-BEFORE - 1 :] for states in to_one_side()]))
    return np.array([agent.q(states.flatten(0, 1)).mean((0, 2)).view(states.shape[:2]).mean(0) for agent in agents])
