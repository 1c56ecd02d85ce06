"""The places of a command's output: asked for before the work, so that no result is lost for want of one."""

import os
import sys
import tempfile
from pathlib import Path

from bootcourse.errors import BootcourseError

ROOM = 2**20  # bytes that a place must be able to hold


def ask_for(*places: Path | None) -> None:
    """Try to write where these files or folders will be, and make the folders that are missing; None is left out.

    Raises BootcourseError, before any is used, for a place that cannot be written.
    """
    for place in places:
        if place is None:
            continue
        folder = Path(place) if Path(place).is_dir() else Path(place).parent
        made = not folder.exists()
        try:
            folder.mkdir(parents=True, exist_ok=True)
            with tempfile.TemporaryFile(dir=folder) as file:
                file.write(bytes(ROOM))
                file.flush()
        except (OSError, ValueError) as error:  # ValueError: a null character in the name
            reason = getattr(error, "strerror", None) or error
            raise BootcourseError(f"Cannot write {place}: {reason}. Free some space or choose another place.") from None
        if made:
            print(f"There was no folder {folder}: it is made.", file=sys.stderr)


def with_home(word: str) -> str:
    """A word of the command line; a ~ that its shell has left there, as in `--out=~/runs`, is the home folder.

    Raises BootcourseError where the user has none.
    """
    option, equals, value = word.partition("=") if word.startswith("--") else ("", "", word)
    if value != "~" and not value.startswith(("~/", f"~{os.sep}")):
        return word
    whole = os.path.expanduser(value)
    if whole.startswith("~"):
        raise BootcourseError(f"{word}: this user has no home folder: write the whole path instead of ~.")
    return f"{option}{equals}{whole}"
