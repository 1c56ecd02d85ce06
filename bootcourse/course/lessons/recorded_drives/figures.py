"""The lesson on recorded drives: three pupils' drives and results, a judge's loss, critics' beliefs, and estimates."""

from collections.abc import Sequence
from functools import cache

import numpy as np
import torch
from matplotlib.figure import Figure

from bootcourse.colours import INK, OTHER, QUIET, Style
from bootcourse.course import charts
from bootcourse.course.lessons.recorded_drives import choosing
from bootcourse.course.shipped import beginning, shipped_agents
from bootcourse.episodes.record import record
from bootcourse.episodes.rollout import Rollout
from bootcourse.learn.learner import SACLearner
from bootcourse.methods import display_name, style
from bootcourse.plots.figure import TEXT, finish, new_figure, plain_axes
from bootcourse.policies import rule_policy
from bootcourse.research.paper import PRINTED
from bootcourse.research.report import rule_results
from bootcourse.research.results import Results, join
from bootcourse.research.tables import escaped, score
from bootcourse.scenario import DEFAULT
from bootcourse.statistics import bracketed

SECONDS = 20  # of a drive: the way out
GUESSING = 2 * np.log(2)  # the discriminator's loss where D = 1/2 everywhere
FORMS = ("with the term", "without")


def three_pupils() -> list[Rollout]:
    """GAIL's shortest drive that is a success and leaves the road after 30 s, and a clone's and CQL's on its road."""
    policies = [agent.as_policy() for agent in shipped_agents("gail")]
    drives = [drive for policy in policies for drive in record(policy, range(20), label="gail")]
    leaves = [drive for drive in drives if drive.success and drive.accident and len(drive.actions) > 30]
    gail = min(leaves, key=lambda drive: len(drive.actions))
    others = [record(shipped_agents(m)[0].as_policy(), [gail.seed], label=m)[0] for m in ("bc", "cql")]
    return [beginning(drive, 50) for drive in (gail, *others)]


def pupils(study: Results) -> tuple[list[str], list[list[str]]]:
    """A table's columns and rows: who escapes and what it earns, the mean over agents; and what the paper prints."""
    rule = rule_results(DEFAULT, study.tested["returns"].shape[1])
    everyone, rows = join([Results(study.agents, study.stopped, study.tested, {}), rule]), []
    for method in ("bc", "cql", "cql_sac", "gail", "rule"):
        earned = bracketed(score(everyone, method, "returns", np.mean))
        printed = PRINTED.get(method, {})
        paper = [f"{printed[column].mean:g}" if printed else "" for column in ("success", "returns")]
        escapers = "yes" if method == "rule" else escaped(everyone, method)
        rows.append([display_name(method), escapers, earned, *paper])
    return ["", "escape", "return [95 % over agents]", "the paper's success, %", "its return"], rows


def off_the_road(study: Results) -> tuple[list[str], list[list[str]]]:
    """A table's columns and rows: how often the agents of a method leave the road, and succeed all the same."""
    rows = []
    for method in ("bc", "cql", "gail"):
        left, ahead = (study.of(method).episodes(what) > 0 for what in ("road_departure", "success"))
        rows.append([display_name(method), f"{100 * left.mean():.1f} %", f"{100 * ahead[left].mean():.0f} %"])
    return ["ten agents", "leave the road in", "of these drives a success"], rows


def judged(losses: Sequence[dict[str, torch.Tensor]]) -> Figure:
    """The discriminator's loss of each agent over the updates, in means of 50; an entry without it came before them."""
    known = [each["discriminator_loss"] for each in losses if each]
    loss = torch.stack(known[: len(known) // 50 * 50]).T.numpy()  # (agents, updates)
    smooth = loss.reshape(len(loss), -1, 50).mean(-1)
    later = "; later this is harder" if (smooth[:, -1] > smooth.min(1)).all() else ""
    named = {f"gail, seed {seed}": each for seed, each in enumerate(smooth)}
    updates, marks = np.arange(smooth.shape[1]) * 50, {"guessing: D = ½": GUESSING}
    title = f"The judge soon tells agent from rule{later}"
    return charts.lines(updates, named, title, "update", "discriminator's loss", marks=marks)


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
        title = "Without CQL's term an untried action seems worth far more than the rule's drive"
    named = {"with: the rule's": of_rule[:half], "with: best untried": rival[:half]}
    named |= {"without: the rule's": of_rule[half:], "without: best untried": rival[half:]}
    looks = [Style(colour, line) for colour in (style("cql").colour, OTHER.colour) for line in ("-", "--")]
    updates, marks = np.arange(len(found)) * every, {f"the rule's drive: {by_rule:.1f}": by_rule}
    label = "mean Q(s,a) of the rule's action and of the best untried one"
    return charts.lines(updates, named, title, "update", label, marks=marks, looks=looks)


def promises(learner: SACLearner) -> tuple[list[str], list[list[str]]]:
    """A table's columns and rows: how the agents drive 100 roads, what Q they promise and what that is worth."""
    rows = []
    for i, settings in enumerate(learner.settings):
        drives = record(learner.agent(i).as_policy(with_q=True), range(100))
        q = [drive.q_values[range(len(drive.actions)), drive.actions][:SECONDS].mean() for drive in drives]
        success, accidents = (100 * np.mean([each > 0 for each in kind]) for kind in (
            [drive.success for drive in drives], [drive.accident for drive in drives]))  # fmt: skip
        paid = np.mean([earned(drive, settings.gamma) for drive in drives])
        name = f"{FORMS[2 * i // learner.agents]}, seed {settings.seed}"
        rows.append([name, f"{success:.0f} %", f"{accidents:.0f} %", f"{np.mean(q):.1f}", f"{paid:.1f}"])
    return ["100 roads", "success", "accidents", "promises: Q, first 20 s", "is then worth"], rows


def estimates(names: Sequence[str], alike: Sequence[float], fits: np.ndarray, truth: Sequence[float]) -> Figure:
    """What drivers are worth: a digit for each fit, (fits, drivers), with a ring if it is the largest of its fit, and
    a bar for the truth. alike: how often each acts as the data do. A line: what the rule itself is worth.
    """
    miss, same = np.abs(fits - truth).max(0), np.array(alike) > 0.8
    title = "What seven drivers are worth: three estimates, and the truth"
    if miss[same].max() < 0.15 and miss[~same].max() > 0.3:
        title = "Where a driver acts as the data do, all its estimates are near the truth"
    shares = [f"{100 * each:.0f} %" for each in alike]
    figure = new_figure(1.45 + 0.48 * len(names))
    height = figure.get_figheight()
    ax = figure.add_axes((0.24, 0.5 / height, 0.73, 1 - 1.45 / height))
    by_rule = choosing.rule_worth()
    ax.axvline(by_rule, color=style("rule").colour, linewidth=1.5, zorder=1)
    for row in range(len(names)):
        ax.plot([truth[row]] * 2, [row - 0.36, row + 0.36], color=INK, linewidth=3, zorder=2)
        for fit, values in enumerate(fits):
            place = values[row], row + 0.26 * (fit - (len(fits) - 1) / 2)
            ax.text(*place, str(fit + 1), fontsize=TEXT, color=OTHER.colour, ha="center", va="center", zorder=4)
            if row == values.argmax():
                ax.plot(*place, "o", markersize=11, color=OTHER.colour, fillstyle="none", zorder=3)
    plain_axes(ax, "", grid="x")
    ax.set_yticks(range(len(names)), [f"{name}\nas the data: {each}" for name, each in zip(names, shares, strict=True)])
    ax.tick_params(axis="y", labelcolor=INK, labelsize=TEXT)
    ax.set_ylim(len(names) - 0.5, -0.5)
    ax.set_xlim(min(fits.min(), *truth) - 0.08, max(fits.max(), *truth) + 0.08)
    ax.set_xlabel("worth from the start (γ = 0.8)", fontsize=TEXT, color=INK)
    key = "bar: the truth on the road · 1, 2, 3: the fits · ring: the largest of a fit · green: the rule"
    ax.text(0, 1.03, key, transform=ax.transAxes, fontsize=TEXT, color=QUIET)
    rows = (
        f"{name}, acts as the data do in {share}: {', '.join(f'{each:.2f}' for each in guesses)}; truth {true:.2f}"
        for name, share, guesses, true in zip(names, shares, fits.T, truth, strict=True)
    )
    return finish(figure, title, f"Estimates of three fits. {'. '.join(rows)}. The rule is worth {by_rule:.2f}.")
