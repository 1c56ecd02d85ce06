"""What every panel rests on: the number that is dragged and typed, the frame, the road, the drawing."""

import base64
import re
from xml.etree import ElementTree

import ipywidgets as widgets
import numpy as np
import pytest

from bootcourse import one_per_cell, panels
from bootcourse.episodes.record import record
from bootcourse.errors import BootcourseError
from bootcourse.panels.arguments import a_number, an_instance, one_drive
from bootcourse.panels.number import Number
from bootcourse.panels.panel import Panel, beside
from bootcourse.plots import svg
from bootcourse.plots.road import road_svg
from bootcourse.policies import idle_policy
from bootcourse.scenario import DEFAULT, Scenario, check_p
from tests.panels import from_page, inside, raise_in_callbacks, words  # noqa: F401

pytestmark = pytest.mark.usefixtures("raise_in_callbacks")


class Plain(Panel):
    def __init__(self):
        self.number = Number("p", 0.9, 0.12, 0.99, 0.01, "A probability.", check=check_p)
        super().__init__("A panel", beside(self.number))

    def picture(self):
        return svg.drawing(10, 10, [svg.rect(0, 0, 5, 5, svg.INK)], "a < b")


def a_p() -> Number:
    return Number("p", 0.9, 0.12, 0.99, 0.01, "A probability.", unit="share", check=check_p)


def test_a_dragged_number_is_shown_as_typed_and_a_typed_one_as_dragged():
    number = a_p()
    from_page(number.slider, value=0.5)
    assert number.value == number.field.value == 0.5
    from_page(number.field, value=0.25)
    assert number.value == number.slider.value == 0.25


def test_a_number_may_be_typed_beyond_its_slider_if_the_library_accepts_it():
    number = a_p()
    from_page(number.field, value=0.999)
    assert number.value == 0.999
    assert number.slider.value == 0.99


@pytest.mark.parametrize("wrong", [1.0, 0.1, -3.0, float("nan"), float("inf")])
def test_what_the_library_refuses_changes_nothing_and_is_said_below_the_number(wrong):
    number = a_p()
    number.field.value = wrong
    assert number.value == 0.9
    assert str(number.refused) == str(wrong)
    assert "bc-wrong" in number.help.value
    assert "finite" in number.help.value or "is outside [1/9, 1)" in number.help.value
    from_page(number.slider, value=0.4)
    assert number.refused is None
    assert "A probability." in number.help.value


def test_what_was_refused_is_taken_when_there_is_room_for_it_later():
    limit = [1.0]

    def check(value):
        if value > limit[0]:
            raise BootcourseError(f"{value} is above {limit[0]}.")

    number = Number("x", 0.5, 0, 5, 0.1, "Some number.", check=check)
    from_page(number.slider, value=3.0)
    assert (number.value, number.refused) == (0.5, 3.0)
    limit[0] = 4.0
    number.retry()
    assert (number.value, number.refused) == (3.0, None)


def test_a_value_set_by_code_is_checked_too():
    with pytest.raises(BootcourseError, match="outside"):
        a_p().value = 2.0


def test_a_logarithmic_number_moves_in_powers_of_ten():
    number = Number("α", 0.01, -4, 0, 0.05, "A weight.", logarithmic=True)
    from_page(number.slider, value=1e-4)
    assert number.value == number.field.value == 1e-4
    from_page(number.field, value=5.0)
    assert (number.value, number.slider.value) == (5.0, 1.0)


def test_a_locked_number_says_why():
    number = a_p()
    number.lock("It trains.")
    assert number.slider.disabled and number.field.disabled
    assert "It trains." in number.help.value
    number.lock()
    assert not number.slider.disabled
    assert "A probability." in number.help.value


def test_a_number_has_symbol_unit_and_help_where_it_is_seen_and_where_it_is_read_aloud():
    number = a_p()
    assert words(number).split() == ["p", "(share)", "A", "probability."]
    assert number.slider.tooltip == "p: A probability."
    assert number.field.tooltip == "p, typed: A probability."


def test_a_cell_that_runs_again_closes_what_it_showed_and_no_other(monkeypatch):
    monkeypatch.setattr(one_per_cell, "this_cell", lambda: "cell 1")
    first = Plain()
    monkeypatch.setattr(one_per_cell, "this_cell", lambda: "cell 2")
    other = Plain()
    monkeypatch.setattr(one_per_cell, "this_cell", lambda: "cell 1")
    again = Plain()
    assert [first.closed, other.closed, again.closed] == [True, False, False]
    assert set(one_per_cell.running()) == {other, again}


def test_outside_a_notebook_panels_stand_side_by_side():
    first, second = Plain(), Plain()
    assert not first.closed and not second.closed


def test_a_closed_panel_leaves_no_part_of_it_behind():
    before = set(widgets.widget._instances)
    panel = Plain()
    panel.number.slider.value = 0.3
    panel.close()
    panel.close()
    assert set(widgets.widget._instances) == before
    assert one_per_cell.running() == []


@pytest.mark.parametrize(
    "make", ["bonus_panel", "drive_panel", "policy_panel", "scenario_panel", "sweep_panel", "train_panel"]
)
def test_every_panel_that_is_closed_leaves_no_widget_behind(make, escape):
    before = set(widgets.widget._instances)
    panel = getattr(panels, make)(*[escape] * (make == "policy_panel"))
    assert len(widgets.widget._instances) > len(before) + 10
    assert all(button.tooltip for button in inside(panel, widgets.Button)), "a button that does not say what it does"
    panel.close()
    assert set(widgets.widget._instances) == before


def test_a_panel_says_the_librarys_sentence_and_lets_a_bug_through():
    panel = Plain()
    with panel.saying_what_is_wrong():
        raise BootcourseError("p is <wrong>.")
    assert "p is &lt;wrong&gt;." in panel.says.value and 'role="alert"' in panel.says.value
    with pytest.raises(ZeroDivisionError), panel.saying_what_is_wrong():
        _ = 1 / 0
    panel.say()
    assert panel.says.value == ""


def test_a_button_whose_callback_raises_fails_a_test():
    button = widgets.Button()
    button.on_click(lambda _: 1 / 0)
    with pytest.raises(ZeroDivisionError):
        button.click()


def test_a_reader_without_a_kernel_sees_a_picture_with_its_words():
    bundle = Plain()._repr_mimebundle_()
    assert "application/vnd.jupyter.widget-view+json" in bundle
    assert bundle["text/plain"] == "a < b"
    data = re.search(r'src="data:image/svg\+xml;base64,([^"]+)" alt="a &lt; b"', bundle["text/html"]).group(1)
    picture = base64.b64decode(data).decode()
    ElementTree.fromstring(picture)
    assert "var(" not in picture and svg.INK in picture


def test_the_road_shows_every_car_near_the_ego_to_scale():
    drive = record(idle_policy, [0], DEFAULT, "idle")[0]
    parts, height = road_svg(drive.states[0], DEFAULT, "#123456", width=1000, scale=5.0)
    assert height == 3 * 4.0 * 5.0
    drawn = "".join(parts)
    assert drawn.count("#123456") == 1
    assert drawn.count('fill="#7A1F1F" stroke="white"') == 2
    [outline] = re.findall(r'd="M([^"]+)Z" fill="#123456"', drawn)
    places = np.array([point.split() for point in outline.split("L")], dtype=float)
    assert np.ptp(places, axis=0) == pytest.approx([25, 10], abs=0.2)
    ElementTree.fromstring(svg.drawing(1000, height, parts, "a road"))


def test_traps_out_of_the_picture_are_named_with_their_distance():
    cars = record(idle_policy, [0], DEFAULT, "idle")[0].states[0].copy()
    cars[1, 0], cars[2, 0] = cars[0, 0] + 500, cars[0, 0] - 400
    drawn = "".join(road_svg(cars, DEFAULT, "#123456", 1000, 7.0)[0])
    assert "trap 1, 500 m ahead ▸" in drawn and "◂ trap 2, 400 m behind" in drawn


@pytest.mark.parametrize("wrong", [None, 3, "rule", [], [1], np.zeros(3), DEFAULT])
def test_what_is_no_drive_is_refused_in_one_sentence(wrong):
    with pytest.raises(BootcourseError, match="^rollout is .*: give .*drive, such as") as error:
        one_drive(wrong, "rollout")
    assert "\n" not in str(error.value)


@pytest.mark.parametrize("wrong", [None, "2", float("nan"), float("inf"), True, [1]])
def test_what_is_no_number_is_refused_in_one_sentence(wrong):
    with pytest.raises(BootcourseError, match="^xi = .*: give a finite number.$"):
        a_number(wrong, "xi")


def test_an_object_of_another_class_is_refused_by_name():
    with pytest.raises(BootcourseError, match="scenario is an int: give a Scenario."):
        an_instance(3, Scenario, "scenario")
