"""The rule's drive with another beginning: one action for the first seconds, then what the rule does."""

from functools import cache
from itertools import count, islice

import numpy as np

from bootcourse.episodes.driving import one_episode_each, steps
from bootcourse.learn.settings import settings_for
from bootcourse.policies import PolicyOutput, rule_policy
from bootcourse.scenario import DEFAULT, IDLE

FASTER = 7  # accelerate, straight on
TRIED, SECONDS = 40, 40  # roads; of each drive so much counts: what comes later adds next to nothing
KEPT, SPED = range(21), range(5)  # the seconds that the picture shows


@cache
def worths(action: int, seconds: int) -> np.ndarray:
    """What such a drive is worth at the learners' γ, without a bonus, (TRIED,): that action for so many seconds."""
    clock, rule = count(), rule_policy(DEFAULT)

    def decide(observations: np.ndarray, cars: np.ndarray) -> PolicyOutput:
        chosen = np.asarray(rule(observations, cars).actions)
        return PolicyOutput(np.full_like(chosen, action) if next(clock) < seconds else chosen)

    driven = islice(steps(decide, one_episode_each(TRIED, DEFAULT, None), list(range(TRIED))), SECONDS)
    rewards = np.array([step.rewards * step.running for step in driven])  # fewer seconds if all have crashed
    return settings_for("demos").gamma ** np.arange(len(rewards)) @ rewards


def means(action: int) -> list[float]:
    """The mean worth for each number of seconds that the picture shows; -2.8 and less: all crash."""
    return [float(worths(action, seconds).mean()) for seconds in (KEPT if action == IDLE else SPED)]


def gains(action: int, seconds: int) -> int:
    """On how many roads that many seconds of the action are worth more than one second less."""
    return int((worths(action, seconds) > worths(action, seconds - 1)).sum())
