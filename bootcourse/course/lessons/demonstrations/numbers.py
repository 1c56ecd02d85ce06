"""What the numbers and claims in this lesson's text are computed from, beside tools/course/known.py."""

from functools import cache

import numpy as np

from bootcourse.episodes.record import record
from bootcourse.research.results import Results
from bootcourse.road.state import EGO, LANE, TRAP_1, X, Y
from tools.course.known import of, rule_drives, shipped_results, shipped_runs, shipped_teachers


def way_out() -> tuple[float, float]:
    """After how many seconds the rule is in the free lane, and ahead of trap 1: medians of those drives."""
    cars = [drive.states[::2] for drive in rule_drives()]
    free = [np.argmax(each[:, EGO, LANE] == 0) for each in cars]
    ahead = [np.argmax(each[:, EGO, X] > each[:, TRAP_1, X]) for each in cars]
    return float(np.median(free)), float(np.median(ahead))


@cache
def in_free_lane() -> tuple[float, float, float]:
    """How often the rule steers there, and how far (m) it is off the middle: in 95 % of the time, and at most."""
    steers, off = [], []
    for drive in rule_drives():
        ego = drive.states[:-1:2, EGO]
        there = ego[:, LANE] == 0
        steers.append((drive.actions % 3 != 1)[there])
        off.append(np.abs(ego[there, Y]))
    off = np.concatenate(off)
    return float(np.concatenate(steers).mean()), float(np.percentile(off, 95)), float(off.max())


@cache
def unlike_the_rule() -> np.ndarray:
    """In how many decisions of a drive the study's clones differ from the rule: in own states, in the rule's.

    The mean over the clones that ship, 60 roads each; own drives without an accident.
    """
    pairs = []
    for run in shipped_runs("bc"):
        own = [drive for drive in record(run.agent.as_policy(), range(60)) if not drive.accident]
        did = [run.agent.probabilities(drive.observations[:-1]).argmax(1) for drive in rule_drives()]
        theirs = [(acts != drive.actions).sum() for acts, drive in zip(did, rule_drives(), strict=True)]
        pairs.append((np.mean([(drive.actions != drive.rule_actions).sum() for drive in own]), np.mean(theirs)))
    return np.mean(pairs, axis=0)


@cache
def study_agreement() -> np.ndarray:
    """The share of the rule's decisions on 60 roads that each shipped clone would take, too, (clones,)."""
    seen = np.concatenate([drive.observations[:-1] for drive in rule_drives()])
    did = np.concatenate([drive.actions for drive in rule_drives()])
    return np.array([(run.agent.probabilities(seen).argmax(1) == did).mean() for run in shipped_runs("bc")])


def clones_of_the_stochastic_rule() -> Results:
    """The ten clones of the study with the paper's choices, where the stochastic rule drives the demonstrations."""
    return shipped_results("paper").of("bc")


def taught_by_dagger() -> Results:
    """The ten DAgger agents that the rule taught, of the experiment on teachers."""
    return shipped_teachers()["rule", "dagger"]


def updates_of(results: Results) -> float:
    """About how many updates each of these agents had: so many follow each decision on all of its roads."""
    agent, curves = results.agents[0], results.curves
    decisions = (curves["distance"] / curves["speed"]).sum(axis=1)  # one a second
    return float(((decisions - agent["learning_starts"]) * agent["updates"] / agent["envs_per_agent"]).mean())


def longer_training() -> str:
    """A table of the study's clones: whose drives, about how many updates, accidents, return."""
    rows = ["| ten clones of | updates, about | have an accident | return |", "|---|---|---|---|"]
    for whose, results in (("the rule", of("bc")), ("the stochastic rule", clones_of_the_stochastic_rule())):
        assert len(results) == 10
        accidents, back = 100 * results.scores("accident").mean(), results.scores("returns").mean()
        rows.append(f"| {whose} | {round(updates_of(results), -3):,.0f} | {accidents:.1f} % | {back:.0f} |")
    return "\n".join(rows)
