"""Pictures and GIFs of a replay, for slides, posters and a README, drawn without a browser or a GPU.

Scene, cars and cameras are those of the browser; Pillow paints their projection, from far to near.
"""

import io
from functools import lru_cache
from pathlib import Path
from typing import NamedTuple

import numpy as np
from PIL import Image, ImageDraw, ImageFont

from bootcourse.colours import ALARM, rgb
from bootcourse.files import check_replaceable, write_bytes
from bootcourse.methods import display_name, style
from bootcourse.replay3d import hud, scene
from bootcourse.replay3d.camera import CHASE, FIELD_OF_VIEW, Pose, pose
from bootcourse.replay3d.car import CRUMB, DARK, LAMPS, LIGHT, car_parts, paint, quads, ring
from bootcourse.replay3d.road import DASH, LINE, PERIOD, SHOULDER, THEMES, Theme, divider_ys, edges
from bootcourse.replay3d.stage import Options
from bootcourse.replay3d.timeline import Timeline
from bootcourse.road.state import EGO, LANE, Accident

SIZE, GIF_SIZE = (1280, 720), (640, 360)  # pixels
GIF_RATE, GIF_SECONDS, GIF_COLOURS = 10, 12.0, 160
SMOOTH = 2  # a picture is painted this many times larger and then reduced, which smooths its edges
NEAR_PLANE, VISIBLE, FOG = 0.6, 380.0, (120.0, 380.0)  # m
AROUND = ring()
SUN = np.array([-0.42, -0.35, 0.84])


class Lens:
    """A pinhole camera: world points in metres to pixels."""

    def __init__(self, place: Pose, size: tuple[int, int]):
        self.width, self.height = size
        self.eye = np.array(place.position)
        forward = np.array(place.look_at) - self.eye
        self.forward = forward / np.linalg.norm(forward)
        right = np.cross(self.forward, [0.0, 0.0, 1.0])
        self.right = right / np.linalg.norm(right)
        self.up = np.cross(self.right, self.forward)
        self.focal = self.height / 2 / np.tan(FIELD_OF_VIEW / 2)

    def see(self, points: np.ndarray) -> np.ndarray:
        """(n, 3) world -> (n, 3): to the right, up, and ahead of the eye, m."""
        return (points - self.eye) @ np.column_stack([self.right, self.up, self.forward])

    def project(self, seen: np.ndarray) -> np.ndarray:
        """(n, 3) as `see` gives it, all ahead of the eye -> (n, 2) pixels."""
        scale = self.focal / seen[:, 2]
        return np.column_stack([self.width / 2 + seen[:, 0] * scale, self.height / 2 - seen[:, 1] * scale])


def clip_near(seen: np.ndarray) -> np.ndarray:
    """The part of a polygon (n, 3) that lies beyond the near plane; it may be empty."""
    ahead = seen[:, 2] >= NEAR_PLANE
    if ahead.all():
        return seen
    kept = []
    for i in range(len(seen)):
        a, b = seen[i - 1], seen[i]
        if ahead[i - 1] != ahead[i]:
            kept.append(a + (NEAR_PLANE - a[2]) / (b[2] - a[2]) * (b - a))
        if ahead[i]:
            kept.append(b)
    return np.array(kept).reshape(-1, 3)


def turn(yaw: float) -> np.ndarray:
    """What (n, 3) points are multiplied with to turn them about z."""
    cos, sin = np.cos(yaw), np.sin(yaw)
    return np.array([[cos, sin, 0], [-sin, cos, 0], [0, 0, 1]])


class Painter:
    """Paints polygons onto one picture; later ones cover earlier ones."""

    def __init__(self, lens: Lens, colours: Theme):
        self.lens, self.colours = lens, colours
        self.horizon = np.array(rgb(colours.horizon), float)
        self.image = Image.fromarray(_backdrop(lens, colours))
        self.draw = ImageDraw.Draw(self.image, "RGBA")

    def polygon(self, corners: np.ndarray, colour, opacity: float = 1.0) -> None:
        """corners: (n, 3) m."""
        seen = clip_near(self.lens.see(corners))
        if len(seen) < 3:
            return
        fog = np.interp(seen[:, 2].mean(), FOG, (0, 1))
        tint = (1 - fog) * np.array(colour) + fog * self.horizon
        pixels = self.lens.project(seen)
        self.draw.polygon([tuple(p) for p in pixels], fill=(*(int(c) for c in tint), int(255 * opacity)))

    def triangles(self, corners: np.ndarray, colours: np.ndarray, opacity: float = 1.0) -> None:
        """Many triangles (n, 3, 3), painted in this order; colours (n, 3)."""
        seen = self.lens.see(corners.reshape(-1, 3)).reshape(corners.shape)
        whole = (seen[:, :, 2] >= NEAR_PLANE).all(axis=1)
        seen, colours = seen[whole], colours[whole]
        fog = np.interp(seen[:, :, 2].mean(axis=1), FOG, (0, 1))[:, None]
        tints = ((1 - fog) * np.clip(colours, 0, 255) + fog * self.horizon).astype(int)
        pixels = self.lens.project(seen.reshape(-1, 3)).reshape(-1, 6)
        alpha = int(255 * opacity)
        for corner, tint in zip(pixels.tolist(), tints.tolist(), strict=True):
            self.draw.polygon(corner, fill=(*tint, alpha))

    def flat(self, mesh, place, yaw: float, colour, opacity: float = 1.0) -> None:
        """A flat convex mark on the road, painted as one polygon."""
        self.polygon(mesh.vertices @ turn(yaw) + np.array(place), colour, opacity)

    def text(self, place, text: str, size: float, colour: str | None = None) -> None:
        """A label above a point (x, y, z)."""
        seen = self.lens.see(np.array([place]))
        if seen[0, 2] > NEAR_PLANE:
            x, y = self.lens.project(seen)[0]
            self.box(x, y, text, size, colour, anchor="ms")

    def box(self, x, y, text: str, size: float, colour: str | None = None, anchor: str = "ls") -> None:
        font = _font(int(size))
        left, top, right, bottom = self.draw.textbbox((x, y), text, font=font, anchor=anchor)
        pad = size * 0.3
        paper = rgb(colour) if colour else (255, 255, 255)
        self.draw.rounded_rectangle((left - pad, top - pad, right + pad, bottom + pad), pad, fill=(*paper, 225))
        self.draw.text((x, y), text, font=font, anchor=anchor, fill=(255, 255, 255) if colour else (20, 24, 28))


def _backdrop(lens: Lens, colours: Theme) -> np.ndarray:
    """Sky and ground as (height, width, 3) uint8; each row has one colour."""
    rows = np.arange(lens.height) + 0.5
    up = (lens.height / 2 - rows) / lens.focal
    slope = lens.forward[2] + up * lens.up[2]  # of the ray through the middle of each row
    sky = np.clip(slope / 0.25, 0, 1)[:, None]
    above = sky * np.array(rgb(colours.sky)) + (1 - sky) * np.array(rgb(colours.horizon))
    away = lens.eye[2] / np.maximum(-slope, 1e-6)
    fog = np.interp(away, FOG, (0, 1))[:, None]
    below = fog * np.array(rgb(colours.horizon)) + (1 - fog) * np.array(rgb(colours.ground))
    column = np.where(slope[:, None] >= 0, above, below)
    return np.repeat(column[:, None, :], lens.width, axis=1).round().astype(np.uint8)


@lru_cache(maxsize=16)
def _font(size: int):
    from matplotlib import get_data_path

    return ImageFont.truetype(str(Path(get_data_path(), "fonts", "ttf", "DejaVuSans.ttf")), size)


class Shot(NamedTuple):
    """One picture: the drives, the time (s), and the camera."""

    timelines: list[Timeline]
    t: float
    options: Options
    camera: str = CHASE
    size: tuple[int, int] = SIZE


def picture(shot: Shot) -> Image.Image:
    """The replay at one time."""
    road = shot.timelines[0].rollout.scenario.road
    span = scene.span(road, len(shot.timelines), shot.options.layout)
    size = (shot.size[0] * SMOOTH, shot.size[1] * SMOOTH)
    painter = Painter(Lens(pose(shot.camera, span), size), THEMES[shot.options.dark])
    views = scene.view(shot.timelines, shot.t, shot.options.layout, shot.options.follow)
    solid = [k for k in range(len(views)) if shot.options.layout == scene.ROADS or k == shot.options.follow]
    for k in solid:
        _paint_road(painter, road, views[k])
    for k, view in enumerate(views):
        _paint_marks(painter, shot, k, view, rule=shot.options.rule and k in solid)
    _paint_cars(painter, shot, views, solid)
    _paint_numbers(painter, shot)
    return painter.image.resize(shot.size, Image.LANCZOS)


def _paint_road(painter: Painter, road, view: scene.DriveView) -> None:
    left, right = edges(road)
    xs = np.array([-60, -40, -25, -10, 0, 12, 25, 40, 60, 85, 115, 150, 190, 240, 300, VISIBLE])
    stripes = [(right - SHOULDER, left + SHOULDER, painter.colours.asphalt)]
    stripes += [(y - LINE / 2, y + LINE / 2, painter.colours.line) for y in (left, right)]
    for low, high, colour in stripes:
        for x0, x1 in zip(xs[:-1], xs[1:], strict=True):
            painter.polygon(quads(x0, x1, low, high).vertices + [0, view.offset, 0], rgb(colour))
    phase = -(view.anchor % PERIOD)
    for x in np.arange(-60 + phase, VISIBLE, PERIOD):
        for y in divider_ys(road):
            dash = quads(x, x + DASH, y - LINE / 2, y + LINE / 2)
            painter.polygon(dash.vertices + [0, view.offset, 0], rgb(painter.colours.line))


def _paint_marks(painter: Painter, shot: Shot, k: int, view: scene.DriveView, rule: bool) -> None:
    if rule and view.rule is not None and not view.ended:
        marks, half = view.rule, 0.42 * shot.timelines[k].rollout.scenario.road.lane_width
        strip = quads(view.x[EGO] - 4, view.x[EGO] + 45, -half, half)
        painter.polygon(strip.vertices + [0, view.offset + marks.lane_y, 0], rgb(style("rule").colour), 0.35)
        gap = quads(marks.gap_x, marks.gap_x + marks.gap, -0.7 * half, 0.7 * half)
        painter.polygon(gap.vertices + [0, view.offset + marks.gap_y, 0], rgb("#F2A900"), 0.7)
    if shot.options.path:
        colour = rgb(style(shot.timelines[k].rollout.label).colour)
        for x, y, z, yaw in view.crumbs:
            if z > 0:
                painter.flat(CRUMB, (x - view.anchor, y + view.offset, z), yaw, colour, 0.8)


def _paint_cars(painter: Painter, shot: Shot, views: list, solid: list[int]) -> None:
    """All cars of all drives, the furthest first, then the labels."""
    size = shot.timelines[0].rollout.scenario.car
    parts = car_parts(size.length, size.width)
    order = []
    for k, view in enumerate(views):
        for car in range(len(view.x)) if k in solid else [EGO]:
            place = np.array([view.x[car], view.y[car] + view.offset, 0.0])
            order.append((float(np.linalg.norm(place - painter.lens.eye)), k, car, place))
    order.sort(reverse=True, key=lambda item: item[0])
    for distance, k, car, place in order:
        if distance > VISIBLE:
            continue
        view, own = views[k], style(shot.timelines[k].rollout.label).colour
        opacity = 1.0 if k in solid else 0.5
        if view.marked[car]:
            painter.triangles(AROUND.vertices[AROUND.faces] + place, np.tile(rgb(ALARM), (len(AROUND.faces), 1)))
        painter.flat(parts["shadow"], place, view.yaw[car], (0, 0, 0), 0.3 * opacity)
        tints = {"dark": DARK, "paint": paint(car, own), "lamps": LAMPS[view.lamps[car]], "light": LIGHT}
        _paint_car(painter, parts, place, view.yaw[car], tints, opacity)
    scale = painter.lens.height / 50
    for k, view in enumerate(views):
        for car, text in view.labels.items():
            if k in solid and (car == EGO or shot.options.labels):
                place = (view.x[car], view.y[car] + view.offset, 2.4)
                painter.text(place, text, scale, ALARM if car == EGO else None)


def _paint_car(painter: Painter, parts: dict, place, yaw: float, tints: dict, opacity: float) -> None:
    """All parts as one mesh, so that its faces are sorted together."""
    triangles = np.concatenate([parts[name].vertices[parts[name].faces] for name in tints]) @ turn(yaw) + place
    colours = np.concatenate([np.tile(rgb(tint), (len(parts[name].faces), 1)) for name, tint in tints.items()])
    glow = np.concatenate([np.full(len(parts[name].faces), name in ("lamps", "light")) for name in tints])
    # Lamps and hubs lie on the body; they are sorted as if a little nearer, so that they are painted after it.
    normals = np.cross(triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0])
    normals /= np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-9)
    towards = painter.lens.eye - triangles.mean(axis=1)
    light = np.where(glow, 1.0, 0.68 + 0.36 * np.clip(normals @ SUN, 0, 1))
    facing = np.flatnonzero(np.einsum("ij,ij->i", normals, towards) > 0)
    distance = np.linalg.norm(towards[facing], axis=1) - 0.12 * glow[facing]
    order = facing[np.argsort(-distance)]
    painter.triangles(triangles[order], colours[order] * light[order][:, None], opacity)


def _paint_numbers(painter: Painter, shot: Shot) -> None:
    """Label, time, speed and return of each drive, in the corner."""
    size = painter.lens.height / 30
    for k, timeline in enumerate(shot.timelines):
        moment, rollout = timeline.at(shot.t), timeline.rollout
        text, _ = hud.status(timeline, shot.t)
        line = f"{display_name(rollout.label)}   {min(shot.t, timeline.duration):5.1f} s   "
        line += f"{moment.speed[EGO]:4.1f} m/s   return {timeline.returns[timeline.earned(shot.t)]:.1f}"
        line += f"   {text}" if text else ""
        painter.box(size, size * (1.6 + 1.8 * k), line, size, style(rollout.label).colour)


def best_moment(timeline: Timeline) -> float:
    """The time (s) for a single picture: the accident, else the first lane change, else the middle."""
    if timeline.rollout.accident != Accident.NONE:
        return timeline.duration
    lanes = timeline.rollout.states[:, EGO, LANE]
    changed = np.flatnonzero(lanes != lanes[0])
    return float(changed[0] * timeline.dt) if len(changed) else timeline.duration / 2


def png_bytes(rollouts, t: float | None = None, options: Options | None = None, **shot) -> bytes:
    """One picture as PNG, at time t (s); by default at `best_moment` of the first drive."""
    timelines = scene.timelines_of(rollouts)
    t = best_moment(timelines[0]) if t is None else t
    buffer = io.BytesIO()
    picture(Shot(timelines, t, options or Options(), **shot)).save(buffer, "PNG", optimize=True)
    return buffer.getvalue()


def gif_bytes(rollouts, start: float | None = None, seconds: float = GIF_SECONDS,
              options: Options | None = None, **shot) -> bytes:  # fmt: skip
    """A GIF from time `start` (s) on; by default from a little before `best_moment` of the first drive."""
    timelines = scene.timelines_of(rollouts)
    duration = max(timeline.duration for timeline in timelines)
    if start is None:
        start = max(0.0, min(best_moment(timelines[0]) - 0.7 * seconds, duration - seconds))
    shot = {"size": GIF_SIZE, **shot}
    times = np.arange(start, min(start + seconds, duration) + 1e-9, 1 / GIF_RATE)
    frames = [picture(Shot(timelines, float(t), options or Options(), **shot)) for t in times]
    sample = np.concatenate([np.asarray(frame) for frame in frames[:: max(1, len(frames) // 6)]])
    palette = Image.fromarray(sample).quantize(GIF_COLOURS, Image.Quantize.FASTOCTREE, dither=Image.Dither.NONE)
    frames = [frame.quantize(palette=palette, dither=Image.Dither.NONE) for frame in frames]
    buffer = io.BytesIO()
    frames[0].save(
        buffer, "GIF", save_all=True, append_images=frames[1:], duration=1000 // GIF_RATE, loop=0, optimize=False
    )
    return buffer.getvalue()


def write_png(rollouts, path: Path, t: float | None = None, options: Options | None = None) -> Path:
    """Write one picture as a whole file. Returns the path. Raises BootcourseError if it does not end in .png."""
    return _write(path, ".png", lambda: png_bytes(rollouts, t, options))


def write_gif(rollouts, path: Path, start: float | None = None, options: Options | None = None) -> Path:
    """Write a GIF of 12 s as a whole file. Returns the path. Raises BootcourseError if it does not end in .gif."""
    return _write(path, ".gif", lambda: gif_bytes(rollouts, start, options=options))


def _write(path: Path, ending: str, make) -> Path:
    path = check_replaceable(path, ending)
    write_bytes(path, make())
    return path
