"""The figures of the course: data in, a matplotlib `Figure` with a title and an alt text out.

    from bootcourse.study.figures import show, top_view, top_view_over_time, traces, training_curves
    show(top_view_over_time(rollout))                # in a notebook
    save(traces([one, other]), "traces.pdf")         # for print

Each is in a file of its own; this one puts them within reach.
"""

from pathlib import Path

from bootcourse.record.rollout import Rollout
from bootcourse.study.drawing import save, show
from bootcourse.study.top_view import top_view, top_view_over_time
from bootcourse.study.traces import traces
from bootcourse.study.training_curves import training_curves

__all__ = ["save", "save_drive", "show", "top_view", "top_view_over_time", "traces", "training_curves"]


def save_drive(rollout: Rollout, path: Path) -> Path:
    """A drive on one page, as PNG: the road at its key moments, and its traces. Returns the path."""
    import io

    from PIL import Image, PngImagePlugin

    from bootcourse.record.files import write_bytes
    from bootcourse.study.drawing import DPI, png

    figures = [top_view_over_time(rollout), traces(rollout, title="The same drive over time")]
    pages = [Image.open(io.BytesIO(png(figure))).convert("RGB") for figure in figures]
    whole = Image.new("RGB", (max(page.width for page in pages), sum(page.height for page in pages)), "white")
    top = 0
    for page in pages:
        whole.paste(page, (0, top))
        top += page.height
    description, buffer = PngImagePlugin.PngInfo(), io.BytesIO()
    description.add_text("Description", " ".join(figure.alt for figure in figures))
    whole.save(buffer, "PNG", pnginfo=description, dpi=(DPI, DPI), optimize=True)
    write_bytes(path, buffer.getvalue())
    return Path(path)
