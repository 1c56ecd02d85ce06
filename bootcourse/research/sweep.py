"""The sweep over p, ξ and c: its file of results, and the results of the setting nearest to a given one.

happened = nearest_setting(load_sweep(), p=0.8, xi_multiplier=150, c=1)
print(happened)
"""

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from bootcourse.errors import BootcourseError
from bootcourse.files import provenance
from bootcourse.research.results import Results, load_jobs, load_results, save_results
from bootcourse.research.tables import bracketed, markdown
from bootcourse.scenario import check_p
from bootcourse.statistics import Estimate, interval
from bootcourse.storage.assets import FOLDER

SHIPPED = FOLDER / "sweep.npz"


@dataclass(frozen=True)
class SweepResult:
    """What the agents of one setting did on the held-out episodes; `curves` holds their training."""

    p: float
    xi_multiplier: float
    c: float
    exact: bool  # is it exactly the setting that was asked for?
    results: Results

    def mean(self, measure: str) -> Estimate:
        """Mean over the seeds with its 95 % interval: success, returns, speed, distance, collision, ..."""
        return interval(self.results.scores(measure), np.mean)

    @property
    def accidents(self) -> float:
        """Share of episodes that ended in an accident of any kind."""
        return float(self.results.scores("accident").mean())

    def __str__(self) -> str:
        setting = f"p = {self.p:g}, ξ = {self.xi_multiplier:g} α, c = {self.c:g}"
        if self.xi_multiplier == 0:
            setting = f"ξ = 0 (so p does not matter), c = {self.c:g}"
        success, returns = self.mean("success"), self.mean("returns")
        return (
            f"{setting}, {len(self.results)} seeds: success {100 * success.value:.0f} % "
            f"[{100 * success.low:.0f}, {100 * success.high:.0f}], return {returns.value:.1f} "
            f"[{returns.low:.1f}, {returns.high:.1f}], accidents {100 * self.accidents:.0f} %"
        )


def load_sweep(path: Path = SHIPPED) -> Results:
    """The sweep's results, by default those that are shipped. Raises BootcourseError if they are not there."""
    return load_results(path)


def write_sweep(study: Path) -> Path:
    """Write the finished sweep in a study's folder to one file, for `load_sweep`, and print its table."""
    results, path = load_jobs(study, "sweep"), study / "sweep.npz"
    save_results(results, path, provenance(command="bootcourse study sweep"))
    print(sweep_table(results))
    return path


def settings_run(sweep: Results) -> list[tuple[float, float, float]]:
    """Every (p, ξ's multiplier, c) that was run."""
    return list(dict.fromkeys(_setting(agent) for agent in sweep.agents))


def nearest_setting(sweep: Results, p: float = 0.9, xi_multiplier: float = 200.0, c: float = 2.0) -> SweepResult:
    """What happened at the nearest setting that was run. Raises BootcourseError for a value out of its range.

    Near in what matters to the learner: the log-odds of p (the KL takes logarithms), the logarithm
    of ξ (0 counts as 2 α), and c as it is; each over the span that was run, and what lies beyond it as
    its end. Without ξ, p is ignored.
    """
    check_p(p)
    for name, value in (("xi_multiplier", xi_multiplier), ("c", c)):
        if not (isinstance(value, (int, float)) and 0 <= value < np.inf):
            raise BootcourseError(f"{name} = {value!r}: give a finite number of 0 or more.")
    run = settings_run(sweep)
    places = np.array([_place(*setting) for setting in run])
    place = np.clip(_place(p, xi_multiplier, c), places.min(axis=0), places.max(axis=0))
    span = np.ptp(places, axis=0)
    gaps = np.abs(places - place) / np.where(span > 0, span, 1)
    gaps[[setting[1] == 0 for setting in run], 0] = 0
    best = run[int(np.square(gaps).sum(axis=1).argmin())]
    which = [i for i, agent in enumerate(sweep.agents) if _setting(agent) == best]
    exact = (best == (p, xi_multiplier, c)) or (xi_multiplier == 0 and best[1:] == (xi_multiplier, c))
    return SweepResult(*best, exact, sweep.pick(which))


def _setting(agent: dict) -> tuple[float, float, float]:
    return agent["rule_p"], agent["xi_multiplier"], agent["bonus"]


def _place(p: float, xi_multiplier: float, c: float) -> tuple[float, float, float]:
    return np.log(p / (1 - p)), np.log10(max(xi_multiplier, 2.0)), c


def sweep_table(sweep: Results) -> str:
    """Every setting that was run, a row each, as Markdown."""
    rows = []
    for p, xi, c in sorted(settings_run(sweep), key=lambda setting: (setting[1], setting[0], setting[2])):
        happened = nearest_setting(sweep, p, xi, c)
        rates = [bracketed(happened.mean(measure), 100) for measure in ("success", "collision", "road_departure")]
        rows.append(
            ["any" if xi == 0 else f"{p:g}", f"{xi:g} α", f"{c:g}", bracketed(happened.mean("returns")), *rates]
        )
    return markdown(["p", "ξ", "c", "return", "success, %", "collisions, %", "road departures, %"], rows)
