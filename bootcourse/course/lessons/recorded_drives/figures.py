"""The lesson on recorded drives: what critics believe, and when pupils first escape."""

from collections.abc import Sequence

import numpy as np
from matplotlib.figure import Figure

from bootcourse.colours import INK
from bootcourse.course.charts import lines
from bootcourse.learn.agent import Agent
from bootcourse.learn.learner import SACLearner
from bootcourse.methods import display_name, style
from bootcourse.research.results import Results
from bootcourse.statistics import rolling_means

WINDOW = 50  # training episodes that a success rate is taken over


def agents_of(learner: SACLearner) -> list[Agent]:
    """The agents of a learner as they are now; they do not change when it learns on."""
    return [learner.agent(i) for i in range(learner.agents)]


def believed(agents: Sequence[Agent], observations: np.ndarray, actions: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Mean Q of the given action, and of the best other one: (batch, 26) and (batch,) -> twice (agents,)."""
    q = np.stack([agent.q_values(observations) for agent in agents])
    places = np.broadcast_to(actions[:, None], (*q.shape[:2], 1))
    given = np.take_along_axis(q, places, 2).mean((1, 2))
    np.put_along_axis(q, places, -np.inf, 2)
    return given, q.max(2).mean(1)


def updates_made(results: Results) -> np.ndarray:
    """Updates, to within a few, that each agent had made when each training episode ended: (agents, episodes)."""
    seconds = results.curves["distance"].astype(np.float64) / np.maximum(results.curves["speed"], 0.1)
    each = [agent["updates"] / agent["envs_per_agent"] for agent in results.agents]  # for each decision, of 1 s
    return np.cumsum(seconds, axis=1) * np.array(each)[:, None]


def half_success(success: np.ndarray) -> np.ndarray:
    """The middle of the first `WINDOW` episodes in a row of which half succeeded, counted from 1; 0 without one.

    success (agents, episodes) -> (agents,).
    """
    at, means = rolling_means(success, WINDOW, success.shape[1])
    reached = means >= 0.5
    return np.where(reached.any(axis=1), at[reached.argmax(axis=1)] - WINDOW // 2, 0)


def success_around(success: np.ndarray, updates: np.ndarray, budget: float) -> np.ndarray:
    """Share of successes among the `WINDOW` episodes around an update: (agents, episodes) twice -> (agents,)."""
    places = [np.searchsorted(own, budget) for own in updates]
    half = WINDOW // 2
    return np.array([own[max(0, i - half) : i + half].mean() for own, i in zip(success, places, strict=True)])


def success_in_training(results: Results, methods: Sequence[str] = ("bc", "cql", "gail")) -> Figure:
    """Success in training against the update, a mean of each method's agents; a dot where half of the drives succeed.

    The dot is at the median of the agents' updates.
    """
    named, halves = {}, {}
    budgets = np.unique(np.geomspace(100, 20_000, 60).round())
    for method in methods:
        of, label = results.of(method), display_name(method)
        success, updates = of.curves["success"], updates_made(of)
        named[label] = 100 * np.array([success_around(success, updates, budget) for budget in budgets]).mean(axis=1)
        at = half_success(success)
        halves[label] = float(np.median(np.take_along_axis(updates, at[:, None] - 1, 1)[at > 0]))
    order = sorted(halves, key=halves.get)
    first, last = (f"{halves[label]:,.0f}" for label in (order[0], order[-1]))
    title = f"Half of the drives succeed after {first} updates of {order[0]}, {last} of {order[-1]}"
    looks = [style(method) for method in methods]
    words = f"success, {WINDOW} episodes (%); dot: half succeed, median agent"
    figure = lines(budgets, named, title, "update (logarithmic)", words, "x", limits=(0, 101), looks=looks)
    for method, label in zip(methods, named, strict=True):
        figure.axes[0].plot(halves[label], 50, "o", color=style(method).colour, mec=INK, ms=7, zorder=5)
    return figure
