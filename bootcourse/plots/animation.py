"""Drives from above, below each other: one moment as a figure, or a small GIF for a README or a slide.

The camera stands half-way between the ego and trap 1, so that you see the one fall back and come again,
and goes on with the ego where both no longer fit. Between two simulation steps every car moves in a straight line.
"""

import io
from collections.abc import Sequence
from pathlib import Path

import numpy as np
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from PIL import Image

from bootcourse.colours import ALARM
from bootcourse.episodes.rollout import Rollout
from bootcourse.episodes.words import cars_at, doing, outcome, overtaken, sentence
from bootcourse.files import check_replaceable, write_bytes
from bootcourse.methods import display_name
from bootcourse.plots.figure import INK, QUIET, WIDTH, as_written, axes_at, new_figure, styles
from bootcourse.plots.top_view import draw_moment
from bootcourse.road.state import EGO, SPEED, TRAP_1, X

SPEED_UP = 3.0  # the clip is so many times faster than the road
FRAME = 0.07  # s of clip that a frame is shown
REST = 2.5  # s of clip that the last frame is shown
VIEW = 86.0  # m of road in the picture
ROOM = VIEW / 2 - 14.0  # m from the picture's middle to the ego, at most: it stays in sight if trap 1 cannot
AFTER = 6.0  # s that the clip goes on after the last overtaking
COLOURS = 64  # in the palette that all frames share


def frame(rollouts: Sequence[Rollout], time: float) -> Figure:
    """The rollouts below each other at a time (s); one that is over stays as it ended."""
    side = 0.12
    width = WIDTH - 2 * side
    road = rollouts[0].scenario.road
    row, head, foot = (road.lanes * road.lane_width + 0.8) * width / VIEW, 0.33, 0.12
    total = len(rollouts) * (row + head) + foot
    figure = new_figure(total)
    looks = styles([rollout.label for rollout in rollouts])
    for i, (rollout, look) in enumerate(zip(rollouts, looks, strict=True)):
        now = min(time, float(rollout.times[-1]))
        cars = cars_at(rollout, now)
        top = i * (row + head) + head
        ax = axes_at(figure, side, top, width, row)
        ax.set_axis_off()
        middle = np.clip((cars[EGO, X] + cars[TRAP_1, X]) / 2, cars[EGO, X] - ROOM, cars[EGO, X] + ROOM)
        draw_moment(ax, rollout, now, -VIEW / 2, VIEW / 2, middle, look.colour)
        over = rollout.accident and now == rollout.times[-1]
        write = {"y": 1 - (top - 0.1) / total, "va": "baseline"}
        bold, driver = {"fontsize": 10.5, "fontweight": "bold"} | write, sentence(display_name(rollout.label))
        figure.text(side / WIDTH, s=driver, color=look.colour, **bold)
        figure.text(0.37, s=doing(rollout, now), fontsize=9, color=ALARM if over else INK, **write)
        figure.text(0.76, s=f"{cars[EGO, SPEED]:.1f} m/s", fontsize=9, color=QUIET, ha="right", **write)
        figure.text(1 - side / WIDTH, s=f"{round(float(now), 1):g} s", color=INK, ha="right", **bold)
    figure.alt = alt(rollouts)
    return figure


def alt(rollouts: Sequence[Rollout]) -> str:
    """How each drive ends, for those who cannot see it."""
    ends = "; ".join(f"{display_name(rollout.label)}: {outcome(rollout)}" for rollout in rollouts)
    start = ", the same start for every driver" if len(rollouts) > 1 else ""
    return f"The road from above{start}. {sentence(ends)}."


def key_frame(rollouts: Sequence[Rollout]) -> Figure:
    """The `frame` at the moment that says most of the last drive: its accident, else its overtaking, else half."""
    last = rollouts[-1]
    end = float(last.times[-1])
    return frame(rollouts, end if last.accident else overtaken(last) or end / 2)


def frame_times(rollouts: Sequence[Rollout]) -> list[float]:
    """The moments (s) of the frames: until some seconds after the last overtaking; 20 s where there is none."""
    end = max(float(rollout.times[-1]) for rollout in rollouts)
    passed = [time for time in map(overtaken, rollouts) if time is not None]
    until = max(passed) + AFTER if passed else 20.0
    return list(np.arange(0.0, min(until, end) + 1e-9, SPEED_UP * FRAME))


def _picture(rollouts: Sequence[Rollout], time: float) -> Image.Image:
    canvas = FigureCanvasAgg(as_written(frame(rollouts, time)))
    canvas.draw()
    return Image.fromarray(np.asarray(canvas.buffer_rgba())[..., :3])


def _palette(pictures: list[Image.Image]) -> Image.Image:
    """One palette for all frames, so that what stands still keeps its colour and is stored once."""
    some = [pictures[i] for i in np.unique(np.linspace(0, len(pictures) - 1, 6).astype(int))]
    sheet = Image.fromarray(np.concatenate([np.asarray(picture) for picture in some]))
    palette = sheet.quantize(COLOURS, Image.Quantize.MEDIANCUT)
    colours = np.array(palette.getpalette()).reshape(-1, 3)
    colours[colours.min(1) > 247] = 255  # the paper stays white
    palette.putpalette(colours.ravel().tolist())
    return palette


def animate(rollouts: Sequence[Rollout], path: Path) -> Path:
    """Write a GIF of drives below each other. Returns the path. The same drives give the same bytes.

    Raises BootcourseError for a path that does not end in .gif.
    """
    check_replaceable(path, ".gif")
    pictures = [_picture(rollouts, time) for time in frame_times(rollouts)]
    palette = _palette(pictures)
    frames = [picture.quantize(palette=palette, dither=Image.Dither.NONE) for picture in pictures]
    durations = [round(1000 * FRAME)] * (len(frames) - 1) + [round(1000 * REST)]
    buffer = io.BytesIO()
    how = {"save_all": True, "duration": durations, "loop": 0, "disposal": 1, "optimize": True}
    frames[0].save(buffer, "GIF", append_images=frames[1:], comment=alt(rollouts).encode(), **how)
    write_bytes(path, buffer.getvalue())
    return Path(path)
