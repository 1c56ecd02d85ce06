"""`bonus_panel`: targets and crossings against numbers worked by hand, its controls at their ends and beyond."""

import math
from dataclasses import replace
from xml.etree import ElementTree

import numpy as np
import pytest

from bootcourse.episodes.record import record
from bootcourse.errors import BootcourseError
from bootcourse.learn.settings import Settings, settings_for
from bootcourse.panels import bonus_panel
from bootcourse.panels.bonus_numbers import bonus_numbers, targets
from bootcourse.panels.number import Number
from bootcourse.plots.svg import printed
from bootcourse.policies import idle_policy, plan_policy
from bootcourse.scenario import CALIBRATED, DEFAULT
from tests.panels import from_page, inside, raise_in_callbacks, seconds_of_a_drag, words  # noqa: F401

pytestmark = pytest.mark.usefixtures("raise_in_callbacks")


@pytest.fixture
def panel():
    return bonus_panel()


def test_a_target_is_the_discounted_sum_of_what_follows():
    assert np.allclose(targets(np.array([1.0, 0.0, 4.0]), 0.5, terminated=True), [2.0, 2.0, 4.0])


def test_a_drive_that_ran_out_of_time_goes_on_as_it_did():
    assert np.allclose(targets(np.full(30, 0.15625), 0.8), 0.78125)


def test_a_bonus_of_2_adds_10_to_every_demonstrated_target_at_a_discount_of_08():
    rewards = np.random.default_rng(0).random(50)
    assert np.allclose(targets(rewards, 0.8, bonus=2.0) - targets(rewards, 0.8), 10.0)


def test_without_a_future_the_target_is_the_reward_and_the_bonus():
    assert np.allclose(targets(np.array([0.25, 0.5]), 0.0, bonus=1.0), [1.25, 1.5])


@pytest.mark.parametrize("gamma, bonus", [(1.0, 0), (-0.1, 0), (math.nan, 0), (0.8, math.inf), (0.8, math.nan)])
def test_a_discount_or_bonus_that_makes_no_sense_is_refused(gamma, bonus):
    with pytest.raises(BootcourseError, match="give a"):
        targets(np.ones(3), gamma, bonus)


def test_at_the_crossing_both_are_worth_the_same(panel):
    for k in (0, 30, 149):
        settings = replace(Settings(), bonus=float(panel.seen.crossing[k]))
        seen = bonus_numbers(panel.demonstration, panel.trapped, settings)
        assert seen.augmented[k] == pytest.approx(seen.trapped[k], abs=1e-9)


def test_the_crossing_is_the_difference_over_what_a_bonus_of_1_adds(panel):
    seen = panel.seen
    assert np.allclose(seen.weight, 5.0)
    assert np.allclose(seen.crossing, (seen.trapped - seen.plain) / 5)
    assert np.allclose(seen.trapped, 0.15625 / 0.2)  # staying behind earns 0.15625 at each decision


def test_the_share_of_demonstrations_fades_the_bonus_in_a_straight_line(panel):
    for episode, beta in ((0, 0.6), (500, 0.3), (1000, 0.0), (1500, 0.0)):
        from_page(panel.episode.slider, value=float(episode))
        assert panel.seen.beta == pytest.approx(beta)
        assert np.allclose(panel.seen.shared, panel.seen.plain + 5 * 2 * beta)


def test_a_demonstration_that_ends_in_an_accident_is_worth_nothing_afterwards():
    crash = record(plan_policy([("keep right", 20)]), [0], DEFAULT, "you")[0]
    assert crash.accident
    panel = bonus_panel(crash)
    seen = panel.seen
    assert "less towards the accident" in panel.svg.alt
    assert seen.plain[-1] == pytest.approx(crash.rewards[-1])
    assert seen.weight[-1] == 1.0 and len(seen.trapped) == len(crash.actions)


def test_every_number_at_both_ends_and_at_nonsense_leaves_a_drawing_of_the_same_size(panel):
    size = panel.svg.split(' role="img"')[0]
    for number in inside(panel, Number):
        for value in (number.slider.min, number.slider.max, -7.5, 1e9 + 0.5, float("nan")):
            number.field.value = value
            ElementTree.fromstring(panel.svg)
            assert panel.svg.split(' role="img"')[0] == size
            assert "nan" not in panel.svg
        assert number.refused is not None and "bc-wrong" in number.help.value
        middle = round((number.slider.min + number.slider.max) / 2)
        from_page(number.slider, value=middle)
        assert number.value == middle and number.refused is None


def test_dragging_c_moves_the_demonstration_and_not_the_trapped_drive(panel):
    trapped = panel.seen.trapped
    seconds = seconds_of_a_drag(panel.c.slider, [round(0.05 * i, 2) for i in range(40)])
    assert np.allclose(panel.seen.augmented, panel.seen.plain + 5 * 1.95)
    assert np.array_equal(panel.seen.trapped, trapped) and panel.view.value == panel.svg
    assert seconds < 0.05, f"{1000 * seconds:.1f} ms"  # 3 ms on a quiet machine


def test_with_an_infinite_sight_the_panel_says_to_stay_below_1(panel):
    from_page(panel.gamma.field, value=1.0)
    assert "give less than 1" in words(panel) and panel.gamma.value == 0.8
    with pytest.raises(BootcourseError, match="less than 1"):
        bonus_panel(settings=Settings(gamma=1.0))


def test_a_method_without_a_bonus_keeps_it_at_0():
    panel = bonus_panel(settings=settings_for("margin"))
    assert panel.c.value == 0
    from_page(panel.c.slider, value=2.0)
    assert panel.c.value == 0 and "choose a method that has it" in words(panel)


def test_the_trapped_drive_given_alone_gets_the_rule_on_its_own_road():
    idle = record(idle_policy, [7], CALIBRATED, "idle")[0]
    panel = bonus_panel(trapped=idle)
    assert (panel.demonstration.seed, panel.demonstration.scenario) == (7, CALIBRATED)


def test_two_drives_of_one_driver_get_two_colours():
    first, second = record(idle_policy, [0, 1], DEFAULT, "idle")
    bonus_panel(first, second)


@pytest.mark.parametrize("wrong", [[], 3, "drive.npz", DEFAULT])
def test_what_is_no_drive_is_refused_in_one_sentence(wrong):
    for name in ("demonstration", "trapped"):
        with pytest.raises(BootcourseError, match=f"{name} is .*: give"):
            bonus_panel(**{name: wrong})


def test_settings_of_another_kind_and_drives_of_two_scenarios_are_refused(panel):
    with pytest.raises(BootcourseError, match="settings is a dict: give a Settings"):
        bonus_panel(settings={"bonus": 2})
    other = record(idle_policy, [0], CALIBRATED, "idle")[0]
    with pytest.raises(BootcourseError, match="different scenarios"):
        bonus_panel(panel.demonstration, other)


def test_the_picture_says_what_the_numbers_say(panel):
    panel.moment.value = 2.0
    picture = printed(panel.picture()).decode()
    assert "var(" not in picture
    assert "staying behind 0.78: it leads from c = 0.0" in panel.picture().alt
    assert "A bonus of 2 adds 10 to the target" in picture
