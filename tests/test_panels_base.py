"""What every panel rests on: the number that is dragged and typed, the frame, the drawing, what is refused."""

import base64
import math
import re
from xml.etree import ElementTree

import ipywidgets as widgets
import numpy as np
import pytest

from bootcourse import one_per_cell, panels
from bootcourse.errors import BootcourseError
from bootcourse.panels import policy_panel, train_panel
from bootcourse.panels.bonus import targets
from bootcourse.panels.number import Number
from bootcourse.panels.panel import Panel
from bootcourse.panels.policy_numbers import policy_numbers
from bootcourse.plots import svg
from bootcourse.scenario import check_p
from tests.panels import from_page, inside, raise_in_callbacks, words  # noqa: F401

pytestmark = pytest.mark.usefixtures("raise_in_callbacks")
NAN, INF = math.nan, math.inf


class Plain(Panel):
    svg = svg.drawing(10, 10, [svg.rect(0, 0, 5, 5, svg.INK)], "a < b")


def a_p() -> Number:
    return Number("p", 0.9, 0.12, 0.99, 0.01, "A probability.", unit="share", check=check_p)


def test_a_logarithmic_slider_is_read_to_two_digits_and_a_typed_number_as_it_is():
    number = Number("ξ", 200, 0.1, 10_000, 0.05, "A strength.", logarithmic=True)
    from_page(number.slider, value=10**2.25)
    assert number.value == number.field.value == 180
    assert number.slider.value == 10**2.25, "nobody moves a slider that is being dragged"
    from_page(number.field, value=177.5)
    assert number.value == 177.5 and number.slider.value == pytest.approx(177.5)
    from_page(number.field, value=0)
    assert number.value == 0 and number.slider.value == pytest.approx(0.1), "the slider stands at its end"


def test_a_typed_number_stays_when_the_page_moves_the_slider_to_its_nearest_step():
    bonus = Number("c", 0.5, 0.001, 3, 0.05, "A bonus.", logarithmic=True)
    bonus.field.value = 0.03
    bonus.slider.value = 10**-1.5  # what a browser reports
    assert bonus.value == bonus.field.value == 0.03
    bonus.slider.value = 10**-1.4  # what a hand does
    assert bonus.value == 0.04


def test_slider_and_field_show_the_same_number_and_a_typed_one_may_lie_beyond_the_slider():
    number = a_p()
    from_page(number.slider, value=0.5)
    assert number.value == number.field.value == 0.5
    from_page(number.field, value=0.25)
    assert number.value == number.slider.value == 0.25
    from_page(number.field, value=0.999)
    assert (number.value, number.slider.value) == (0.999, 0.99)
    assert words(number).split() == ["p", "(share)", "A", "probability."]


def test_a_refused_number_changes_nothing_but_the_sentence():
    number = a_p()
    for wrong in (1.0, 0.1, NAN, INF):
        from_page(number.field, value=wrong)
        assert number.value == 0.9 and ("finite" in words(number) or "is outside [1/9, 1)" in words(number))
    from_page(number.slider, value=0.4)
    assert (number.value, words(number).split()[-1]) == (0.4, "probability.")


def test_a_cell_that_runs_again_closes_what_it_showed_and_no_other(monkeypatch):
    shown = []
    for cell in ("cell 1", "cell 2", "cell 1", None, None):
        monkeypatch.setattr(one_per_cell, "this_cell", lambda cell=cell: cell)
        shown.append(Plain("A panel"))
    assert [panel.closed for panel in shown] == [True, False, False, False, False]
    assert set(one_per_cell.running()) == set(shown[1:])


@pytest.mark.parametrize("make", [name for name in vars(panels) if name.endswith("_panel")])
def test_every_panel_explains_its_buttons_has_a_picture_and_leaves_no_widget_behind(make, escape):
    before = set(widgets.widget._instances)
    panel = getattr(panels, make)(*[escape] * (make == "policy_panel"))
    assert all(button.tooltip for button in inside(panel, widgets.Button))
    page = panel._repr_mimebundle_()["text/html"]
    [data] = re.findall(r'src="data:image/svg\+xml;base64,([^"]+)" alt="[^"]{20,}"', page)
    picture = base64.b64decode(data).decode()
    ElementTree.fromstring(picture)
    assert "var(" not in picture and svg.INK in picture, "a reader without a kernel sees the figures' colours"
    panel.close()
    panel.close()
    assert set(widgets.widget._instances) == before and one_per_cell.running() == []


def test_a_panel_escapes_the_librarys_sentence_and_lets_a_bug_through():
    panel = Plain("A panel")
    with panel.saying_what_is_wrong():
        raise BootcourseError("p is <wrong>.")
    assert "p is &lt;wrong&gt;." in panel.says.value and 'role="alert"' in panel.says.value
    with pytest.raises(ZeroDivisionError), panel.saying_what_is_wrong():
        _ = 1 / 0
    assert 'alt="a &lt; b"' in panel._repr_mimebundle_()["text/html"]


A_WEIGHT = "give a finite number|is outside"
REFUSED = [
    *[(lambda _, wrong=wrong: policy_panel(wrong), "rollout is .*: give one recorded drive") for wrong in ("rule", [])],
    *[(lambda _, wrong=wrong: targets(np.ones(3), wrong), "give a discount") for wrong in (1.0, -0.1, NAN)],
    *[(lambda _, wrong=wrong: policy_numbers(None, None, 0, *wrong), A_WEIGHT)
      for wrong in ((1.0, 2, 0.1), (0.9, -1, 0.1), (0.9, 2, 0), (0.9, 1, INF))],
    (lambda drive: policy_panel(drive, xi=None), A_WEIGHT),
    (lambda _: train_panel(method="magic"), "'magic' is unknown"),
    (lambda _: train_panel(rule_p=1.0), "p = 1.0 is outside"),
    (lambda _: train_panel(gama=0.5), "'gama' is unknown"),
    (lambda _: train_panel(seeds=0), "seeds = 0"),
    (lambda _: train_panel(episodes=1.5), "episodes = 1.5"),
]  # fmt: skip


@pytest.mark.parametrize(("call", "sentence"), REFUSED)
def test_what_a_panel_cannot_show_is_refused_in_one_sentence(call, sentence, idle):
    with pytest.raises(BootcourseError, match=sentence) as refusal:
        call(idle)
    assert "\n" not in str(refusal.value)
