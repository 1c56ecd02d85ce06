"""Two clocks: ξ = 200 α fades with the updates, β with the episodes. Which help lasts?

The panel shows what `bootcourse study clocks` measured, by default the results that ship; nothing is trained here.
"""

from collections.abc import Mapping
from pathlib import Path

import ipywidgets as widgets
import numpy as np

from bootcourse.errors import BootcourseError, check_known
from bootcourse.methods import display_name, style
from bootcourse.panels.panel import Panel
from bootcourse.plots.svg import QUIET, SvgAxes, drawing, text
from bootcourse.plots.training_curves import WINDOW, draw_band
from bootcourse.research.clocks import cells, faded
from bootcourse.research.plan import VARIED
from bootcourse.research.results import Results, experiment
from bootcourse.statistics import iqm, rolling_means
from bootcourse.storage.assets import FOLDER

WIDTH, HEIGHT = 940, 500
FADING, SUCCESS = (52, 84, 660, 140), (52, 296, 660, 150)  # the charts' left, top, width and height, pixels


class ClocksPanel(Panel):
    """`chosen` is the pair (updates per decision, driver of the demonstrations), `svg` what the panel shows."""

    def __init__(self, measured: Mapping[tuple[str, str], Results], chosen: tuple[str, str]):
        self.measured = measured
        updates, drivers = (list(dict.fromkeys(pair[i] for pair in measured)) for i in (0, 1))
        look = {"style": {"description_width": "190px", "button_width": "56px"}}
        self.updates = widgets.ToggleButtons(
            options=updates, value=chosen[0], description="updates per decision", **look
        )
        self.driver = widgets.ToggleButtons(
            options=drivers, value=chosen[1], description="demonstrations driven by", **look
        )
        self.view = widgets.HTML()
        super().__init__("Two clocks: which help lasts?", self.updates, self.driver, self.view)
        self.update_with(self.updates, self.driver)

    def update(self, change=None) -> None:
        """Draw the choice; say so if it was not computed."""
        pair = (self.updates.value, self.driver.value)
        if pair not in self.measured:
            self.say(f"{pair[0]} updates per decision with demonstrations by {pair[1]} were not computed.", wrong=True)
            return
        self.say()
        self.chosen, results = pair, self.measured[pair]
        self.svg = self.view.value = clocks(results, told(results, pair[0]))


def told(results: Results, updates: str) -> str:
    """What the curves say: when ξ is down to a tenth, when β is 0, and who escapes after that."""
    xi, beta = faded(results.of("soft").curves["xi"]), results.of("demos").agents[0]["beta_episodes"]
    soft, demos = (f"{results.escapers(method)} of {len(results.of(method))}" for method in ("soft", "demos"))
    return (
        f"{updates} updates per decision: ξ is down to a tenth after {xi:.0f} episodes, β is 0 after {beta:,}. "
        f"In the end {soft} agents escape with the soft constraint alone, {demos} with demonstrations alone."
    )


def clocks(results: Results, alt: str) -> str:
    """The drawing: what is left of ξ and β above, the success of each method below."""
    episodes = np.arange(results.curves["success"].shape[1])
    soft, schedule = results.of("soft"), results.of("demos").agents[0]["beta_episodes"]
    xi, of_alpha = soft.curves["xi"], f"ξ = {soft.agents[0]['xi_multiplier']:g}α"
    fading = SvgAxes(*FADING, (0, len(episodes)), (0, 100))
    fading.frame("% of their start that is left of ξ, α and β")
    beta = np.maximum(0, 1 - episodes / schedule)
    for method, share, name in (("soft", iqm(xi / xi[:, :1], axis=0), of_alpha), ("demos", beta, "β")):
        look, half = style(method), int((share <= 0.5).argmax())
        fading.line(episodes, 100 * share, look.colour, 2, look.line)
        fading.words(half + 0.01 * len(episodes), 56, name, look.colour, size=10)
    success, ends = SvgAxes(*SUCCESS, (0, len(episodes)), (0, 100)), {}
    success.frame(f"success, % of the last {WINDOW} training episodes", "training episode")
    for method in VARIED:
        look = style(method)
        at, means = rolling_means(100 * results.of(method).curves["success"], WINDOW)
        draw_band(success, at, means, look.colour)
        middle = iqm(means, axis=0)
        success.line(at, middle, look.colour, max(1.8, look.width), look.line)
        ends[display_name(method)] = (middle[-1], look.colour)
    _label(success, ends)
    first, second = alt.split(". ", 1)
    head = [text(4, 20, f"{first}.", size=14, bold=True), text(4, 42, second, fill=QUIET, size=13)]
    agents = " or ".join(map(str, sorted({len(results.of(method)) for method in VARIED})))
    foot = f"Interquartile means over {agents} agents of each method, with their 95 % intervals."
    foot = text(4, HEIGHT - 6, foot, fill=QUIET, size=11)
    return drawing(WIDTH, HEIGHT, [*head, *fading.parts, *success.parts, foot], alt)


def _label(axes: SvgAxes, ends: dict[str, tuple[float, str]]) -> None:
    """Name each line at its right end; names that would touch are moved apart."""
    y, across = -np.inf, axes.left + axes.width + 8
    for name, (end, colour) in sorted(ends.items(), key=lambda each: -each[1][0]):
        y = max(y + 15, axes.at(0, end)[1] + 4)
        axes.parts.append(text(across, y, name, fill=colour, bold=True))


def clocks_panel(updates: str = "", demonstrations: str = "", study: Path | str = "") -> ClocksPanel:
    """See which help lasts: ξ, β and success over the episodes, for a chosen number of updates per decision.

    updates: "1/4", "1", "2" or "4", and demonstrations: driven by "μ", the rule, or by "π̃", the stochastic rule; by
    default the first pair that was computed. study: a folder in which `bootcourse study clocks` has finished jobs; by
    default the results that ship. Raises BootcourseError for a pair that was not computed.
    """
    measured = cells(experiment("clocks", study))
    if not measured:
        run = f"run `bootcourse study clocks --out {study or 'DIR'}`" + ("" if study else ", then give study=DIR")
        raise BootcourseError(f"{study or FOLDER} holds no results of the experiment clocks: {run}.")
    first = next(iter(measured))
    chosen = (updates or first[0], demonstrations or first[1])
    check_known("Choice", " ".join(chosen), [" ".join(pair) for pair in measured])
    return ClocksPanel(measured, chosen)
