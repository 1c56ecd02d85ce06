"""`bonus_panel`: targets and crossings against numbers worked by hand, and one walk through its controls."""

from dataclasses import replace
from xml.etree import ElementTree

import numpy as np
import pytest

from bootcourse.episodes.record import record
from bootcourse.errors import BootcourseError
from bootcourse.learn.settings import Settings, settings_for
from bootcourse.panels import bonus_panel
from bootcourse.panels.bonus_numbers import bonus_numbers, targets
from bootcourse.policies import idle_policy, plan_policy
from bootcourse.scenario import CALIBRATED, DEFAULT
from tests.panels import at_its_ends, from_page, raise_in_callbacks, words  # noqa: F401

pytestmark = pytest.mark.usefixtures("raise_in_callbacks")


@pytest.fixture
def panel():
    return bonus_panel()


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


def test_at_the_crossing_both_are_worth_the_same(panel):
    seen = panel.seen
    assert np.allclose(seen.weight, 5.0) and np.allclose(seen.crossing, (seen.trapped - seen.plain) / 5)
    assert np.allclose(seen.trapped, 0.15625 / 0.2)  # staying behind earns 0.15625 at each decision
    for k in (0, 30, 149):
        settings = replace(Settings(), bonus=float(seen.crossing[k]))
        crossed = bonus_numbers(panel.demonstration, panel.trapped, settings)
        assert crossed.augmented[k] == pytest.approx(crossed.trapped[k], abs=1e-9)


def test_every_control_moves_its_own_numbers_and_the_picture_and_refuses_nonsense(panel):
    trapped, before = panel.seen.trapped, panel.svg
    from_page(panel.c.slider, value=1.95)
    assert np.allclose(panel.seen.augmented, panel.seen.plain + 5 * 1.95)
    assert np.array_equal(panel.seen.trapped, trapped) and panel.view.value == panel.svg != before
    panel.c.value, panel.moment.value = 2.0, 2.0
    assert "staying behind 0.78: it leads from c = 0.0" in panel.svg.alt
    assert "A bonus of 2 adds 10 to the target" in panel.svg.alt
    for episode, beta in ((0, 0.6), (500, 0.3), (1000, 0.0), (1500, 0.0)):
        from_page(panel.episode.slider, value=float(episode))
        assert panel.seen.beta == pytest.approx(beta)
        assert np.allclose(panel.seen.shared, panel.seen.plain + 5 * 2 * beta)
    for number in (panel.c, panel.gamma, panel.moment, panel.episode):
        at_its_ends(panel, number)
    from_page(panel.gamma.field, value=1.0)
    assert "give less than 1" in words(panel) and panel.gamma.value < 1


def test_a_demonstration_that_ends_in_an_accident_is_worth_nothing_afterwards():
    crash = record(plan_policy([("keep right", 20)]), [0], DEFAULT, "you")[0]
    panel = bonus_panel(crash)
    assert panel.seen.plain[-1] == pytest.approx(crash.rewards[-1]) and panel.seen.weight[-1] == 1.0
    assert len(panel.seen.trapped) == len(crash.actions) and "less towards the accident" in panel.svg.alt


def test_a_method_without_a_bonus_keeps_it_at_0():
    panel = bonus_panel(settings=settings_for("margin"))
    from_page(panel.c.slider, value=2.0)
    assert panel.c.value == 0 and "choose a method that has it" in words(panel)


def test_a_drive_given_alone_gets_the_other_on_its_own_road_and_one_of_another_scenario_is_refused():
    idle, other = record(idle_policy, [7, 8], CALIBRATED, "idle")
    panel = bonus_panel(trapped=idle)
    assert (panel.demonstration.seed, panel.demonstration.scenario) == (7, CALIBRATED)
    both = bonus_panel(other, idle)
    assert both.own.colour != both.other.colour, "two drives of one driver"
    ElementTree.fromstring(both.svg)
    with pytest.raises(BootcourseError, match="different scenarios"):
        bonus_panel(bonus_panel().demonstration, idle)
