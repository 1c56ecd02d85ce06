"""What tests of panels share: the page's side of a widget, and exceptions that are not swallowed.

In a notebook ipywidgets catches what a button's callback raises and shows it; a test must fail instead.
Import `raise_in_callbacks` and write `pytestmark = pytest.mark.usefixtures("raise_in_callbacks")`.
"""

import math
import re
from xml.etree import ElementTree

import ipywidgets as widgets
import pytest
from ipywidgets.widgets.widget import CallbackDispatcher


@pytest.fixture
def raise_in_callbacks(monkeypatch):
    """Callbacks of buttons and of messages raise."""

    def call_all(self, *args, **kwargs):
        for callback in list(self.callbacks):
            callback(*args, **kwargs)

    monkeypatch.setattr(CallbackDispatcher, "__call__", call_all)


def from_page(widget: widgets.Widget, **state) -> None:
    """Set traits as the page does, with notifications held until all are set; what goes wrong is raised."""
    widget.set_state(state)


def inside(widget: widgets.Widget, kind: type = widgets.Widget) -> list[widgets.Widget]:
    """All widgets of a kind in a panel, itself included, from top to bottom."""
    below = [each for child in getattr(widget, "children", ()) for each in inside(child, kind)]
    return [widget] * isinstance(widget, kind) + below


def words(widget: widgets.Widget) -> str:
    """All that is written in a panel, without the tags."""
    html = " ".join(each.value for each in inside(widget, widgets.HTML))
    return re.sub(r"\s+", " ", re.sub(r"<style>.*?</style>|<[^>]*>", " ", html, flags=re.DOTALL))


def at_its_ends(panel, number) -> None:
    """Enter a number's ends and nonsense: each is taken or refused, and the drawing keeps its size and stays whole."""
    size = panel.svg.split(' role="img"')[0]
    low = number.low
    for value in (low, number.high, -7.5, 1e9 + 0.5, math.nan):
        from_page(number.field, value=value)
        ElementTree.fromstring(panel.svg)
        assert panel.svg.split(' role="img"')[0] == size and "nan" not in panel.svg
        assert math.isclose(number.value, value) or "bc-wrong" in number.help.value
    assert "bc-wrong" in number.help.value, "NaN is refused"
    from_page(number.slider, value=low)
    assert math.isclose(number.value, low) and "bc-wrong" not in number.help.value
