"""`bootcourse study` computes what ships; `bootcourse assets` checks it and makes it.

A study that is stopped by Ctrl-C (exit status 130) or killed goes on when the same command is started again.
"""

import sys
import time
from collections.abc import Callable
from pathlib import Path

import typer

from bootcourse.cli.training import INTERRUPTED
from bootcourse.errors import BootcourseError, check_known
from bootcourse.files import write_bytes


def study(
    name: str = typer.Argument(
        "default",
        help="default, calibrated or paper; sensitivity, clocks, ablations, longer-view or teachers; "
        "beyond-search or beyond; elsewhere; checks; look-ahead or distil; bug-hunt, students, second-trap, easier or "
        "reachable-entropy.",
    ),
    out: Path = typer.Option(..., help="The study's folder: new, or that of a study to continue; all may share one."),
    seeds: int = typer.Option(0, min=0, help="Training seeds of each method; 0: the study's own number."),
    episodes: int = typer.Option(0, min=0, help="Training episodes of each agent; 0: the study's own number."),
    tests: int = typer.Option(0, min=0, help="Held-out episodes of each agent's test; 0: the study's own number."),
    only: str = typer.Option(
        "",
        help="Only these methods, such as sac,bootstrapped; planner is the bound. "
        "Of an experiment: a method, a teacher, or a part such as planner-dagger.",
    ),
    backend: str = typer.Option("loky", help="loky (this machine) or dask."),
    scheduler: str = typer.Option("", help="The address of a dask cluster that you have."),
    workers: int = typer.Option(0, min=0, help="Jobs at once; 0: one for each core that may be used."),
) -> None:
    """Train and test methods with many seeds; write tables, figures and the fidelity report.

    default, calibrated and paper: the paper's methods and baselines. sensitivity, clocks and ablations: the paper's
    ablation, varied. longer-view: its method with other numbers. teachers: what a teacher is worth. beyond: methods
    that the paper does not train, at equal numbers of decisions, with the settings of beyond-search. elsewhere: does a
    teacher help on other problems? checks: do our learners reach published figures? look-ahead: agents with rollouts,
    and with wrong models. distil: do networks learn what the look-ahead does? bug-hunt, students, second-trap, easier
    and reachable-entropy: the agents of five lessons.
    """
    from bootcourse.research import checks, plan
    from bootcourse.research.report import write_report
    from bootcourse.research.results import experiment, in_study
    from bootcourse.research.tables import measured_table

    check_known("Study", name, (*plan.STUDIES, *plan.EXPERIMENTS))
    if name in plan.STUDIES:
        methods = plan.methods_named(only)
        wanted = plan.study_jobs(name, methods, seeds or plan.SEEDS, tests or plan.TESTS, episodes)
    else:
        wanted = plan.experiment_named(name).only(only).jobs(name, seeds, episodes, tests)

    def report(problems: list[str]) -> None:
        study = in_study(out)
        if study.results:
            print(write_report(study, out))
        if name not in plan.STUDIES and (varied := experiment(name, out)):
            means = f"# {name}: means over agents\n\n{measured_table(varied)}"
            page = checks.page(varied) if name == "checks" else means
            write_bytes(out / f"{name}.md", page.encode())
            print(page, out / f"{name}.md", sep="\n")

    raise typer.Exit(compute(wanted, out, report, backend=backend, scheduler=scheduler, workers=workers))


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
) -> None:
    """Check the files that ship with the course, or make them again."""
    from bootcourse.storage import assets

    check_known("Action", what, ("verify", "build", "report"))
    if what == "build" and study is None:
        raise BootcourseError("build needs --study DIR, a folder that `bootcourse study` wrote.")
    if what != "verify":
        from bootcourse.research.ship import build

        build(study if what == "build" else None)
    raise typer.Exit(report_assets(assets.FOLDER))


def report_assets(folder: Path) -> int:
    """Print which shipped files are damaged or missing. Returns the exit status."""
    from bootcourse.storage.assets import read_manifest, verify

    problems, entries = verify(folder), read_manifest(folder)["files"]
    for sentence in problems:
        print(sentence)
    print(f"{len(entries)} files, {sum(entry['bytes'] for entry in entries) / 1e6:.1f} MB: {len(problems)} wrong.")
    return 1 if problems else 0
