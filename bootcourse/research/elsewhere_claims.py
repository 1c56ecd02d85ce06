"""The comparisons that the hypotheses of `elsewhere.py` make, and their verdicts; elsewhere_page.py shows them.

A verdict is computed from the agents' scores, never typed. A claim compares two groups of agents; it is *confirmed* or
*contradicted* if the two-sided test of Mann and Whitney gives p < 0.05 (against the teacher or a constant: the sign
test), and *open* otherwise. The hypotheses are older than the results. This rule is not: it was written when the first
three problems were computed.
"""

from collections.abc import Callable
from dataclasses import dataclass
from itertools import product

import numpy as np
import scipy

from bootcourse.research.elsewhere import ALONE, NOBODY, TAUGHT
from bootcourse.research.problems import PROBLEMS
from bootcourse.research.results import Results
from bootcourse.research.tables import bracketed
from bootcourse.statistics import interval

SIGNIFICANT = 0.05
SAC, ENTROPY, _ = ALONE
TEACHER = "the teacher"
COLUMNS = (*ALONE, TEACHER, *TAUGHT)


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
        above = np.sign(np.subtract.outer(np.atleast_1d(self.left), np.atleast_1d(self.right))).sum()
        return "confirmed" if above > 0 and self.expected != "=" else "contradicted"

    def row(self) -> list[str]:
        values = [
            f"{side:.3g}" if np.ndim(side) == 0 else bracketed(interval(side, np.mean))
            for side in (self.left, self.right)
        ]
        p = "< 0.001" if self.p < 0.001 else f"{self.p:.3f}"
        return [self.where, self.words, *values, p, self.verdict]


Expectation = Callable[[Cells], Claim]  # a comparison before it is made; it raises Missing for what was not computed


def compared(problem: str, teacher: str, left: str, expected: str, right: str, measure="returns") -> Expectation:
    """Two methods with the same problem and teacher. The teacher itself is one number."""
    words = f"{left} {expected.replace('>=', '≥')} {right}, {measure.replace('returns', 'return')}"

    def claim(cells: Cells) -> Claim:
        scores = {method: cells.scores(problem, teacher, method, measure) for method in (left, right)}
        sides = (each[0] if method == TEACHER else each for method, each in scores.items())
        return Claim(f"{PROBLEMS[problem].name}, {teacher}", words, *sides, expected)

    return claim


def hardly_succeeds(problem: str, method: str) -> Expectation:
    """A method without a teacher succeeds in less than 10 %."""
    name, words = PROBLEMS[problem].name, f"10 % > {method}, success"
    return lambda cells: Claim(name, words, 0.1, cells.scores(problem, NOBODY, method, "success"), ">")


def gains_more(problem: str, other: str) -> Expectation:
    """The soft constraint with the good teacher gains more success over the better SAC than on another problem."""

    def gain(cells: Cells, problem: str) -> np.ndarray:
        alone = max(cells.scores(problem, NOBODY, method, "success").mean() for method in (SAC, ENTROPY))
        return cells.scores(problem, "good", "soft", "success") - alone

    where = f"{PROBLEMS[problem].name} and {PROBLEMS[other].name}, good"
    words = "gain of soft over the better SAC, success"
    return lambda cells: Claim(where, words, gain(cells, problem), gain(cells, other), ">")


TEACHERS = ("good", "random", "systematic")
SPARSE = ("chain", "mountain-car", "acrobot")  # long without a reward
STUDIED = (*SPARSE, "cartpole", "doorkey")  # the problems that the hypotheses were written for
EXPECTED = {
    "H1": [
        *(compared("doorkey", teacher, "both, c = 0", ">", "both", "success") for teacher in TEACHERS),
        *(compared("mountain-car", teacher, "both, c = 0", "=", "both") for teacher in TEACHERS),
    ],
    "H2": [
        *(compared(problem, "random", "cloning", ">", TEACHER) for problem in SPARSE),
        *(compared(problem, "systematic", TEACHER, ">=", "cloning") for problem in SPARSE),
    ],
    "H3": [compared(each, "systematic", how, ">", "cloning") for each, how in product(STUDIED, ("soft", "both"))],
    "H4": [
        *(hardly_succeeds("mountain-car", method) for method in (SAC, ENTROPY)),
        *(compared("cartpole", "good", ENTROPY, ">=", method) for method in ("soft", "demonstrations", "both")),
        *(gains_more(problem, "cartpole") for problem in SPARSE),
    ],
    "H5": [compared(problem, "random", "soft", ">", "demonstrations") for problem in STUDIED],
    "H6": [compared(*row, "PPO after cloning", ">=", "cloning") for row in product(STUDIED, TEACHERS)],
}


def claims_of(hypothesis: str, cells: Cells) -> tuple[list[Claim], list[str]]:
    """(the comparisons that can be made, the cells that the others lack)."""
    claims, lacking = [], []
    for each in EXPECTED[hypothesis]:
        try:
            claims.append(each(cells))
        except Missing as missing:
            lacking.append(str(missing))
    return claims, lacking


def verdict(hypothesis: str, cells: Cells) -> str:
    """ "fails", "holds" or "open", and how many of its comparisons are confirmed, contradicted, open and not run."""
    claims, lacking = claims_of(hypothesis, cells)
    counts = {name: sum(claim.verdict == name for claim in claims) for name in ("confirmed", "contradicted", "open")}
    whole = counts["confirmed"] == len(claims) + len(lacking)
    word = "fails" if counts["contradicted"] else "holds" if whole else "open"
    counted = [f"{n} {name}" for name, n in (counts | {"not run": len(lacking)}).items() if n]
    return f"{word}: {', '.join(counted)}"
