"""`bonus_panel`: targets and crossings against numbers worked by hand, and one walk through its controls."""

from dataclasses import replace

import numpy as np
import pytest

from bootcourse.episodes.record import record
from bootcourse.learn.settings import Settings
from bootcourse.panels import bonus_panel
from bootcourse.panels.bonus import bonus_numbers, targets
from bootcourse.policies import plan_policy
from bootcourse.scenario import DEFAULT
from tests.panels import at_its_ends, from_page, raise_in_callbacks, words  # noqa: F401

pytestmark = pytest.mark.usefixtures("raise_in_callbacks")


@pytest.mark.parametrize(
    "rewards, gamma, options, worth",
    [
        ([1.0, 0.0, 4.0], 0.5, {"terminated": True}, [2.0, 2.0, 4.0]),
        ([0.15625] * 3, 0.8, {}, [0.78125] * 3),  # a drive that ran out of time goes on as it did
        ([0.25, 0.5], 0.0, {"bonus": 1.0}, [1.25, 1.5]),  # without a future: the reward and the bonus
        ([0.0] * 3, 0.8, {"bonus": 2.0}, [10.0] * 3),
    ],
)
def test_a_target_is_the_discounted_sum_of_what_follows(rewards, gamma, options, worth):
    assert np.allclose(targets(np.array(rewards), gamma, **options), worth)


def test_at_the_crossing_both_are_worth_the_same_and_every_control_moves_the_picture():
    panel = bonus_panel()
    seen = panel.seen
    assert np.allclose(seen.weight, 5.0) and np.allclose(seen.crossing, (seen.trapped - seen.plain) / 5)
    assert np.allclose(seen.trapped, 0.15625 / 0.2)  # staying behind earns 0.15625 at each decision
    for k in (0, 30, 149):
        settings = replace(Settings(), bonus=float(seen.crossing[k]))
        crossed = bonus_numbers(panel.demonstration, panel.trapped, settings)
        assert crossed.augmented[k] == pytest.approx(crossed.trapped[k], abs=1e-9)
    before = panel.svg
    assert "A bonus of 2 adds 10 to its target" in before.alt
    from_page(panel.c.slider, value=1.95)
    assert np.allclose(panel.seen.augmented, seen.plain + 5 * 1.95) and panel.view.value == panel.svg != before
    for number in (panel.c, panel.gamma):
        at_its_ends(panel, number)
    from_page(panel.gamma.field, value=1.0)
    assert "0 or more, below 1" in words(panel) and panel.gamma.value < 1


def test_a_demonstration_that_ends_in_an_accident_is_worth_nothing_afterwards(idle):
    [crash] = record(plan_policy([("keep right", 20)]), [0], DEFAULT, "you")
    seen = bonus_numbers(crash, idle, Settings())
    assert seen.plain[-1] == pytest.approx(crash.rewards[-1]) and seen.weight[-1] == 1.0
    assert len(seen.trapped) == len(crash.actions)
