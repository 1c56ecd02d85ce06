"""A drive on one page: the road at its key moments, and its traces below."""

import io
from pathlib import Path

import numpy as np
from PIL import Image, PngImagePlugin

from bootcourse.episodes.rollout import Rollout
from bootcourse.files import check_replaceable, write_bytes
from bootcourse.plots.figure import DPI, png
from bootcourse.plots.top_view import top_view_over_time
from bootcourse.plots.traces import traces


def save_drive(rollout: Rollout, path: Path) -> Path:
    """A drive on one page, as PNG: the road at its key moments, and its traces. Returns the path.

    Raises BootcourseError for another ending, or for a file that is not a picture.
    """
    check_replaceable(path, ".png")
    figures = [top_view_over_time(rollout), traces(rollout, title="The same drive over time")]
    pages = [Image.open(io.BytesIO(png(figure))).convert("RGB") for figure in figures]
    whole = Image.fromarray(np.concatenate(pages))
    description, buffer = PngImagePlugin.PngInfo(), io.BytesIO()
    description.add_text("Description", " ".join(figure.alt for figure in figures))
    whole.save(buffer, "PNG", pnginfo=description, dpi=(DPI, DPI), optimize=True)
    write_bytes(path, buffer.getvalue())
    return Path(path)
