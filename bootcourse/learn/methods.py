"""Which learner a method needs. Everything around it - roads, replay, curves, files - is the same for all.

    training = Training(with_seeds(settings_for("bc"), 4), episodes=1000)

So every method has as many updates for each decision as any other, and the same curves: of the
episodes that its policy drives meanwhile. BC and CQL learn from the demonstrations alone; what they
drive is looked at and never learned from.
"""

from collections.abc import Sequence

from bootcourse.errors import BootcourseError
from bootcourse.learn.bc import BCLearner
from bootcourse.learn.cql import CQLLearner
from bootcourse.learn.gail import GAILLearner
from bootcourse.learn.learner import SACLearner
from bootcourse.learn.settings import Settings
from bootcourse.scenario import N_ACTIONS

LEARNERS = {"bc": BCLearner, "cql": CQLLearner, "gail": GAILLearner}  # all others: a `SACLearner`


def learner_for(settings: Sequence[Settings], observation_size: int, n_actions: int = N_ACTIONS) -> SACLearner:
    """The learner of these agents. Raises BootcourseError if their methods need different ones."""
    kinds = {LEARNERS.get(s.method, SACLearner) for s in settings}
    if len(kinds) > 1:
        methods = ", ".join(sorted({s.method for s in settings}))
        raise BootcourseError(f"{methods} cannot train side by side: their updates differ. Train these apart.")
    return kinds.pop()(settings, observation_size, n_actions)
