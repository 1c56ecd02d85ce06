"""What the numbers and claims in this lesson's text are computed from, beside tools/course/known.py."""

import re
from functools import cache

import numpy as np

from bootcourse.course.lessons import COURSE, ELECTIVES
from bootcourse.course.shipped import shipped_agents
from bootcourse.episodes.record import record
from tools.course.known import ROAD, SETTINGS, code_of, minutes, shipped_runs, talk
from tools.course.numbering import resolved

ALL, READ, PICTURE, KNOWN = "", "the text, without the exercises", "the picture at its beginning", "known"
SAC = dict.fromkeys(("values", "discrete_sac", "update_and_loop"), KNOWN)
ROUTES = {  # {lesson: what a route has of it}, in their order
    "evening": {"the_trap": ALL, "discrete_sac": PICTURE, "the_barrier": ALL},
    "week": dict.fromkeys(COURSE[1:], ALL),
    "researcher": dict.fromkeys((*COURSE[1:], *ELECTIVES), ALL)
    | SAC
    | dict.fromkeys(("the_trap", "the_rule", "demonstrations", "your_teacher"), READ),
}
UPDATES, LAST = 2000, 50  # of the agent that the student trains; the drives that are counted at its end
LOOK = "display: inline-block; padding: 6px 14px; margin: 3px 0; border: 1px solid #0072B2; border-radius: 6px"


def time_of(lesson: str, part: str) -> int:
    """The minutes that a part of a lesson takes."""
    return {ALL: minutes, READ: talk, PICTURE: lambda name: 5, KNOWN: lambda name: 0}[part](lesson)


def hours(route: str) -> str:
    """The hours of a route, this page included."""
    return f"{(minutes('start') + sum(time_of(*each) for each in ROUTES[route].items())) / 60:.1f}"


def way(route: str) -> str:
    """The lessons of a route with their times, as a list."""
    rows = [
        f"* [[{name}]] · []({name}.ipynb), {time_of(name, part)} minutes" + f": {part}" * (part != ALL)
        for name, part in ROUTES[route].items() if part != KNOWN
    ]  # fmt: skip
    return resolved("\n".join(rows))


def button(route: str, name: str, words: str) -> str:
    """A button that opens the way of a route: it needs no kernel, and where styles are taken out it is a plain list."""
    summary = f'<summary style="{LOOK}"><b>{name}</b>, {hours(route)} hours: {words}</summary>'
    return f"<details>{summary}\n\n{way(route)}\n\n</details>"


def missing(route: str) -> list[tuple[str, str]]:
    """Lessons that one of the route's needs, as it says at its top, and that the route has nothing of."""
    taken, needed = ROUTES[route], []
    for name in (name for name, part in taken.items() if part == ALL):
        time = re.search(r"\*\*Time\*\*.*?(?=\n#\n|\n\n)", code_of(name), re.S)[0]
        needed += [(name, other) for other in re.findall(r"\[\[(\w+)\]\]", time) if other != "start"]
    return [(name, other) for name, other in needed if other not in taken]


def getting_out(method: str) -> list[int]:
    """[how many of the shipped agents of a method get out on the student's road, of how many]."""
    out = [record(agent.as_policy(), [ROAD])[0].success for agent in shipped_agents(method)]
    return [sum(map(bool, out)), len(out)]


@cache
def drives() -> np.ndarray:
    """How many training drives each shipped bootstrapped agent had ended when it had as many updates as the
    student's agent, (agents,)."""
    decisions = SETTINGS.learning_starts + UPDATES * SETTINGS.envs_per_agent // SETTINGS.updates
    ends = (np.cumsum(run.curves["decisions"]) for run in shipped_runs("bootstrapped"))
    return np.array([(each <= decisions).sum() for each in ends])


def lately(measure: str) -> np.ndarray:
    """A curve's mean over the last drives of each of these agents until then, (agents,); of "accident" the share."""
    runs = zip(shipped_runs("bootstrapped"), drives(), strict=True)
    last = [run.curves[measure][done - LAST : done] for run, done in runs]
    return np.mean(np.array(last) > 0 if measure == "accident" else last, axis=1)


def crashed_at_first() -> float:
    """How many seconds the longest-driving of these agents drives in its first ten drives, on average."""
    return float(max(run.curves["decisions"][:10].mean() for run in shipped_runs("bootstrapped")))


def between(values: np.ndarray) -> str:
    """The lowest and the highest value: "12 to 17"."""
    return f"{values.min():.0f} to {values.max():.0f}"


def percent(shares: np.ndarray) -> str:
    """The lowest and the highest share, in per cent: "70 to 78"."""
    return between(100 * shares)
