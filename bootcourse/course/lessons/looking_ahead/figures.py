"""The figures of this lesson: what looking ahead changes, and what a model costs that is wrong, or learned.

The last three take the results of the experiments `look-ahead` and `learned-model`, {cell: agents}; their files, in
bootcourse.research.experiments, say what was measured.
"""

from collections.abc import Container, Mapping, Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import NullLocator

from bootcourse.episodes.evaluate import Episodes
from bootcourse.episodes.lookahead import nine_drives
from bootcourse.episodes.record import record
from bootcourse.errors import BootcourseError
from bootcourse.learn.agent import Agent
from bootcourse.learn.road_model import ImaginedAhead, RoadModel
from bootcourse.methods import display_name, style
from bootcourse.plots.figure import GRID, INK, QUIET, SMALL, TEXT, WIDTH, axes_at, finish, new_figure, plain_axes
from bootcourse.research.experiments import learned_model
from bootcourse.research.experiments.lookahead import CLOSELY, Cell, Score, score
from bootcourse.research.results import Results
from bootcourse.scenario import N_ACTIONS

MEANINGS = {  # of the wrong models that the lesson shows, for readers
    "others keep speed and lane": "nobody accelerates, brakes or changes lane",
    "twice the time gap": "the others keep twice the distance",
    "only the four visible cars": "the cars that the agent's numbers do not show are missing",
    "places off by 1 m, speeds by 0.5 m/s": "noise on the others, drawn anew each second",
    "the others a second late": "the others where they were a second ago, moved on at their speed",
    "everything a second late": "the whole road as it was a second ago, the ego included",
}
LEARNED_FORMS = {"the look-ahead": "mean of five", "the shield": "shield"}  # as the lesson calls two forms
BASE = "bootstrapped"  # whose agents the lesson follows
LINEAR = 1.0  # accidents in 1,000 drives: the axis is linear below, logarithmic above
LOWEST = 120.0  # return: lower ones stand at the axis' left end as numbers
MARKS = {"rollouts": "●", "shield": "□"}
NAMES = {"rollouts": "look-ahead", "shield": "shield"}  # as the lesson calls the forms


def _accident_axis(axis_of: Axes, axis: str) -> None:
    """Accidents in 1,000 drives: logarithmic, and linear near 0, where a bar may end."""
    getattr(axis_of, f"set_{axis}scale")("symlog", linthresh=LINEAR, linscale=0.6)
    getattr(axis_of, f"set_{axis}ticks")([0, 1, 10, 100, 1000], ["0", "1", "10", "100", "1,000"])
    getattr(axis_of, f"set_{axis}lim")(-0.35, 2200)
    getattr(axis_of, f"{axis}axis").set_minor_locator(NullLocator())


def accidents(drives: Episodes) -> int:
    """How many of the drives end in an accident."""
    return int((drives.accident > 0).sum())


def compared(drives_of: Mapping[str, Episodes]) -> tuple[list[str], list[list]]:
    """A table of the same agent's drives, in each of some forms: its headings and rows."""
    roads = len(next(iter(drives_of.values())).returns)
    rows = [[name, accidents(drives), f"{drives.returns.mean():.1f}"] for name, drives in drives_of.items()]
    return ["the same agent", f"accidents in {roads}", "return"], rows


def each_agent(cells: dict[str, Results], bases: Sequence[str]) -> Figure:
    """Each agent's success and accidents, alone and with the look-ahead: a panel for each measure and base policy."""
    title = "With the look-ahead some agents leave the trap, and some crash more often than alone"
    figure, alt_parts, left, high = new_figure(2 * 2.1 + 0.7), [], 0.55, 2.1
    width = (WIDTH - left - 0.1) / len(bases)
    measures = {"ahead of trap 1 (%)": "success", "accidents in 1,000 drives (logarithmic above 1)": "accidents"}
    for row, (words, measure) in enumerate(measures.items()):
        place = 1 - (0.78 + row * high) / figure.get_figheight()
        figure.text(0.012, place, words, fontsize=SMALL, color=QUIET)
        for column, base in enumerate(bases):
            ax = axes_at(figure, left + column * width, 1.12 + row * high, width - 0.35, 1.3)
            pair = [cells[Cell(base, form).name].measured for form in ("alone", "rollouts")]
            share = [of[measure] / of["roads"] if measure == "accidents" else of[measure] for of in pair]
            values = np.array(share) * (1000 if measure == "accidents" else 100)  # (2, agents)
            ax.plot([0, 1], values, color=style(base).colour, linewidth=1.1, marker="o", ms=3.5, clip_on=False)
            plain_axes(ax, display_name(base))
            ax.set(xlim=(-0.15, 1.15), ylim=(0, 100))
            if measure == "accidents":
                _accident_axis(ax, "y")
            ax.set_xticks([0, 1], ["alone", "look-ahead"])
            each = ", ".join(f"{alone:.0f} to {ahead:.0f}" for alone, ahead in values.T)
            alt_parts.append(f"{display_name(base)}, {words}: {each}")
    return finish(figure, title, f"A line for each agent, from alone to with the look-ahead. {'; '.join(alt_parts)}.")


def promised(agent: Agent, model: RoadModel, roads: Sequence[int]) -> tuple[list[str], list[list]]:
    """A table of Q at each road's first decision, as a learned model has it, and as the true road has it."""
    policy = agent.as_policy()
    begun = [(drive.observations[0], drive.cars[0]) for drive in record(policy, roads)]
    observations, cars = (np.stack(each) for each in zip(*begun, strict=True))
    values, own = ImaginedAhead(agent, model)(observations, cars).q_values, policy(observations, cars).actions
    true, of_own = nine_drives(cars, policy).values, np.arange(N_ACTIONS) == own[:, None]
    taken = np.arange(N_ACTIONS) == values.argmax(1)[:, None]
    which = {"the agent's own": of_own, "the other eight": ~of_own, "the one that the look-ahead takes": taken}
    rows = [[name, f"{values[of].mean():.0f}", f"{true[of].mean():.0f}"] for name, of in which.items()]
    return ["action at the first decision", "Q̂ in the model", "Q̂ on the true road"], rows


def learned(computed: dict[str, Results], cells: dict[str, Results]) -> Figure:
    """Accidents of each agent with a model that it learned: a panel for each form, over the rounds; 0 is alone.

    computed: the cells of `learned-model`; cells: those of the look-ahead, which drove the same agents alone.
    """
    title = "Drives of the look-ahead help it in part; more drives of the agent do not"
    figure, rounds, alt_parts = new_figure(3.7), learned_model.ROUNDS, []
    agents, colour, left = learned_model.together(computed), style(learned_model.BASE).colour, 0.6
    width = (WIDTH - left) / len(LEARNED_FORMS)
    of_alone = cells[Cell(learned_model.BASE, "alone").name].measured
    alone = 1000 * (of_alone["accidents"] / of_alone["roads"])[: len(agents)]
    for column, (name, form) in enumerate(LEARNED_FORMS.items()):
        ax = axes_at(figure, left + column * width, 1.2, width - 0.3, 1.7)
        values = np.column_stack([alone, learned_model.per_thousand(agents, form)])
        control = learned_model.per_thousand(agents, form, control=True)[:, 0]
        ax.plot(range(rounds + 1), values.T, color=colour, linewidth=0.8, alpha=0.6)
        ax.plot(range(rounds + 1), values.mean(0), color=colour, linewidth=2.4, marker="o", ms=4)
        ax.plot([rounds + 0.8] * len(control), control, "s", color=QUIET, ms=3, alpha=0.6, clip_on=False)
        ax.plot(rounds + 0.8, control.mean(), "s", color=INK, ms=6, clip_on=False)
        plain_axes(ax, name)
        ax.set(xlim=(-0.2, rounds + 1.1), ylim=(0, 1000))
        drives = [str(learned_model.DRIVES * number) for number in range(1, rounds + 1)]
        ax.set_xticks([*range(rounds + 1), rounds + 0.8], ["alone", *drives, "control"])
        ax.set_xlabel("drives that the model learned from", fontsize=TEXT, color=INK)
        means = ", ".join(f"{mean:.0f}" for mean in values.mean(0))
        alt_parts.append(f"{name}: {means}; the control {control.mean():.0f}")
    figure.text(0.012, 1 - 0.83 / figure.get_figheight(), "accidents in 1,000 drives", fontsize=SMALL, color=QUIET)
    drives = rounds * learned_model.DRIVES
    words = f"thin: each agent; thick: their mean; squares: the control, {drives} drives of the agent"
    figure.text(0.012, 0.1 / figure.get_figheight(), words, fontsize=SMALL, color=INK)
    return finish(figure, title, f"Mean accidents in 1,000 drives, alone and with each model. {'; '.join(alt_parts)}.")


def _check_computed(there: Container, wanted: Sequence, base: str) -> None:
    if missing := [str(one) for one in wanted if one not in there]:
        raise BootcourseError(
            f"These results of {base} lack {', '.join(missing)}: run `bootcourse study look-ahead --out DIR`."
        )


def wrong_models(cells: dict[str, Results], base: str = CLOSELY[0]) -> Figure:
    """Accidents and return with each wrong model, as full rollouts and as a shield, and of the base policy alone.

    Raises BootcourseError if the base policy alone, or any of the two with a model, was not computed.
    """
    title = "With everything a second late, every drive with the look-ahead ends in an accident"
    alone, names = score(cells, Cell(base, "alone")), ["exact", *MEANINGS]
    models = [Cell(base, form, model=name).name for form in ("rollouts", "shield") for name in names]
    _check_computed(cells, [Cell(base, "alone").name, *models], base)
    row, colour = 0.4, style(base).colour
    figure = new_figure(1.0 + row * len(names) + 0.8)
    ax, earned = (axes_at(figure, left, 1.0, wide, row * len(names)) for left, wide in ((2.25, 2.6), (5.2, 1.6)))
    words, scores_of = [], {}
    for form, shift, fill in (("rollouts", -0.14, colour), ("shield", 0.14, "white")):
        scores = {name: score(cells, Cell(base, form, model=name)) for name in names}
        scores_of[form] = scores
        at = np.arange(len(names)) + shift
        look = {"fmt": "o" if form == "rollouts" else "s", "color": colour, "mfc": fill, "mec": colour, "mew": 1.5}
        middle, low, high = 1000 * np.array([one.accident_rate for one in scores.values()]).T
        ax.errorbar(middle, at, xerr=[middle - low, high - middle], **look, ms=6, lw=1.3, zorder=3)
        middle, low, high = np.array([one.returns for one in scores.values()]).T
        shown = middle > LOWEST
        earned.errorbar(middle[shown], at[shown], xerr=[(middle - low)[shown], (high - middle)[shown]], **look, ms=6,
                        lw=1.3, zorder=3)  # fmt: skip
        for value, place in zip(middle[~shown], at[~shown], strict=True):
            mark = f"◂ {MARKS[form]} {value:.0f}".replace("-", "−")
            earned.text(LOWEST, place, mark, va="center", fontsize=SMALL, color=colour)
        numbers = (
            f"{name} {1000 * one.accident_rate.value:.1f} and {one.returns.value:.1f}" for name, one in scores.items()
        )
        words.append(f"{NAMES[form]}: {'; '.join(numbers)}.")
    of_alone = {ax: 1000 * np.array(alone.accident_rate), earned: np.array(alone.returns)}
    labels = {ax: "accidents in 1,000 drives\n(logarithmic above 1)", earned: "return"}
    for panel, (value, low, high) in of_alone.items():
        plain_axes(panel, "", grid="x")
        panel.axvspan(low, high, color=QUIET, alpha=0.15, linewidth=0, zorder=0)
        panel.axvline(value, color=QUIET, linewidth=1.2, linestyle=(0, (4, 3)), zorder=1)
        panel.text(value, -0.62, "alone", ha="center", fontsize=SMALL, color=QUIET)
        panel.set(ylim=(len(names) - 0.5, -0.5), yticks=[])
        panel.set_xlabel(labels[panel], fontsize=TEXT, color=INK)
        panel.spines["bottom"].set_color(GRID)
    _accident_axis(ax, "x")
    earned.set_xlim(LOWEST, 140)
    ax.set_yticks(range(len(names)), [name.replace(", ", ",\n") for name in names], fontsize=TEXT, color=INK)
    legend = "    ".join(f"{MARKS[form]} {NAMES[form]}{_drives(of)}" for form, of in scores_of.items())
    figure.text(0.012, 0.1 / figure.get_figheight(), legend, fontsize=SMALL, color=INK)
    alt = (
        f"For each model, accidents in 1,000 drives and the return. Alone: {1000 * alone.accident_rate.value:.1f} and "
        f"{alone.returns.value:.1f}. {' '.join(words)}"
    )
    return finish(figure, title, alt)


def _drives(scores: dict[str, Score]) -> str:
    """ " (10 agents × 300 to 1,000 roads)", of all models."""
    agents, roads = ({getattr(one, name) for one in scores.values()} for name in ("agents", "roads"))
    agents, roads = (" to ".join(f"{n:,}" for n in sorted({min(each), max(each)})) for each in (agents, roads))
    return f" ({agents} agents × {roads} roads)"
