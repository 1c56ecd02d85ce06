"""Plain SAC on the road with one thing made easier.

    bootcourse study easier --out DIR    # some minutes

`LaneKeeper`: the nine actions are wishes that a lane keeper carries out, so attempts to leave are better driven.
`LaterStart`: an episode begins after the 8 s in which the lesson's plan steers, on the free lane, behind the traps and
as fast as they are. (One second later a car passes them even if it does nothing.) The plan leaves the car 1.9 m left of
the lane's middle, so each action that steers left ends the drive; `MidLaneStart` puts it in the middle. In a third kind
the temperature does not fall to 0, either. `costing`: an accident ends the drive, and costs less or nothing. Each kind
has ten agents with the paper's γ and ten that look further ahead; they learn by themselves, as those of the lesson's
first round do. Four kinds, which carry the lesson's verdict, are stressed: other seeds, and twice the updates.
"""

from collections.abc import Callable
from dataclasses import replace
from functools import cache
from pathlib import Path

import numpy as np

from bootcourse.course.lessons.the_barrier.attempts import PLAN, drive, keep_lane
from bootcourse.episodes.evaluate import held_out_seeds
from bootcourse.learn.settings import settings_for, with_seeds
from bootcourse.learn.training import Training
from bootcourse.policies import idle_policy
from bootcourse.research.cells import results_of, tested_results
from bootcourse.research.experiment import Computed, Experiment
from bootcourse.research.jobs import Interrupted, orphaned
from bootcourse.research.results import Results
from bootcourse.research.tables import bracketed, escaped, markdown
from bootcourse.research.teachers import RULE
from bootcourse.road import twin
from bootcourse.road.state import EGO, LANE, SPEED, Y
from bootcourse.road.vector_env import TrapVectorEnv
from bootcourse.scenario import DEFAULT, Scenario
from bootcourse.statistics import interval

SEEDS, GAMMAS = 10, (0.8, 0.95)
UPDATES = 2_000  # as the agents of the lesson have
EPISODES = 4_000  # more than any of these trainings drives
TESTS = 200  # held-out roads
LATER = 8  # s


class LaneKeeper(TrapVectorEnv):
    """The road, with other actions: 3 (1 + turn) + 1 + pace, each of the two -1, 0 or 1.

    A lane keeper steers to the middle of the lane on the left (turn -1), of its own, or of the one on the right, and
    wants to be slower by 1 m/s (pace -1), as fast, or faster.
    """

    def step(self, actions):
        cars, actions = self.cars, np.asarray(actions)
        lanes = np.clip(cars[:, EGO, LANE] + actions // 3 - 1, 0, self.scenario.road.lanes - 1)
        return super().step(keep_lane(cars, cars[:, EGO, SPEED] + actions % 3 - 1, lanes))


class LaterStart(TrapVectorEnv):
    """The road after the first `LATER` seconds of the lesson's plan. Where these have an accident, another is drawn."""

    def _start(self, mask: np.ndarray) -> None:
        while mask.any():
            super()._start(mask)
            accidents = np.where(mask, 0, 1)
            for action in PLAN[:LATER]:
                actions, asleep = np.full(self.num_envs, action), accidents != 0
                rewards, terms = np.zeros(self.num_envs), np.zeros((self.num_envs, 3))
                twin.decide(self.cars, actions, asleep, self.constants, rewards, terms, accidents, twin.NO_TRACE)
            self.decisions[mask] = LATER
            mask = mask & (accidents != 0)


class MidLaneStart(LaterStart):
    """The same, with the ego put in the middle of the free lane."""

    def _start(self, mask: np.ndarray) -> None:
        super()._start(mask)
        self.cars[mask, EGO, Y] = 0.0


def costing(price: float, road: type[TrapVectorEnv] = TrapVectorEnv) -> Callable[..., TrapVectorEnv]:
    """A road, where an accident ends the drive and costs this much in place of 10: as `TrapVectorEnv`."""

    def make_env(roads: int, scenario: Scenario = DEFAULT, *more) -> TrapVectorEnv:
        return road(roads, replace(scenario, reward=replace(scenario.reward, accident=-price)), *more)

    return make_env


MIDDLE, CHEAP = "a later start, mid-lane", "accidents cost 1"
BOTH, FREE = "mid-lane, and accidents cost 1", "free accidents"
KEPT = "a lane keeper and cheap accidents"  # they cost 1, too
TWICE = ", twice the updates"
KINDS: dict[str, tuple[Callable, dict]] = {  # what makes the roads, and the settings that differ
    "as it is": (TrapVectorEnv, {}),
    "a lane keeper": (LaneKeeper, {}),
    "a later start": (LaterStart, {}),
    MIDDLE: (MidLaneStart, {}),
    "a later start, η = 1": (LaterStart, {"target_entropy": 1.0}),
    FREE: (costing(0.0), {}),
    CHEAP: (costing(1.0), {}),
    KEPT: (costing(1.0, LaneKeeper), {}),
    BOTH: (costing(1.0, MidLaneStart), {}),
}

SHOWN = {  # the kinds whose agents the lesson shows, by start and price, in its words
    ("start in the trap", "an accident costs 10"): "as it is",
    ("start in the trap", "an accident costs 1"): CHEAP,
    ("start in the free lane", "an accident costs 10"): MIDDLE,
    ("start in the free lane", "an accident costs 1"): BOTH,
}


@cache
def staying(kind: str) -> float:
    """The return of a car that stays behind trap 1, mean of 100 roads of a kind."""
    return float(drive(idle_policy, held_out_seeds(7, 100), KINDS[kind][0]).values(1.0).mean())


def train_kind(kind: str, first_seed: int, updates: int) -> Results:
    """Train the agents of a kind side by side. Raises Interrupted.

    Tested: on the study's first held-out roads, as this kind drives them, by the most probable action.
    """
    make_env, changes = KINDS[kind]
    alike = [settings_for("sac", gamma=gamma, **changes) for gamma in GAMMAS]
    settings = [agent for each in alike for agent in with_seeds(each, SEEDS, first_seed)]
    training = Training(settings, EPISODES * updates // UPDATES, make_env=make_env)
    result = training.run(progress=False, updates=updates, stop=orphaned)
    if training.updates < updates:
        raise Interrupted(kind)
    return tested_results(result, TESTS, RULE, make_env)


def stressed(kind: str) -> str:
    """The cell of the same kind with other seeds and twice the updates."""
    return kind + TWICE


CELLS = {kind: {"kind": kind, "first_seed": 0, "updates": UPDATES} for kind in KINDS} | {
    stressed(kind): {"kind": kind, "first_seed": SEEDS, "updates": 2 * UPDATES} for kind in (MIDDLE, CHEAP, KEPT, BOTH)
}
SECTION = f"""Plain SAC, {SEEDS} agents with each γ of {GAMMAS[0]} and {GAMMAS[1]}, {UPDATES:,} updates each, on roads
where one thing or two are easier; tested on {TESTS} such roads.
"""


def section(computed: dict[str, Computed], folder: Path) -> list[str]:
    """Who escapes on the easier roads, and what they earn."""
    rows = [
        [kind, escaped(agents, "sac"), bracketed(interval(agents.scores("returns"))),
         f"{100 * agents.scores('accident').mean():.1f}"]
        for kind, agents in computed["easier"].items()
    ]  # fmt: skip
    headings = ["road", "escape", "return [95 %]", "accidents, %"]
    return ["## Plain SAC where the trap is easier to leave\n", SECTION, markdown(headings, rows)]


EXPERIMENT = Experiment("easier", lambda: CELLS, results_of(train_kind), ("success", "alpha"), section)
