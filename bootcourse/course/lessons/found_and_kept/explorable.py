"""To drag in this lesson: one agent's training; and when a way out counts as lost, in four groups of agents: β ends or
never does, with the bonus or without.
"""

import numpy as np

from bootcourse.colours import INK, QUIET
from bootcourse.course import own_code
from bootcourse.course.lessons.found_and_kept import ways
from bootcourse.course.shipped import shipped_experiment, shipped_results
from bootcourse.episodes.record import record
from bootcourse.methods import style
from bootcourse.panels.explorable import WIDTH, Explorable
from bootcourse.panels.number import Number, whole_number
from bootcourse.plots.road import draw_cars, draw_road, edges_of
from bootcourse.plots.svg import Drawing, SvgAxes, drawing, line, over, rect, text, ticks
from bootcourse.policies import idle_policy
from bootcourse.research.results import Results
from bootcourse.road.state import TRAP_1, X
from bootcourse.scenario import DEFAULT
from bootcourse.statistics import HAD, IN_A_ROW, LOST, rolling_means

BACK, FRONT = -45.0, 45.0  # m: of the road behind and before trap 1 that is drawn
SEEN_FIRST = 700  # the training episode with which the picture of one agent's training begins
TALL_M = DEFAULT.road.lanes * DEFAULT.road.lane_width  # m: the road's width
LEFT, RIGHT, TOP = 124, 470, 84  # pixels: of the bars
ROW, TALL, APART = 7, 70, 24  # pixels: a row, a group, the space between two groups
LOSE, KEEP, EARN, CRASH = 508, 578, 646, 718  # pixels: the middles of the four columns at the right


def training() -> Explorable:
    """One agent with demonstrations alone while it learns: its drive beside trap 1, and how often it gets ahead."""
    agents = shipped_experiment("ways")["demos"]
    which = ways.gives_up(agents)
    notes, success = {name: each[which] for name, each in agents.notes.items()}, agents.curves["success"][which]
    at, (share,) = rolling_means(100 * success, IN_A_ROW, len(success))
    colour, end = style("demos").colour, agents.agents[which]["beta_episodes"]
    start = record(idle_policy, [ways.SHOWN])[0].states[0]
    start = start - np.eye(1, start.shape[1], X) * start[TRAP_1, X]  # x counts from trap 1

    def draw(episode: float) -> Drawing:
        look = round(episode / ways.EVERY)
        road = SvgAxes(
            20, 60, WIDTH - 40, (WIDTH - 40) * TALL_M / (FRONT - BACK), (BACK, FRONT), edges_of(DEFAULT.road)[::-1]
        )
        draw_road(road, DEFAULT, BACK, FRONT)
        draw_cars(road, start, DEFAULT, colour, BACK, FRONT, 0.0)
        ends = _path(road, notes["way"][look], colour)
        chart = SvgAxes(52, 214, WIDTH - 72, 100, (0.0, float(len(success))), (0.0, 100.0))
        chart.frame(f"% of the last {IN_A_ROW} training episodes ahead of trap 1", "training episode", rows=2)
        chart.line(at, share, colour, 1.5)
        chart.line([end, end], [0, 100], INK, 0.8, "--")
        chart.words(end + 75, 88, "← no demonstrations from here on", QUIET)
        chart.line([episode, episode], [0, 100], INK, 1.5)
        ahead = 100 * notes["success"][look]
        says = f"After {episode:,.0f} episodes: ahead of trap 1 on {ahead:.0f} % of {ways.ROADS} roads."
        words = f"the first {ways.SECONDS} s of one drive, seen from trap 1; a dot a second, until {ends}"
        parts = [text(4, 20, says, size=14, bold=True), text(20, 48, words, fill=QUIET, size=11.5)]
        return drawing(WIDTH, 356, parts + road.parts + chart.parts, f"{says} The drive shown goes on until {ends}.")

    number = Number("training episode", SEEN_FIRST, 0, len(success), ways.EVERY, "How far the agent has learned.")
    return Explorable("One agent with demonstrations alone, while it learns", draw, episode=number)


def _path(road: SvgAxes, way: np.ndarray, colour: str) -> str:
    """Draw a way beside trap 1, (seconds, 2); returns where it ends, in words."""
    driven = way[np.isfinite(way[:, 0])]
    inside = np.flatnonzero((driven[:, 0] < BACK) | (driven[:, 0] > FRONT))
    shown = driven[: inside[0] if len(inside) else len(driven)]
    road.line(*shown.T, colour, 1.4)
    for x, y in shown:
        road.dot(x, y, colour)
    for second in range(0, len(shown), 5):  # the seconds tell in which direction it goes
        across, down = road.at(*shown[second])
        place = f"start, {second} s" if second == 0 else f"{second} s"
        road.parts.append(over(text(across, down - 8, place, "middle", INK, 10.5)))
    if len(shown) < len(driven):
        return "it is 45 m ahead" if driven[len(shown), 0] > 0 else "it is 45 m behind"
    if len(driven) == len(way):
        return f"second {len(way) - 1}"
    road.words(*shown[-1], "×", INK, "middle", 16)
    return f"its accident in second {len(driven) - 1}"


def groups() -> dict[str, Results]:
    """The agents with both aids, ten in each group: {words: results}."""
    changed = shipped_experiment("ablations")
    of = {
        "β ends, bonus": shipped_results(),
        "β never ends, bonus": changed["β for ever"],
        "β ends, no bonus": changed["c = 0"],
        "β never ends, no bonus": changed["β for ever, c = 0"],
    }
    return {words: results.of("bootstrapped") for words, results in of.items()}


def losing() -> Explorable:
    """When each agent has the way out; how many lose it, by a limit; and how the ten drive in the test.

    Who loses it is counted by the student's `ever_lost`, if it passed its check.
    """
    shown, ever_lost = groups(), own_code.yours_or_ours("ever_lost", doing="Counting")
    episodes, bottom = shipped_results().curves["success"].shape[1], TOP + len(shown) * (TALL + APART) - APART
    axes = SvgAxes(LEFT, TOP, RIGHT - LEFT, bottom - TOP, (0.0, float(episodes)), (0.0, 1.0))
    still = [text((LEFT + RIGHT) / 2, bottom + 31, "training episode", "middle", QUIET, 11)]
    for tick in ticks(0, episodes, 4):
        across, _ = axes.at(tick, 0)
        still += [line(across, TOP, across, bottom + 3), text(across, bottom + 15, f"{tick:,.0f}", "middle", QUIET, 11)]
    columns = (LOSE, "lose it at", "least once"), (KEEP, "escape in", "the test"), (EARN, "all ten", "earn")
    columns += ((CRASH, "drives with", "accident"),)
    for x, *words in columns:
        still += [text(x, TOP - 38 + 16 * i, word, "middle", bold=True) for i, word in enumerate(words)]

    kept, ends = {}, {}
    for place, (words, results) in enumerate(shown.items()):
        keep = results.found_and_kept("bootstrapped")[1]
        earned, crash = (results.scores(each).mean() for each in ("returns", "accident"))
        kept[words] = f"{keep.sum()} escape in the test; all ten earn {earned:.0f}, {100 * crash:.0f} % accidents"
        top = TOP + place * (TALL + APART)
        still += _named(words, top)
        row = {KEEP: f"{keep.sum()} of {len(keep)}", EARN: f"{earned:.0f}", CRASH: f"{100 * crash:.0f} %"}
        still += [text(x, _middle(top), cell, "middle") for x, cell in row.items()]
        ends[words] = _end_of_beta(axes, top, results)  # over the bars

    def draw(limit: float) -> Drawing:
        parts, losers = [], {}
        for place, (words, results) in enumerate(shown.items()):
            top, success = TOP + place * (TALL + APART), results.curves["success"]
            losers[words] = int(np.sum(ever_lost(success, HAD, int(limit))))
            parts += _bars(axes, top, success, limit) + ends[words]
            parts.append(text(LOSE, _middle(top), f"{losers[words]} of {len(success)}", "middle"))
        *some, last = losers.values()
        counted = f"{', '.join(map(str, some))} and {last}"
        says = f"Lost at {limit:.0f} of {IN_A_ROW} or fewer: from top to bottom {counted} of ten lose it."
        parts.append(text(4, 20, says, size=14, bold=True))
        bars = f"bar: more than {limit:.0f} of the last {IN_A_ROW} ahead"
        parts.append(text(LEFT, TOP - 22, bars, bold=True))
        in_all = "; ".join(f"{words}: {count} lose it at least once, {kept[words]}" for words, count in losers.items())
        return drawing(WIDTH, bottom + 38, still + parts, f"{says} {in_all}.")

    help = f"After {HAD} of {IN_A_ROW} ahead, so few count as lost."
    number = Number("limit", LOST, 5, 35, 1, help, check=whole_number("limit", 5, 35))
    return Explorable("Both aids, four groups of ten: who loses the way out?", draw, limit=number)


def _middle(top: float) -> float:
    """The base line of words at the middle of a group's bars."""
    return top + TALL / 2 + 4


def _named(words: str, top: float) -> list[str]:
    """A group's words beside its bars, a line for each part."""
    parts = words.split(", ")
    first = _middle(top) - 8 * (len(parts) - 1)
    return [text(LEFT - 8, first + 16 * i, part, "end", bold=True) for i, part in enumerate(parts)]


def _bars(axes: SvgAxes, top: float, success: np.ndarray, limit: float) -> list[str]:
    """For each agent a bar from window to window with more than `limit` ahead: 0/1 (agents, episodes)."""
    parts, (at, share) = [], rolling_means(success, IN_A_ROW, success.shape[1])
    for row, good in enumerate(share > limit / IN_A_ROW):
        edges = at[0] + np.flatnonzero(np.diff(np.concatenate([[0], good, [0]])))
        for first, after in edges.reshape(-1, 2):
            begin, end = axes.at(np.array([first, after]), 0)[0]
            parts.append(rect(begin, top + row * ROW, end - begin, ROW - 1.5, style("bootstrapped").colour))
    return parts


def _end_of_beta(axes: SvgAxes, top: float, results: Results) -> list[str]:
    """A dashed line where a group's β is 0, if it ends."""
    ends = results.agents[0]["beta_episodes"]
    if ends is None:
        return []
    across, _ = axes.at(ends, 0)
    dashed = line(across, top - 4, across, top + TALL + 2, INK, 1.2, 'stroke-dasharray="4 3"')
    return [dashed, text(across + 4, top - 4, "β is 0 from here on", fill=QUIET, size=10.5)]
