"""What the numbers and claims in this lesson's text are computed from, beside tools/course/known.py."""

import re

from tools.course.known import code_of, minutes, talk

ROUTES = ("evening", "week", "researcher")  # the table's columns
ALL, READ, PICTURE, KNOWN = "●", "◐", "picture", "known"  # what a route has of a lesson


def marks(route: str) -> dict[str, str]:
    """{lesson: what a route has of it}, as this lesson's table says."""
    rows = re.findall(r"^# \| \[\[(\w+)\]\](.*)\|$", code_of("start"), re.M)
    cells = {name: row.split("|")[1 + ROUTES.index(route)].strip() for name, row in rows}
    return {name: mark for name, mark in cells.items() if mark in (ALL, READ, PICTURE, KNOWN)}


def long(route: str) -> int:
    """The minutes of a route: of a lesson that is read, those without its exercises; 5 for a picture."""
    each = {ALL: minutes, READ: talk, PICTURE: lambda name: 5, KNOWN: lambda name: 0}
    return minutes("start") + sum(each[mark](name) for name, mark in marks(route).items())


def missing(route: str) -> list[tuple[str, str]]:
    """Lessons that one of the route's needs, as it says at its top, and that the route has nothing of."""
    taken, needed = marks(route), []
    for name in (name for name, mark in taken.items() if mark == ALL):
        time = re.search(r"\*\*Time\*\*.*?(?=\n#\n|\n\n)", code_of(name), re.S)[0]
        needed += [(name, other) for other in re.findall(r"\[\[(\w+)\]\]", time) if other != "start"]
    return [(name, other) for name, other in needed if other not in taken]
