"""What the numbers and claims in this lesson's text are computed from, beside tools/course/known.py."""

from bootcourse.course.lessons.imitation.reachable_entropy import REACHABLE, UPDATES, by_entropy  # noqa: F401
from bootcourse.research.results import Results
from tools.course.known import shipped_experiment


def with_entropy(entropy: float) -> Results:
    """The CQL agents with an actor that were trained with this target entropy (nats), beside others with another."""
    return by_entropy(shipped_experiment("reachable-entropy")["cql_sac"])[entropy]
