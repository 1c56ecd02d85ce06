"""The car drives on by the compromise between an agent's Q and the rule, beside the agent's own way and the rule's."""

from typing import NamedTuple

import numpy as np
import torch

from bootcourse.colours import ALARM
from bootcourse.episodes.lookahead import imagine
from bootcourse.episodes.rollout import Rollout
from bootcourse.episodes.words import ACCIDENTS
from bootcourse.learn.agent import Agent
from bootcourse.learn.bootstrap import log_stochastic_rule, regularised_policy
from bootcourse.markup import Markup, html, joined
from bootcourse.methods import style
from bootcourse.plots.futures import Trail
from bootcourse.plots.svg import INK
from bootcourse.policies import Policy, PolicyOutput, rule_policy
from bootcourse.road.state import Accident
from bootcourse.rule import rule
from bootcourse.scenario import Scenario

SECONDS = 40  # driven on, about 10 ms of computing
OWN, BY_RULE, CHOSEN = "the agent's way", "the rule's way", "this compromise"


class Way(NamedTuple):
    """A drive on from one decision."""

    path: np.ndarray  # (points, 2) m, x and y
    accident: int  # an `Accident`'s number
    seconds: float  # until its end

    @property
    def words(self) -> str:
        """ "599 m in 40 s", or how and when it ends."""
        if self.accident != Accident.NONE:
            return f"{ACCIDENTS[Accident(self.accident)]} after {self.seconds:g} s"
        return f"{self.path[-1, 0] - self.path[0, 0]:.0f} m in {self.seconds:g} s"


def compromise(agent: Agent, scenario: Scenario, p: float, xi: float, alpha: float) -> Policy:
    """Drives the most probable action of softmax((Q + ξ log π̃) / (α + ξ)), see `regularised_policy`.

    p, xi, alpha: as in `policy_numbers`. The agent has critics.
    """

    def drive(observations: np.ndarray, cars: np.ndarray) -> PolicyOutput:
        by_rule = torch.from_numpy(np.asarray(rule(cars, scenario).actions))
        log_rule = log_stochastic_rule(by_rule, torch.tensor(p, dtype=torch.float64))
        q = torch.from_numpy(np.asarray(agent.q_values(observations), dtype=np.float64))
        return PolicyOutput(regularised_policy(q, log_rule, alpha, xi).argmax(-1).numpy())

    return drive


def drive_on(rollout: Rollout, k: int, policy: Policy) -> Way:
    """Drive on from decision k of a recorded drive for `SECONDS`, or to its end, by a policy."""
    clock, cars = rollout.scenario.clock, rollout.cars[k][None].copy()
    horizon = min(SECONDS * clock.decision_rate, clock.decisions - k)
    observation = np.asarray(rollout.observations[k][None], dtype=np.float32)
    first = np.asarray(policy(observation, cars).actions)[:, None]
    imagined = imagine(cars, first, policy, int(horizon), rollout.scenario)
    path = imagined.paths[0, 0]
    moves = np.flatnonzero(np.any(np.diff(path, axis=0) != 0, axis=1))
    ended = imagined.accidents[0, 0] != 0
    seconds = (moves[-1] + 1 if ended and len(moves) else horizon) / clock.decision_rate
    return Way(path, int(imagined.accidents[0, 0]), seconds)


class Ways:
    """The three ways on from a decision; those that p and ξ do not change are kept."""

    def __init__(self, rollout: Rollout, agent: Agent):
        self.rollout, self.agent, self._kept = rollout, agent, {}

    def at(self, k: int, p: float, xi: float, alpha: float) -> dict[str, Way]:
        """{OWN: ..., BY_RULE: ..., CHOSEN: ...} from decision k."""
        if k not in self._kept:
            ways = {OWN: self.agent.as_policy(), BY_RULE: rule_policy(self.rollout.scenario)}
            self._kept = {k: {name: drive_on(self.rollout, k, policy) for name, policy in ways.items()}}
        chosen = compromise(self.agent, self.rollout.scenario, p, xi, alpha)
        return self._kept[k] | {CHOSEN: drive_on(self.rollout, k, chosen)}

    def trails(self, ways: dict[str, Way]) -> list[Trail]:
        """To be drawn on the road, the compromise on top; red if it ends in an accident."""
        colours = {OWN: style(self.rollout.label).colour, BY_RULE: style("rule").colour, CHOSEN: INK}
        return [
            Trail(*way.path.T, ALARM if way.accident else colours[name], name == CHOSEN, 0, way.accident != 0)
            for name, way in ways.items()
        ]


def in_words(ways: dict[str, Way]) -> str:
    """ "From here, the agent's way: 599 m in 40 s; the rule's way: 449 m in 40 s; ...": one sentence."""
    return "From here, " + "; ".join(f"{name}: {way.words}" for name, way in ways.items()) + "."


def in_page(ways: dict[str, Way], drawn: list[Trail]) -> Markup:
    """The same for a page, each way behind a piece of its line on the road."""
    page = '<i style="display:inline-block;width:22px;height:{}px;background:{};vertical-align:middle"></i> {}: {}'
    looks = ((4 if trail.chosen else 2, "currentColor" if trail.colour == INK else trail.colour) for trail in drawn)
    named = (html(page, *look, name, way.words) for look, (name, way) in zip(looks, ways.items(), strict=True))
    return html('<div class="bc-says">From here, {}.</div>', joined(named, "; "))
