"""`bootcourse study` and `bootcourse sweep`: what the command line does with cells."""

import sys
import time
from pathlib import Path

from bootcourse.errors import BootcourseError
from bootcourse.record.commands import INTERRUPTED
from bootcourse.record.drive import provenance
from bootcourse.scenario import named
from bootcourse.study import plan
from bootcourse.study.found import in_study
from bootcourse.study.report import write_report
from bootcourse.study.results import load_cells, save_results
from bootcourse.study.runner import run_cells
from bootcourse.study.sweep import sweep_table

SENSITIVITY_SEEDS = 3

# **how is how to compute: backend, scheduler, jobs, recompute; see runner.run_cells.


def study(out: Path, scenario: str, seeds: int, episodes: int, tests: int, only: str, sensitivity: bool, **how) -> int:
    """Compute a scenario's cells, or the sensitivity's, and write the report. Returns the exit status."""
    road, methods = named(scenario), plan.methods_named(only)
    if sensitivity and (only or scenario != "default"):
        raise BootcourseError("--sensitivity has its own methods and scenarios: leave --only and --scenario away.")
    if sensitivity:
        cells = plan.sensitivity_cells(min(seeds, SENSITIVITY_SEEDS), episodes, tests)
    else:
        cells = plan.study_cells(methods, seeds, episodes, road, tests)
    status = compute(cells, out, **how)
    if list(out.glob("cells/default/*/results.npz")) or list(out.glob("cells/calibrated/*/results.npz")):
        print(write_report(in_study(out), out))
    return status


def sweep(out: Path, seeds: int, episodes: int, tests: int, **how) -> int:
    """Compute the sweep over p, ξ and c and write its one file. Returns the exit status."""
    status = compute(plan.sweep_cells(seeds, episodes, tests), out, **how)
    if status == 0:
        found = load_cells(out, "sweep")
        save_results(
            found, out / "sweep.npz", provenance(command=f"bootcourse sweep --seeds {seeds} --episodes {episodes}")
        )
        print(sweep_table(found))
        print(out / "sweep.npz")
    return status


def compute(cells: list, out: Path, **how) -> int:
    """Compute what is missing; says what went wrong and how to go on."""
    started = time.monotonic()
    try:
        problems = run_cells(cells, out, **how)
    except KeyboardInterrupt:
        print("Interrupted: start the same command again to go on. What is done is kept.", file=sys.stderr)
        return INTERRUPTED
    minutes = (time.monotonic() - started) / 60
    print(f"{len(cells) - len(problems)} of {len(cells)} cells are done, after {minutes:.1f} minutes.")
    for problem in problems:
        print(problem)
    if problems:
        print("Start the same command again to go on: what is done is kept.")
    return 1 if problems else 0
