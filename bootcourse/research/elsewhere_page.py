"""The page of the report "When does a sub-optimal teacher help?": the tables and the figure of `elsewhere.py`.

Everything on it is computed from the agents' scores; the verdicts on the hypotheses are those of elsewhere_claims.py.
"""

import textwrap
from pathlib import Path

import numpy as np
from matplotlib.colors import LinearSegmentedColormap
from matplotlib.figure import Figure
from matplotlib.patches import Rectangle

from bootcourse.files import write_bytes
from bootcourse.plots.figure import INK, QUIET, SMALL, TEXT, axes_at, finish, new_figure, save
from bootcourse.research.elsewhere import HYPOTHESES, METHODS, TAUGHT, USABLE, WINDOW
from bootcourse.research.elsewhere_claims import (
    COLUMNS,
    ENTROPY,
    SIGNIFICANT,
    TEACHER,
    TEACHERS,
    Cells,
    claims_of,
    verdict,
)
from bootcourse.research.problems import PROBLEMS
from bootcourse.research.results import Results
from bootcourse.research.tables import bracketed, k_of_n, markdown
from bootcourse.statistics import interval

SOLVES = 0.5  # an agent has solved a problem if it succeeds in more than this share of its test episodes
MOST = 0.9  # "most of the gap", in the figure's title and in the findings
SHORT = {"PPO after cloning": "PPO after\ncloning", ENTROPY: f"SAC, η =\n{USABLE}", TEACHER: "the\nteacher",
         "demonstrations": "demon-\nstrations", "both, c = 0": "both,\nc = 0"}  # fmt: skip
SHADES = LinearSegmentedColormap.from_list("share", ["#FFFFFF", "#F0E442", "#44BB99"])


def summary_rows(cells: Cells) -> tuple[list[str], list[list[str]]]:
    """(headings, rows): mean success in % and return of every cell; the best return that was trained is bold."""
    table = []
    for problem, teacher in cells.rows():
        trained = {name: cells.mean(problem, teacher, name) for name in METHODS}
        best, words = max((value for value in trained.values() if value == value), default=None), []
        for method in COLUMNS:
            text = scored(cells, problem, teacher, method)
            words.append(f"**{text}**" if trained.get(method) == best else text)
        table.append([PROBLEMS[problem].name, teacher, *words])
    return ["problem", "teacher", *COLUMNS], table


def scored(cells: Cells, problem: str, teacher: str, method: str) -> str:
    """ "98 (-120)": mean success in % and mean return; "–" if not computed."""
    success, returns = (cells.mean(problem, teacher, method, measure) for measure in ("success", "returns"))
    return "–" if np.isnan(returns) else f"{100 * success:.0f} ({returns:.3g})"


def agent_rows(cells: Cells) -> tuple[list[str], list[list[str]]]:
    """(headings, rows): every cell's counts of agents with exact intervals, and greedy and drawn scores."""
    table = []
    for name, results in cells.computed.items():
        problem, teacher, method = name.split(", ", 2)
        solving, measured = k_of_n(results.scores("success") > SOLVES), results.measured
        numbers = [bracketed(interval(scores, np.mean), scale) for scores, scale in (
            (results.scores("success"), 100), (measured["drawn_success"], 100),
            (results.scores("returns"), 1), (measured["drawn_returns"], 1),
        )]  # fmt: skip
        counts = [str(int(measured[which].sum())) for which in ("found", "kept")]
        table.append([PROBLEMS[problem].name, teacher, method, solving, *numbers, *counts])
    headings = ["problem", "teacher", "method", f"agents that succeed in more than {100 * SOLVES:g} %"]
    return [*headings, "success, %", "drawn", "return", "drawn", "found", f"last {WINDOW}"], table


def findings(cells: Cells) -> list[str]:
    """Sentences that are counted from the cells."""
    rows = cells.rows()
    counts = {method: most_of_the_gap(cells, method) for method in TAUGHT}
    listed = ", ".join(f"{method} in {n}" for method, n in sorted(counts.items(), key=lambda item: -item[1]))
    most = f"at least {100 * MOST:g} % of the gap between plain SAC and the problem's best"
    text = [f"Of {len(rows)} pairs of problem and teacher, {most} is closed by {listed}."]
    for teacher in TEACHERS:
        named = "; ".join(f"{PROBLEMS[row[0]].name}: {leaders(cells, *row)}" for row in rows if row[1] == teacher)
        text.append(f"Highest mean return with the {teacher} teacher. {named}.")
    return [each for each in (*text, not_run(cells)) if each]


def not_run(cells: Cells) -> str:
    """ "Not run: Lunar lander.", the problems without a cell of a teacher; "" for none."""
    run = {row[0] for row in cells.rows()}
    names = [one.name for problem, one in PROBLEMS.items() if problem not in run]
    return f"Not run: {', '.join(names)}." if names else ""


def leaders(cells: Cells, problem: str, teacher: str) -> str:
    """The methods with the highest mean return, plain ones too."""
    means = {method: cells.mean(problem, teacher, method) for method in METHODS}
    best = [method for method, value in means.items() if value == np.nanmax(list(means.values()))]
    return " and ".join(best) if len(best) < 3 else f"{len(best)} methods alike"


def most_of_the_gap(cells: Cells, method: str) -> int:
    """In how many rows a method closes most of the gap."""
    return sum(cells.share(*row, method) >= MOST for row in cells.rows())


def figure(cells: Cells) -> Figure:
    """Problem and teacher against method: success, return, and as a colour the share of the gap that is closed."""
    rows, high, wide = cells.rows(), 0.36, 0.72
    height = 1.75 + high * len(rows)
    fig = new_figure(height, 9.0)
    ax = axes_at(fig, 1.72, 1.12, wide * len(COLUMNS), high * len(rows))
    words = []
    for y, (problem, teacher) in enumerate(rows):
        for x, method in enumerate(COLUMNS):
            share = cells.share(problem, teacher, method)
            text = scored(cells, problem, teacher, method)
            colour = SHADES(np.clip(share, 0, 1)) if np.isfinite(share) else "white"
            ax.add_patch(Rectangle((x + 0.03, y + 0.04), 0.94, 0.92, facecolor=colour, edgecolor="none"))
            success, _, returns = text.partition(" ")
            ax.text(x + 0.5, y + 0.36, success, ha="center", va="center", fontsize=TEXT, color=INK)
            ax.text(x + 0.5, y + 0.74, returns.strip("()"), ha="center", va="center", fontsize=SMALL - 1, color=INK)
        ax.text(-0.08, y + 0.5, teacher, ha="right", va="center", fontsize=TEXT, color=INK)
        if not y or rows[y - 1][0] != problem:
            name = PROBLEMS[problem].name
            ax.text(-2.3, y + 0.5, textwrap.fill(name, 12), va="center", fontsize=TEXT, color=INK, weight="bold")
            ax.plot([-2.3, len(COLUMNS)], [y, y], color=QUIET, linewidth=0.6, clip_on=False)
        closed = ", ".join(f"{method} {100 * cells.share(problem, teacher, method):.0f} %" for method in METHODS)
        words.append(f"{PROBLEMS[problem].name}, {teacher} teacher: {closed}.")
    for x, method in enumerate(COLUMNS):
        ax.text(x + 0.5, -0.15, SHORT.get(method, method), ha="center", va="bottom", fontsize=TEXT, color=INK)
    ax.set(xlim=(0, len(COLUMNS)), ylim=(len(rows), 0))
    ax.set_axis_off()
    about = (
        "Above: success in %; below: return; means over agents. Colour: share of the gap in return between plain SAC"
    )
    notes = f"{about} (white) and the problem's best (green).\n{not_run(cells)}"
    fig.text(0.012, 0.3 / height, notes, va="top", linespacing=1.5, fontsize=SMALL, color=INK)
    counts = [
        f"{method} in {most_of_the_gap(cells, method)}" for method in ("cloning", "soft", "demonstrations", "both")
    ]
    title = f"Of {len(rows)} pairs of problem and teacher, most of the gap is closed by {', '.join(counts)}"
    alt = f"Share of the gap in return between plain SAC and the problem's best. {' '.join(words)}"
    return finish(fig, title, f"{alt.replace('nan %', 'not computed')} {not_run(cells)}".strip())


def write_page(computed: dict[str, Results], folder: Path) -> Path | None:
    """Write folder/elsewhere.md and its figure; None if no cell of a teacher was computed."""
    cells = Cells(computed)
    if not cells.rows():
        return None
    picture = figure(cells)
    save(picture, folder / "figures" / "elsewhere.png")
    text = [
        HEAD,
        f"![{picture.alt}](figures/elsewhere.png)\n",
        "\n".join(f"- {each}" for each in findings(cells)) + "\n",
    ]
    text += [markdown(*summary_rows(cells)), "## The hypotheses\n", RULE]
    for name, words in HYPOTHESES.items():
        text.append(f"### {name} {verdict(name, cells)}\n\n{words}\n")
        claims, lacking = claims_of(name, cells)
        if claims:
            headings = ["problem, teacher", "expected", "left [95 %]", "right [95 %]", "p", "verdict"]
            text.append(markdown(headings, [claim.row() for claim in claims]))
        if lacking:
            text.append(f"Not run: {'; '.join(dict.fromkeys(lacking))}.\n")
    text += ["## Every cell\n", EVERY, markdown(*agent_rows(cells))]
    path = folder / "elsewhere.md"
    write_bytes(path, "\n".join(text).encode())
    return path


HEAD = """# When does a sub-optimal teacher help?

The paper's method on other problems, with hand-written teachers: *good* is the rule as it is, *random* errs in states
that look random, *systematic* makes the same error everywhere in one region. γ, episodes and the copies driven at once
are the same for all methods but PPO of a problem. SAC, soft, demonstrations and both have the paper's target entropy of
-1. Every number on this page is computed from the results. A cell has ten agents; on Lunar lander, which needs box2d
(`pip install bootcourse[lander]`), they trained in two groups of five. highway-env's merge is left out: one core makes
about 46 decisions a second there, so that its cells would take many hours.
"""

RULE = f"""They were written before any cell was run with more than two seeds, and are quoted as they were. A comparison
of two groups of agents is confirmed or contradicted if the two-sided test of Mann and Whitney gives p < {SIGNIFICANT:g}
(against the teacher or a constant: the sign test), and open otherwise; p is not corrected for their number. This rule
was written when the first three problems were computed. A hypothesis fails if a comparison contradicts it, and holds if
all confirm it. "=" can only be contradicted or stay open. Intervals of means are from resampling agents.
"""

EVERY = f"""Rates of agents have exact (Clopper-Pearson) intervals; means over agents have 95 % intervals from
resampling agents, of length 0 where all agents score the same. Drawn: actions drawn from the policy instead of the most
probable ones. Found: agents that succeeded in more than half of some {WINDOW} training episodes in a row. Last
{WINDOW}: agents that succeeded in more than half of the last ones.
"""
