"""The lesson on recorded drives: three agents' drives, returns, promises, and estimates."""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from functools import cache

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from bootcourse.colours import OTHER, QUIET
from bootcourse.course.dots import beside, dots, name_rows
from bootcourse.course.lessons.recorded_drives import choosing
from bootcourse.course.shipped import beginning, shipped_agents
from bootcourse.episodes.record import record
from bootcourse.episodes.rollout import Rollout
from bootcourse.learn.learner import SACLearner
from bootcourse.methods import display_name, style
from bootcourse.plots.figure import TEXT, finish, new_figure, one_axes
from bootcourse.policies import rule_policy
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


@cache
def rule_on_its_way() -> float:
    """What the rule's own drives on 100 roads earn, as in `earned`: the mean."""
    short = replace(DEFAULT, clock=replace(DEFAULT.clock, decisions=SECONDS + choosing.SECONDS))
    drives = record(rule_policy(short), range(100), short)
    return float(np.mean([earned(drive, 0.8) for drive in drives]))


def promises(learners: Mapping[str, SACLearner]) -> Figure:
    """How agents drive 100 roads: the Q that they promise on the way out, and what that is worth.

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
    names = [f"{name}, seed {seed}" for name, seed in found]
    colours = [style("cql").colour if name == WITH else OTHER.colour for name, _ in found]
    promised, paid, crashes = (np.array(each) for each in zip(*found.values(), strict=True))
    label, ring = "worth, mean of the first 20 s (γ = 0.8)", "the promise, Q of the actions taken"
    filled = np.zeros((1, len(names)), bool)
    figure, ax = worths(names, promised[None], filled, paid, rule_on_its_way(), colours, label, ring)
    for row, crashed in enumerate(crashes):
        beside(ax, row, f"{crashed} % crash")
    said = [
        f"{names[row]}: promises {promised[row]:.1f}, is then worth {paid[row]:.1f}, {crashes[row]} crash on 100 roads"
        for row in range(len(names))
    ]
    return finish(figure, title, f"{'; '.join(said)}. The rule is worth {rule_on_its_way():.1f}.")


def estimates(names: Sequence[str], alike: Sequence[float], fits: np.ndarray, truth: Sequence[float]) -> Figure:
    """What agents are worth: a ring for each fit, (fits, agents), filled if it is the largest of its fit, and the
    truth. alike: how often each acts as the data do.
    """
    largest, title = fits.argmax(1), "What is each agent worth? Estimates, and the truth"
    if (fits.max(1) > np.array(truth)[largest]).all():
        title = "In each fit the largest estimate is too large"
    shares, by_rule, alt = [f"{100 * each:.0f} %" for each in alike], choosing.rule_worth(), []
    rows = [f"{name}\nas the data: {each}" for name, each in zip(names, shares, strict=True)]
    filled, colours = largest[:, None] == range(len(names)), [OTHER.colour] * len(names)
    label, ring = "worth from the start (γ = 0.8)", "an estimate · filled: the largest of its fit"
    figure, ax = worths(rows, fits, filled, truth, by_rule, colours, label, ring)
    for row, guesses in enumerate(fits.T):
        words = f"largest in {(largest == row).sum()}" if row in largest else ""
        beside(ax, row, words, colour=OTHER.colour)
        said = f"{', '.join(f'{each:.2f}' for each in guesses)}{words and ', '}{words}; truth {truth[row]:.2f}"
        alt.append(f"{names[row]}, acts as the data do in {shares[row]}: {said}")
    return finish(figure, title, f"{'. '.join(alt)}. The rule is worth {by_rule:.2f}.")


def worths(
    rows: Sequence[str],
    claimed: np.ndarray,
    filled: np.ndarray,
    truth: Sequence[float],
    by_rule: float,
    colours: Sequence[str],
    label: str,
    ring: str,
) -> tuple[Figure, Axes]:
    """A row for each agent: what is claimed of its worth, (claims, agents), rings or filled; a bar for the truth.

    by_rule: what the rule is worth, a line. label: of the axis. ring: what a ring is.
    """
    height = 1.1 + 0.48 * len(rows)  # inches
    figure = new_figure(height)
    ax = figure.add_axes((0.27, 0.5 / height, 0.58, 1 - 1.1 / height))
    ax.axvline(by_rule, color=style("rule").colour, linewidth=1.5, zorder=1)
    for row, values in enumerate(claimed.T):
        dots(ax, values, row, colours[row], filled[:, row], bar=truth[row], size=30)
    name_rows(ax, rows, label)
    ax.margins(x=0.04)
    key = f"ring: {ring} · bar: the truth on the road · green: the rule"
    figure.text(0.012, 1 - 0.52 / height, key, fontsize=TEXT, color=QUIET)
    return figure, ax
