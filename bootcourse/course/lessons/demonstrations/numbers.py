"""What the numbers and claims in this lesson's text are computed from, beside tools/course/known.py."""

from functools import cache

import numpy as np
import torch

from bootcourse.course.lessons.demonstrations import cloning
from bootcourse.course.lessons.demonstrations.cloning import UPDATES as UPDATES
from bootcourse.learn.demonstrations import demonstrate
from bootcourse.policies import stochastic_rule_policy
from bootcourse.research.results import Results
from bootcourse.scenario import DEFAULT
from tools.course.known import shipped_results


def clones_of_the_stochastic_rule() -> Results:
    """The ten clones of the study with the paper's choices, where the stochastic rule drives the demonstrations."""
    return shipped_results("paper").of("bc")


@cache
def accidents_of_clones_of_cut_drives() -> float:
    """The share of accidents: eight clones of the rule's 200 drives, cut as short as the stochastic rule's."""
    whole, unsure = demonstrate(200), stochastic_rule_policy(DEFAULT, np.random.default_rng(0))
    rows, pairs = whole.rows(), zip(whole.drives, demonstrate(200, policy=unsure).drives, strict=True)
    cut = torch.cat([rows[drive][: other.stop - other.start] for drive, other in pairs])
    return float(cloning.measure(cloning.clones({"cut": cut})["cut"], cut)[:, 2].mean())


def updates_of(results: Results) -> float:
    """About how many updates each of these agents had: so many follow each decision on all of its roads."""
    agent, curves = results.agents[0], results.curves
    decisions = (curves["distance"] / curves["speed"]).sum(axis=1)  # one a second
    return float(((decisions - agent["learning_starts"]) * agent["updates"] / agent["envs_per_agent"]).mean())
