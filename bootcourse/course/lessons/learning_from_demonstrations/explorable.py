"""To drag in this lesson: what a critic thinks of nine actions in each second of a demonstrated drive."""

import numpy as np

from bootcourse.colours import INK, QUIET
from bootcourse.course.lessons.learning_from_demonstrations import measures
from bootcourse.episodes.rollout import Rollout
from bootcourse.learn.agent import Agent
from bootcourse.learn.settings import settings_for
from bootcourse.methods import style
from bootcourse.panels.explorable import CHART, HEIGHT, WIDTH, Curve, Explorable, legend
from bootcourse.panels.number import Number
from bootcourse.plots.svg import Drawing, SvgAxes, drawing, text
from bootcourse.scenario import ACTION_NAMES

OTHERS, EDGE = "#B8BEC6", "#5F6B77"  # the actions that were not demonstrated, and the margin on them
LOWEST = -3.0  # bars below it are cut off
MOST, VISIBLE = 2.0, 1.0  # the largest margin; bars this high can be seen
HALF = 0.36  # of a bar's width; the bars stand 1 apart
AGENT = 1  # whose Q the panel shows: of the agents that ship


def nine_values() -> Explorable:
    """`nine_values_of` the lesson's agent, on the rule's drive that it shows."""
    return nine_values_of(measures.agents()[AGENT], measures.demonstrated(), measures.SECONDS)


def nine_values_of(agent: Agent, drive: Rollout, seconds: int) -> Explorable:
    """The Q of the nine actions in each of a drive's first seconds, and above all but the rule's a margin to drag."""
    q, did = agent.q_values(drive.observations[:seconds]), drive.rule_actions[:seconds]
    y = (min(0.0, max(float(q.min()), LOWEST)), max(0.5, float(q.max()) + MOST))
    of_rule = q[np.arange(len(q)), did]
    leads = of_rule - np.where(np.arange(q.shape[1]) == did[:, None], -np.inf, q).max(1)
    seen = np.abs(of_rule) >= VISIBLE
    first = int(np.where(seen if seen.any() else True, leads, np.inf).argmin()) + 1  # another action is far ahead

    def draw(second: float, margin: float) -> Drawing:
        values, mine = q[round(second) - 1], int(did[round(second) - 1])
        others = np.arange(len(values)) != mine
        levels = float(values[mine]), float((values + margin * others).max())
        ahead = int(values.argmax())
        says = f"Second {second:.0f}: {ACTION_NAMES[mine]} is demonstrated"
        says += " and has the largest Q." if ahead == mine else f", {ACTION_NAMES[ahead]} has the largest Q."
        apart = f"loss, between the dashed lines: {levels[1] - levels[0]:.1f}"
        chart = SvgAxes(*CHART, (0.0, float(len(values))), y)
        chart.scale("Q" if q.min() > LOWEST else f"Q (bars are cut off at {LOWEST:g})".replace("-", "−"))
        for place, value in enumerate(values):
            sides = np.array([-HALF, HALF, HALF, -HALF]) + place + 0.5
            low, high = np.clip([value, value + margin], *y)
            chart.fill(sides, [0.0, 0.0, low, low], style("demos").colour if place == mine else OTHERS)
            if margin and place != mine:
                chart.line([place + 0.5] * 2, [low, high], EDGE, 1.0)
                chart.line([place + 0.5 - HALF / 2, place + 0.5 + HALF / 2], [high, high], EDGE, 1.0)
        chart.line([0, len(values)], [0.0, 0.0], INK, 0.8)
        for level in levels:
            chart.line([0, len(values)], [level, level], QUIET, 0.8, "--")
        below, looks = CHART[1] + CHART[3] + 16, ((QUIET, 11), (INK, 11, True))
        under = [
            text(chart.at(place + 0.5, 0)[0], below + 13 * row, word, "middle", *looks[place == mine])
            for place, action in enumerate(ACTION_NAMES)
            for row, word in enumerate(action.split())
        ]
        names = {"demonstrated": Curve([], style("demos").colour), "other actions": Curve([], OTHERS)}
        names |= {"margin": Curve([], EDGE)} if margin else {}
        head = [text(4, 20, says, size=14, bold=True), text(520, 46, apart), *legend(names)]
        return drawing(WIDTH, HEIGHT, [*head, *chart.parts, *under], f"{says} {apart[0].upper()}{apart[1:]}.")

    second = Number("second", first, 1, seconds, 1, "Of the rule's drive.")
    margin = Number(
        "margin", 1, 0, MOST, 0.1, f"On each other action; the paper's is {settings_for('margin').margin:g}."
    )
    return Explorable("What a critic thinks of the nine actions", draw, second=second, margin=margin)
