"""To drag in this lesson: how many attempts may crash, by what an accident costs and how far ahead a driver looks."""

from functools import cache

import numpy as np

from bootcourse.course.lessons.the_barrier.attempts import PLAN
from bootcourse.episodes.evaluate import drive_episodes, held_out_seeds
from bootcourse.episodes.record import record
from bootcourse.methods import style
from bootcourse.panels.explorable import Axes, Curve, Explorable, curves
from bootcourse.panels.number import Number
from bootcourse.plots.svg import Drawing
from bootcourse.policies import PlanPolicy, idle_policy, rule_policy
from bootcourse.scenario import DEFAULT

ROAD, CRASH_AFTER = 10, 3  # the road of the drives; s, after which an attempt crashes if it does
RISKS = np.linspace(0, 100, 101)  # % of attempts


@cache
def the_plan_crashes() -> float:
    """On which share of the study's 1,000 held-out roads lesson 1's plan ends in an accident."""
    return float((drive_episodes(PlanPolicy(PLAN), held_out_seeds(1, 1000)).accident > 0).mean())


def attempt() -> Explorable:
    """What an attempt like lesson 1's plan is worth, beside staying, by how many such attempts crash."""
    by_rule, plan, idle = (
        record(policy, [ROAD])[0].rewards for policy in (rule_policy(DEFAULT), PlanPolicy(PLAN), idle_policy)
    )
    crashes = 100 * the_plan_crashes()

    def draw(price: float, gamma: float) -> Drawing:
        stay, out, crash = (
            gamma ** np.arange(len(rewards)) @ rewards for rewards in (idle, plan, [*by_rule[:CRASH_AFTER], -price])
        )
        worth = (out + (crash - out) * RISKS / 100) / stay
        share = f"{(out - stay) / (out - crash):.0%}".replace("%", " %")
        says = f"Price {price:g}, γ = {gamma:g}: it pays if at most {share} crash early (the plan: "
        says += f"{crashes:.0f} %, early or later)."
        axes = Axes("early crashes, % of attempts", "worth, as a multiple of staying", (-10.0, 4.0))
        named = {
            "an attempt": Curve(worth, style("sac").colour),
            "staying": Curve(np.ones(len(RISKS)), style("idle").colour, "--"),
        }
        return curves(says, axes, RISKS, named, mark=crashes)

    numbers = {
        "price": Number("price", 10, 0, 15, 1, "What an accident costs."),
        "gamma": Number("γ", 0.8, 0.8, 0.95, 0.05, "What a reward one second later is worth, as a share of one now."),
    }
    return Explorable("When does an attempt pay?", draw, **numbers)
