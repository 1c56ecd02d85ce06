"""Panels for notebooks: each function returns a widget. What a panel shows is computed in the rest of the library."""

from bootcourse.panels.bonus import bonus_panel as bonus_panel
from bootcourse.panels.clocks import clocks_panel as clocks_panel
from bootcourse.panels.drive import drive_panel as drive_panel
from bootcourse.panels.policy import policy_panel as policy_panel
from bootcourse.panels.sweep import sweep_panel as sweep_panel
from bootcourse.panels.teachers import teachers_panel as teachers_panel
from bootcourse.panels.train import train_panel as train_panel
