"""`bootcourse study` and `sweep` compute what ships; `assets` checks it and makes it.

A study that is stopped by Ctrl-C (exit status 130) or killed goes on when the same command is started again.
"""

import sys
import time
from collections.abc import Callable
from pathlib import Path

import typer

from bootcourse.cli.training import INTERRUPTED
from bootcourse.errors import BootcourseError, check_known


def study(
    name: str = typer.Argument(
        "default",
        help="default, calibrated or paper; sensitivity, clocks, ablations, longer-view, beyond, teachers or safe.",
    ),
    out: Path = typer.Option(..., help="The study's folder: new, or that of a study to continue; all may share one."),
    seeds: int = typer.Option(0, min=0, help="Training seeds of each method; 0: the study's own number."),
    episodes: int = typer.Option(0, min=0, help="Training episodes of each agent; 0: the study's own number."),
    tests: int = typer.Option(0, min=0, help="Held-out episodes of each agent's test; 0: the study's own number."),
    only: str = typer.Option(
        "",
        help="Only these methods, such as sac,bootstrapped; planner is the bound. "
        "Of an experiment: a method, a teacher, or a part such as learned-mask.",
    ),
    backend: str = typer.Option("loky", help="loky (this machine), dask or ray."),
    scheduler: str = typer.Option("", help="The address of a dask or ray cluster that you have."),
    workers: int = typer.Option(0, min=0, help="Jobs at once; 0: one for each core."),
    recompute: bool = typer.Option(False, "--recompute", help="Compute damaged jobs again."),
) -> None:
    """Train and test methods with many seeds; write tables, figures and the fidelity report.

    default, calibrated and paper: the paper's methods and baselines. sensitivity, clocks and ablations: the paper's
    ablation, varied. longer-view: its method with other numbers. beyond: methods that the paper does not train.
    teachers: what a teacher is worth. safe: what prevents accidents.
    """
    from bootcourse.research import plan
    from bootcourse.research.report import write_report
    from bootcourse.research.results import in_study

    check_known("Study", name, (*plan.STUDIES, *plan.EXPERIMENTS))
    if name in plan.STUDIES:
        methods = plan.methods_named(only)
        wanted = plan.study_jobs(name, methods, seeds or plan.SEEDS, tests or plan.TESTS, episodes)
    else:
        wanted = plan.EXPERIMENTS[name].only(only).jobs(name, seeds, episodes, tests)

    def report(problems: list[str]) -> None:
        found = in_study(out)
        if found.results:
            print(write_report(found, out))

    how = {"backend": backend, "scheduler": scheduler, "workers": workers, "recompute": recompute}
    raise typer.Exit(compute(wanted, out, report, **how))


def sweep(
    out: Path = typer.Option(..., help="The folder: new, a study's, or that of a sweep to continue."),
    seeds: int = typer.Option(4, min=1, help="Training seeds of each setting."),
    episodes: int = typer.Option(1500, min=1, help="Training episodes of each agent."),
    tests: int = typer.Option(1000, min=1, help="Held-out episodes that each agent is tested on."),
    backend: str = typer.Option("loky", help="loky (this machine), dask or ray."),
    scheduler: str = typer.Option("", help="The address of a dask or ray cluster that you have."),
    workers: int = typer.Option(0, min=0, help="Jobs at once; 0: one for each core."),
    recompute: bool = typer.Option(False, "--recompute", help="Compute damaged jobs again."),
) -> None:
    """Train the paper's method with many settings of p, ξ and c; write one file of results."""
    from bootcourse.files import provenance
    from bootcourse.research.plan import sweep_jobs
    from bootcourse.research.results import load_jobs, save_results
    from bootcourse.research.sweep import sweep_table

    wanted = sweep_jobs(seeds, episodes, tests)

    def write(problems: list[str]) -> None:
        if not problems:
            found = load_jobs(out, "sweep")
            made = provenance(command=f"bootcourse sweep --seeds {seeds} --episodes {episodes}")
            save_results(found, out / "sweep.npz", made)
            print(sweep_table(found))
            print(out / "sweep.npz")

    how = {"backend": backend, "scheduler": scheduler, "workers": workers, "recompute": recompute}
    raise typer.Exit(compute(wanted, out, write, **how))


def compute(wanted: list, out: Path, after: Callable[[list[str]], None], **how) -> int:
    """Compute the missing jobs, then call `after`; print failures and how to continue. Returns the exit status."""
    from bootcourse.research.runner import run_jobs

    started = time.monotonic()
    try:
        problems = run_jobs(wanted, out, after=after, **how)
    except KeyboardInterrupt:
        print("Interrupted. Finished jobs are kept: start the same command again to continue.", file=sys.stderr)
        return INTERRUPTED
    minutes = (time.monotonic() - started) / 60
    print(f"{len(wanted) - len(problems)} of {len(wanted)} jobs are done, after {minutes:.1f} minutes.")
    for problem in problems:
        print(problem)
    if problems:
        print("Finished jobs are kept: start the same command again to continue.")
    return 1 if problems else 0


def assets(
    what: str = typer.Argument(
        ...,
        help="verify: check them. build: make them from a study's folder. report: only the report, from themselves.",
    ),
    study: Path | None = typer.Option(None, help="The study's folder, for build."),
    replace_larger: bool = typer.Option(
        False, "--replace-larger", help="Let build replace results of more agents or episodes."
    ),
) -> None:
    """Check the files that ship with the course, or make them again."""
    from bootcourse.storage import assets

    check_known("Action", what, ("verify", "build", "report"))
    if what == "build" and study is None:
        raise BootcourseError("build needs --study DIR, a folder that `bootcourse study` and `bootcourse sweep` wrote.")
    if what != "verify":
        from bootcourse.research.ship import build

        build(study if what == "build" else None, assets.FOLDER, replace_larger)
    assets.put_back(assets.FOLDER)
    raise typer.Exit(report_assets(assets.FOLDER))


def report_assets(folder: Path) -> int:
    """Print the shipped files that are damaged or older than the code. Returns the exit status."""
    from bootcourse.research.fingerprint import older
    from bootcourse.storage.assets import read_manifest, verify

    problems, old = verify(folder), older(folder)
    for sentence in (*problems, *old):
        print(sentence)
    entries = read_manifest(folder)["files"]
    size = sum(entry["bytes"] for entry in entries) / 1e6
    print(f"{len(entries)} files, {size:.1f} MB: {len(problems)} wrong, {len(old)} made by older code.")
    return 1 if problems else 0
