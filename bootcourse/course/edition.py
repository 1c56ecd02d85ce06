"""The edition: in what a lecturer hands out, solutions may be closed."""

from pathlib import Path

import bootcourse
from bootcourse.course.notebook import beside_the_notebook
from bootcourse.files import read_json

HANDOUT = "handout.json"
CLOSED = "Solutions are closed in this handout: `check.hint` helps, and so does your lecturer."


def solutions_are_open() -> bool:
    """False in a handout, unless its lecturer has opened them. Raises BootcourseError for a damaged handout.json."""
    here = beside_the_notebook().resolve()
    for folder in (here, here.parent, Path(bootcourse.__file__).resolve().parent.parent):
        if (folder / HANDOUT).is_file():
            return read_json(folder / HANDOUT, dict).get("solutions") is True
    return True
