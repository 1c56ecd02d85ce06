"""The command line: `bootcourse` or `python -m bootcourse`. A command is a function with `@app.command()`.

What a command needs is imported inside it, so that `bootcourse --help` answers at once.
"""

import sys

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


def main() -> None:
    """Run a command. A mistake of the user's is one sentence and exit status 2; Ctrl-C is 130."""
    try:
        app(prog_name="bootcourse")
    except BootcourseError as error:
        print(error, file=sys.stderr)
        sys.exit(2)


if __name__ == "__main__":
    main()
