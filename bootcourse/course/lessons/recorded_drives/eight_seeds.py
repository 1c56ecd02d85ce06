"""Q-learning from the lesson's recorded drives alone, as it is, short-sighted, and with CQL's term: eight seeds each.

    bootcourse study offline --out DIR    # about a minute

Trained as the lesson's two agents of each kind are. Measured, (agents,): in which share of the recorded seconds an
agent would accelerate, and on how many of 100 roads it crashes.
"""

from collections.abc import Sequence

import numpy as np
import torch

from bootcourse.course.lessons.recorded_drives import choosing
from bootcourse.episodes.record import record
from bootcourse.learn.learner import SACLearner
from bootcourse.learn.settings import Settings, settings_for, with_seeds
from bootcourse.learn.training import Training
from bootcourse.policies import Policy
from bootcourse.research.cells import results_of
from bootcourse.research.experiment import Experiment
from bootcourse.research.results import Results, agent_entries

NAME = "offline"
SEEDS, UPDATES, BATCH, ROADS = 8, 1000, 64, 100
KINDS = {
    "Q-learning": {"cql_weight": 0.0},
    "γ = 0.01": {"cql_weight": 0.0, "gamma": 0.01},
    "with CQL's term": {},
}


def train_kind(kind: str) -> Results:
    """Train the agents of a kind side by side from recorded drives, and count what they do."""
    settings = with_seeds(settings_for("cql", **KINDS[kind]), SEEDS)
    learner = learned(settings)
    policies = [learner.agent(row).as_policy() for row in range(SEEDS)]
    states = choosing.recorded().states
    measured = {
        "accelerate": np.array([accelerates(choosing.actions_of(policy, states)) for policy in policies]),
        "crashes": np.array([crashes(policy) for policy in policies]),
    }
    return Results(agent_entries(settings), np.full(SEEDS, -1), measured=measured)


def learned(settings: Sequence[Settings]) -> SACLearner:
    """Agents after their updates from recorded drives, as in the notebook."""
    training, generators = Training(settings), [np.random.default_rng(each.seed) for each in settings]
    for _ in range(UPDATES):
        training.learner.update(training.replay.sample(BATCH, np.ones(len(settings)), generators))
    return training.learner


def accelerates(actions: torch.Tensor) -> float:
    """In which share of the seconds these actions accelerate."""
    return float((actions >= 6).float().mean())


def crashes(policy: Policy) -> int:
    """On how many of 100 roads a driver has an accident."""
    return sum(drive.accident > 0 for drive in record(policy, range(ROADS)))


CELLS = {kind: {"kind": kind} for kind in KINDS}
EXPERIMENT = Experiment(NAME, lambda: CELLS, results_of(train_kind), ())
