"""What the numbers and claims in this lesson's text are computed from, beside tools/course/known.py."""

from bootcourse.course.lessons.demonstrations.cloning import UPDATES as UPDATES
from bootcourse.course.shipped import shipped_results
from bootcourse.research.results import Results


def by_chance() -> Results:
    """The ten clones of the stochastic rule, trained with more updates than the study's clones of the rule."""
    return shipped_results("paper").of("bc")


def updates_of(results: Results) -> float:
    """About how many updates each of these agents had: so many follow each decision on all of its roads."""
    agent, curves = results.agents[0], results.curves
    decisions = (curves["distance"] / curves["speed"]).sum(axis=1)  # one a second
    return float(((decisions - agent["learning_starts"]) * agent["updates"] / agent["envs_per_agent"]).mean())
