"""Panels for notebooks: each function returns a widget. What a panel shows is computed in the rest of the library."""

import importlib
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from bootcourse.panels.bonus import bonus_panel as bonus_panel
    from bootcourse.panels.policy import policy_panel as policy_panel
    from bootcourse.panels.train import train_panel as train_panel

PANELS = {f"{name}_panel": f"{__name__}.{name}" for name in ("bonus", "policy", "train")}


def __getattr__(name: str):
    """Load a panel when it is first used: most need torch, and the form of a prediction does not."""
    if name not in PANELS:
        raise AttributeError(f"There is no {name!r} in bootcourse.panels: choose one of {', '.join(PANELS)}.")
    return getattr(importlib.import_module(PANELS[name]), name)


def __dir__() -> list[str]:
    return sorted(PANELS)
