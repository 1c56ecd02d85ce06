"""The lesson on recorded drives: three agents' drives, returns, critics' beliefs, estimates, and a judge's D."""

from collections.abc import Sequence
from functools import cache
from typing import NamedTuple

import numpy as np
import torch
from matplotlib.figure import Figure

from bootcourse.colours import INK, OTHER, QUIET, Style
from bootcourse.course import charts
from bootcourse.course.dots import beside, dots, name_rows
from bootcourse.course.lessons.recorded_drives import choosing
from bootcourse.course.shipped import beginning, shipped_agents
from bootcourse.episodes.record import record
from bootcourse.episodes.rollout import Rollout
from bootcourse.learn.gail import GAILLearner
from bootcourse.learn.learner import SACLearner
from bootcourse.learn.networks import mlp
from bootcourse.methods import display_name, style
from bootcourse.plots.figure import TEXT, finish, new_figure, one_axes, plain_axes
from bootcourse.policies import rule_policy
from bootcourse.research.report import rule_results
from bootcourse.research.results import Results
from bootcourse.research.tables import escaped
from bootcourse.scenario import DEFAULT, N_ACTIONS
from bootcourse.statistics import ESCAPES

SECONDS = 20  # of a drive: the way out
LAST = 10  # seconds before an accident
FORMS = ("with the term", "without")


def three_drives() -> list[Rollout]:
    """GAIL's shortest drive that is a success and leaves the road after 30 s, and a clone's and CQL's on its road."""
    policies = [agent.as_policy() for agent in shipped_agents("gail")]
    drives = [drive for policy in policies for drive in record(policy, range(20), label="gail")]
    leaves = [drive for drive in drives if drive.success and drive.accident and len(drive.actions) > 30]
    gail = min(leaves, key=lambda drive: len(drive.actions))
    others = [record(shipped_agents(m)[0].as_policy(), [gail.seed], label=m)[0] for m in ("bc", "cql")]
    return [beginning(drive, 50) for drive in (gail, *others)]


def returns(study: Results) -> Figure:
    """Each agent's return and how often it leaves the road, filled: it escapes; a line for the rule's return."""
    title = "CQL earns more than its teacher, and GAIL often leaves the road"
    label = "return of an agent on 1,000 roads; filled: it escapes"
    figure, ax = one_axes(3.6, title, label, "drives that leave the road")
    by_rule, alt = rule_results(DEFAULT, study.tested["returns"].shape[1]).scores("returns").mean(), []
    ax.axvline(by_rule, color=style("rule").colour, linewidth=1.5, zorder=1)
    ax.text(by_rule + 0.6, 79, "the rule", fontsize=TEXT, color=style("rule").colour, va="top")
    places = {"bc": (50.6, 20, "right"), "cql": (57.5, 7, "center"), "cql_sac": (12.5, 7, "center")}
    places["gail"] = (16, 72, "left")
    for method, (x, y, side) in places.items():
        mine, look = study.of(method), style(method)
        earns, left, ahead = mine.scores("returns"), 100 * mine.scores("road_departure"), mine.scores("success")
        fills = np.where(ahead >= ESCAPES, look.colour, "white")
        ax.scatter(earns, left, s=34, c=fills, edgecolors=look.colour, linewidths=1.3, zorder=3, clip_on=False)
        words = f"{display_name(method)}: {escaped(study, method)} escape"
        ax.text(x, y, words, fontsize=TEXT, color=look.colour, ha=side)
        alt.append(f"{words}, mean return {earns.mean():.1f}, {left.mean():.1f} % of drives leave the road")
        if method == "gail":
            worst = np.argmax(np.where(ahead >= ESCAPES, left, -1))
            alt.append(f"one is ahead of trap 1 on {100 * ahead[worst]:.0f} %\nand off the road on {left[worst]:.0f} %")
            ax.text(earns[worst] + 1, left[worst], alt[-1], fontsize=TEXT, color=look.colour, va="center")
    ax.set_ylim(-2, 80)
    ax.yaxis.set_major_formatter(lambda share, _: f"{share:.0f} %")
    words = "; ".join(alt).replace("\n", " ")
    return finish(figure, title, f"A dot for each agent. {words}. The rule's return is {by_rule:.1f}.")


@cache
def way_out() -> tuple[np.ndarray, np.ndarray, float]:
    """Of the rule, on its way out on 20 roads: observations, actions, and what it earns from there, discounted."""
    drives = record(rule_policy(DEFAULT), range(20), label="rule")
    observations = np.concatenate([drive.observations[:SECONDS] for drive in drives])
    actions = np.concatenate([drive.actions[:SECONDS] for drive in drives])
    return observations, actions, float(np.mean([earned(drive, 0.8) for drive in drives]))


def earned(drive: Rollout, gamma: float) -> float:
    """What a drive earns from a second of its way out on, discounted, the mean over these seconds."""
    weights = gamma ** np.arange(len(drive.rewards))
    seconds = range(min(SECONDS, len(drive.actions)))
    return float(np.mean([drive.rewards[t:] @ weights[: len(weights) - t] for t in seconds]))


def believed(learner: SACLearner) -> tuple[np.ndarray, np.ndarray]:
    """Mean Q of the rule's action on its way out, and of the best other one: twice (agents,)."""
    observations, actions, _ = way_out()
    q = np.stack([learner.agent(i).q_values(observations) for i in range(learner.agents)])
    places = np.broadcast_to(actions[:, None], (*q.shape[:2], 1))
    given = np.take_along_axis(q, places, 2).mean((1, 2))
    np.put_along_axis(q, places, -np.inf, 2)
    return given, q.max(2).mean(1)


def beliefs(found: Sequence[tuple[np.ndarray, np.ndarray]], every: int) -> Figure:
    """What `believed` has found every so many updates. The first half of the agents has CQL's term."""
    of_rule, rival = np.array(found).transpose(1, 2, 0)  # (agents, looks)
    half, by_rule = len(of_rule) // 2, way_out()[2]
    title = "What critics believe on the way out, with CQL's term and without"
    if rival[half:, -1].min() > 2 * by_rule and rival[:half, -1].max() < by_rule:
        title = "Without CQL's term the best other action seems worth far more than the rule's drive"
    named = {"with: the rule's": of_rule[:half], "with: best other": rival[:half]}
    named |= {"without: the rule's": of_rule[half:], "without: best other": rival[half:]}
    looks = [Style(colour, line) for colour in (style("cql").colour, OTHER.colour) for line in ("-", "--")]
    updates, marks = np.arange(len(found)) * every, {f"the rule's drive: {by_rule:.1f}": by_rule}
    label = "mean Q(s,a) of the rule's action and of the best other one"
    return charts.lines(updates, named, title, "update", label, marks=marks, looks=looks)


def promises(learner: SACLearner) -> Figure:
    """How the agents drive 100 roads: the Q that they promise on the way out, a ring, and what that is worth, a dot."""
    colours = [(style("cql") if row < learner.agents / 2 else OTHER).colour for row in range(learner.agents)]
    names = [f"{FORMS[2 * row // learner.agents]}, seed {each.seed}" for row, each in enumerate(learner.settings)]
    found = []  # promised, paid, crashes
    for row, settings in enumerate(learner.settings):
        drives = record(learner.agent(row).as_policy(with_q=True), range(100))
        q = [drive.q_values[range(len(drive.actions)), drive.actions][:SECONDS].mean() for drive in drives]
        paid = np.mean([earned(drive, settings.gamma) for drive in drives])
        found.append((np.mean(q), paid, sum(drive.accident > 0 for drive in drives)))
    (promised, paid, crashes), half = np.transpose(found), learner.agents // 2
    title = "With CQL's term and without: what agents promise, and what they earn"
    if min(promised[half:]) > max(promised[:half]) and max(crashes[:half]) < 50 < min(crashes[half:]):
        title = "Without CQL's term agents promise most, and crash"
    figure, ax = one_axes(2.8, title, "worth, mean of the first 20 s (γ = 0.8)", "")
    ax.set_position((0.2, 0.2, 0.6, 0.56))
    plain_axes(ax, "", grid="x")
    alt = []
    for row, (name, colour, ring, dot, count) in enumerate(zip(names, colours, promised, paid, crashes, strict=True)):
        ax.plot([ring, dot], [row, row], color=colour, linewidth=1.5, zorder=2)
        ax.plot(ring, row, "o", markersize=11, color=colour, markerfacecolor="white", zorder=3)
        ax.plot(dot, row, "o", markersize=7, color=colour, zorder=4)
        words = f"{count:.0f} crash"
        ax.text(1.03, row, words, transform=ax.get_yaxis_transform(), va="center", fontsize=TEXT, color=INK)
        alt.append(f"{name}: promises {ring:.1f}, is then worth {dot:.1f}, {words} on 100 roads")
    key = "ring: the promise, Q of the actions taken · dot: what the drive is worth · right: of 100 drives"
    ax.text(0, 1.06, key, transform=ax.transAxes, fontsize=TEXT, color=QUIET)
    ax.set_yticks(range(len(names)), names)
    ax.set_ylim(len(names) - 0.5, -0.5)
    return finish(figure, title, f"{'; '.join(alt)}.")


def estimates(names: Sequence[str], alike: Sequence[float], fits: np.ndarray, truth: Sequence[float] = ()) -> Figure:
    """What agents are worth: a dot for each fit, (fits, agents), filled if it is the largest of its fit, and a bar
    for the truth where it is known. alike: how often each acts as the data do. A line: what the rule is worth.
    """
    known, largest = len(truth) > 0, np.bincount(fits.argmax(1), minlength=len(names))
    title = "What is each agent worth? Estimates without a road"
    if known:
        title = "What is each agent worth? Estimates, and the truth"
        if (fits.max(1) > np.array(truth)[fits.argmax(1)]).mean() > 0.5:
            title = "In most fits the largest estimate is too large"
    shares = [f"{100 * each:.0f} %" for each in alike]
    figure = new_figure(1.2 + 0.48 * len(names))
    height = figure.get_figheight()
    ax = figure.add_axes((0.27, 0.5 / height, 0.58, 1 - 1.2 / height))
    by_rule, alt = choosing.rule_worth(), []
    ax.axvline(by_rule, color=style("rule").colour, linewidth=1.5, zorder=1)
    for row, guesses in enumerate(fits.T):
        dots(ax, guesses, row, OTHER.colour, fits.argmax(1) == row, bar=truth[row] if known else None, size=24)
        words = f"largest in {largest[row]}" if largest[row] else ""
        beside(ax, row, words, colour=OTHER.colour)
        said = f"{', '.join(f'{each:.2f}' for each in guesses)}{words and ', '}{words}"
        if known:
            said += f"; truth {truth[row]:.2f}"
        alt.append(f"{names[row]}, acts as the data do in {shares[row]}: {said}")
    rows = [f"{name}\nas the data: {each}" for name, each in zip(names, shares, strict=True)]
    name_rows(ax, rows, "worth from the start (γ = 0.8)")
    every = np.append(fits, truth)
    ax.set_xlim(every.min() - 0.08, every.max() + 0.08)
    key = f"dot: a fit · filled: the largest of its fit · green: the rule{' · bar: the truth on the road' * known}"
    ax.text(0, 1.03, key, transform=ax.transAxes, fontsize=TEXT, color=QUIET)
    return finish(figure, title, f"{'. '.join(alt)}. The rule is worth {by_rule:.2f}.")


class Judged(NamedTuple):
    """How an agent's discriminator sees its drives and the rule's."""

    crashes: int  # of 100 drives
    before: np.ndarray  # mean D in the last seconds of those, (LAST,)
    own: float  # mean D in all drives
    of_rule: float  # mean D in drives of the rule


def seen_by_judge(learner: GAILLearner) -> list[Judged]:
    """Of each agent, on 100 roads."""
    by_rule, found = record(rule_policy(DEFAULT), range(20)), []
    for row in range(learner.agents):
        drives = record(learner.agent(row).as_policy(), range(100))
        own, of_rule = ([d_of(learner, row, drive) for drive in each] for each in (drives, by_rule))
        ends = [d[-LAST:] for d, drive in zip(own, drives, strict=True) if drive.accident]
        before = [np.mean([d[-back] for d in ends if len(d) >= back] or [np.nan]) for back in range(LAST, 0, -1)]
        found.append(Judged(len(ends), np.array(before), np.concatenate(own).mean(), np.concatenate(of_rule).mean()))
    return found


@torch.no_grad()
def d_of(learner: GAILLearner, row: int, drive: Rollout) -> np.ndarray:
    """D of a drive's decisions by one agent's discriminator, (T,)."""
    actions = torch.as_tensor(drive.actions, dtype=torch.int64)
    states = torch.as_tensor(drive.observations[: len(actions)], dtype=torch.float32)
    pairs = torch.cat([states, torch.eye(N_ACTIONS)[actions]], dim=-1)
    return mlp([each[row : row + 1] for each in learner.discriminator], pairs[None]).flatten().sigmoid().numpy()


def judged(learner: GAILLearner) -> Figure:
    """What each agent's judge says in the last seconds before its crashes, and of the rule's drives."""
    found = seen_by_judge(learner)
    named = {f"gail, seed {i}": each.before for i, each in enumerate(found) if each.crashes}
    title = "What the judge says in the last seconds before a crash"
    if named and np.nanmin(list(named.values())) > 0.1:
        title = "Before a crash D is not near 0, so these seconds are paid"
    marks = {f"the rule, by judge {i}": float(each.of_rule) for i, each in enumerate(found)} | {"a guess": 0.5}
    seconds = np.arange(1 - LAST, 1)
    crashes = " and ".join(f"{each.crashes}" for each in found)
    label = f"mean D(s,a) in the drives that crash: {crashes} of 100"
    alt = "; ".join(
        f"seed {i}, {each.crashes} of 100 drives crash, D in the last {LAST} seconds "
        f"{', '.join(f'{d:.2f}' for d in each.before)}, in all of its own {each.own:.2f}, "
        f"in the rule's {each.of_rule:.2f}"
        for i, each in enumerate(found)
    )
    x_label = "seconds, 0: the last one before the crash"
    return charts.lines(seconds, named, title, x_label, label, marks=marks, limits=(0, 1), alt=f"GAIL, {alt}.")
