"""The pictures of the lesson on the soft constraint: nine probabilities, ξ in a training, how twenty agents ended."""

from collections.abc import Mapping, Sequence

import numpy as np
from matplotlib.figure import Figure
from torch import Tensor

from bootcourse.colours import INK, QUIET, Style
from bootcourse.course.charts import action_bars, lines
from bootcourse.course.dots import beside, dots, name_rows
from bootcourse.course.live_curves import LiveCurves
from bootcourse.episodes.record import record
from bootcourse.learn.settings import settings_for
from bootcourse.learn.training import Training
from bootcourse.methods import style
from bootcourse.plots.figure import finish, one_axes
from bootcourse.policies import stochastic_rule_policy
from bootcourse.research.results import Results
from bootcourse.scenario import ACTION_NAMES, DEFAULT
from bootcourse.statistics import lost


def first_second(road: int) -> Figure:
    """π of an untrained agent and π̃ in the first second of a road."""
    agent = Training([settings_for("soft")], episodes=1).agent(0)
    drive = record(stochastic_rule_policy(DEFAULT, np.random.default_rng(0)), [road])[0]
    pi = agent.probabilities(drive.observations[:1])[0].tolist()
    named = {"the untrained agent, π": pi, "the stochastic rule, π̃": drive.policy[0].tolist()}
    title = f"The rule would {ACTION_NAMES[drive.rule_actions[0]]}; the untrained agent hardly prefers any action"
    return action_bars(named, title, looks=[style("soft"), style("rule")])


def compromise(q: Tensor, log_rule: Tensor, alpha: float, best: Tensor) -> Figure:
    """The policy of Q alone, π̃, and their best compromise in one state, each (1, 9)."""
    named = {"Q alone (ξ = 0)": (q / alpha).softmax(-1), "the stochastic rule, π̃": log_rule.exp()}
    named["the best compromise"] = best
    title = "Here the best compromise divides its probability between the rule's action and Q's best"
    looks = [Style(QUIET), style("rule"), style("soft")]
    return action_bars({words: pi[0].tolist() for words, pi in named.items()}, title, looks)


class LivePull(LiveCurves):
    """ξ over the episodes of each agent of a training, named by its target entropy η, while they learn."""

    def show(self, training: Training) -> None:
        if training.curves.finished.min() >= 2:  # a line has two points
            super().show(training)

    def draw(self, training: Training) -> Figure:
        done = min(int(training.curves.finished.min()), training.episodes)
        xi = training.curves.values["xi"][:, :done]
        targets = [f"η = {settings.target_entropy:g}".replace("-", "−") for settings in training.settings]
        now = " and ".join(f"{last:.2g} with {eta}" for eta, last in zip(targets, xi[:, -1], strict=True))
        looks = [Style(style("soft").colour), Style(INK)]
        named, title = dict(zip(targets, xi, strict=True)), f"After {done} episodes ξ is {now}"
        return lines(np.arange(1, done + 1), named, title, "episode", "ξ", logarithmic="y", looks=looks)


def twenty(kinds: Mapping[str, Sequence[Results]]) -> Figure:
    """The return of each agent as a dot, a row for each kind of agents with the soft constraint, filled: it escapes."""
    title = "Where ξ falls to 0.1 and stays there, all twenty agents escape"
    figure, ax = one_axes(3.0, title, "", "")
    ax.set_position((0.17, 0.19, 0.62, 0.6))
    colour, alt = style("soft").colour, []
    for place, (kind, studies) in enumerate(kinds.items()):
        returns = np.concatenate([each.scores("returns") for each in studies])
        found, kept = np.concatenate([each.found_and_kept("soft") for each in studies], axis=1)
        dots(ax, returns, place, colour, kept, bar=returns.mean())
        losing = np.concatenate([lost(each.of("soft").curves["success"]) for each in studies])
        counts = f"{found.sum()} find the way out,\n{losing.sum()} lose it in training,\n{kept.sum()} escape"
        beside(ax, place, counts)
        alt.append(f"{kind}: {counts}, mean return {returns.mean():.0f}, {returns.min():.0f} to {returns.max():.0f}")
    name_rows(ax, list(kinds), "return of an agent on 1,000 roads; filled: it escapes; bar: mean of twenty")
    return finish(figure, title, f"A dot for each agent. {'; '.join(alt)}.".replace("\n", " "))
