"""What the numbers and claims in this lesson's text are computed from, beside tools/course/known.py."""

from functools import cache

import numpy as np
from torch import Tensor

from bootcourse.course.lessons.demonstrations.cloning import UPDATES as UPDATES
from bootcourse.course.lessons.demonstrations.cloning import left_in
from bootcourse.course.shipped import shipped_results
from bootcourse.learn.demonstrations import collect
from bootcourse.policies import stochastic_rule_policy
from bootcourse.research.results import Results
from bootcourse.scenario import DEFAULT


@cache
def rows() -> dict[str, Tensor]:
    """The rows of 200 drives of the rule, and of 200 of the stochastic rule."""
    unsure = stochastic_rule_policy(DEFAULT, np.random.default_rng(0))
    return {"the rule": collect(200), "the stochastic rule": collect(200, policy=unsure)}


def beyond_the_band() -> int:
    """How many of the stochastic rule's rows are farther left than all of the rule's."""
    return int((left_in(rows()["the stochastic rule"]) > left_in(rows()["the rule"]).max()).sum())


def by_chance() -> Results:
    """The ten clones of the stochastic rule, trained with more updates than the study's clones of the rule."""
    return shipped_results("paper").of("bc")


def updates_of(results: Results) -> float:
    """About how many updates each of these agents had: so many follow each decision on all of its roads."""
    agent, curves = results.agents[0], results.curves
    decisions = (curves["distance"] / curves["speed"]).sum(axis=1)  # one a second
    return float(((decisions - agent["learning_starts"]) * agent["updates"] / agent["envs_per_agent"]).mean())
