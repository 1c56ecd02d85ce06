"""The fidelity report: every number of the paper's two tables beside ours, with a verdict and its reason.

The verdicts follow rules that stand here and were fixed before the study was run:

- cannot be compared: the paper's number contradicts itself, or we have no result;
- reproduced: at least half of our agents agree, which means: they score within the 95 % interval of the
  paper's number for its 20 test episodes, or `CLOSE` to that number;
- partly: fewer do, or none but our interval over training seeds meets the paper's;
- not reproduced: neither.

Agents are counted because the paper's numbers stand, as far as it says, for one agent each.
"""

from typing import NamedTuple

import numpy as np

from bootcourse.research.paper import COLUMNS, PRINTED, RATES, ROWS, paper_interval, possible
from bootcourse.research.results import Results
from bootcourse.research.tables import bracketed, markdown, score
from bootcourse.statistics import Estimate

VERDICTS = ("reproduced", "partly", "not reproduced", "cannot be compared")
CLOSE = {"success": 5.0, "returns": 1.0, "speed": 0.1, "distance": 15.0, "collision": 5.0}  # units of the column


class FidelityRow(NamedTuple):
    """One number of the paper, and what we found."""

    method: str
    column: str
    paper: Estimate
    ours: Estimate | None
    verdict: str
    reason: str


def verdict_on(results: Results, method: str, column: str) -> FidelityRow:
    """The verdict on one number. The mean over agents is compared, as the paper prints means."""
    paper = paper_interval(method, column)
    if method not in results.methods:
        return FidelityRow(method, column, paper, None, "cannot be compared", "This study has not run this method.")
    ours = score(results, method, column, np.mean)
    scores = results.of(method).scores(column) * (100 if column in RATES else 1)  # in the paper's units
    if not possible(method, column):
        average, sd = PRINTED[method][column]
        reason = f"{average:g} ± {sd:g} % is impossible for a rate, so it is not known what was measured."
        return FidelityRow(method, column, paper, ours, "cannot be compared", reason)
    close = CLOSE[column]
    low, high = min(paper.low, paper.value - close), max(paper.high, paper.value + close)
    so, all_of_them = int(((scores >= low) & (scores <= high)).sum()), len(scores)
    meet = ours.low <= paper.high and ours.high >= paper.low
    verdict = "reproduced" if 2 * so >= all_of_them else "partly" if so or meet else "not reproduced"
    unit = "" if column == "returns" else " " + COLUMNS[column].rsplit(", ")[-1]
    gap = abs(ours.value - paper.value)
    difference = f"{gap:.4g}{unit} {'higher' if ours.value > paper.value else 'lower'}" if gap > 1e-9 else "the same"
    reason = f"{so} of our {all_of_them} agents" if all_of_them > 1 else "Ours does" if so else "Ours does not"
    reason += f" score so; our mean is {difference}."
    return FidelityRow(method, column, paper, ours, verdict, reason)


def fidelity(results: Results) -> list[FidelityRow]:
    """A finding for every number of the two tables (a row that stands in both is judged once)."""
    return [verdict_on(results, method, column) for method in PRINTED for column in COLUMNS]


def fidelity_table(findings: dict[str, list[FidelityRow]]) -> str:
    """Every number of the paper's tables, beside each scenario's: {scenario: findings}."""
    rows = []
    scenarios = list(findings)
    for alike in zip(*findings.values(), strict=True):
        first = alike[0]
        cells = [ROWS[first.method], COLUMNS[first.column], bracketed(first.paper)]
        for finding in alike:
            cells.append("not run" if finding.ours is None else bracketed(finding.ours))
            cells.append(f"**{finding.verdict}** {finding.reason}")
        rows.append(cells)
    headings = ["row", "number", "paper [95 % of 20 episodes]"]
    for scenario in scenarios:
        headings += [f"ours, {scenario}", f"verdict, {scenario}"]
    return markdown(headings, rows)
