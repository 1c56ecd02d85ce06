"""The 3D replay of recorded drives, in a notebook, in a browser, or as one HTML file. Only this folder uses viser."""

from bootcourse.replay3d.recorder import Recording, export, recording
from bootcourse.replay3d.viewer import Replay, replay

__all__ = ["Recording", "Replay", "export", "recording", "replay"]
