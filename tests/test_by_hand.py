"""A drive decision by decision, and any drives as demonstrations."""

import numpy as np
import pytest
import torch

from bootcourse.episodes.interactive import InteractiveEpisode
from bootcourse.episodes.record import record
from bootcourse.episodes.rollout import Rollout, interpolate_states
from bootcourse.errors import BootcourseError
from bootcourse.learn.demonstrations import FIRST_SEED, collect, demonstration_rows
from bootcourse.learn.settings import settings_for
from bootcourse.learn.training import Training
from bootcourse.policies import plan_policy, rule_policy
from bootcourse.scenario import ACTION_NAMES, CALIBRATED, DEFAULT, IDLE

SMALL = {"hidden": (16, 16), "demonstration_episodes": 2, "learning_starts": 8}


def same(a: Rollout, b: Rollout) -> bool:
    names = ("states", "observations", "actions", "rewards", "terms", "rule_actions", "rule_reasons")
    return a.accident == b.accident and all(np.array_equal(getattr(a, n), getattr(b, n)) for n in names)


def test_a_drive_by_hand_is_the_drive_that_is_recorded_of_the_same_actions():
    recorded = record(rule_policy(DEFAULT), [3], label="you")[0]
    drive = InteractiveEpisode(3)
    for action in recorded.actions:
        drive.decide(int(action))
    assert drive.over and same(drive.rollout(), recorded) and drive.rollout().label == "you"
    assert sum(drive.rewards) == pytest.approx(recorded.rewards.sum()) and drive.terms == tuple(recorded.terms[-1])


def test_an_accident_ends_the_drive_where_it_happened():
    recorded = record(plan_policy([("keep right", 30)]), [3])[0]
    drive = InteractiveEpisode(3)
    while not drive.over:
        drive.decide(ACTION_NAMES.index("keep right"))
    assert recorded.accident and same(drive.rollout(), recorded)
    with pytest.raises(BootcourseError, match="over"):
        drive.decide(IDLE)


@pytest.mark.parametrize("nonsense", [-1, 9, 1.5, "left", True, None])
def test_an_action_that_is_none_is_refused_and_changes_nothing(nonsense):
    drive = InteractiveEpisode(0)
    with pytest.raises(BootcourseError, match="give a whole number"):
        drive.decide(nonsense)
    assert drive.time == 0.0


def test_between_two_steps_cars_are_between_and_headings_turn_the_short_way():
    states = np.zeros((2, 1, 10))
    states[:, 0, 0], states[:, 0, 2] = (0, 10), (3.1, -3.1)
    middle = interpolate_states(states, 0.5)
    assert middle[0, 0] == 5 and abs(abs(middle[0, 2]) - np.pi) < 1e-9
    assert interpolate_states(states, -1)[0, 0] == 0 and interpolate_states(states, 7)[0, 0] == 10


def test_the_rule_s_recorded_drives_are_the_demonstrations_that_it_drives_itself():
    mine = demonstration_rows(record(rule_policy(DEFAULT), [FIRST_SEED, FIRST_SEED + 1]))
    own = collect(2)
    assert mine.dtype == own.dtype and mine.shape == own.shape
    assert torch.equal(torch.unique(mine, dim=0), torch.unique(own, dim=0))


def test_only_an_accident_is_an_end_without_a_future():
    crash = record(plan_policy([("keep right", 30)]), [3])[0]
    n = 2 * DEFAULT.observation_size
    assert demonstration_rows([crash])[-1, n + 2] == 1 and demonstration_rows([crash])[:-1, n + 2].sum() == 0
    assert demonstration_rows(record(rule_policy(DEFAULT), [3]))[:, n + 2].sum() == 0


def test_what_cannot_be_bootstrapped_is_refused():
    drives = record(rule_policy(DEFAULT), [5])
    with pytest.raises(BootcourseError, match="no demonstration"):
        demonstration_rows([])
    with pytest.raises(BootcourseError, match="different scenarios"):
        demonstration_rows([*drives, *record(rule_policy(CALIBRATED), [5], CALIBRATED)])
    with pytest.raises(BootcourseError, match="'sac' uses no demonstrations"):
        Training([settings_for("sac", **SMALL)], 2, demonstrations=drives)
    with pytest.raises(BootcourseError, match="another scenario"):
        others = record(rule_policy(CALIBRATED), [5], CALIBRATED)
        Training([settings_for("demos", **SMALL)], 2, demonstrations=others)
