"""Six silent bugs that occur in practice, and agents that were trained with each.

Each bug is a `SACLearner` whose update is wrong in one place. No error is raised, no number is NaN, and the
curves look plausible.

    bootcourse study bug-hunt --out DIR    # trains all seven in some minutes

The results that ship hold curves, probes and weights; `Hunt` reads them and calls the agents A to F.
"""

import math
from collections.abc import Callable, Sequence
from functools import cache
from unittest.mock import patch

import numpy as np
import torch
from torch import Tensor

from bootcourse.episodes.record import record
from bootcourse.episodes.rollout import Rollout
from bootcourse.errors import BootcourseError, check_known
from bootcourse.learn import bootstrap, sac
from bootcourse.learn.agent import Agent
from bootcourse.learn.demonstrations import demonstration_rows
from bootcourse.learn.learner import SACLearner
from bootcourse.learn.replay_buffer import Batch, decode_transitions
from bootcourse.learn.settings import settings_for, with_seeds
from bootcourse.learn.training import Training
from bootcourse.policies import rule_policy
from bootcourse.research.cells import results_of
from bootcourse.research.computed import experiment
from bootcourse.research.experiment import Experiment
from bootcourse.research.results import Results, agent_entries, weights_of
from bootcourse.scenario import DEFAULT, RULE_P
from bootcourse.statistics import rolling_means

# The six bugs ----------------------------------------------------------------------------------------


class FlippedKL(SACLearner):
    """The KL divergence is taken the other way round: D_KL(π̃ ‖ π)."""

    def kl(self, log_pi: Tensor, rule_actions: Tensor) -> Tensor:
        return bootstrap.kl_from_rule(log_pi, rule_actions, self.rule_p[:, 0])


class NoEnd(SACLearner):
    """(1 - terminated) is missing: the target adds the next value after an accident, too."""

    def critic_target(self, batch: Batch) -> Tensor:
        return super().critic_target(batch._replace(terminated=torch.zeros_like(batch.terminated)))


class Sampled(SACLearner):
    """One sampled action replaces the expectation, as in SAC for continuous actions."""

    draws = None

    def soft_value(self, log_pi: Tensor, q: Tensor, alpha: Tensor, constraint: Tensor) -> Tensor:
        """Q(s, a) - α log π(a|s) of one action a ~ π; the draw has no gradient."""
        self.draws = self.draws or torch.Generator().manual_seed(0)
        action = torch.multinomial(log_pi.detach().exp().flatten(0, -2), 1, generator=self.draws)
        action = action.view(*log_pi.shape[:-1], 1)
        return q.gather(-1, action)[..., 0] - alpha * log_pi.gather(-1, action)[..., 0] - constraint

    def actor_loss(self, log_pi: Tensor, q: Tensor, kl: Tensor) -> Tensor:
        return -self.soft_value(log_pi, q.detach(), self.alpha, self.xi * kl).mean(-1)


class NoStop(SACLearner):
    """The stop-gradient on Q is missing in the actor's loss."""

    def actor_loss(self, log_pi: Tensor, q: Tensor, kl: Tensor) -> Tensor:
        return -sac.soft_value(log_pi, q, self.alpha, self.xi * kl).mean(-1)


class BonusForAll(SACLearner):
    """The bonus c is paid for the agent's own driving as well."""

    def critic_target(self, batch: Batch) -> Tensor:
        return super().critic_target(batch._replace(is_demonstration=torch.ones_like(batch.is_demonstration)))


class ShiftedLabels(SACLearner):
    """The rule is asked after the step: each label belongs to the state one second later."""

    def losses(self, batch: Batch) -> dict[str, Tensor]:
        return super().losses(batch._replace(rule_actions=batch.next_rule_actions))


BUGS = {
    "flipped_kl": FlippedKL,
    "no_end": NoEnd,
    "sampled": Sampled,
    "no_stop": NoStop,
    "bonus_for_all": BonusForAll,
    "shifted_labels": ShiftedLabels,
}
LEARNERS = {"none": SACLearner, **BUGS}
LETTERS = "ABCDEF"
SHUFFLE = 2025  # the seed that assigns the letters
SEEDS, UPDATES, EVERY = 2, 10_000, 250  # agents with each bug; updates of each; updates between two probes
ROADS = range(900, 908)  # whose drives by the rule give the states of the probes
PROBES = ("kl", "entropy", "alike", "late", "rarest", "promise", "end")
CURVES = ("success", "return", "accident", "alpha")

# Tests without training ------------------------------------------------------------------------------


def transitions(drives: Sequence[Rollout]) -> Batch:
    """The transitions of some drives as NumPy arrays, (T, ...): what a probe of the critic is given."""
    return Batch(*(values[0].numpy() for values in _as_batch(drives)))


def labels(bug: str, drive: Rollout) -> np.ndarray:
    """What an untrained learner with a bug, "none" for none, takes for the rule's action before each step: (T,)."""
    learner = _untrained(bug)
    with patch.object(learner, "kl", wraps=learner.kl) as kl:
        learner.losses(_as_batch([drive]))
    return kl.call_args.args[1][0].numpy()  # the last KL is the actor's, in s; the one before is the target's, in s'


def target_of(bug: str) -> Callable:
    """The critic's target of an untrained learner, in double precision, as a function that a test can call."""

    def target(reward, demo, bonus, end, next_value, gamma):
        columns = np.broadcast_arrays(*(np.asarray(each, float) for each in (reward, demo, end, next_value)))
        reward, demo, end, next_value = (torch.tensor(column.reshape(1, -1)) for column in columns)
        learner, nothing = _untrained(bug), torch.zeros_like(reward, dtype=torch.int64)
        learner.bonus, learner.gamma = (torch.tensor([[value]], dtype=torch.float64) for value in (bonus, gamma))
        states = torch.zeros(*reward.shape, DEFAULT.observation_size)
        batch = Batch(states, states, nothing, reward, end, nothing, nothing, demo)
        with patch.object(learner, "soft_value", lambda *_: next_value):
            return learner.critic_target(batch).detach().numpy().reshape(columns[0].shape)

    return target


@cache
def pull(bug: str, states: int = 2_000) -> float:
    """How strongly the actor's loss of an untrained learner raises the logit of an action that is worth 5 more.

    Nine equally likely actions, KL 0, in so many states: minus the mean slope, as `sampled` draws in each state.
    """
    logits = torch.zeros(1, states, 9, requires_grad=True)
    q = 5.0 * torch.nn.functional.one_hot(torch.zeros(1, states, dtype=torch.int64), 9)
    loss = _untrained(bug).actor_loss(logits.log_softmax(-1), q, torch.zeros(1, states))
    return -float(torch.autograd.grad(loss.sum(), logits)[0][0, :, 0].sum())


def _untrained(bug: str) -> SACLearner:
    return LEARNERS[bug]([settings_for("bootstrapped")], DEFAULT.observation_size)


def _as_batch(drives: Sequence[Rollout]) -> Batch:
    rows = demonstration_rows(drives)[None]
    return decode_transitions(rows, DEFAULT.observation_size, torch.zeros(rows.shape[:2]))


# Training them ---------------------------------------------------------------------------------------


class Probe:
    """A training's callback: measures every agent every 250 updates, on states of drives by the rule.

    kl: mean D_KL(π ‖ π̃) in nats. entropy: mean H(π) in nats. alike: share of the states whose most probable
    action is the rule's. late: the same for the rule's action one second later. rarest: mean log of the
    smallest of the nine probabilities. promise: mean Σ_a π Q. end: mean Q(s, a) of the agent's own
    decisions that ended in an accident; their right value is -10.
    """

    def __init__(self):
        drives = record(rule_policy(DEFAULT), ROADS)
        self.states = np.concatenate([drive.observations[:-2] for drive in drives])
        self.now = torch.from_numpy(np.concatenate([drive.rule_actions[:-1] for drive in drives]))
        self.later = torch.from_numpy(np.concatenate([drive.rule_actions[1:] for drive in drives]))
        self.updates, self.rows = [], []

    def __call__(self, training: Training) -> None:
        if training.updates % EVERY or training.updates in self.updates:
            return
        self.updates.append(training.updates)
        self.rows.append([self.look(training, i) for i in range(training.n_agents)])

    def look(self, training: Training, i: int) -> list[float]:
        agent = training.agent(i)
        pi, q = agent.probabilities(self.states), agent.q_values(self.states)
        log_pi = torch.from_numpy(pi).clamp(min=1e-30).log()
        likeliest = log_pi.argmax(-1)
        measured = (
            bootstrap.kl_to_rule(log_pi, self.now, torch.tensor(RULE_P)),
            sac.entropy(log_pi),
            (likeliest == self.now).float(),
            (likeliest == self.later).float(),
            log_pi.amin(-1),
            torch.from_numpy((pi * q).sum(-1)),
        )
        return [float(values.mean()) for values in measured] + [self.at_the_end(training, i, agent)]

    @staticmethod
    def at_the_end(training: Training, i: int, agent: Agent) -> float:
        first = training.replay.first[i]
        rows = training.replay.table[first : first + training.replay.size]
        own = decode_transitions(rows, training.scenario.observation_size, rows[:, 0])
        ended = own.terminated > 0
        if not ended.any():
            return math.nan
        q = torch.from_numpy(agent.q_values(own.states[ended].numpy()))
        return float(q.gather(-1, own.actions[ended][:, None]).mean())


def train_bug(bug: str, updates: int = UPDATES) -> Results:
    """Train the paper's method with a bug, "none" for none: curves, probes, and the weights of the first agent."""
    settings, probe = with_seeds(settings_for("bootstrapped"), SEEDS), Probe()
    training = Training(settings, 4000, make_learner=LEARNERS[bug])
    result = training.run(progress=False, callback=probe, stop=lambda: training.updates >= updates)
    episodes = int(training.curves.finished.max())
    probes = np.array(probe.rows, dtype=np.float32).reshape(-1, SEEDS, len(PROBES)).transpose(2, 1, 0)
    return Results(
        agent_entries(training.settings),
        np.full(SEEDS, -1),
        curves={name: result.curves[name][:, :episodes].astype(np.float16) for name in CURVES},
        notes={"updates": np.tile(probe.updates, (SEEDS, 1)), **dict(zip(PROBES, probes, strict=True))},
        measured={"alpha": np.array([agent.alpha for agent in result.agents])},
        weights=weights_of(result.agents[:1], "actor", "critics"),
    )


EXPERIMENT = Experiment("bug-hunt", lambda: {bug: {"bug": bug} for bug in LEARNERS}, results_of(train_bug))


# Reading them ----------------------------------------------------------------------------------------


class Hunt:
    """The trained agents under the names that the student sees: "healthy", and A to F with one bug each.

    Raises BootcourseError if some agents are missing or damaged, or for another name.
    """

    def __init__(self):
        self._results = experiment("bug-hunt")
        if missing := LEARNERS.keys() - self._results.keys():
            raise BootcourseError(f"No agents of {', '.join(missing)} ship: run `bootcourse study bug-hunt --out DIR`.")
        bugs = np.random.default_rng(SHUFFLE).permutation(list(BUGS)).tolist()
        self._bug_of = {"healthy": "none", **dict(zip(LETTERS, bugs, strict=True))}
        self.names = tuple(self._bug_of)
        self.updates = self._results["none"].notes["updates"][0]  # (points,)

    def _of(self, name: str) -> Results:
        check_known("The agent", name, self.names)
        return self._results[self._bug_of[name]]

    def curve(self, name: str, what: str) -> np.ndarray:
        """success, return, accident (1 or 0) or alpha of every training episode: (2 seeds, episodes)."""
        values = self._of(name).curves[what].astype(float)
        return np.where(values > 0, 1.0, values) if what == "accident" else values

    def probe(self, name: str, what: str) -> np.ndarray:
        """One of `PROBES` after each of `updates`: (2 seeds, points)."""
        return self._of(name).notes[what].astype(float)

    def curves(self, what: str, window: int = 30) -> dict[str, tuple[np.ndarray, np.ndarray]]:
        """A curve of every agent, for a picture: {name: (episode (points,), rolling means (2, points))}.

        The seeds made as many updates, and not as many episodes: a shorter curve is NaN where it has ended.
        """
        curves = {}
        for name in self.names:
            curve = self.curve(name, what)
            longest = int(np.isfinite(curve).sum(axis=1).max())
            curves[name] = rolling_means(curve[:, :longest], window, longest)
        return curves

    def at_the_end(self, what: str, window: int = 30) -> dict[str, np.ndarray]:
        """The mean of the last episodes of every seed: {name: (2,)}."""
        ends = {}
        for name in self.names:
            rows = [row[np.isfinite(row)] for row in self.curve(name, what)]
            ends[name] = np.array([row[-window:].mean() for row in rows])
        return ends

    def probes(self, what: str) -> dict[str, tuple[np.ndarray, np.ndarray]]:
        """A probe of every agent, for a picture: {name: (updates (points,), values (2, points))}."""
        return {name: (self.updates, self.probe(name, what)) for name in self.names}

    def agent(self, name: str) -> Agent:
        """The agent of the first seed at the end of its training."""
        return self._of(name).agent()
