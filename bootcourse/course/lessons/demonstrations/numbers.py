"""What the numbers and claims in this lesson's text are computed from, beside tools/course/known.py."""

from functools import cache

import numpy as np
import torch

from bootcourse.course.lessons.demonstrations import cloning
from bootcourse.course.lessons.demonstrations.cloning import UPDATES as UPDATES
from bootcourse.learn.agent import Agent
from bootcourse.learn.demonstrations import demonstrate
from bootcourse.policies import stochastic_rule_policy
from bootcourse.research.results import Results
from bootcourse.scenario import DEFAULT
from tools.course.known import rule_drives, shipped_results


def clones_of_the_stochastic_rule() -> Results:
    """The ten clones of the study with the paper's choices, where the stochastic rule drives the demonstrations."""
    return shipped_results("paper").of("bc")


@cache
def few_clones() -> tuple[list[Agent], list[Agent], torch.Tensor]:
    """Two clones of the rule's 200 drives, four of them cut as short as the stochastic rule's, and these rows."""
    whole, unsure = demonstrate(200), stochastic_rule_policy(DEFAULT, np.random.default_rng(0))
    rows, pairs = whole.rows(), zip(whole.drives, demonstrate(200, policy=unsure).drives, strict=True)
    cut = torch.cat([rows[drive][: other.stop - other.start] for drive, other in pairs])
    return *cloning.side_by_side([rows, cut], [range(2), range(4)]), cut


def accidents_of_clones_of_cut_drives() -> float:
    """The share of accidents of those four."""
    _, four, cut = few_clones()
    return float(cloning.measure(four, cut)[:, 2].mean())


def early_errors() -> tuple[float, float]:
    """In how many of the rule's states of the first 10 s those two differ from it, and in how many of these they steer
    otherwise but keep the rule's change of speed: shares.
    """
    theirs = np.array([drive.actions[:10] for drive in rule_drives()])
    states = np.array([drive.observations[:10] for drive in rule_drives()])
    chosen = np.array([agent.probabilities(states.reshape(-1, cloning.SIZE)).argmax(1) for agent in few_clones()[0]])
    chosen = chosen.reshape(-1, *theirs.shape)
    wrong = chosen != theirs
    return float(wrong.mean()), float((chosen // 3 == theirs // 3)[wrong].mean())


def updates_of(results: Results) -> float:
    """About how many updates each of these agents had: so many follow each decision on all of its roads."""
    agent, curves = results.agents[0], results.curves
    decisions = (curves["distance"] / curves["speed"]).sum(axis=1)  # one a second
    return float(((decisions - agent["learning_starts"]) * agent["updates"] / agent["envs_per_agent"]).mean())
