"""New agents for the lesson's ablation: does a bonus for demonstrated seconds help to learn the way out early?

    bootcourse study new-agents --out DIR    # about two minutes

Trained and tested as the lesson's five of each group are, with other seeds. Their number, forty of each, was decided
before the first was trained: intervals are then about a third as long as those of five.
"""

from bootcourse.learn.settings import settings_for, with_seeds
from bootcourse.learn.training import Training
from bootcourse.research.cells import results_of, tested_results
from bootcourse.research.experiment import Experiment
from bootcourse.research.jobs import Interrupted, orphaned
from bootcourse.research.results import Results
from bootcourse.research.teachers import RULE

AGENTS, FIRST = 40, 5  # of each group; their first seed: the lesson's own are 0 to 4
EPISODES, TESTS = 150, 200  # of training; held-out roads
CHANGES = {"as it is": {}, "changed": {"bonus": 0.0}}


def train_group(group: str) -> Results:
    """Train the agents of a group side by side. Measured, (agents,): success. Raises Interrupted."""
    settings = with_seeds(settings_for("bootstrapped", **CHANGES[group]), AGENTS, FIRST)
    result = Training(settings, EPISODES, learner="compiled").run(progress=False, stop=orphaned)
    if result.interrupted:
        raise Interrupted(group)
    results = tested_results(result, TESTS, RULE)
    return Results(results.agents, results.stopped, measured={"success": results.scores("success")})


CELLS = {group: {"group": group} for group in CHANGES}
EXPERIMENT = Experiment("new-agents", lambda: CELLS, results_of(train_group), ())
