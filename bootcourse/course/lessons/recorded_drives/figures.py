"""The lesson on recorded drives: three agents' drives, returns, choices, and estimates."""

from collections.abc import Mapping, Sequence

import numpy as np
import torch
from matplotlib.colors import LinearSegmentedColormap
from matplotlib.figure import Figure

from bootcourse.colours import GRID, INK, OTHER, QUIET
from bootcourse.course.lessons.recorded_drives import choosing
from bootcourse.course.shipped import beginning, shipped_agents
from bootcourse.episodes.record import record
from bootcourse.episodes.rollout import Rollout
from bootcourse.learn.learner import SACLearner
from bootcourse.methods import display_name, style
from bootcourse.plots.figure import TEXT, axes_at, finish, new_figure, one_axes
from bootcourse.research.report import rule_results
from bootcourse.research.results import Results
from bootcourse.research.tables import escaped
from bootcourse.scenario import DEFAULT
from bootcourse.statistics import ESCAPES

ROAD = 9  # of the held-out ones: chosen for GAIL's drive
WITH, IN_TARGET = "with CQL's term", "rule's a' in the target"
CRASHED = "drives with crashes"
CRASH_TOO = {  # the titles of two figures if all agents in them crash
    IN_TARGET: "With the rule's a' in the target both crash, too",
    CRASHED: "Crashes in the data do not help: both crash",
}
LABELS = {  # where a method's name stands in `estimates`: x, y, side
    "bc": (99, 0.15, "right"), "cql": (99, -0.25, "right"), "gail": (55, -0.25, "center"),
    "sac": (26, 0.55, "left"), "bootstrapped": (29, -0.6, "left"),
}  # fmt: skip
METHODS_BY_NAME = {display_name(method): method for method in choosing.METHODS}


def three_drives() -> list[Rollout]:
    """A drive of GAIL that is ahead of trap 1 and then leaves the road, and a clone's and CQL's on its road."""
    drivers = [(method, shipped_agents(method)[which]) for method, which in (("gail", 3), ("bc", 0), ("cql", 0))]
    return [beginning(record(agent.as_policy(), [ROAD], label=method)[0], 46) for method, agent in drivers]


def returns(study: Results) -> Figure:
    """Each agent's return and how often it has an accident, filled: it escapes; a line for the rule's return."""
    title = "CQL earns more than its teacher, and GAIL often crashes"
    label = "return of an agent on 1,000 roads; filled: it escapes"
    figure, ax = one_axes(3.6, title, label, "drives with an accident")
    by_rule, alt = rule_results(DEFAULT, study.tested["returns"].shape[1]).scores("returns").mean(), []
    ax.axvline(by_rule, color=style("rule").colour, linewidth=1.5, zorder=1)
    ax.text(by_rule + 0.6, 103, "the rule", fontsize=TEXT, color=style("rule").colour, va="top")
    places = {
        "bc": (50.6, 8, "right"),
        "cql": (59, 6, "center"),
        "gail": (36, 34, "left"),
    }
    for method, (x, y, side) in places.items():
        mine, look = study.of(method), style(method)
        earns, hurt, ahead = mine.scores("returns"), 100 * mine.scores("accident"), mine.scores("success")
        fills = np.where(ahead >= ESCAPES, look.colour, "white")
        ax.scatter(earns, hurt, s=20, c=fills, edgecolors=look.colour, linewidths=1, alpha=0.7, zorder=3, clip_on=False)
        words = f"{display_name(method)}: {escaped(study, method)} escape"
        shown = words.replace(": ", ":\n") if method in ("cql", "bc") else words  # in two lines, for want of room
        ax.text(x, y, shown, fontsize=TEXT, color=look.colour, ha=side)
        alt.append(f"{words}, mean return {earns.mean():.1f}, {hurt.mean():.1f} % of drives end in an accident")
        if method == "gail":
            worst = np.argmax(np.where(ahead >= ESCAPES, hurt, -1))
            alt.append(f"one is ahead of trap 1 on {100 * ahead[worst]:.0f} %,\nin an accident on {hurt[worst]:.0f} %")
            ax.text(earns[worst] + 1, hurt[worst], alt[-1], fontsize=TEXT, color=look.colour, va="center")
    ax.set_ylim(-2, 104)
    ax.tick_params(labelsize=TEXT)
    ax.yaxis.set_major_formatter(lambda share, _: f"{share:.0f} %")
    words = "; ".join(alt).replace("\n", " ")
    return finish(figure, title, f"A dot for each agent. {words}. The rule's return is {by_rule:.1f}.")


def would_do(learners: Mapping[str, SACLearner]) -> Figure:
    """In which share of the recorded seconds the rule took each of the nine actions, and agents would, as grids.

    learners: by what they are called, such as `WITH`. Below each grid, the crashes on 100 roads, and what
    an agent promises at their starts (the mean Q of its actions) beside what it is worth from there.
    The rule's grid is left out for the kinds in `CRASH_TOO`, which follow a figure that has it.
    """
    data, names = choosing.recorded(), ["the rule"]
    taken, colours = [data.actions], [style("rule").colour]
    words = ["no crash"]
    crashes = {name: [] for name in learners}
    for name, learner in learners.items():
        for row, settings in enumerate(learner.settings):
            agent = learner.agent(row)
            policy = agent.as_policy(with_q=True)
            drives = record(agent.as_policy(), range(100))
            crashes[name].append(sum(drive.accident > 0 for drive in drives))
            taken.append(choosing.actions_of(policy, data.states))
            names.append(f"{name}, seed {settings.seed}")
            colours.append(style("cql").colour if name == WITH else OTHER.colour)
            promise = choosing.promised(policy, choosing.starts())
            earns = choosing.worth(policy, range(100), settings.gamma)
            says = f"promises {promise:.1f}, is worth {earns:.1f}".replace("-", "−")
            words.append(f"crashes {crashes[name][-1]} of 100\n{says}")
    shares = [torch.bincount(each, minlength=9).reshape(3, 3).numpy() / len(each) for each in taken]
    faster = [share[2].sum() for share in shares[1:]]
    title, follows = "What the rule did, and what the agents would do", next(iter(learners))
    all_crash, with_rule = CRASH_TOO.get(follows, ""), follows not in CRASH_TOO
    if min(faster) == 1 and all(each == 100 for many in crashes.values() for each in many):
        title = all_crash or "Both would always accelerate, and crash on every road"
    elif all(each == 100 for many in crashes.values() for each in many):
        title = all_crash or "Both crash on every road"
    elif set(learners) == {WITH} and max(abs(each - shares[0][2].sum()) for each in faster) < 0.15:
        title = "With CQL's term they stay near what the rule did"
    figure, height = new_figure(2.95), 2.95
    shown, wide = (slice(None), 2.1) if with_rule else (slice(1, None), 3.1)
    names, shares, colours, words = (each[shown] for each in (names, shares, colours, words))
    for place, (name, share, colour, below) in enumerate(zip(names, shares, colours, words, strict=True)):
        ax = axes_at(figure, 0.85 + wide * place, 0.92, wide - 0.4, 1.2)
        fade = LinearSegmentedColormap.from_list("", ["white", colour])
        ax.imshow(share[::-1], cmap=fade, vmin=0, vmax=0.8, aspect="auto")  # "accelerate" on top
        for (row, column), value in np.ndenumerate(share[::-1]):
            ax.text(column, row, f"{100 * value:.0f} %", ha="center", va="center", fontsize=TEXT,
                    color="white" if value > 0.6 else INK)  # fmt: skip
        ax.set_xticks(range(3), ["left", "straight", "right"])
        ax.set_yticks(range(3), ["accelerate", "keep", "brake"] if place == 0 else [""] * 3)
        ax.tick_params(length=0, labelsize=TEXT, labelcolor=INK)
        ax.spines[:].set_color(GRID)
        ax.set_title(name, fontsize=TEXT, color=colour)
        ax.set_xlabel(below, fontsize=TEXT, color=INK)
    who = "the rule took, and agents would take," if with_rule else "agents would take"
    key = f"in how many of the {len(data.actions):,} recorded seconds {who} each action"
    figure.text(0.012, 1 - 0.52 / height, key, fontsize=TEXT, color=QUIET)
    said = "; ".join(
        f"{name}: accelerates {100 * share[2].sum():.0f} %, {below}".replace("\n", ", ")
        for name, share, below in zip(names, shares, words, strict=True)
    )
    return finish(figure, title, f"A grid of nine actions each. {said}.")


def estimates(
    names: Sequence[str], alike: np.ndarray, fits: Sequence[np.ndarray], truth: np.ndarray, same: float
) -> Figure:
    """How far the estimates of two fits are off, for sets of agents, (sets, agents); alike: how often each acts as the
    data do; same: a worth that is said of all agents, for comparison.
    """
    off, control = np.stack(fits) - truth, same - truth
    title = "How far is each estimate off?"
    near = max(abs(off[:, alike > 0.8]).max(), abs(control[alike > 0.8]).max())
    if near < 0.1 < 0.4 < abs(off[:, alike < 0.4]).max():
        title = "Where an agent acts as the data do, both fits are within 0.1 of the truth, and so is a constant"
    label = "share of recorded seconds in which an agent would do what the rule did (close ones moved apart)"
    above = f"estimate less truth (above 0: too high; grey: ±0.1); ● first, ○ second fit, × {same:.2f} for every agent"
    figure, ax = one_axes(3.7, title, label, above)
    ax.axhspan(-0.1, 0.1, color=GRID, zorder=0)
    ax.axhline(0, color=INK, linewidth=1)
    places = _moved_apart(100 * alike)
    ax.scatter(places, control, s=26, color=QUIET, marker="x", linewidths=1.2, zorder=2.5)
    said = []
    for i, name in reversed([*enumerate(names)]):
        look = style(METHODS_BY_NAME[name])
        x, mine = 100 * alike[:, i], off[:, :, i]
        ax.vlines(places[:, i], *mine, color=look.colour, linewidth=1, zorder=2)
        for each, fill in zip(mine, (look.colour, "white"), strict=True):
            ax.scatter(places[:, i], each, s=34, color=fill, edgecolors=look.colour, linewidths=1.3, zorder=3)
        dx, dy, side = LABELS[METHODS_BY_NAME[name]]
        ax.text(dx, dy, name, fontsize=TEXT, color=look.colour, ha=side)
        apart = abs(mine[0] - mine[1]).max()
        said.append(
            f"{name}: {x.min():.0f}–{x.max():.0f} %, off {mine.min():+.2f} to {mine.max():+.2f}, two fits up to "
            f"{apart:.2f} apart, {same:.2f} off {control[:, i].min():+.2f} to {control[:, i].max():+.2f}"
        )
    ax.set_xlim(0, 100)
    ax.xaxis.set_major_formatter(lambda share, _: f"{share:.0f} %")
    return finish(figure, title, f"For each agent a dot for either fit, joined by a line: {'; '.join(said)}.")


def _moved_apart(shares: np.ndarray, least: float = 1.8) -> np.ndarray:
    """Shares (%) up to 50, moved so that no two are closer than so many points; those above as they are."""
    low = np.flatnonzero(shares.ravel() < 50)
    order, moved = low[np.argsort(shares.ravel()[low], kind="stable")], shares.astype(float).ravel()
    for before, after in zip(order, order[1:], strict=False):
        moved[after] = max(moved[after], moved[before] + least)
    moved[order] -= (moved[order] - shares.ravel()[order]).mean()
    return moved.reshape(shares.shape)
