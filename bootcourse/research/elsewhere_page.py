"""The page of the report "When does a sub-optimal teacher help?": tables, figure and verdicts of `elsewhere.py`.

A verdict is computed from the agents' scores, never typed. A claim compares two groups of agents; it is *confirmed* or
*contradicted* if the two-sided test of Mann and Whitney gives p < 0.05 (against a constant: the sign test), and *open*
otherwise. The hypotheses are older than the results. This rule is not: it was written when the first three problems
were computed.
"""

import textwrap
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from itertools import product
from pathlib import Path

import numpy as np
import scipy
from matplotlib.colors import LinearSegmentedColormap
from matplotlib.figure import Figure
from matplotlib.patches import Rectangle

from bootcourse.files import write_bytes
from bootcourse.plots.figure import INK, QUIET, SMALL, TEXT, axes_at, finish, new_figure, save
from bootcourse.research.elsewhere import ALONE, HYPOTHESES, METHODS, NOBODY, TAUGHT, USABLE, WINDOW
from bootcourse.research.problems import PROBLEMS
from bootcourse.research.results import Results
from bootcourse.research.tables import bracketed, k_of_n, markdown
from bootcourse.statistics import interval

SOLVES = 0.5  # an agent has solved a problem if it succeeds in more than this share of its test episodes
MOST = 0.9  # "most of the gap", in the figure's title and in the findings
SIGNIFICANT = 0.05
SAC, ENTROPY, _ = ALONE
TEACHER = "the teacher"
COLUMNS = (*ALONE, TEACHER, *TAUGHT)
SHORT = {"PPO after cloning": "PPO after\ncloning", ENTROPY: f"SAC, η =\n{USABLE}", TEACHER: "the\nteacher",
         "demonstrations": "demon-\nstrations", "both, c = 0": "both,\nc = 0"}  # fmt: skip
SHADES = LinearSegmentedColormap.from_list("share", ["#FFFFFF", "#F0E442", "#44BB99"])


class Missing(Exception):
    """A cell that was not computed."""


@dataclass(frozen=True)
class Cells:
    """What was computed: {"PROBLEM, TEACHER, METHOD": its agents}, see `elsewhere.EXPERIMENT`."""

    computed: dict[str, Results]

    def get(self, problem: str, teacher: str, method: str) -> Results | None:
        return self.computed.get(f"{problem}, {NOBODY if method in ALONE else teacher}, {method}")

    def scores(self, problem: str, teacher: str, method: str, measure: str = "returns") -> np.ndarray:
        """Each agent's mean, (agents,); of the teacher itself (1,). Raises Missing for a cell that was not computed.

        measure: "success" or "returns", by the most probable action, or with "drawn_" before it, by drawn actions.
        """
        if method == TEACHER:
            taught = [each for name in TAUGHT if (each := self.get(problem, teacher, name)) is not None]
            if not taught:
                raise Missing(f"{problem}, {teacher}")
            return taught[0].measured[f"teacher_{measure}"][:1]
        results = self.get(problem, teacher, method)
        if results is None:
            raise Missing(f"{problem}, {teacher}, {method}")
        return results.measured[measure] if measure.startswith("drawn_") else results.scores(measure)

    def rows(self) -> list[tuple[str, str]]:
        """(problem, teacher) of which anything that was taught was computed."""
        every = ((problem, teacher) for problem, one in PROBLEMS.items() for teacher in one.teachers())
        return [row for row in every if any(self.get(*row, method) is not None for method in TAUGHT)]

    def mean(self, problem: str, teacher: str, method: str, measure: str = "returns") -> float:
        """The mean over agents, NaN for a cell that was not computed."""
        try:
            return float(self.scores(problem, teacher, method, measure).mean())
        except Missing:
            return float("nan")

    def share(self, problem: str, teacher: str, method: str) -> float:
        """The share of the gap in mean return between plain SAC and the best column of the problem's rows."""
        teachers = [row[1] for row in self.rows() if row[0] == problem]
        low = self.mean(problem, teacher, SAC)
        best = np.nanmax([self.mean(problem, t, each) for t, each in product(teachers, COLUMNS)])
        return (self.mean(problem, teacher, method) - low) / (best - low) if best > low else float("nan")


# Hypotheses and their verdicts ------------------------------------------------------------------------


@dataclass(frozen=True)
class Claim:
    """One comparison that a hypothesis makes."""

    where: str  # problem and teacher
    words: str  # what is expected
    left: np.ndarray | float  # (agents,), or a constant
    right: np.ndarray | float
    expected: str  # ">", ">=" or "=": left against right

    @property
    def p(self) -> float:
        """Two-sided."""
        if np.ndim(self.left) and np.ndim(self.right):
            p = scipy.stats.mannwhitneyu(self.left, self.right).pvalue
            return 1.0 if np.isnan(p) else float(p)
        above, below = int(np.sum(self.left > self.right)), int(np.sum(self.left < self.right))
        return float(scipy.stats.binomtest(above, above + below).pvalue) if above + below else 1.0

    @property
    def verdict(self) -> str:
        """ "confirmed", "contradicted" or "open"."""
        if self.p >= SIGNIFICANT:
            return "open"
        greater = self._rank() > 0
        if self.expected == "=" or not greater:
            return "contradicted"
        return "confirmed"

    def _rank(self) -> float:
        """How much more often left is above right than below."""
        return float(np.sign(np.subtract.outer(np.atleast_1d(self.left), np.atleast_1d(self.right))).mean())

    def row(self) -> list[str]:
        values = [
            f"{side:.3g}" if np.ndim(side) == 0 else bracketed(interval(side, np.mean))
            for side in (self.left, self.right)
        ]
        p = "< 0.001" if self.p < 0.001 else f"{self.p:.3f}"
        return [self.where, self.words, *values, p, self.verdict]


def claims_of(hypothesis: str, cells: Cells) -> tuple[list[Claim], list[str]]:
    """(the comparisons that can be made, the cells that the others lack)."""
    made, lacking = [], []
    for where, words, make, expected in CLAIMS[hypothesis](cells):
        try:
            made.append(Claim(where, words, *make(), expected))
        except Missing as missing:
            lacking.append(str(missing))
    return made, lacking


Made = Iterator[tuple[str, str, Callable[[], tuple], str]]  # where, words, () -> (left, right), expected


def _pair(cells: Cells, problem: str, teacher: str, left: str, expected: str, right: str, measure="returns") -> tuple:
    def sides():
        return tuple(cells.scores(problem, teacher, method, measure) for method in (left, right))

    words = f"{left} {expected.replace('>=', '≥')} {right}, {measure.replace('returns', 'return')}"
    return f"{PROBLEMS[problem].name}, {teacher}", words, sides, expected


def _against_the_teacher(cells: Cells, problem: str, teacher: str, left: str, expected: str, right: str) -> tuple:
    where, words, sides, expected = _pair(cells, problem, teacher, left, expected, right)

    def against():
        one, other = sides()
        return (one[0] if left == TEACHER else one), (other[0] if right == TEACHER else other)

    return where, words, against, expected


TEACHERS = ("good", "random", "systematic")
SPARSE = ("chain", "mountain-car", "acrobot")  # long without a reward
STUDIED = (*SPARSE, "cartpole", "doorkey")  # the problems that the hypotheses were written for


def _h1(cells: Cells) -> Made:
    for teacher in TEACHERS:
        yield _pair(cells, "doorkey", teacher, "both, c = 0", ">", "both", "success")
    for teacher in TEACHERS:
        yield _pair(cells, "mountain-car", teacher, "both, c = 0", "=", "both")


def _h2(cells: Cells) -> Made:
    for problem in SPARSE:
        yield _against_the_teacher(cells, problem, "random", "cloning", ">", TEACHER)
    for problem in SPARSE:
        yield _against_the_teacher(cells, problem, "systematic", TEACHER, ">=", "cloning")


def _h3(cells: Cells) -> Made:
    for problem, method in product(STUDIED, ("soft", "both")):
        yield _pair(cells, problem, "systematic", method, ">", "cloning")


def _h4(cells: Cells) -> Made:
    for method in (SAC, ENTROPY):
        yield (
            PROBLEMS["mountain-car"].name,
            f"10 % > {method}, success",
            lambda method=method: (0.1, cells.scores("mountain-car", NOBODY, method, "success")),
            ">",
        )
    for method in ("soft", "demonstrations", "both"):
        yield _pair(cells, "cartpole", "good", ENTROPY, ">=", method)

    def gain(problem: str) -> np.ndarray:
        alone = max(cells.scores(problem, NOBODY, method, "success").mean() for method in (SAC, ENTROPY))
        return cells.scores(problem, "good", "soft", "success") - alone

    for problem in SPARSE:
        where = f"{PROBLEMS[problem].name} and CartPole, good"
        yield where, "gain of soft over the better SAC, success", lambda p=problem: (gain(p), gain("cartpole")), ">"


def _h5(cells: Cells) -> Made:
    for problem in STUDIED:
        yield _pair(cells, problem, "random", "soft", ">", "demonstrations")


def _h6(cells: Cells) -> Made:
    for problem, teacher in product(STUDIED, TEACHERS):
        yield _pair(cells, problem, teacher, "PPO after cloning", ">=", "cloning")


CLAIMS = {"H1": _h1, "H2": _h2, "H3": _h3, "H4": _h4, "H5": _h5, "H6": _h6}


def verdict(hypothesis: str, cells: Cells) -> str:
    """ "fails", "holds" or "open", and how many of its comparisons are confirmed, contradicted, open and not run."""
    claims, lacking = claims_of(hypothesis, cells)
    counts = {name: sum(claim.verdict == name for claim in claims) for name in ("confirmed", "contradicted", "open")}
    whole = counts["confirmed"] == len(claims) + len(lacking)
    word = "fails" if counts["contradicted"] else "holds" if whole else "open"
    counted = [f"{n} {name}" for name, n in (counts | {"not run": len(lacking)}).items() if n]
    return f"{word}: {', '.join(counted)}"


# The page ---------------------------------------------------------------------------------------------


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
    return text


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
    fig.text(0.012, 0.2 / height, f"{about} (white) and the problem's best (green).", fontsize=SMALL, color=INK)
    counts = [
        f"{method} in {most_of_the_gap(cells, method)}" for method in ("cloning", "soft", "demonstrations", "both")
    ]
    title = f"Of {len(rows)} pairs of problem and teacher, most of the gap is closed by {', '.join(counts)}"
    alt = f"Share of the gap in return between plain SAC and the problem's best. {' '.join(words)}"
    return finish(fig, title, alt.replace("nan %", "not computed"))


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
-1. Everything on this page is computed from the results.
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
