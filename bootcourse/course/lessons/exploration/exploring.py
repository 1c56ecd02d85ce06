"""Where drives went, the policy's entropy there, and a map of both for many agents."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from matplotlib.figure import Figure
from scipy import special

from bootcourse.episodes.rollout import Rollout
from bootcourse.plots.figure import INK, QUIET, SMALL, TEXT, finish, new_figure, wrapped
from bootcourse.road.state import EGO, LANE, TRAP_1, X


@dataclass(frozen=True)
class Visits:
    """Every decision of some drives, one after the other."""

    place: np.ndarray  # (n,) m: how far the ego is ahead of trap 1; negative is behind
    lane: np.ndarray  # (n,) 0 is the leftmost
    policy: np.ndarray  # (n, 9) the driver's probabilities; for a driver without probabilities, 1 for its action

    @property
    def entropy(self) -> np.ndarray:
        """H(π) of each decision in nats, (n,)."""
        return special.entr(self.policy.astype(float)).sum(axis=-1)


def visits(drives: Sequence[Rollout]) -> Visits:
    """The decisions of all drives together."""
    cars = np.concatenate([drive.cars for drive in drives])
    policy = [np.eye(9)[drive.actions] if drive.policy is None else drive.policy for drive in drives]
    return Visits(cars[:, EGO, X] - cars[:, TRAP_1, X], cars[:, EGO, LANE].astype(int), np.concatenate(policy))


def cells_seen(seen: Visits, edges: np.ndarray, lanes: int = 3) -> float:
    """The share of the cells (a stretch between two edges, a lane) in which at least one decision was made."""
    found, _, _ = np.histogram2d(seen.place, seen.lane, bins=[edges, np.arange(lanes + 1) - 0.5])
    return float(np.mean(found > 0))


def chance_of_another(policy: np.ndarray) -> float:
    """The chance that in a drive with this policy, (seconds, 9), some drawn action is not the likeliest one."""
    return float(1 - np.prod(policy.max(axis=-1)))


def mean_in_bins(seen: Visits, values: np.ndarray, edges: np.ndarray) -> np.ndarray:
    """The mean of some values (n,) in each stretch of road, (bins,); NaN where no decision was made."""
    total, count = (np.histogram(seen.place, bins=edges, weights=w)[0] for w in (values, np.ones(len(values))))
    return np.where(count > 0, total / np.maximum(count, 1), np.nan)


def lanes_in_bins(seen: Visits, edges: np.ndarray) -> list[str]:
    """The lanes in which decisions were made in each stretch of road: "0 2" for the lanes 0 and 2."""
    stretch = np.digitize(seen.place, edges) - 1
    return [" ".join(map(str, np.unique(seen.lane[stretch == k]))) for k in range(len(edges) - 1)]


def map_of_places(
    rows: Mapping[str, np.ndarray], words: Mapping[str, Sequence[str]], edges: np.ndarray, title: str, label: str
) -> Figure:
    """A row for each name, a field for each stretch of road: darker is more, empty has no decisions.

    rows: {name: (bins,)}, NaN for no decisions; words: {name: what is written into each field}; edges (bins + 1,) m
    relative to trap 1; label says what is shown.
    """
    values, head = np.array(list(rows.values())), 0.62 + 0.2 * wrapped(title).count("\n")
    height = head + 0.21 * len(values) + 0.55
    figure = new_figure(height)
    ax = figure.add_axes((0.25, 0.5 / height, 0.73, 0.21 * len(values) / height))
    ax.imshow(values, aspect="auto", cmap="Blues", vmin=np.nanmin(values), vmax=1.15 * np.nanmax(values))
    middle = (np.nanmin(values) + np.nanmax(values)) / 1.6
    for (row, column), value in np.ndenumerate(values):
        if np.isfinite(value):
            colour = "white" if value > middle else INK
            text = list(words.values())[row][column]
            ax.text(column, row, text, fontsize=SMALL - 1, color=colour, ha="center", va="center")
    ax.set_yticks(range(len(values)), list(rows), fontsize=SMALL)
    ax.set_xticks(np.arange(len(edges)) - 0.5, [f"{edge:g}" for edge in edges], fontsize=SMALL)
    ax.tick_params(length=0, labelcolor=QUIET)
    for side in ax.spines.values():
        side.set_visible(False)
    ax.set_xlabel("metres ahead of trap 1 (negative: behind it)", fontsize=TEXT, color=INK)
    figure.text(0.012, 1 - (head - 0.26) / height, f"{label}; empty: not there", fontsize=TEXT, color=QUIET)
    return finish(figure, title, f"A map of {label}. {_told(rows, edges)}")


def _told(rows: Mapping[str, np.ndarray], edges: np.ndarray) -> str:
    parts = []
    for name, values in rows.items():
        there = np.flatnonzero(np.isfinite(values))
        if there.size:
            best = there[values[there].argmax()]
            parts.append(
                f"{name}: from {edges[there[0]]:g} to {edges[there[-1] + 1]:g} m, "
                f"most ({values[best]:.2f}) between {edges[best]:g} and {edges[best + 1]:g} m."
            )
    return " ".join(parts)
