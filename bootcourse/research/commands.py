"""`bootcourse study` computes what ships; `bootcourse assets` checks it and makes it.

A study that is stopped by Ctrl-C (exit status 130) or killed goes on when the same command is started again.
"""

import ast
import re
import sys
import time
from collections.abc import Callable
from pathlib import Path

import typer

import bootcourse
from bootcourse.cli.training import INTERRUPTED
from bootcourse.errors import BootcourseError, check_known
from bootcourse.files import write_bytes
from bootcourse.rooms import added

EXPERIMENTS = added("EXPERIMENTS")


def study(
    name: str = typer.Argument("default", help="A study or an experiment: see above."),
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

    default, calibrated and paper are the studies of the paper's methods and baselines: behind traps of 10 m/s, behind
    faster ones, and with the paper's two updates for each decision. The others are experiments:
    """
    from bootcourse.research.computed import experiment, in_study
    from bootcourse.research.experiment import experiment_named
    from bootcourse.research.report import write_report
    from bootcourse.research.studies import STUDIES
    from bootcourse.research.tables import measured_table

    check_known("Study", name, (*STUDIES, *EXPERIMENTS))
    wanted = STUDIES[name] if name in STUDIES else experiment_named(name)
    jobs = wanted.jobs(only, seeds=seeds, episodes=episodes, tests=tests)

    def report(problems: list[str]) -> None:
        study = in_study(out)
        if study.results:
            print(write_report(study, out))
        if name in EXPERIMENTS and (computed := experiment(name, out)):
            means = f"# {name}: means over agents\n\n{measured_table(computed)}"
            page = wanted.page(computed) if wanted.page else means
            write_bytes(out / f"{name}.md", page.encode())
            print(page, out / f"{name}.md", sep="\n")

    raise typer.Exit(compute(jobs, out, report, backend=backend, scheduler=scheduler, workers=workers))


def words_of(experiment: str) -> str:
    """The first sentence of an experiment's file, which is read and not loaded: loading them all takes seconds."""
    file = Path(bootcourse.__file__).parents[1] / f"{EXPERIMENTS[experiment].replace('.', '/')}.py"
    text = ast.get_docstring(ast.parse(file.read_text(encoding="utf-8")))
    return re.split(r"(?<=[.?])\s", text, maxsplit=1)[0].replace("\n", " ")


LISTED = "".join(f"\n\n    {name}: {words_of(name)}" for name in EXPERIMENTS)
study.__doc__ = f"{study.__doc__}{LISTED}"  # what `--help` prints


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
