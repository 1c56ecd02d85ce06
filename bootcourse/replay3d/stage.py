"""The scene as viser nodes, which are made once and then moved.

A car is a frame with a few meshes under it, so each frame of the replay sends a position and a rotation for each
car. All changes of one frame go out as one batch. A property is sent only when it changes, and positions are
rounded to a millimetre; both keep an exported file small.
"""

from dataclasses import dataclass, field

import numpy as np
from viser import _messages

from bootcourse.colours import ALARM, rgb
from bootcourse.methods import display_name
from bootcourse.plots.futures import BRIGHT, Trail, trails
from bootcourse.replay3d import scene
from bootcourse.replay3d.camera import CHASE, FIELD_OF_VIEW, pose
from bootcourse.replay3d.car import CRUMB, DARK, LAMPS, LIGHT, Mesh, car_parts, paint, ring
from bootcourse.replay3d.road import AHEAD, BEHIND, THEMES, ground, road_parts
from bootcourse.replay3d.timeline import Timeline
from bootcourse.road.state import EGO, TRAP_1, TRAP_2, X

PLACES = {"position": _messages.SetPositionMessage, "wxyz": _messages.SetOrientationMessage}
GRAIN = 1024.0  # positions are rounded to 1/1024 m, which is exact in binary


@dataclass
class Drive:
    """The nodes of one drive."""

    name: str  # of the driver
    road: object = None
    cars: dict = field(default_factory=dict)  # car -> its frame
    lamps: dict = field(default_factory=dict)
    rings: dict = field(default_factory=dict)
    labels: dict = field(default_factory=dict)
    crumbs: object = None
    futures: list = field(default_factory=list)  # nine ribbons on the road
    decision: int = -1  # whose imagined drives they are; -1: none
    step: int = -1  # to which the path reaches; -1: it has to be sent


class Stage:
    """The nodes of all drives on one viser server; `show(t)` moves them."""

    def __init__(self, server, timelines: list[Timeline], dark: bool = False):
        self.server, self.timelines, self.dark = server, timelines, dark
        self.futures = True  # are the imagined drives shown, where there are some?
        self.span = scene.span(len(timelines), timelines[0].rollout.scenario.road)  # m, of all roads together
        self.drives: list[Drive] = []
        self.sent: dict[tuple, object] = {}  # (a node's id, a property) -> the value that `show` gave it
        self.build()

    def build(self) -> None:
        """Make every node anew: at the start, and when the theme changes."""
        with self.server.atomic():
            for k in range(len(self.drives)):
                self.server.scene.remove_by_name(f"/drive{k}")
            self._surroundings()
            self.sent.clear()
            self.drives = [self._drive(k) for k in range(len(self.timelines))]

    def show(self, t: float) -> None:
        """Move everything to time t, in one batch."""
        with self.server.atomic():
            for drive, timeline in zip(self.drives, self.timelines, strict=True):
                self._move(drive, timeline, t)

    def unsettle(self) -> None:
        """Change every property that `show` sets, so that the next `show` sends them all.

        A recording that is played again starts with the messages of its first frame.
        """
        self.sent.clear()
        with self.server.atomic():
            for drive in self.drives:
                for node in drive.lamps.values():
                    node.color = (1, 2, 3)
                for node in drive.labels.values():
                    node.text = "…"
                for node in drive.futures:
                    node.color, node.vertices = (1, 2, 3), node.vertices + 1.0
                drive.decision = drive.step = -1
                for node in (*drive.rings.values(), *drive.labels.values(), *drive.futures):
                    node.visible = not node.visible
                drive.crumbs.vertices = drive.crumbs.vertices + 1.0

    def _surroundings(self) -> None:
        colours, api = THEMES[self.dark], self.server.scene
        self.server.gui.configure_theme(dark_mode=self.dark, show_logo=False, show_share_button=False)
        # Two plain lights and no environment map, so that a car has the same colour as in a figure. Without a graphics
        # card, more lights and finer materials cost time at every pixel.
        api.configure_default_lights(enabled=False)
        api.configure_environment_map(None)
        api.add_light_ambient("/lights/ambient", intensity=1.5)
        api.add_light_directional("/lights/sun", position=(-30.0, -25.0, 60.0), intensity=1.3)
        api.configure_fog(150.0, 420.0, color=_linear(colours.horizon))
        api.set_background_image(_sky(colours.sky, colours.horizon), format="png")
        api.world_axes.visible = False
        _mesh(api, "/ground", ground(), colours.ground)
        camera, place = self.server.initial_camera, pose(CHASE, self.span)
        camera.position, camera.look_at, camera.fov = place.position, place.look_at, FIELD_OF_VIEW
        camera.near, camera.far = 0.5, 2000.0

    def _drive(self, k: int) -> Drive:
        timeline, api, base = self.timelines[k], self.server.scene, f"/drive{k}"
        rollout, own = timeline.rollout, timeline.colour
        drive = Drive(display_name(rollout.label))
        place = (0.0, scene.offsets(len(self.timelines), rollout.scenario.road)[k], 0.0)
        api.add_frame(base, show_axes=False, position=place)
        drive.road = api.add_frame(f"{base}/road", show_axes=False)
        self._road(f"{base}/road", rollout)
        for car in range(rollout.scenario.vehicles):
            self._car(drive, f"{base}/car{car}", rollout.scenario.car, car, own)
        path = _crumb_mesh(scene.crumbs(timeline, 0.0))
        drive.crumbs = _mesh(api, f"{base}/road/path", path, own, opacity=0.75)
        if timeline.imagined is not None:
            nine = enumerate(trails(timeline.imagined, int(rollout.actions[0]), 0, BRIGHT))
            drive.futures = [
                _mesh(api, f"{base}/road/future{i}", _ribbon(each), each.colour, opacity=0.9) for i, each in nine
            ]
        # Beside each other only the drivers have labels, turned outwards: with those of the traps they would overprint.
        alone, last = len(self.timelines) == 1, k == len(self.timelines) - 1
        anchor = "bottom-center" if alone or 0 < k and not last else "bottom-left" if last else "bottom-right"
        named = {EGO: "name"} | ({TRAP_1: "to_trap1", TRAP_2: "to_trap2"} if alone else {})
        for car, name in named.items():
            drive.labels[car] = api.add_label(
                f"{base}/car{car}/{name}", "", position=(0.0, 0.0, 2.6), anchor=anchor,
                font_screen_scale=0.9, visible=False,
            )  # fmt: skip
        return drive

    def _road(self, base: str, rollout) -> None:
        api, road, colours = self.server.scene, rollout.scenario.road, THEMES[self.dark]
        states = rollout.states[:, :, X]
        start, end = float(states[:, EGO].min()) - BEHIND, float(states[:, EGO].max()) + AHEAD
        tints = {"asphalt": colours.asphalt, "lines": colours.line, "posts": colours.post}
        for name, mesh in road_parts(road, start, end).items():
            _mesh(api, f"{base}/{name}", mesh, tints[name])

    def _car(self, drive: Drive, name: str, size, car: int, own: str) -> None:
        api, parts = self.server.scene, car_parts(size.length, size.width)
        drive.cars[car] = api.add_frame(name, show_axes=False)
        for part, tint in (("paint", paint(car, own)), ("dark", DARK), ("light", LIGHT)):
            _mesh(api, f"{name}/{part}", parts[part], tint, flat=True)
        drive.lamps[car] = _mesh(api, f"{name}/lamps", parts["lamps"], LAMPS["off"])
        _mesh(api, f"{name}/shadow", parts["shadow"], "#000000", opacity=0.28)
        drive.rings[car] = _mesh(api, f"{name}/ring", ring(0.11), ALARM, visible=False)

    def _move(self, drive: Drive, timeline: Timeline, t: float) -> None:
        view = scene.view(timeline, t)
        self._set(drive.road, position=tidy(-view.anchor, 0.0, 0.0), wxyz=(1.0, 0.0, 0.0, 0.0))
        for car, frame in drive.cars.items():
            turned = tuple(round(q * 65536) / 65536 for q in scene.quaternion(view.yaw[car]))
            self._set(frame, position=tidy(view.x[car], view.y[car], 0.0), wxyz=turned)
            self._set(drive.lamps[car], color=rgb(LAMPS[view.lamps[car]]))
            self._set(drive.rings[car], visible=bool(view.marked[car]))
        if drive.step != view.step:
            drive.step, drive.crumbs.vertices = view.step, _crumb_mesh(scene.crumbs(timeline, t)).vertices
        names = {EGO: drive.name} if len(self.timelines) > 1 else {}
        for car, label in drive.labels.items():
            words = ": ".join(part for part in (names.get(car), view.labels.get(car)) if part)
            self._set(label, visible=bool(words), **({"text": words} if words else {}))
        self._move_futures(drive, timeline, view)

    def _move_futures(self, drive: Drive, timeline: Timeline, view: scene.DriveView) -> None:
        """The nine imagined drives of the decision that is being carried out. They change when it does."""
        for node in drive.futures:
            self._set(node, visible=self.futures and not view.ended)
        if not drive.futures or drive.decision == view.decision:
            return
        drive.decision = view.decision
        nine = trails(timeline.imagined, int(timeline.rollout.actions[view.decision]), view.decision, BRIGHT)
        for node, one in zip(drive.futures, nine, strict=True):
            node.vertices = _ribbon(one).vertices
            self._set(node, color=rgb(one.colour))

    def _set(self, node, **properties) -> None:
        """Give a node new properties, if they are new.

        viser's own setters of a place compare it once more, by numpy, which takes as long as all the rest of a frame.
        """
        for name, value in properties.items():
            if self.sent.get((id(node), name)) != value:
                if name in PLACES:
                    self.server.scene._queue_scene_message(PLACES[name](node.name, value))
                else:
                    setattr(node, name, value)
                self.sent[id(node), name] = value


def tidy(x: float, y: float, z: float) -> tuple[float, float, float]:
    return round(float(x) * GRAIN) / GRAIN, round(float(y) * GRAIN) / GRAIN, round(float(z) * GRAIN) / GRAIN


def _mesh(api, name: str, mesh, colour: str, opacity: float | None = None, flat: bool = False, visible: bool = True):
    return api.add_mesh_simple(
        name, mesh.vertices.astype(np.float32), mesh.faces.astype(np.uint32), color=rgb(colour), opacity=opacity,
        material="toon3", flat_shading=flat, cast_shadow=False, receive_shadow=False, visible=visible,
    )  # fmt: skip


def _crumb_mesh(crumbs: np.ndarray) -> Mesh:
    """A small dash for every crumb, in the direction in which the car drove."""
    cos, sin = np.cos(crumbs[:, 3])[:, None], np.sin(crumbs[:, 3])[:, None]
    x, y = CRUMB.vertices[:, 0][None], CRUMB.vertices[:, 1][None]
    corners = np.stack([x * cos - y * sin, x * sin + y * cos, np.zeros_like(x * cos)], axis=2) + crumbs[:, None, :3]
    faces = (np.arange(len(crumbs))[:, None, None] * 4 + CRUMB.faces[None]).reshape(-1, 3)
    return Mesh(corners.reshape(-1, 3).astype(np.float32), faces)


def _ribbon(trail: Trail) -> Mesh:
    """An imagined drive as a strip on the road: broad if it is the chosen one, and then above the others."""
    x, y = scene.to_world(trail.x, trail.y)
    across = np.stack([-np.gradient(y), np.gradient(x)], axis=1)
    length = np.maximum(np.hypot(*across.T), 1e-9)[:, None]  # 0 where the drive has ended
    half = (0.28 if trail.chosen else 0.09) * across / length
    sides = np.concatenate([np.stack([x, y], axis=1) + half, np.stack([x, y], axis=1) - half])
    height = np.full((len(sides), 1), 0.1 if trail.chosen else 0.085)
    left = np.arange(len(x) - 1)
    right = left + len(x)
    faces = np.concatenate([np.stack([left, right, left + 1], 1), np.stack([left + 1, right, right + 1], 1)])
    vertices = np.round(np.concatenate([sides, height], axis=1), 3).astype(np.float32)
    return Mesh(vertices, faces)


def _linear(colour: str) -> tuple[int, int, int]:
    """A colour in linear light: fog is blended before gamma correction, all other colours are given after it."""
    return tuple(round(255 * (channel / 255) ** 2.2) for channel in rgb(colour))


def _sky(top: str, horizon: str, height: int = 64) -> np.ndarray:
    """A picture of the sky, (height, 2, 3) uint8, which fades from the colour `top` to the colour `horizon`."""
    part = np.clip(np.linspace(0, 4.0, height), 0, 1)[:, None]
    column = (1 - part) * np.array(rgb(top)) + part * np.array(rgb(horizon))
    return np.repeat(column[:, None, :], 2, axis=1).round().astype(np.uint8)
