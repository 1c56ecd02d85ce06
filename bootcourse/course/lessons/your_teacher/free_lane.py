"""What the drives show from which students learn: how long they are in the free lane, and whether they crash."""

from functools import cache

from bootcourse.episodes.driving import one_episode_each, steps
from bootcourse.learn.demonstrations import FIRST_SEED
from bootcourse.learn.settings import Settings
from bootcourse.learn.teachers import teacher_policy
from bootcourse.research.teachers import teacher_named
from bootcourse.road.state import EGO, LANE
from bootcourse.scenario import DEFAULT


@cache
def shown(teacher: str) -> tuple[float, float]:
    """(seconds of a drive in the free lane, share of drives that crash) of what a teacher demonstrates; means."""
    roads, decisions, crashed = Settings.demonstration_episodes, 0, 0
    seeds = range(FIRST_SEED, FIRST_SEED + roads)
    for step in steps(teacher_policy(teacher_named(teacher)), one_episode_each(roads, DEFAULT, None), list(seeds)):
        decisions += int((step.running & (step.cars[:, EGO, LANE] == 0)).sum())
        crashed += int((step.running & step.terminated).sum())
    return decisions / DEFAULT.clock.decision_rate / roads, crashed / roads
