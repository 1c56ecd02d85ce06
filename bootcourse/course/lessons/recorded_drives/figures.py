"""The lesson on recorded drives: three agents' drives, returns, promises, and estimates."""

from collections.abc import Mapping, Sequence

import numpy as np
from matplotlib.figure import Figure

from bootcourse.colours import INK, OTHER, QUIET
from bootcourse.course.dots import beside, dots, name_rows
from bootcourse.course.lessons.recorded_drives import choosing
from bootcourse.course.shipped import beginning, shipped_agents
from bootcourse.episodes.record import record
from bootcourse.episodes.rollout import Rollout
from bootcourse.learn.learner import SACLearner
from bootcourse.methods import display_name, style
from bootcourse.plots.figure import TEXT, finish, new_figure, one_axes, plain_axes
from bootcourse.research.report import rule_results
from bootcourse.research.results import Results
from bootcourse.research.tables import escaped
from bootcourse.scenario import DEFAULT
from bootcourse.statistics import ESCAPES

ROAD = 9  # of the held-out ones: chosen for GAIL's drive
SECONDS = 20  # of a drive: the way out
WITH = "with CQL's term"


def three_drives() -> list[Rollout]:
    """A drive of GAIL that is ahead of trap 1 and then leaves the road, and a clone's and CQL's on its road."""
    drivers = [(method, shipped_agents(method)[which]) for method, which in (("gail", 3), ("bc", 0), ("cql", 0))]
    return [beginning(record(agent.as_policy(), [ROAD], label=method)[0], 46) for method, agent in drivers]


def returns(study: Results) -> Figure:
    """Each agent's return and how often it leaves the road, filled: it escapes; a line for the rule's return."""
    title = "CQL earns more than its teacher, and GAIL often leaves the road"
    label = "return of an agent on 1,000 roads; filled: it escapes"
    figure, ax = one_axes(3.6, title, label, "drives that leave the road")
    by_rule, alt = rule_results(DEFAULT, study.tested["returns"].shape[1]).scores("returns").mean(), []
    ax.axvline(by_rule, color=style("rule").colour, linewidth=1.5, zorder=1)
    ax.text(by_rule + 0.6, 79, "the rule", fontsize=TEXT, color=style("rule").colour, va="top")
    places = {"bc": (50.6, 20, "right"), "cql": (59, 6, "center"), "cql_sac": (12.5, 7, "center")}
    places["gail"] = (16, 72, "left")
    for method, (x, y, side) in places.items():
        mine, look = study.of(method), style(method)
        earns, left, ahead = mine.scores("returns"), 100 * mine.scores("road_departure"), mine.scores("success")
        fills = np.where(ahead >= ESCAPES, look.colour, "white")
        ax.scatter(earns, left, s=34, c=fills, edgecolors=look.colour, linewidths=1.3, zorder=3, clip_on=False)
        words = f"{display_name(method)}: {escaped(study, method)} escape"
        ax.text(x, y, words.replace("CQL: ", "CQL:\n"), fontsize=TEXT, color=look.colour, ha=side)
        alt.append(f"{words}, mean return {earns.mean():.1f}, {left.mean():.1f} % of drives leave the road")
        if method == "gail":
            worst = np.argmax(np.where(ahead >= ESCAPES, left, -1))
            alt.append(f"one is ahead of trap 1 on {100 * ahead[worst]:.0f} %\nand off the road on {left[worst]:.0f} %")
            ax.text(earns[worst] + 1, left[worst], alt[-1], fontsize=TEXT, color=look.colour, va="center")
    ax.set_ylim(-2, 80)
    ax.yaxis.set_major_formatter(lambda share, _: f"{share:.0f} %")
    words = "; ".join(alt).replace("\n", " ")
    return finish(figure, title, f"A dot for each agent. {words}. The rule's return is {by_rule:.1f}.")


def earned(drive: Rollout, gamma: float) -> float:
    """What a drive earns from a second of its way out on, discounted, the mean over these seconds."""
    weights = gamma ** np.arange(len(drive.rewards))
    seconds = range(min(SECONDS, len(drive.actions)))
    return float(np.mean([drive.rewards[t:] @ weights[: len(weights) - t] for t in seconds]))


def promises(learners: Mapping[str, SACLearner]) -> Figure:
    """How agents drive 100 roads: the Q that they promise on the way out, a ring, and what that is worth, a dot.

    learners: by what they are called, such as `WITH`.
    """
    found = {}  # (name, seed): promised, paid, crashes
    for name, learner in learners.items():
        for row, settings in enumerate(learner.settings):
            drives = record(learner.agent(row).as_policy(with_q=True), range(100))
            q = [drive.q_values[range(len(drive.actions)), drive.actions][:SECONDS].mean() for drive in drives]
            paid = np.mean([earned(drive, settings.gamma) for drive in drives])
            found[name, settings.seed] = np.mean(q), paid, sum(drive.accident > 0 for drive in drives)
    without = [each for (name, _), each in found.items() if name != WITH]
    with_it = [each for (name, _), each in found.items() if name == WITH]
    title = "What agents promise, and what they earn"
    if all(promised > 0 > paid and crashes == 100 for promised, paid, crashes in without):
        title = "These agents promise a gain, and crash on every road"
        if with_it and all(abs(promised - paid) < 0.5 and crashes < 50 for promised, paid, crashes in with_it):
            title = "With CQL's term agents earn about what they promise"
    height = 1.23 + 0.39 * len(found)  # inches: rows between 0.56 below and 0.67 above
    figure, ax = one_axes(height, title, "worth, mean of the first 20 s (γ = 0.8)", "")
    ax.set_position((0.2, 0.56 / height, 0.6, 0.39 * len(found) / height))
    plain_axes(ax, "", grid="x")
    alt, names = [], [f"{name}, seed {seed}" for name, seed in found]
    for row, ((name, _), (promised, paid, crashes)) in enumerate(found.items()):
        colour = (style("cql") if name == WITH else OTHER).colour
        ax.plot([promised, paid], [row, row], color=colour, linewidth=1.5, zorder=2)
        ax.plot(promised, row, "o", markersize=11, color=colour, markerfacecolor="white", zorder=3)
        ax.plot(paid, row, "o", markersize=7, color=colour, zorder=4)
        words = f"{crashes} crash"
        ax.text(1.03, row, words, transform=ax.get_yaxis_transform(), va="center", fontsize=TEXT, color=INK)
        alt.append(f"{names[row]}: promises {promised:.1f}, is then worth {paid:.1f}, {words} on 100 roads")
    key = "ring: the promise, Q of the actions taken · dot: what the drive is worth · right: of 100 drives"
    ax.annotate(key, (0, 1), (0, 6), "axes fraction", textcoords="offset points", fontsize=TEXT, color=QUIET)
    ax.set_yticks(range(len(names)), names)
    ax.set_ylim(len(names) - 0.5, -0.5)
    return finish(figure, title, f"{'; '.join(alt)}.")


def estimates(names: Sequence[str], alike: Sequence[float], fits: np.ndarray, truth: Sequence[float]) -> Figure:
    """What agents are worth: a dot for each fit, (fits, agents), filled if it is the largest of its fit, and a bar
    for the truth. alike: how often each acts as the data do. A line: what the rule is worth.
    """
    largest, title = fits.argmax(1), "What is each agent worth? Estimates, and the truth"
    if (fits.max(1) > np.array(truth)[largest]).all():
        title = "In each fit the largest estimate is too large"
    shares = [f"{100 * each:.0f} %" for each in alike]
    figure = new_figure(1.2 + 0.48 * len(names))
    height = figure.get_figheight()
    ax = figure.add_axes((0.27, 0.5 / height, 0.58, 1 - 1.2 / height))
    by_rule, alt = choosing.rule_worth(), []
    ax.axvline(by_rule, color=style("rule").colour, linewidth=1.5, zorder=1)
    for row, guesses in enumerate(fits.T):
        dots(ax, guesses, row, OTHER.colour, largest == row, bar=truth[row], size=24)
        words = f"largest in {(largest == row).sum()}" if row in largest else ""
        beside(ax, row, words, colour=OTHER.colour)
        said = f"{', '.join(f'{each:.2f}' for each in guesses)}{words and ', '}{words}; truth {truth[row]:.2f}"
        alt.append(f"{names[row]}, acts as the data do in {shares[row]}: {said}")
    rows = [f"{name}\nas the data: {each}" for name, each in zip(names, shares, strict=True)]
    name_rows(ax, rows, "worth from the start (γ = 0.8)")
    every = np.append(fits, truth)
    ax.set_xlim(every.min() - 0.08, every.max() + 0.08)
    key = "dot: a fit · filled: the largest of its fit · bar: the truth on the road · green: the rule"
    ax.text(0, 1.03, key, transform=ax.transAxes, fontsize=TEXT, color=QUIET)
    return finish(figure, title, f"{'. '.join(alt)}. The rule is worth {by_rule:.2f}.")
