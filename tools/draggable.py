"""Sliders that move in the book: all pictures of a panel are drawn when its page is made (drag.js shows them).

A lesson's explorable is called as its cell calls it, where that is one call without arguments. Of the library's panels
those in `MOVED` are drawn, where their cell needs no other one. Each is drawn at some places of each slider. Pictures
of one panel share most of their parts, so the page holds each part once.
"""

import json
import re
from collections.abc import Callable
from functools import cache
from importlib import import_module
from itertools import product
from typing import NamedTuple

import numpy as np

import bootcourse as bc
from bootcourse.errors import BootcourseError
from bootcourse.markup import Markup, html
from bootcourse.panels.number import Number
from bootcourse.plots.svg import printed

EXPLORABLE = re.compile(r"explorable\.(\w+)\(\)$")
LIBRARY = re.compile(r"bc\.panels\.(\w+)\(")
MOVED = {"bonus_panel": ("c", "gamma"), "policy_panel": ("xi",)}  # a panel of the library -> what moves in the book
PLACES = {1: 41, 2: 13, 3: 6, 4: 4}  # of each slider, at most, where a panel has so many
ROUND = (1, 2, 4, 5, 10, 20, 25, 50, 100, 200, 250, 500, 1000)  # every so many-th step of a slider is a place
BETWEEN = re.compile(r"(?<=>)(?=<)")


class Drawn(NamedTuple):
    """A panel as a page without a kernel shows it."""

    numbers: dict[str, Number]  # those that have a slider
    picture: Callable[..., Markup]  # of the values of these numbers, by their names


@cache
def page_of(lesson: str, code: str) -> Markup | None:
    """The sliders and pictures of the panel that a cell ends with: see `panel_of`. Drawn once in a process."""
    panel = panel_of(lesson, code)
    return panel and page(panel)


def panel_of(lesson: str, code: str) -> Drawn | None:
    """The panel that a cell ends with; None if it ends with none that can be drawn without the cells before it."""
    *above, last = code.strip().splitlines() or [""]
    if call := EXPLORABLE.fullmatch(last):
        panel = getattr(import_module(f"bootcourse.course.lessons.{lesson}.explorable"), call[1])()
        return Drawn(panel.numbers, lambda **values: Markup(printed(panel.draw(**values)).decode()))
    if not (call := LIBRARY.match(last)) or call[1] not in MOVED:
        return None
    names = {"bc": bc}
    exec("\n".join(above), names)
    panel = eval(last, names)

    def picture(**values: float) -> Markup:
        for name, value in values.items():
            getattr(panel, name).value = value
        return Markup(printed(panel.svg).decode()) + getattr(panel, "below", Markup(""))

    return Drawn({name: getattr(panel, name) for name in MOVED[call[1]]}, picture)


def places(number: Number, most: int) -> tuple[list[float], int]:
    """Values along a slider, as it gives them, at most so many; and which of them the panel begins with.

    A logarithmic one begins with 0, which one types in the panel, where the panel takes it.
    """
    low, high = np.log10([number.low, number.high]) if number.logarithmic else (number.low, number.high)
    steps = np.arange(round((high - low) / number.step) + 1) * number.step + low
    values = [float(f"{10**step:.2g}") for step in steps] if number.logarithmic else [round(step, 10) for step in steps]
    first = int(np.argmin(np.abs(np.array(values) - number.value)))
    every = next(each for each in ROUND if each * (most - 1) >= len(values) - 1)
    kept = [i for i in range(len(values)) if (i - first) % every == 0 or i in (0, len(values) - 1)]
    kept = [i for i in kept if accepted(number, values[i])]
    nothing = [0.0] if number.logarithmic and accepted(number, 0.0) else []
    return nothing + [values[i] for i in kept], len(nothing) + kept.index(first)


def accepted(number: Number, value: float) -> bool:
    """Does the panel take this value?"""
    try:
        number.check(value)
    except BootcourseError:
        return False
    return True


def page(panel: Drawn) -> Markup:
    """The panel's sliders and pictures."""
    along = {name: places(number, PLACES[len(panel.numbers)]) for name, number in panel.numbers.items()}
    first = tuple(values[begins] for values, begins in along.values())
    parts: dict[str, int] = {}
    pictures, shown = [], Markup("")
    for values in product(*(values for values, _ in along.values())):
        picture = panel.picture(**dict(zip(along, values, strict=True)))
        shown = picture if values == first else shown
        pictures.append([parts.setdefault(part, len(parts)) for part in BETWEEN.split(picture)])
    rows = Markup("").join(slider(number, *along[name]) for name, number in panel.numbers.items())
    held = json.dumps({"parts": list(parts), "pictures": pictures}, separators=(",", ":")).replace("</", "<\\/")
    data = html('<script type="application/json">{}</script>', Markup(held))
    return html('<div class="draggable">{}<div class="picture">{}</div>{}</div>', rows, shown, data)


def slider(number: Number, values: list[float], first: int) -> Markup:
    """One slider, with its name, its value and its sentence of help."""
    unit = f" ({number.unit})" if number.unit else ""
    shown = " ".join(f"{value:.6g}" for value in values)
    moved = html(
        '<input type="range" min="0" max="{}" value="{}" data-values="{}" aria-label="{}">',
        len(values) - 1, first, shown, f"{number.symbol}: {number.sentence}",
    )  # fmt: skip
    named = html("<label><b>{}</b>{} {}<output>{}</output></label>", number.symbol, unit, moved, f"{values[first]:.6g}")
    return html("<p>{}<small>{}</small></p>", named, number.sentence)
