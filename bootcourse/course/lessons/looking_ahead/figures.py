"""The figures of this lesson: what looking ahead changes, and what a model costs that is wrong or learned.

`each_agent`, `learned` and `wrong_models` take the results of the experiments `look-ahead` and `learned-model`,
{cell: agents}; their files, in bootcourse.research.experiments, say what was measured.
"""

from collections.abc import Mapping, Sequence
from typing import NamedTuple

import numpy as np
import torch
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import NullLocator

from bootcourse.colours import ALARM
from bootcourse.course.dots import beside, dots, name_rows
from bootcourse.episodes.lookahead import nine_drives
from bootcourse.episodes.record import Rollout
from bootcourse.errors import BootcourseError
from bootcourse.learn.agent import Agent
from bootcourse.learn.road_model import RoadModel, imagine
from bootcourse.methods import display_name, style
from bootcourse.plots.figure import GRID, INK, QUIET, SMALL, TEXT, axes_at, finish, new_figure, plain_axes
from bootcourse.research.experiments import learned_model
from bootcourse.research.experiments.lookahead import CLOSELY, Cell
from bootcourse.research.results import Results
from bootcourse.road.state import EGO, TRAP_1, Accident, X
from bootcourse.scenario import ACTION_NAMES, N_ACTIONS

MEANINGS = {  # of the wrong models that the lesson shows, for readers: what each is called, and what is wrong
    "others keep speed and lane": ("others keep speed and lane", "nobody accelerates, brakes or changes lane"),
    "only the four visible cars": ("only the four visible cars", "those that the agent does not see are missing"),
    "places off by 1 m, speeds by 0.5 m/s": (
        "noise on the others",
        "places off by 1 m, speeds by 0.5 m/s, drawn anew each second",
    ),
    "everything a second late": ("all a second late", "as it was a second ago, not moved on"),
}
LEARNED_FORM = "mean of five"  # of the look-ahead in a learned model, as the lesson shows it
LEARNED_TITLES = {
    LEARNED_FORM: "With 800 drives no kind of learned model makes the look-ahead safer than the agent alone",
    "shield": "Used as a shield, the same models help the four agents that crash most",
}
COLUMNS = 166, 192  # where the numbers beside the bars of the learned model end
LINEAR = 1.0  # accidents in 1,000 drives: the axis is linear below, logarithmic above
NAMES = {"rollouts": "look-ahead", "shield": "shield"}  # as the lesson calls the forms


def _accident_axis(axis_of: Axes, axis: str) -> None:
    """Accidents in 1,000 drives: logarithmic, and linear near 0, where a bar may end."""
    getattr(axis_of, f"set_{axis}scale")("symlog", linthresh=LINEAR, linscale=0.6)
    getattr(axis_of, f"set_{axis}ticks")([0, 1, 10, 100, 1000], ["0", "1", "10", "100", "1,000"])
    getattr(axis_of, f"set_{axis}lim")(-0.35, 2200)
    getattr(axis_of, f"{axis}axis").set_minor_locator(NullLocator())


def accidents(drives: Sequence[Rollout]) -> int:
    """How many of the drives end in an accident."""
    return sum(drive.accident > 0 for drive in drives)


def got_out(drives: Sequence[Rollout]) -> int:
    """How many of the drives end ahead of trap 1."""
    return sum(bool(drive.cars[-1, EGO, X] > drive.cars[-1, TRAP_1, X]) for drive in drives)


def compared(drives_of: Mapping[str, Sequence[Rollout]]) -> tuple[list[str], list[list]]:
    """A table of the same agent's drives, in each of some forms: its headings and rows."""
    roads = len(next(iter(drives_of.values())))
    rows = [
        [name, accidents(drives), f"{np.mean([drive.rewards.sum() for drive in drives]):.1f}"]
        for name, drives in drives_of.items()
    ]
    return ["the same agent", f"accidents in {roads}", "return"], rows


def per_thousand(cells: dict[str, Results], cell: Cell) -> np.ndarray:
    """Accidents in 1,000 drives of each agent of a cell, (agents,)."""
    of = cells[cell.name].measured
    return 1000 * of["accidents"] / of["roads"]


def each_agent(cells: dict[str, Results], base: str) -> Figure:
    """Success and accidents, alone and with the look-ahead, of each agent that stays behind alone.

    Dark: who crashes more often with the look-ahead.
    """
    title = "With the look-ahead some agents leave the trap, and some crash more often than alone"
    pair, figure = [Cell(base, form) for form in ("alone", "rollouts")], new_figure(3.2)
    success = np.array([100 * cells[cell.name].measured["success"] for cell in pair])
    stays, hurt = success[0] < 1, np.array([per_thousand(cells, cell) for cell in pair])
    panels = {
        "ahead of trap 1 (%)": success[:, stays],
        "accidents in 1,000 drives (logarithmic above 1)": hurt[:, stays],
    }
    alone, ahead = [*panels.values()][1]
    worse, alt_parts = ahead > alone, []
    for column, (words, values) in enumerate(panels.items()):
        ax = axes_at(figure, 0.5 + column * 3.4, 1.05, 2.9, 1.55)
        for of, colour, width in ((~worse, style(base).colour, 1.1), (worse, INK, 2.2)):
            ax.plot([0, 1], values[:, of], color=colour, linewidth=width, marker="o", ms=4, clip_on=False)
        plain_axes(ax, words)
        ax.set(xlim=(-0.15, 1.15), ylim=(0, 100))
        ax.set_xticks([0, 1], ["alone", "look-ahead"])
        for x, ends in enumerate(values.round().astype(int)):
            for y, lines in zip(*np.unique(ends, return_counts=True), strict=True):
                if lines > 1:  # lie on each other
                    side = {"ha": "left" if x else "right", "va": "bottom", "fontsize": SMALL, "color": QUIET}
                    ax.annotate(f"×{lines}", (x, y), (6 if x else -6, 3), textcoords="offset points", **side)
        each = ", ".join(f"{before:.0f} to {after:.0f}" for before, after in values.T)
        alt_parts.append(f"{words}: {each}")
    _accident_axis(ax, "y")
    words = f"a line for each of the {stays.sum()} agents of {display_name(base)} that stay behind (×: so many alike); "
    words += "dark: it crashes more often with the look-ahead"
    figure.text(0.012, 0.1 / figure.get_figheight(), words, fontsize=SMALL, color=INK)
    alt = f"A line for each of these agents, from alone to with the look-ahead. {'; '.join(alt_parts)}."
    return finish(figure, title, alt)


class Judged(NamedTuple):
    """What a learned model says of the nine actions at each decision of a drive, and what is true; each (decisions, 9).

    An imagined drive is ten decisions long: the action, then the agent's own ones.
    """

    values: np.ndarray  # Q̂ in the model, the mean of its networks
    risks: np.ndarray  # how probable the model finds an accident within the ten decisions
    true_values: np.ndarray  # Q̂ on the true road
    accidents: np.ndarray  # int: how the drive on the true road ends, an Accident's number


def judged(agent: Agent, model: RoadModel, drive: Rollout) -> Judged:
    """The model and the true road at each decision of a drive that the agent itself drove."""
    states = torch.from_numpy(drive.observations[: len(drive.actions)]).float()
    values, risks = imagine(model, agent, states, torch.arange(N_ACTIONS).expand(len(states), -1))
    true = nine_drives(drive.cars, agent.as_policy(), drive.scenario)
    return Judged(values.mean(0).numpy(), risks.mean(0).numpy(), true.values, true.accidents)


def own_and_others(agent: Agent, model: RoadModel, drives: Sequence[Rollout]) -> tuple[list[str], list[list]]:
    """A table of the agent's own drives: how many imagined futures crash, in the model and on the true road."""
    parts = zip(*(judged(agent, model, drive) for drive in drives), strict=True)
    values, risks, _, accidents = (np.concatenate(part) for part in parts)
    own = np.eye(N_ACTIONS, dtype=bool)[np.concatenate([drive.actions for drive in drives])]
    picked = np.eye(N_ACTIONS, dtype=bool)[values.argmax(axis=1)]
    kinds = {"the agent's own": own, "the eight others": ~own, "the best of nine in the model": picked}
    rows = [
        [name, f"{100 * risks[kind].mean():.0f}", f"{100 * (accidents[kind] > 0).mean():.0f}"]
        for name, kind in kinds.items()
    ]
    return ["first action", "the model says: crash, %", "true road: crash, %"], rows


def promised(agent: Agent, model: RoadModel, drive: Rollout) -> Figure:
    """The nine Q̂ in a learned model and on the true road, at one decision of a drive that the agent itself drove.

    It is the first at which the best of nine in the model ends in an accident and another action would not; without
    one, the drive's first.
    """
    values, _, true, hurt = judged(agent, model, drive)
    chosen = values.argmax(1)
    misled = (hurt[np.arange(len(chosen)), chosen] > 0) & (hurt == 0).any(1)
    now = int(misled.argmax())
    figure, ends, best, alt_parts = new_figure(4.55), hurt[now], chosen[now], []
    how = "leaves the road" if ends[best] == Accident.ROAD_DEPARTURE else "ends in an accident"
    title = f"The model promises {values[now, best]:.0f}; on the true road this action {how}"
    if not misled.any():
        title = "The model's best of nine ends well"
    ax, at = axes_at(figure, 1.35, 0.8, 3.5, 2.95), np.arange(N_ACTIONS)
    colours = [ALARM if end else style("bootstrapped").colour for end in ends]
    ax.barh(at - 0.19, values[now], 0.34, facecolor="white", edgecolor=INK, linewidth=0.9)
    ax.barh(at + 0.19, true[now], 0.34, color=colours)
    for row, name in enumerate(ACTION_NAMES):
        pair = [f"{of[now, row]:.0f}".replace("-", "−") for of in (values, true)]
        look = {"color": ALARM if ends[row] else INK, "fontweight": "bold" if row == best else "normal"}
        for x, words in zip(COLUMNS, pair, strict=True):
            ax.text(x, row, words, va="center", ha="right", fontsize=TEXT, **look)
        marks = ["chosen"] * bool(row == best) + ["the agent's"] * bool(row == drive.actions[now])
        if marks:
            ax.text(COLUMNS[1] + 5, row, f"← {', '.join(marks)}", va="center", fontsize=TEXT, **look)
        alt_parts.append(", ".join([f"{name}: {' and '.join(pair)}", *marks]))
    for x, words in zip(COLUMNS, ("model", "true road"), strict=True):
        ax.text(x, -0.75, words, va="center", ha="right", fontsize=SMALL, color=QUIET)
    plain_axes(ax, "", grid="x")
    ax.set(ylim=(N_ACTIONS - 0.5, -0.5), xlim=(-14, 155), xticks=[0, 50, 100, 150])
    ax.set_yticks(at, ACTION_NAMES, fontsize=TEXT, color=INK)
    ax.axvline(0, color=QUIET, linewidth=0.8)
    ax.set_xlabel(f"Q̂ at decision {now + 1}", fontsize=TEXT, color=INK)
    red = "leaves the road" if set(ends[ends > 0]) == {Accident.ROAD_DEPARTURE} else "ends in an accident"
    words = f"White: model; filled: true road; red: {red}."
    figure.text(0.012, 0.1 / figure.get_figheight(), words, fontsize=SMALL, color=INK)
    alt = f"Decision {now + 1}, Q̂ in the model and on the true road. {'; '.join(alt_parts)}."
    return finish(figure, title, alt)


def learned(computed: dict[str, Results], form: str = LEARNED_FORM) -> Figure:
    """Accidents of each agent in a model that it learned, a row for each kind of drives that the model learned from.

    computed: the cells of `learned-model`. form: one of `LEARNED_TITLES`.
    """
    title = LEARNED_TITLES[form]
    agents, base = learned_model.together(computed), learned_model.BASE
    alone = np.array(learned_model.alone())
    controls = {"the agent": agents}
    controls |= {
        f"{100 * share:.0f} % of its actions random": learned_model.together(computed, share)
        for share in learned_model.RANDOM
    }
    rows = {"(alone, without a model)": alone}
    rows |= {name: learned_model.per_thousand(of, form, control=True).ravel() for name, of in controls.items()}
    rows["the agent, then the look-ahead"] = learned_model.per_thousand(agents, form)[:, -1]
    learned_from = [of.measured["rows"] for of in controls.values()] + [agents.notes["rows"][:, -1]]
    thousands = ["–"] + [f"{of.mean() / 1000:.0f}" for of in learned_from]
    row, alt_parts = 0.46, []
    figure = new_figure(1.75 + row * len(rows))
    ax = axes_at(figure, 3.05, 1.0, 2.4, row * len(rows))
    on_the_left = {"transform": ax.get_yaxis_transform(), "ha": "right", "va": "center", "fontsize": SMALL}
    for place, ((name, values), rows_of) in enumerate(zip(rows.items(), thousands, strict=True)):
        worse, mean, first = values > alone, f"{values.mean():,.0f}", values is alone
        dots(ax, values, place, style(base).colour, worse, values.mean())
        ax.text(-0.13, place, rows_of, color=INK, **on_the_left)
        more = f"{worse.sum()} of {len(worse)}"
        beside(ax, place, mean, "" if first else more)
        shown, worse_of = ("", "") if first else (f", {rows_of} thousand decisions", f", {more} more than alone")
        alt_parts.append(f"{name}{shown}: mean {mean}{worse_of}")
    beside(ax, -0.75, "mean", "more than\nalone", colour=QUIET)
    name_rows(ax, list(rows), "accidents in 1,000 drives")
    ax.axvline(alone.mean(), color=QUIET, linewidth=1.2, linestyle=(0, (4, 3)), zorder=1)
    ax.text(alone.mean(), -0.62, "alone", ha="center", fontsize=SMALL, color=QUIET)
    ax.tick_params(axis="y", pad=48)
    for x, words in ((-0.026, "decisions\n(thousand)"), (-0.31, "the model learns from")):
        ax.text(x, -0.75, words, color=QUIET, **on_the_left)
    ax.set(xlim=(0, 1080))
    ax.set_xticks([0, 500, 1000], ["0", "500", "1,000"])
    words = "A dot for each agent; filled: it crashes more than alone. Bar: the mean. Each drove the same 100 roads."
    figure.text(0.012, 0.1 / figure.get_figheight(), words, fontsize=SMALL, color=INK)
    doing = "with the look-ahead" if form == LEARNED_FORM else "under the shield"
    alt = f"Accidents in 1,000 drives {doing}, by what the model learns from. {'; '.join(alt_parts)}."
    return finish(figure, title, alt)


def wrong_models(cells: dict[str, Results], base: str = CLOSELY[0]) -> Figure:
    """The agents' mean accidents with each wrong model, with the look-ahead and with the shield, and alone.

    Raises BootcourseError if the base policy alone, or any of the two with a model, was not computed.
    """
    title = "Noise on the others costs far more drives than cars that are missing"
    names, alone, forms = ["exact", *MEANINGS], Cell(base, "alone"), {"rollouts": "o", "shield": "s"}
    called = ["exact", *(name for name, _ in MEANINGS.values())]
    models = [Cell(base, form, model=name) for form in forms for name in names]
    if missing := [cell.name for cell in (alone, *models) if cell.name not in cells]:
        raise BootcourseError(
            f"These results of {base} lack {', '.join(missing)}: run `bootcourse study look-ahead --out DIR`."
        )
    row, colour, of_alone = 0.36, style(base).colour, per_thousand(cells, alone).mean()
    figure, alt_parts = new_figure(1.0 + row * len(names) + 0.8), []
    ax = axes_at(figure, 2.4, 1.0, 4.3, row * len(names))
    for (form, marker), shift, fill in zip(forms.items(), (-0.16, 0.16), (colour, "white"), strict=True):
        each = [per_thousand(cells, Cell(base, form, model=name)) for name in names]
        means = [values.mean() for values in each]
        look = {"color": colour, "mfc": fill, "marker": marker, "ls": "", "clip_on": False}
        ax.plot(means, np.arange(len(names)) + shift, **look, ms=8, mew=1.6, zorder=4)
        numbers = "; ".join(f"{name} {mean:.1f}" for name, mean in zip(called, means, strict=True))
        alt_parts.append(f"{NAMES[form]}: {numbers}.")
    plain_axes(ax, "", grid="x")
    ax.axvline(of_alone, color=QUIET, linewidth=1.2, linestyle=(0, (4, 3)), zorder=1)
    ax.text(of_alone, -0.62, "alone", ha="center", fontsize=SMALL, color=QUIET)
    ax.set(ylim=(len(names) - 0.5, -0.5))
    ax.set_xlabel("accidents in 1,000 drives (logarithmic above 1)", fontsize=TEXT, color=INK)
    ax.spines["bottom"].set_color(GRID)
    _accident_axis(ax, "x")
    ax.set_yticks(range(len(names)), called, fontsize=TEXT, color=INK)
    words = "● look-ahead    □ shield    (means of ten agents)"
    figure.text(0.012, 0.1 / figure.get_figheight(), words, fontsize=TEXT, color=colour)
    return finish(figure, title, f"Mean accidents in 1,000 drives. Alone: {of_alone:.1f}. {' '.join(alt_parts)}")
