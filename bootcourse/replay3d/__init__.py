"""The 3D replay: what was driven, in a notebook, in a browser, or as one HTML file. viser is imported only in here."""

from bootcourse.replay3d.recorder import Recording, export, recording
from bootcourse.replay3d.viewer import Replay, replay

__all__ = ["Recording", "Replay", "export", "recording", "replay"]
