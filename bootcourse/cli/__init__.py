"""The command line, `bootcourse` or `python -m bootcourse`: a command is a function in `COMMANDS` or of a room behind.

Commands import their modules themselves, so that `bootcourse --help` is fast.
"""

import sys
from pkgutil import resolve_name

import typer
from typer.core import TyperGroup
from typer.main import get_command

from bootcourse.cli.driving import drive, evaluate, replay
from bootcourse.cli.places import with_home
from bootcourse.cli.training import train
from bootcourse.errors import BootcourseError
from bootcourse.rooms import added
from bootcourse.terminal import SPELL

PLAIN = {"add_completion": False, "rich_markup_mode": None, "pretty_exceptions_enable": False}  # on every terminal


class Commands(TyperGroup):
    """The commands of `COMMANDS`, and of the rooms (rooms.py) those that are asked for, which are then imported."""

    def __init__(self, **options):
        super().__init__(**options)
        self.places = added("COMMANDS")
        self.commands |= dict.fromkeys(self.places)

    def get_command(self, ctx, name):
        if name in self.places and self.commands[name] is None:
            alone = typer.Typer(**PLAIN)
            alone.command(name)(resolve_name(self.places[name]))
            self.commands[name] = get_command(alone)
        return super().get_command(ctx, name)


app = typer.Typer(
    cls=Commands,
    help="A trap on the highway, and how an imperfect driver pulls a learner out of it.",
    no_args_is_help=True,
    **PLAIN,
)


def main() -> None:
    """Run a command. Exit status: 2, after one sentence, for a user mistake; 130 for Ctrl-C."""
    for stream in (sys.stdout, sys.stderr):
        if hasattr(stream, "reconfigure"):
            stream.reconfigure(errors=SPELL)
    try:
        sys.argv = [sys.argv[0], *map(with_home, sys.argv[1:])]
        app(prog_name="bootcourse")
    except BootcourseError as error:
        print(error, file=sys.stderr)
        sys.exit(2)
    except OSError as error:  # a name that is too long, a folder without permission, a disk that is gone ...
        print(f"{error.filename or 'A file'}: {error.strerror or error}.", file=sys.stderr)
        sys.exit(2)


def show_version(wanted: bool) -> None:
    """Print the version and exit, if wanted."""
    if wanted:
        from bootcourse import __version__

        print(f"bootcourse {__version__}")
        raise typer.Exit()


@app.callback()
def options(
    version: bool = typer.Option(False, "--version", callback=show_version, is_eager=True, help="Print the version."),
) -> None:
    """The options of `bootcourse` itself."""


def doctor() -> None:
    """Check the installation and this machine, and print a remedy for each problem."""
    from bootcourse import doctor

    raise typer.Exit(doctor.main())


COMMANDS = (doctor, train, evaluate, drive, replay)
for command in COMMANDS:
    app.command()(command)
