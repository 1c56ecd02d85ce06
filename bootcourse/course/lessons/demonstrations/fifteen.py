"""Do the clones of the lesson on demonstrations crash as often with other seeds?

    bootcourse study clones --out DIR    # some minutes

Fifteen clones of each data set, with other seeds than the lesson's own. `ALIKE` is DAgger's control: as many drives as
its last clones learn from, all of the rule. Other processors round otherwise, and may give other clones.
"""

import numpy as np

from bootcourse.course.lessons.demonstrations import cloning
from bootcourse.learn.bc import cloning_loss
from bootcourse.learn.demonstrations import collect
from bootcourse.learn.settings import settings_for, with_seeds
from bootcourse.policies import stochastic_rule_policy
from bootcourse.research.cells import results_of
from bootcourse.research.experiment import Experiment
from bootcourse.research.results import Results, agent_entries
from bootcourse.research.teachers import RULE
from bootcourse.scenario import DEFAULT

FIRST, SEEDS = 5, 15  # the lesson has the seeds 0 to 4
RULE_S, STOCHASTIC, ALIKE, TAUGHT = "the rule's drives", "the stochastic rule's drives", "60 drives", "DAgger"
ADDED = tuple(cloning.ADDED.values())
MEASURES = ("agrees", "own", "accidents", "returns")  # the columns of `cloning.measure`


def measured(kind: str) -> np.ndarray:
    """Of each clone of a kind, after each round of DAgger, the columns of `cloning.measure`: (clones, rounds, 4)."""
    by_rule, seeds = collect(200), range(FIRST, FIRST + SEEDS)
    if kind == TAUGHT:
        trainings = cloning.Trainings(cloning_loss, seeds)
        drivers = cloning.dagger(trainings.begin(collect(20)), trainings.train, trainings.drive, rounds=2)
        return np.array([cloning.measure(each, by_rule[::10]) for each in zip(*drivers, strict=True)])
    if kind == RULE_S:
        rows = by_rule
    elif kind == ALIKE:
        rows = collect(60)
    else:
        rows = collect(200, policy=stochastic_rule_policy(DEFAULT, np.random.default_rng(0)))
        if kind != STOCHASTIC:
            rows[:, cloning.ACTION] = rows[:, cloning.RULE_ACTION]
            more = [*cloning.rows_to_add(by_rule, rows).values()][ADDED.index(kind)]
            rows = cloning.with_added(by_rule, more)
    return cloning.measure(cloning.clones({kind: rows}, seeds=seeds)[kind], rows)[:, None]


def clones_of(kind: str) -> Results:
    """The clones of a kind."""
    values = measured(kind)
    entries = agent_entries(with_seeds(settings_for("bc"), SEEDS, FIRST), RULE)
    notes = {name: values[:, :, k] for k, name in enumerate(MEASURES)}
    return Results(entries, np.full(SEEDS, -1), notes=notes)


CELLS = {kind: {"kind": kind} for kind in (RULE_S, STOCHASTIC, *ADDED, ALIKE, TAUGHT)}
EXPERIMENT = Experiment("clones", lambda: CELLS, results_of(clones_of))
