"""The comparisons that the hypotheses of `elsewhere.py` make, and their verdicts; elsewhere_page.py shows them.

A verdict is computed from the agents' scores, never typed. A claim compares two groups of agents; it is *confirmed* or
*contradicted* if the two-sided test of Mann and Whitney gives p < 0.05 (against the teacher or a constant: the sign
test), and *open* otherwise. The hypotheses are older than the results. This rule is not: it was written when the first
three problems were computed.
"""

from collections.abc import Callable, Iterator
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
    claims, lacking = [], []
    for where, words, sides, expected in CLAIMS[hypothesis](cells):
        try:
            claims.append(Claim(where, words, *sides(), expected))
        except Missing as missing:
            lacking.append(str(missing))
    return claims, lacking


Expectations = Iterator[tuple[str, str, Callable[[], tuple], str]]  # where, words, () -> (left, right), expected


def _pair(cells: Cells, problem: str, teacher: str, left: str, expected: str, right: str, measure="returns") -> tuple:
    """A comparison of two methods in a row; the teacher itself is one number."""

    def sides():
        return tuple(side(method) for method in (left, right))

    def side(method: str) -> np.ndarray | float:
        scores = cells.scores(problem, teacher, method, measure)
        return scores[0] if method == TEACHER else scores

    words = f"{left} {expected.replace('>=', '≥')} {right}, {measure.replace('returns', 'return')}"
    return f"{PROBLEMS[problem].name}, {teacher}", words, sides, expected


TEACHERS = ("good", "random", "systematic")
SPARSE = ("chain", "mountain-car", "acrobot")  # long without a reward
STUDIED = (*SPARSE, "cartpole", "doorkey")  # the problems that the hypotheses were written for


def _h1(cells: Cells) -> Expectations:
    for teacher in TEACHERS:
        yield _pair(cells, "doorkey", teacher, "both, c = 0", ">", "both", "success")
    for teacher in TEACHERS:
        yield _pair(cells, "mountain-car", teacher, "both, c = 0", "=", "both")


def _h2(cells: Cells) -> Expectations:
    for problem in SPARSE:
        yield _pair(cells, problem, "random", "cloning", ">", TEACHER)
    for problem in SPARSE:
        yield _pair(cells, problem, "systematic", TEACHER, ">=", "cloning")


def _h3(cells: Cells) -> Expectations:
    for problem, method in product(STUDIED, ("soft", "both")):
        yield _pair(cells, problem, "systematic", method, ">", "cloning")


def _h4(cells: Cells) -> Expectations:
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


def _h5(cells: Cells) -> Expectations:
    for problem in STUDIED:
        yield _pair(cells, problem, "random", "soft", ">", "demonstrations")


def _h6(cells: Cells) -> Expectations:
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
