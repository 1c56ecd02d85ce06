"""To drag in this lesson: what the trap pays and how far one looks, and what each state of the chain is then worth."""

import numpy as np

from bootcourse.colours import INK
from bootcourse.course.lessons.values import chain, diagrams
from bootcourse.methods import style
from bootcourse.panels.explorable import WIDTH, Curve, Explorable, legend
from bootcourse.panels.number import Number
from bootcourse.plots.svg import Drawing, SvgAxes, drawing, text

CHART, BOXES, HEIGHT = (52, 90, 690, 170), 312, 400  # pixels: the bars' axes, the top of the chain's boxes, the whole
BAR, FARTHEST = 0.4, 0.85  # of a state's part of the width; the largest γ


def worths() -> Explorable:
    """Each state's worth to a walker who goes to the trap and stays and to one who goes on, by the trap's pay and γ."""

    def draw(pay: float, gamma: float) -> Drawing:
        on, stay = chain.REWARD[4, 1] / (1 - gamma) * gamma ** np.arange(4, -1, -1), pay / (1 - gamma)
        back = np.array([stay, *[gamma * stay] * 3, 0.0])  # nobody comes back from the free road
        named = {
            "goes to the trap, and stays": Curve(back, style("idle").colour),
            "goes on to the free road": Curve(on, style("soft").colour),
        }
        better = "leaving" if on[0] > back[0] else "staying"
        says = f"If the trap pays {pay:.2f} and γ is {gamma:.2f}, {better} is worth more: "
        says += f"staying {back[0]:.3f}, leaving {on[0]:.3f}."
        chart = SvgAxes(*CHART, (0.0, float(chain.STATES)), (0.0, 1 / (1 - FARTHEST)))
        chart.scale("what a walker gets from this state on, discounted")
        for row, curve in enumerate(named.values()):
            for state, value in enumerate(curve.values):
                left = state + 0.1 + row * BAR
                right = left + 0.92 * BAR
                chart.fill([left, right, right, left], [0, 0, value, value], curve.colour)
        middles = [float(chart.at(state + 0.5, 0)[0]) for state in range(chain.STATES)]
        boxes, alt = diagrams.five_states(middles, BOXES, pay)
        chain_below = f'<g color="{INK}" font-size="13">{"".join(boxes)}</g>'
        parts = [text(4, 20, says, size=14, bold=True), *legend(named), *chart.parts, chain_below]
        return drawing(WIDTH, HEIGHT, parts, f"{says} {alt}")

    pay = Number("pay", float(chain.REWARD[0, 0]), 0, 1, 0.01, "What each decision to stay in the trap pays.")
    gamma = Number("γ", 0.8, 0.5, FARTHEST, 0.01, "What a reward one decision later counts.")
    return Explorable("What is each state worth?", draw, pay=pay, gamma=gamma)
