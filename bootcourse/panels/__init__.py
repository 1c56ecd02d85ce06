"""Panels for notebooks: each function returns a widget. What a panel shows is computed in the rest of the library."""

import importlib

from bootcourse.panels.bonus import bonus_panel as bonus_panel
from bootcourse.panels.drive import drive_panel as drive_panel
from bootcourse.panels.policy import policy_panel as policy_panel
from bootcourse.panels.train import train_panel as train_panel

ELSEWHERE = {"sweep_panel": "bootcourse.research.sweep_panel"}  # loaded when it is first used


def __getattr__(name: str):
    """Load a panel of another part of the package when it is first used."""
    if name not in ELSEWHERE:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return getattr(importlib.import_module(ELSEWHERE[name]), name)


def __dir__() -> list[str]:
    return sorted([*globals(), *ELSEWHERE])
