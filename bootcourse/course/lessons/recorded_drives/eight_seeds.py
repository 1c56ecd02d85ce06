"""Q-learning from the lesson's recorded drives: as it is, with another target, with CQL's term; eight seeds each.

    bootcourse study offline --out DIR    # about two minutes

Trained as the lesson's two agents of each kind are. Measured, (agents,): in which share of the recorded seconds an
agent would accelerate, on how many of 100 roads it crashes, the Q of what it does at the start of a drive, and what it
is worth from there at γ = 0.8.
"""

import numpy as np
import torch
from torch import Tensor

from bootcourse.course.lessons.recorded_drives import choosing
from bootcourse.episodes.record import record
from bootcourse.learn import sac
from bootcourse.learn.cql import CQLLearner
from bootcourse.learn.learner import SACLearner
from bootcourse.learn.replay_buffer import Batch
from bootcourse.learn.settings import settings_for, with_seeds
from bootcourse.learn.training import Training
from bootcourse.policies import Policy
from bootcourse.research.cells import results_of
from bootcourse.research.experiment import Experiment
from bootcourse.research.results import Results, agent_entries
from bootcourse.scenario import DEFAULT

NAME = "offline"
SEEDS, UPDATES, BATCH, ROADS = 8, 1000, 64, 100
RULES_NEXT = "the rule's next action"
KINDS = {
    "Q-learning": {"cql_weight": 0.0},
    RULES_NEXT: {"cql_weight": 0.0},
    "with CQL's term": {},
    "CQL's term, γ = 0.01": {"gamma": 0.01},
    "no term, γ = 0.01": {"cql_weight": 0.0, "gamma": 0.01},
}


class RulesNextLearner(CQLLearner):
    """Its target takes what the rule did next, r + γ Q(s', μ(s')), in place of the action whose Q is highest."""

    def critic_target(self, batch: Batch) -> Tensor:
        """(agents, batch), like `CQLLearner`'s."""
        next_q = self.target_q(batch.next_states)  # (agents, batch, 9)
        next_value = next_q.gather(-1, batch.next_rule_actions.unsqueeze(-1)).squeeze(-1)
        return sac.critic_target(batch.rewards, batch.terminated, next_value, self.gamma)


def train_kind(kind: str) -> Results:
    """Train the agents of a kind side by side from recorded drives, and count what they do."""
    training = training_of(kind, SEEDS)
    settings, learner = training.settings, learned(training)
    policies = [learner.agent(row).as_policy(with_q=True) for row in range(SEEDS)]
    states = choosing.recorded().states
    measured = {
        "accelerate": np.array([accelerates(choosing.actions_of(policy, states)) for policy in policies]),
        "crashes": np.array([crashes(policy) for policy in policies]),
        "promises": np.array([choosing.promised(policy, choosing.starts()) for policy in policies]),
        "worth": np.array([choosing.worth(policy, range(ROADS), 0.8) for policy in policies]),
    }
    return Results(agent_entries(settings), np.full(SEEDS, -1), measured=measured)


def training_of(kind: str, seeds: int) -> Training:
    """The training of so many agents of a kind, before its first update."""
    training = Training(with_seeds(settings_for("cql", **KINDS[kind]), seeds))
    if kind == RULES_NEXT:
        training.learner = RulesNextLearner(training.settings, DEFAULT.observation_size)
    return training


def learned(training: Training) -> SACLearner:
    """Its agents after their updates from recorded drives, as in the notebook."""
    generators = [np.random.default_rng(each.seed) for each in training.settings]
    for _ in range(UPDATES):
        training.learner.update(training.replay.sample(BATCH, np.ones(len(generators)), generators))
    return training.learner


def accelerates(actions: torch.Tensor) -> float:
    """In which share of the seconds these actions accelerate."""
    return float((actions >= 6).float().mean())


def crashes(policy: Policy) -> int:
    """On how many of 100 roads a driver has an accident."""
    return sum(drive.accident > 0 for drive in record(policy, range(ROADS)))


CELLS = {kind: {"kind": kind} for kind in KINDS}
EXPERIMENT = Experiment(NAME, lambda: CELLS, results_of(train_kind), ())
