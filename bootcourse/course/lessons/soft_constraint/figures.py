"""The two pictures of the lesson on the soft constraint: nine probabilities, of two and of three policies."""

import numpy as np
from matplotlib.figure import Figure
from torch import Tensor

from bootcourse.colours import QUIET, Style
from bootcourse.course.charts import action_bars
from bootcourse.episodes.record import record
from bootcourse.learn.settings import settings_for
from bootcourse.learn.training import Training
from bootcourse.methods import style
from bootcourse.policies import stochastic_rule_policy
from bootcourse.scenario import ACTION_NAMES, DEFAULT


def first_second(road: int) -> Figure:
    """π of an untrained agent and π̃ in the first second of a road."""
    agent = Training([settings_for("soft")], episodes=1).agent(0)
    drive = record(stochastic_rule_policy(DEFAULT, np.random.default_rng(0)), [road])[0]
    pi = agent.probabilities(drive.observations[:1])[0].tolist()
    named = {"the untrained agent, π": pi, "the stochastic rule, π̃": drive.policy[0].tolist()}
    title = f"The rule would {ACTION_NAMES[drive.rule_actions[0]]}; the untrained agent has no preference"
    return action_bars(named, title, looks=[style("soft"), style("rule")])


def compromise(q: Tensor, log_rule: Tensor, alpha: float, best: Tensor) -> Figure:
    """The policy of Q alone, π̃, and their best compromise in one state, each (1, 9)."""
    named = {"Q alone (ξ = 0)": (q / alpha).softmax(-1), "the stochastic rule, π̃": log_rule.exp()}
    named["the best compromise"] = best
    title = "The best compromise shares its probability between the rule's action and the best by Q"
    looks = [Style(QUIET), style("rule"), style("soft")]
    return action_bars({words: pi[0].tolist() for words, pi in named.items()}, title, looks)
