"""The rooms behind the small library, which it does not know by name: each folder of the package with a `door.py`.

A door says what its room adds, and where it is, as "module:name"; it imports nothing, and it is read without its room:

    NAMES        {name: module} of the front door
    COMMANDS     {command: function} of the command line
    TEACHERS     {what they are: a table of named teachers} of `bootcourse train --teacher`
    EXPERIMENTS  {name: module, whose EXPERIMENT it is} of `bootcourse study`
"""

import runpy
from functools import cache
from pathlib import Path


@cache
def added(what: str) -> dict[str, str]:
    """What all rooms add of one kind, such as "COMMANDS": {name: where it is}, a room after the other."""
    doors = [runpy.run_path(str(path)) for path in sorted(Path(__file__).parent.glob("*/door.py"))]
    return {name: where for door in doors for name, where in door.get(what, {}).items()}
