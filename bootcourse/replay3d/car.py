"""The body that all cars share: a saloon made of few polygons.

It stands on z = 0, with its centre at the origin and its nose along +x, 5 m long and 2 m wide, and is scaled to the
scenario's car. Each part has one colour: `paint` has the car's, the others have their own.
"""

from functools import lru_cache
from typing import NamedTuple

import numpy as np

from bootcourse.colours import TRAFFIC, TRAP
from bootcourse.road.state import EGO
from bootcourse.road.state import TRAFFIC as FIRST_OF_TRAFFIC

DARK, LIGHT = "#20242B", "#EDF1F5"  # glass, tyres and grille; head lamps and hubs
LAMPS = {"off": "#6B1414", "brake": "#FF2020", "power": "#2BE070"}  # of the bar at the rear

# One cross-section of the body per row: x, then half widths at sill, waist and shoulder, then their heights (m).
BODY = np.array(
    [
        [-2.50, 0.78, 0.84, 0.76, 0.42, 0.60, 0.80],
        [-2.38, 0.88, 0.96, 0.84, 0.30, 0.60, 0.93],
        [-1.70, 0.92, 1.00, 0.88, 0.24, 0.62, 0.98],
        [0.95, 0.92, 1.00, 0.88, 0.24, 0.62, 0.95],
        [2.05, 0.90, 0.97, 0.80, 0.26, 0.58, 0.80],
        [2.42, 0.82, 0.88, 0.70, 0.34, 0.54, 0.68],
        [2.50, 0.74, 0.80, 0.62, 0.40, 0.52, 0.62],
    ]
)
# The cabin: x and half width at its foot and at the roof, back to front.
CABIN_FOOT = np.array([[-1.80, 0.80], [1.15, 0.82]])
CABIN_ROOF = np.array([[-1.10, 0.62], [0.25, 0.64]])
FOOT_Z, ROOF_Z = 0.93, 1.42
WHEEL_X, WHEEL_Y, WHEEL_RADIUS, WHEEL_WIDTH, WHEEL_SIDES = (-1.52, 1.55), 0.90, 0.36, 0.25, 12


class Mesh(NamedTuple):
    vertices: np.ndarray  # (V, 3) m
    faces: np.ndarray  # (F, 3) int, counter-clockwise seen from outside


def join(*meshes: Mesh) -> Mesh:
    """Several meshes as one."""
    starts = np.cumsum([0] + [len(mesh.vertices) for mesh in meshes[:-1]])
    faces = [mesh.faces + start for mesh, start in zip(meshes, starts, strict=True)]
    return Mesh(np.concatenate([mesh.vertices for mesh in meshes]), np.concatenate(faces))


def loft(sections: np.ndarray) -> Mesh:
    """The closed skin over cross-sections (sections, points, 3), each counter-clockwise seen from the front (+x)."""
    n, m, _ = sections.shape
    faces = []
    for i in range(n - 1):
        for j in range(m):
            a, b = i * m + j, i * m + (j + 1) % m
            faces += [[a, b, b + m], [a, b + m, a + m]]
    for j in range(1, m - 1):  # the back and the front
        faces += [[0, j + 1, j], [(n - 1) * m, (n - 1) * m + j, (n - 1) * m + j + 1]]
    return Mesh(sections.reshape(-1, 3).astype(float), np.array(faces))


def box(low, high) -> Mesh:
    (x0, y0, z0), (x1, y1, z1) = low, high
    return loft(np.array([[[x, y0, z0], [x, y1, z0], [x, y1, z1], [x, y0, z1]] for x in (x0, x1)]))


def quads(x0, x1, y0, y1, z: float = 0.0) -> Mesh:
    """Flat rectangles that face up; x0, x1, y0, y1: (n,) or scalars."""
    x0, x1, y0, y1 = np.broadcast_arrays(*map(np.atleast_1d, (x0, x1, y0, y1)))
    n = len(x0)
    corners = np.stack([x0, y0, x1, y0, x1, y1, x0, y1], axis=1).reshape(n * 4, 2)
    vertices = np.column_stack([corners, np.full(n * 4, z)])
    return Mesh(vertices, (np.arange(n)[:, None, None] * 4 + np.array([[0, 1, 2], [0, 2, 3]])).reshape(-1, 3))


def disc(radius_x: float, radius_y: float, sides: int, z: float = 0.0) -> Mesh:
    """A flat ellipse that faces up."""
    angles = np.arange(sides) * 2 * np.pi / sides
    rim = np.column_stack([radius_x * np.cos(angles), radius_y * np.sin(angles), np.full(sides, z)])
    return Mesh(rim, np.array([[0, j, j + 1] for j in range(1, sides - 1)]))


def ring(z: float = 0.0) -> Mesh:
    """A flat ring around a car, which faces up."""
    inner, outer, sides = 3.1, 3.7, 40
    angles = np.arange(sides) * 2 * np.pi / sides
    circle = np.column_stack([np.cos(angles), np.sin(angles)])
    vertices = np.column_stack([np.concatenate([inner * circle, outer * circle]), np.full(2 * sides, z)])
    j = np.arange(sides)
    k = (j + 1) % sides
    faces = np.concatenate([np.column_stack([j, j + sides, k + sides]), np.column_stack([j, k + sides, k])])
    return Mesh(vertices, faces)


def _body() -> Mesh:
    sections = []
    for x, sill, waist, shoulder, z_sill, z_waist, z_shoulder in BODY:
        right = [[x, -sill, z_sill], [x, -waist, z_waist], [x, -shoulder, z_shoulder]]
        left = [[x, -y, z] for x, y, z in reversed(right)]
        sections.append((right + left)[::-1])
    return loft(np.array(sections))


def _cabin() -> Mesh:
    ends = zip(CABIN_FOOT, CABIN_ROOF, strict=True)
    return loft(
        np.array([[[x, -w, FOOT_Z], [x, w, FOOT_Z], [u, v, ROOF_Z], [u, -v, ROOF_Z]] for (x, w), (u, v) in ends])
    )


def _roof() -> Mesh:
    (x0, w0), (x1, w1) = CABIN_ROOF + np.array([[-0.06, 0.02], [0.06, 0.02]])
    low = [[[x, -w, ROOF_Z - 0.02], [x, w, ROOF_Z - 0.02]] for x, w in ((x0, w0), (x1, w1))]
    high = [[[x, w - 0.05, ROOF_Z + 0.05], [x, -w + 0.05, ROOF_Z + 0.05]] for x, w in ((x0 + 0.08, w0), (x1 - 0.1, w1))]
    return loft(np.array([a + b for a, b in zip(low, high, strict=True)]))


def _wheels(radius: float, y_inner: float, y_outer: float) -> Mesh:
    angles = np.arange(WHEEL_SIDES) * 2 * np.pi / WHEEL_SIDES
    wheels = []
    for x in WHEEL_X:
        for low, high in ((-y_outer, -y_inner), (y_inner, y_outer)):
            rim = np.column_stack([radius * np.sin(angles), np.zeros(WHEEL_SIDES), radius * np.cos(angles)])
            side = np.array([rim + [x, y, WHEEL_RADIUS] for y in (low, high)])
            wheels.append(loft(side))
    return join(*wheels)


CRUMB = quads(-0.55, 0.55, -0.09, 0.09)  # a small dash of the path driven


def paint(car: int, own: str) -> str:
    """The colour of a car; own: of the ego."""
    return own if car == EGO else TRAP if car < FIRST_OF_TRAFFIC else TRAFFIC


@lru_cache(maxsize=8)
def car_parts(length: float = 5.0, width: float = 2.0) -> dict[str, Mesh]:
    """The parts of a car of that size: paint, dark, light, lamps, shadow."""
    outer = WHEEL_Y + WHEEL_WIDTH / 2
    tyres, hubs = _wheels(WHEEL_RADIUS, WHEEL_Y - WHEEL_WIDTH / 2, outer), _wheels(0.2, WHEEL_Y, outer + 0.01)
    grille = box((2.36, -0.55, 0.34), (2.505, 0.55, 0.46))
    right, left = box((2.30, -0.80, 0.50), (2.48, -0.48, 0.62)), box((2.30, 0.48, 0.50), (2.48, 0.80, 0.62))
    parts = {
        "paint": join(_body(), _roof()),
        "dark": join(_cabin(), tyres, grille),
        "light": join(hubs, right, left),
        "lamps": join(box((-2.54, -0.80, 0.64), (-2.30, 0.80, 0.78)), box((-1.24, -0.30, 1.38), (-1.10, 0.30, 1.45))),
        "shadow": disc(2.85, 1.25, 20, 0.085),
    }
    scale = np.array([length / 5, width / 2, width / 2])
    return {name: Mesh(mesh.vertices * scale, mesh.faces) for name, mesh in parts.items()}
