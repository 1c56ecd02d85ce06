"""Camera positions. The ego stays at the world's origin and the road moves past it, so a camera never has to move."""

from typing import NamedTuple

CHASE, BIRD, SIDE, FREE = "chase", "bird's eye", "side", "free"
CAMERAS = (CHASE, BIRD, SIDE, FREE)
FIELD_OF_VIEW = 0.87  # rad, vertical (50 degrees)


class Pose(NamedTuple):
    position: tuple[float, float, float]  # m, world
    look_at: tuple[float, float, float]


def pose(name: str, span: float) -> Pose:
    """A camera over roads that are `span` metres wide together. "free": from there, turn it with the mouse."""
    more = max(0.0, span - 14.0)  # one road of three lanes is 14 m wide
    return {
        CHASE: Pose((-17.0 - 0.55 * more, 0.0, 7.5 + 0.32 * more), (13.0, 0.0, 0.0)),
        BIRD: Pose((2.0, 0.0, 62.0 + 0.85 * more), (12.0, 0.0, 0.0)),
        SIDE: Pose((6.0, -20.0 - 0.9 * more, 5.0 + 0.25 * more), (6.0, 0.0, 0.0)),
        FREE: Pose((-30.0 - 0.5 * more, -24.0 - 0.6 * more, 24.0 + 0.5 * more), (12.0, 0.0, 0.0)),
    }[name]


def point(camera, name: str, span: float) -> None:
    """Move one viewer's camera (a viser CameraHandle). The position comes first, since setting it moves the aim too."""
    place = pose(name, span)
    camera.up_direction = (0.0, 0.0, 1.0)
    camera.position = place.position
    camera.look_at = place.look_at
