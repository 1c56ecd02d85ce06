"""Sliders that move in the book: all pictures of an explorable are drawn when its page is made (drag.js shows them).

It is called as its cell calls it, where that is one call without arguments, and drawn at some places of each slider.
Pictures of one panel share most of their parts, so the page holds each part once.
"""

import json
import re
from importlib import import_module
from itertools import product

import numpy as np

from bootcourse.errors import BootcourseError
from bootcourse.markup import Markup, html
from bootcourse.panels.explorable import Explorable
from bootcourse.panels.number import Number
from bootcourse.plots.svg import printed

CALL = re.compile(r"explorable\.(\w+)\(\)$")
PLACES = {1: 41, 2: 13, 3: 6, 4: 4}  # of each slider, at most, where a panel has so many
BETWEEN = re.compile(r"(?<=>)(?=<)")


def explorable_of(lesson: str, code: str) -> Explorable | None:
    """The panel that a cell ends with, if it is one call without arguments."""
    last = code.strip().splitlines()[-1] if code.strip() else ""
    if not (call := CALL.fullmatch(last)):
        return None
    return getattr(import_module(f"bootcourse.course.lessons.{lesson}.explorable"), call[1])()


def places(number: Number, most: int) -> tuple[list[float], int]:
    """Values along a slider, as it gives them, at most so many; and which of them the panel begins with."""
    low, high = np.log10([number.low, number.high]) if number.logarithmic else (number.low, number.high)
    steps = np.arange(round((high - low) / number.step) + 1) * number.step + low
    values = [float(f"{10**step:.2g}") for step in steps] if number.logarithmic else [round(step, 10) for step in steps]
    first = int(np.argmin(np.abs(np.array(values) - number.value)))
    every = -(-(len(values) - 1) // (most - 1))
    kept = [i for i in range(len(values)) if (i - first) % max(every, 1) == 0 or i in (0, len(values) - 1)]
    kept = [i for i in kept if accepted(number, values[i])]
    return [values[i] for i in kept], kept.index(first)


def accepted(number: Number, value: float) -> bool:
    """Does the panel take this value?"""
    try:
        number.check(value)
    except BootcourseError:
        return False
    return True


def page(panel: Explorable) -> Markup:
    """The panel's sliders and pictures."""
    along = {name: places(number, PLACES[len(panel.numbers)]) for name, number in panel.numbers.items()}
    parts: dict[str, int] = {}
    pictures = []
    for values in product(*(values for values, _ in along.values())):
        picture = printed(panel.draw(**dict(zip(along, values, strict=True)))).decode()
        pictures.append([parts.setdefault(part, len(parts)) for part in BETWEEN.split(picture)])
    rows = Markup("").join(slider(panel.numbers[name], *each) for name, each in along.items())
    held = json.dumps({"parts": list(parts), "pictures": pictures}, separators=(",", ":")).replace("</", "<\\/")
    data = html('<script type="application/json">{}</script>', Markup(held))
    return html(
        '<div class="draggable">{}<div class="picture">{}</div>{}</div>',
        rows,
        Markup(printed(panel.svg).decode()),
        data,
    )


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
