"""The lesson on the baselines: what critics believe, when pupils first escape, who stays on the road."""

from collections.abc import Mapping, Sequence

import numpy as np
from matplotlib.figure import Figure

from bootcourse.course.charts import lines
from bootcourse.episodes.record import record
from bootcourse.episodes.rollout import Rollout
from bootcourse.learn.agent import Agent
from bootcourse.learn.learner import SACLearner
from bootcourse.research.results import Results
from bootcourse.road.state import EGO, TRAP_1, X
from bootcourse.scenario import N_ACTIONS
from bootcourse.statistics import rolling_means

WINDOW = 50  # training episodes that a success rate is taken over
SHORT = {"bc": "BC", "cql": "CQL", "gail": "GAIL"}


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


def as_the_rule_would(drives: Sequence[Rollout]) -> tuple[float, float, float]:
    """The share of the decisions in which these drives do what the rule would do there.

    Overall; where the rule would brake, how often they brake, too; where it would accelerate, how often they do.
    """
    done = np.concatenate([drive.actions for drive in drives])
    rule = np.concatenate([drive.rule_actions for drive in drives])
    brakes, accelerates = (float(np.mean((done // 3 == kind)[rule // 3 == kind])) for kind in (0, 2))
    return float(np.mean(done == rule)), brakes, accelerates


def occupancy(drives: Sequence[Rollout], edges: Sequence[float], seconds: int = 20) -> np.ndarray:
    """The share of all decisions in the first seconds that fall into a stretch of road, by action: (stretches, 9).

    edges (stretches + 1,) m ahead of trap 1.
    """
    place, action = [], []
    for drive in drives:
        cars = drive.cars[:seconds]
        place.append(cars[:, EGO, X] - cars[:, TRAP_1, X])
        action.append(drive.actions[:seconds])
    place, action = np.concatenate(place), np.concatenate(action)
    counts, _, _ = np.histogram2d(place, action, bins=[edges, np.arange(N_ACTIONS + 1) - 0.5])
    return counts / len(place)


def followers(groups: Mapping[str, Sequence[Agent]], roads: Sequence[int]) -> tuple[list[str], list[list[str]]]:
    """Headings and a row for each group of agents: how far they do what the rule would, and what they earn."""
    rows = []
    for name, agents in groups.items():
        drives = [drive for agent in agents for drive in record(agent.as_policy(), roads)]
        shares = [f"{100 * share:.0f} %" for share in as_the_rule_would(drives)]
        rows.append([name, *shares, f"{np.mean([drive.rewards.sum() for drive in drives]):.1f}"])
    return ["does what the rule would", "overall", "where it brakes", "where it speeds up", "return"], rows


def updates_made(results: Results) -> np.ndarray:
    """Updates, to within a few, that each agent had made when each training episode ended: (agents, episodes)."""
    seconds = results.curves["distance"].astype(np.float64) / np.maximum(results.curves["speed"], 0.1)
    each = [agent["updates"] / agent["envs_per_agent"] for agent in results.agents]  # for each decision, of 1 s
    return np.cumsum(seconds, axis=1) * np.array(each)[:, None]


def half_escape(success: np.ndarray) -> np.ndarray:
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


def escapes_in_training(results: Results, methods: Sequence[str] = ("bc", "cql", "gail")) -> Figure:
    """The share of escapes in training, a mean of each method's agents over the last `WINDOW` episodes."""
    named = {}
    for method in methods:
        success = results.of(method).curves["success"]
        at, means = rolling_means(success, WINDOW, 40)
        named[method] = 100 * means.mean(axis=0)
    title = "CQL and the clones escape first; GAIL needs more episodes"
    return lines(at, named, title, "training episode", f"escapes, last {WINDOW} episodes, %", limits=(0, 101))


def still_going(results: Results, methods: Sequence[str] = ("bc", "cql", "gail"), single: str = "gail") -> Figure:
    """The share of test drives that have not ended, over time: a mean for each method, every agent of one."""
    longest = round(float((results.tested["distance"] / results.tested["speed"]).max()))
    seconds, named, ended = np.arange(longest + 1), {}, []
    for method in methods:
        tested, label = results.of(method).tested, SHORT.get(method, method)
        going = 100 * ((tested["distance"] / tested["speed"])[..., None] >= seconds - 0.25).mean(axis=1)
        named[f"{label}: each agent" if method == single else f"{label}: mean"] = (
            going if method == single else going.mean(axis=0)
        )
        ended.append(f"{100 - going[:, -1].mean():.1f} % of {label}'s")
    title = f"Drives that end before their time: {', '.join(ended)}"
    return lines(seconds, named, title, "second of the drive", "test drives that still go on, %", limits=(0, 101))
