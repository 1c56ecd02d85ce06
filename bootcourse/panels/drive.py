"""Drive the ego yourself, a decision for each press of a button or an arrow key, against a ghost.

    mine = drive_panel(seed=3)
    mine.rollout          # what you drove, as `record` would have recorded it
    mine.demonstrations   # the drives that you kept: train_panel(drives=mine.demonstrations)

`episodes/interactive.py` drives, `cockpit.py` draws, `pad.py` reads the keys.
"""

import ipywidgets as widgets
import numpy as np

from bootcourse.episodes.interactive import InteractiveEpisode
from bootcourse.episodes.lookahead import nine_drives
from bootcourse.episodes.record import record
from bootcourse.episodes.rollout import Rollout
from bootcourse.errors import whole
from bootcourse.panels.cockpit import cockpit
from bootcourse.panels.number import Number, whole_number
from bootcourse.panels.pad import Pad
from bootcourse.panels.panel import Panel
from bootcourse.plots.futures import Trail, in_words, trails
from bootcourse.policies import Policy, rule_policy
from bootcourse.scenario import DEFAULT, Scenario

LAST_ROAD = 2**32 - 1  # the training roads have higher seeds


class DrivePanel(Panel):
    """`.rollout` is the present drive (None before its first decision), `.demonstrations` the drives that were kept."""

    def __init__(self, seed: int, scenario: Scenario, ghost: Policy | None, futures: Policy | None):
        self.scenario, self.base = scenario, futures or rule_policy(scenario)
        self.rival, self.name = (rule_policy(scenario), "rule") if ghost is None else (ghost, "agent")
        self._begin(seed)
        self.chosen: dict[InteractiveEpisode, Rollout] = {}
        self.view = widgets.HTML()
        self.view.add_class("bc-road")
        self.road = Number("road", seed, 0, 99, 1, "The seed of the road. Another one begins a new drive.",
                           check=whole_number("road", 0, LAST_ROAD))  # fmt: skip
        self.again = self.make_button("Drive again", "refresh", "The same road, from its start", self._again,
                                      width="124px")  # fmt: skip
        self.keep = self.make_button("Keep as demonstration", "graduation-cap",
                                     "Keep this drive as a demonstration for an agent", self._keep,
                                     width="214px")  # fmt: skip
        self.nine = widgets.Checkbox(
            futures is not None, description="nine futures", indent=False,
            tooltip="Draw where each action leads if the base policy drives on: red ends in an accident",
        )  # fmt: skip
        buttons = widgets.HBox([self.again, self.keep, self.nine], layout={"flex_flow": "row wrap"})
        controls = widgets.VBox([buttons, self.road], layout={"grid_gap": "4px"})
        self.pad = Pad(self.press)
        row = widgets.HBox([self.pad, controls], layout={"flex_flow": "row wrap", "grid_gap": "6px 28px"})
        super().__init__("Drive it yourself", self.view, row)
        self.road.observe(lambda change: self.handle(self._again), "value")
        self.update_with(self.nine)

    @property
    def rollout(self) -> Rollout | None:
        return self.drive.rollout() if self.drive.actions else None

    @property
    def demonstrations(self) -> list[Rollout]:
        return list(self.chosen.values())

    def press(self, action: int) -> None:
        """A button or a key: drive a decision."""
        self.say()
        if self.drive.over:
            self.say("This drive is over: press Drive again, or choose another road.")
        else:
            self.drive.decide(action)
            self.update()

    def update(self, change=None) -> None:
        """Draw the drive where it is now."""
        nine, words = self.futures()
        self.svg = self.view.value = cockpit(self.drive, self.ghost, nine, words)

    def futures(self) -> tuple[list[Trail], str]:
        """The nine imagined drives from here, the best of them bold, and a clause about them; none if switched off."""
        if not self.nine.value or self.drive.over:
            return [], ""
        imagined = nine_drives(np.array(self.drive.recorder.states[-1])[None], self.base, self.scenario)
        return trails(imagined, int(imagined.values[0].argmax())), in_words(imagined)

    def _begin(self, seed: int) -> None:
        self.drive = InteractiveEpisode(seed, self.scenario)
        self.ghost = record(self.rival, [seed], self.scenario, self.name)[0]

    def _again(self) -> None:
        self._begin(int(self.road.value))
        self.update()

    def _keep(self) -> None:
        self.chosen[self.drive] = self.drive.rollout()
        drives, decisions = len(self.chosen), sum(len(drive.actions) for drive in self.demonstrations)
        several = "s" * (drives > 1)
        self.say(f"Kept {drives} demonstration{several}, {decisions} decisions, in PANEL.demonstrations.")


def drive_panel(
    seed: int = 0, ghost: Policy | None = None, scenario: Scenario = DEFAULT, futures: Policy | None = None
) -> DrivePanel:
    """Drive the road of a seed yourself.

    ghost: whom you drive against, a policy such as `agent.as_policy()`; None: the rule. futures: the base policy of
    the nine imagined drives, which the panel then draws from the start. Without one, the switch "nine futures" takes
    the rule. Raises BootcourseError for a seed that is not a whole number in range.
    """
    return DrivePanel(whole(seed, "seed", LAST_ROAD), scenario, ghost, futures)
