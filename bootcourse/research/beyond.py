"""What learners cost: the decisions until the way out is learned, and the returns within a budget."""

from collections.abc import Mapping

import numpy as np

from bootcourse.research.results import Results
from bootcourse.research.tables import bracketed, escaped, score
from bootcourse.statistics import found_after

SHARE, WINDOW = 0.95, 50  # an agent has learned the way out when this share of so many episodes in a row ended ahead


def lengths(curves: dict[str, np.ndarray]) -> np.ndarray:
    """Decisions of each training episode, (agents, episodes)."""
    return curves["decisions"]


def decisions_until(success: np.ndarray, decisions: np.ndarray, share: float = SHARE, window: int = WINDOW):
    """Decisions until at least `share` of the last `window` episodes ended ahead, (agents,); inf if they never did.

    success, decisions: (agents, episodes), 1 or 0 and the episode's length; NaN for episodes that were not driven.
    """
    after = found_after(success, window, share * window)
    spent = np.cumsum(np.nan_to_num(decisions), axis=1, dtype=float)
    return np.where(after > 0, spent[np.arange(len(spent)), np.maximum(after, 1) - 1], np.inf)


def spent(results: Results) -> np.ndarray:
    """Decisions of each agent until it had learned the way out, (agents,); inf if it did not. See `decisions_until`."""
    return decisions_until(results.curves["success"], lengths(results.curves))


def thousands(decisions: np.ndarray) -> str:
    """ "120 (34 to 200), 9 of 10": the median and the extremes of those that got there, in thousands, and how many."""
    there = decisions[np.isfinite(decisions)] / 1000
    if not len(there):
        return f"none of {len(decisions)}"
    middle = f"{np.median(there):,.0f} ({there.min():,.0f} to {there.max():,.0f})"
    return middle if len(there) == len(decisions) else f"{middle}, {len(there)} of {len(decisions)}"


def learner_rows(named: Mapping[str, Results]) -> tuple[list[str], list[list[str]]]:
    """(headings, rows): what some agents reached, and at which cost. named: {what they are: results of one method}."""
    rows = []
    for name, results in named.items():
        method = results.methods[0]
        rates = [f"{100 * results.episodes(measure).mean():.1f}" for measure in ("success", "accident")]
        cells = [rates[0], bracketed(score(results, method, "returns")), rates[1], thousands(spent(results))]
        rows.append([name, escaped(results, method), *cells])
    learned = f"thousand decisions until {100 * SHARE:g} % of {WINDOW} episodes are ahead"
    return ["", "agents that escape", "drives that do, %", "return [95 %]", "accidents, %", learned], rows


def at_budget(curves: dict[str, np.ndarray], decisions: float | np.ndarray, measure: str = "return") -> np.ndarray:
    """Mean of a measure over the last `WINDOW` training episodes that ended within so many decisions, (agents,).

    curves: each (agents, episodes), NaN for episodes that were not driven. decisions: of each agent, or (agents,). NaN
    for an agent whose whole training was shorter, or that ended fewer episodes.
    """
    episodes, values = lengths(curves), curves[measure]
    means, totals = np.full(len(values), np.nan), np.nansum(episodes, axis=1, dtype=float)
    for i, budget in enumerate(np.broadcast_to(decisions, len(values))):
        ended = np.searchsorted(np.cumsum(episodes[i], dtype=float), budget, side="right")
        if totals[i] >= budget and ended >= WINDOW:
            means[i] = values[i, ended - WINDOW : ended].mean(dtype=float)
    return means
