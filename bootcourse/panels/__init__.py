"""Panels for notebooks: each function returns a widget. What a panel shows is computed in the rest of the library."""

from bootcourse.panels.bonus import bonus_panel as bonus_panel
from bootcourse.panels.policy import policy_panel as policy_panel
from bootcourse.panels.train import train_panel as train_panel
