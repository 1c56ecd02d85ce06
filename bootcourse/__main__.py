"""The command line: `bootcourse` or `python -m bootcourse`. A command is a function with `@app.command()`.

What a command needs is imported inside it, so that `bootcourse --help` answers at once.
"""

import sys
from pathlib import Path

from bootcourse.errors import BootcourseError

try:
    import typer
except ModuleNotFoundError:  # the doctor says what else is missing, whatever was asked
    from bootcourse import doctor as missing

    sys.exit(missing.main())

app = typer.Typer(
    help="A trap on the highway, and how an imperfect driver pulls a learner out of it.",
    no_args_is_help=True,
    add_completion=False,
    rich_markup_mode=None,  # plain text, on every terminal
    pretty_exceptions_enable=False,
)


def show_version(wanted: bool) -> None:
    if wanted:
        from bootcourse import __version__

        print(f"bootcourse {__version__}")
        raise typer.Exit()


@app.callback()
def options(
    version: bool = typer.Option(False, "--version", callback=show_version, is_eager=True, help="Print the version."),
) -> None:
    pass


@app.command()
def doctor() -> None:
    """Say what is right and wrong with this machine, and how to mend it."""
    from bootcourse import doctor

    raise typer.Exit(doctor.main())


@app.command()
def train(
    method: str = typer.Option("bootstrapped", help="sac, soft, demos, bootstrapped, margin or margin_soft."),
    seeds: int = typer.Option(4, min=1, max=64, help="How many agents, side by side, each with its own seed."),
    first_seed: int = typer.Option(0, min=0, help="The first training seed."),
    episodes: int = typer.Option(1000, min=1, help="Training episodes of each agent."),
    out: Path = typer.Option(..., help="A new folder for the runs."),
    scenario: str = typer.Option("default", help="default or calibrated."),
    resume: bool = typer.Option(False, "--resume", help="Go on with a training that was interrupted or killed."),
    quiet: bool = typer.Option(False, "--quiet", help="No progress bar."),
) -> None:
    """Train agents and write a run for each."""
    from bootcourse.record import commands

    if resume:
        raise typer.Exit(commands.resume(out, not quiet))
    raise typer.Exit(commands.train(method, seeds, first_seed, episodes, out, scenario, not quiet))


@app.command()
def evaluate(
    who: str = typer.Argument(..., help="rule, idle, or a folder that `bootcourse train` wrote."),
    episodes: int = typer.Option(1000, min=1, help="Held-out episodes."),
    seed: int = typer.Option(1, min=0, help="Which block of held-out roads."),
    scenario: str = typer.Option("", help="default or calibrated; a run is tested on its own unless you say."),
    sample: bool = typer.Option(False, "--sample", help="Draw an agent's actions instead of taking the most probable."),
    as_json: bool = typer.Option(False, "--json", help="Print JSON."),
) -> None:
    """Drive held-out episodes and print success, return, speed, distance and accidents with 95 % intervals."""
    from bootcourse.study import commands

    commands.evaluate(who, episodes, seed, scenario, sample, as_json)


@app.command()
def drive(
    who: str = typer.Argument(..., help="rule, idle, random, or a run's folder."),
    out: Path = typer.Option(..., help="The rollout to write, such as drive.npz."),
    seed: int = typer.Option(0, min=0, help="The road."),
    scenario: str = typer.Option("", help="default or calibrated; a run drives its own unless you say."),
    png: Path | None = typer.Option(None, help="Also draw the top view and the traces to this picture."),
) -> None:
    """Record one drive, to be drawn or replayed."""
    from bootcourse.study import commands

    commands.drive(who, out, seed, scenario, png)


@app.command()
def replay(
    files: list[Path] = typer.Argument(..., help="Rollouts of `bootcourse drive`; several of one road are compared."),
    export: Path | None = typer.Option(None, help="Write one HTML file that plays anywhere, such as out.html."),
    gif: Path | None = typer.Option(None, help="Write an animation for slides, such as out.gif."),
    png: Path | None = typer.Option(None, help="Write a picture, such as out.png."),
    text: bool = typer.Option(False, "--text", help="Print each drive in words."),
    port: int = typer.Option(0, min=0, max=65535, help="The server's port; 0: any free one."),
    browser: bool = typer.Option(True, help="Open the browser, or only print the address."),
) -> None:
    """Show drives in 3D in the browser, or write them as a file, or in words."""
    from bootcourse.replay3d.command import replay_command

    replay_command(files, export, gif, png, text, port, browser)


@app.command()
def study(
    out: Path = typer.Option(..., help="The study's folder: new, or one to go on with."),
    scenario: str = typer.Option("default", help="default or calibrated; both may share a folder."),
    seeds: int = typer.Option(10, min=1, help="Training seeds of each method."),
    episodes: int = typer.Option(2000, min=1, help="Training episodes of each agent."),
    tests: int = typer.Option(1000, min=1, help="Held-out episodes that each agent is tested on."),
    only: str = typer.Option("", help="Some methods, such as sac,bootstrapped; planner is the bound."),
    sensitivity: bool = typer.Option(False, "--sensitivity", help="Vary what the paper leaves open, 3 seeds each."),
    backend: str = typer.Option("loky", help="loky (this machine), dask or ray."),
    scheduler: str = typer.Option("", help="The address of a dask or ray cluster that you have."),
    jobs: int = typer.Option(0, min=0, help="Cells at once; 0: one for each core."),
    recompute: bool = typer.Option(False, "--recompute", help="Compute damaged cells again."),
) -> None:
    """Train and test every method with many seeds; write tables, figures and the fidelity report."""
    from bootcourse.study import study_commands

    how = {"backend": backend, "scheduler": scheduler, "jobs": jobs, "recompute": recompute}
    raise typer.Exit(study_commands.study(out, scenario, seeds, episodes, tests, only, sensitivity, **how))


@app.command()
def sweep(
    out: Path = typer.Option(..., help="The folder: new, a study's, or one to go on with."),
    seeds: int = typer.Option(4, min=1, help="Training seeds of each setting."),
    episodes: int = typer.Option(1500, min=1, help="Training episodes of each agent."),
    tests: int = typer.Option(1000, min=1, help="Held-out episodes that each agent is tested on."),
    backend: str = typer.Option("loky", help="loky (this machine), dask or ray."),
    scheduler: str = typer.Option("", help="The address of a dask or ray cluster that you have."),
    jobs: int = typer.Option(0, min=0, help="Cells at once; 0: one for each core."),
    recompute: bool = typer.Option(False, "--recompute", help="Compute damaged cells again."),
) -> None:
    """Train the paper's method with many settings of p, ξ and c; write one file of results."""
    from bootcourse.study import study_commands

    how = {"backend": backend, "scheduler": scheduler, "jobs": jobs, "recompute": recompute}
    raise typer.Exit(study_commands.sweep(out, seeds, episodes, tests, **how))


@app.command()
def assets(
    what: str = typer.Argument(..., help="verify: check the shipped files. build: make them from a study's folder."),
    study: Path | None = typer.Option(None, help="The study's folder, for build."),
) -> None:
    """Check what ships with the course, or make it again."""
    from bootcourse import assets

    raise typer.Exit(assets.command(what, study))


def main() -> None:
    """Run a command. A mistake of the user's is one sentence and exit status 2; Ctrl-C is 130."""
    try:
        app(prog_name="bootcourse")
    except BootcourseError as error:
        print(error, file=sys.stderr)
        sys.exit(2)


if __name__ == "__main__":
    main()
