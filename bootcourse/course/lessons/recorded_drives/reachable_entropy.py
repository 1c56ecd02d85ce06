"""GAIL, and CQL with an actor, with a target entropy that nine actions can reach.

    bootcourse study reachable-entropy --out DIR    # some minutes

The study trains both with the paper's η = -1 nat, below every entropy that a policy over actions can have. Here five
agents of each method have η = 0.3 log 9 and five have η = -1, with the same seeds and as many updates.
"""

import math

from bootcourse.learn.settings import settings_for, with_seeds
from bootcourse.learn.training import Training
from bootcourse.research.cells import results_of, tested_results
from bootcourse.research.experiment import Experiment
from bootcourse.research.jobs import Interrupted, orphaned
from bootcourse.research.results import Results
from bootcourse.research.teachers import RULE
from bootcourse.scenario import N_ACTIONS

METHODS = ("gail", "cql_sac")
REACHABLE = 0.3 * math.log(N_ACTIONS)  # nats
ENTROPIES = (-1.0, REACHABLE)
SEEDS = 5
UPDATES = 12_000  # the study's GAIL agents had long found the way out by then
EPISODES = 10_000  # more than any of these trainings drives
TESTS = 800  # held-out roads


def train_method(method: str) -> Results:
    """Train the agents of a method side by side. Raises Interrupted."""
    settings = [agent for η in ENTROPIES for agent in with_seeds(settings_for(method, target_entropy=η), SEEDS)]
    training = Training(settings, EPISODES)
    result = training.run(progress=False, updates=UPDATES, stop=orphaned)
    if training.updates < UPDATES:
        raise Interrupted(method)
    return tested_results(result, TESTS, RULE)


CELLS = {method: {"method": method} for method in METHODS}
EXPERIMENT = Experiment("reachable-entropy", lambda: CELLS, results_of(train_method), ())


def by_entropy(results: Results) -> dict[float, Results]:
    """The agents of such a file of results, by their target entropy (nats), the lowest first."""
    entropies = sorted({agent["target_entropy"] for agent in results.agents})
    return {
        each: results.pick(i for i, agent in enumerate(results.agents) if agent["target_entropy"] == each)
        for each in entropies
    }
