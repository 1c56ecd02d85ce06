"""The critic's target along a drive, with and without the bonus c on its rewards.

`bonus.py` draws these numbers and lets you move c. The bonus is r'(s, a_E) = r(s, a_E) + c
(Section IV-B, "Demonstration-Guided Reward Augmentation"); it and the target are computed in `bootcourse.learn`.
"""

from dataclasses import dataclass

import numpy as np

from bootcourse.episodes.rollout import Rollout
from bootcourse.errors import BootcourseError
from bootcourse.learn import sac
from bootcourse.learn.bootstrap import augmented_reward, demonstration_share
from bootcourse.learn.settings import Settings

LAST = 10  # decisions whose mean reward goes on for ever after a drive that ran out of time


@dataclass(frozen=True)
class BonusNumbers:
    """The targets of two drives at each decision, each array (T,), up to the end of the shorter drive."""

    plain: np.ndarray  # of the demonstration without a bonus
    augmented: np.ndarray  # with c on every reward
    shared: np.ndarray  # with β c: the mean over a batch in which the share β are demonstrations
    trapped: np.ndarray  # of the drive that stays behind
    crossing: np.ndarray  # the c above which the demonstration's target is higher; below 0: higher without a bonus
    weight: np.ndarray  # what a bonus of 1 adds to the demonstration's target
    beta: float


def targets(rewards: np.ndarray, gamma: float, bonus: float = 0.0, terminated: bool = False) -> np.ndarray:
    """y_t = Σ_k γ^k (r_{t+k} + c), computed backwards from the end of a drive: (T,) -> (T,).

    terminated: nothing follows (an accident); otherwise the mean of the last ten rewards goes on for ever.
    gamma in [0, 1). Raises BootcourseError for a gamma outside, or a bonus that is not finite.
    """
    if not 0 <= gamma < 1:
        raise BootcourseError(f"gamma = {gamma!r}: give a discount of 0 or more, below 1.")
    if not np.isfinite(bonus):
        raise BootcourseError(f"bonus = {bonus!r}: give a finite number.")
    rewards = augmented_reward(np.asarray(rewards, dtype=np.float64), 1.0, bonus)
    following = float(rewards[-LAST:].mean() / (1 - gamma))
    worth = np.empty(len(rewards))
    for k in range(len(rewards) - 1, -1, -1):
        following = worth[k] = sac.critic_target(rewards[k], terminated and k == len(rewards) - 1, following, gamma)
    return worth


def bonus_numbers(demonstration: Rollout, trapped: Rollout, settings: Settings, episode: int = 0) -> BonusNumbers:
    """The targets of both drives with the settings' γ and c, after that many episodes of training.

    y is linear in c: a bonus of 1 adds the target of a drive that earns 1 at each decision.
    """
    gamma, c = settings.gamma, settings.bonus
    beta = float(demonstration_share(episode, settings.beta_start, settings.beta_episodes))
    length, crashed = min(len(demonstration.rewards), len(trapped.rewards)), bool(demonstration.accident)

    def worth(bonus):
        return targets(demonstration.rewards, gamma, bonus, crashed)[:length]

    plain, behind = worth(0.0), targets(trapped.rewards, gamma, 0.0, bool(trapped.accident))[:length]
    weight = targets(np.ones(len(demonstration.rewards)), gamma, 0.0, crashed)[:length]
    return BonusNumbers(plain, worth(c), worth(beta * c), behind, (behind - plain) / weight, weight, beta)
