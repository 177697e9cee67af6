"""Solid objects in a hall, seen from above, up to the robot's height: read from its MJCF, without MuJoCo."""

from collections.abc import Mapping
from contextlib import suppress
from math import cos, dist, hypot, inf, pi, sin
from typing import NamedTuple

from lumen.lint.mjcf_elements import ModelElement, mjcf_elements

ROBOT_HEIGHT, TOE_HEIGHT = 0.6, 0.02
"""Heights above the stage [m]: objects that begin above the first or end below the second block no robot."""

STAGE_SITE = "stage"
"""The site at which the robot starts."""


class GroundPoint(NamedTuple):
    """A point of the ground [m] in the frame of the stage: x forward, y to the left."""

    x: float
    y: float


class Obstacle(NamedTuple):
    """A solid object from above: a rectangle around (`x`, `y`), turned by `yaw` and enlarged by `round` on all sides.

    If `length` and `width` are 0, it is a disc.
    """

    x: float
    """The x coordinate of the centre [m]."""
    y: float
    """The y coordinate of the centre [m]."""
    yaw: float
    """The turn to the left [rad]."""
    length: float
    """Half the extent along the rectangle's own x axis [m]."""
    width: float
    """Half the extent along its own y axis [m]."""
    round: float
    """The radius by which the rectangle is enlarged [m]."""

    def distance(self, point: GroundPoint) -> float:
        """Return the distance of a point from the object [m]; 0 inside."""
        dx, dy, c, s = point.x - self.x, point.y - self.y, cos(self.yaw), sin(self.yaw)
        along, across = abs(dx * c + dy * s) - self.length, abs(dy * c - dx * s) - self.width
        return max(0.0, hypot(max(along, 0.0), max(across, 0.0)) - self.round)


class _Frame(NamedTuple):
    """The frame of a body in the hall: its position [m] and its turn to the left [rad]."""

    x: float = 0.0
    y: float = 0.0
    z: float = 0.0
    yaw: float | None = 0.0
    """The turn [rad]; None (unknown) if the body is also turned about an axis other than the vertical."""


def obstacles(content: bytes) -> tuple[Obstacle, ...]:
    """Return the solid objects of a hall that can block a robot; none if the hall is unreadable or has no stage.

    Boxes, cylinders, spheres, capsules and planes are read; meshes and height fields are not.
    """
    stage, found = _solids(content)
    low, high = stage.z + TOE_HEIGHT, stage.z + ROBOT_HEIGHT
    return tuple(_from(stage, shape) for shape, bottom, top in found if top > low and bottom < high)


def ground(content: bytes) -> tuple[Obstacle, ...]:
    """Return a hall's surfaces at the height of its stage, on which the robot can stand; none if they are unknown."""
    stage, found = _solids(content)
    return tuple(_from(stage, shape) for shape, _, top in found if abs(top - stage.z) < TOE_HEIGHT)


def _from(stage: _Frame, shape: Obstacle) -> Obstacle:
    return shape._replace(x=shape.x - stage.x, y=shape.y - stage.y)


def _solids(content: bytes) -> tuple[_Frame, list[tuple[Obstacle, float, float]]]:
    """Return the frame of the stage, and the solid objects with their bottom and top [m] in the frame of the hall.

    If the hall is unreadable or has no stage, there are no objects.
    """
    elements, fault = mjcf_elements(content)
    if fault:
        return _Frame(), []
    degrees = not any(e.name == "compiler" and e.attributes.get("angle") == "radian" for e in elements)
    defaults, found, stage, frames = _defaults(elements), [], None, {0: _Frame()}
    inherited = {0: ""}
    for element in elements:
        depth, said = element.depth, element.attributes
        around = frames.get(depth - 1) or _Frame()
        inherits = inherited.get(depth - 1, "")
        frames[depth], inherited[depth] = around, said.get("childclass", inherits)
        with suppress(ValueError, IndexError):
            if element.name == "body":
                frames[depth] = _placed(around, said, degrees)
            elif element.name == "site" and said.get("name") == STAGE_SITE:
                stage = _placed(around, said, degrees)
            elif element.name == "geom":
                whole = {**defaults.get("", {}), **defaults.get(said.get("class", inherits), {}), **said}
                found += [shape] if (shape := _shape(around, whole, degrees)) else []
    return (stage, found) if stage else (_Frame(), [])


def _defaults(elements: list[ModelElement]) -> dict[str, Mapping[str, str]]:
    """Return the default attributes of geoms by class; the outermost class has an empty name."""
    classes: dict[int, str] = {}
    found: dict[str, Mapping[str, str]] = {"": {}}
    for element in elements:
        if element.name == "default":
            around = classes.get(element.depth - 1, "")
            name = element.attributes.get("class", "") if element.depth - 1 in classes else ""
            classes = {depth: c for depth, c in classes.items() if depth < element.depth} | {element.depth: name}
            found[name] = {**found.get(around, {}), **found.get(name, {})}
        elif element.name == "geom" and element.depth - 1 in classes:
            name = classes[element.depth - 1]
            found[name] = {**found[name], **element.attributes}
        elif element.name in ("worldbody", "asset"):
            break
    return found


def _placed(around: _Frame, said: Mapping[str, str], degrees: bool) -> _Frame:
    x, y, z = _numbers(said.get("pos", "0 0 0"))
    yaw = around.yaw or 0.0
    turn: float | None = 0.0
    if "euler" in said:
        roll, pitch, heading = _numbers(said["euler"])
        turn = None if roll or pitch else heading * (pi / 180 if degrees else 1.0)
    elif any(name in said for name in ("quat", "axisangle", "xyaxes", "zaxis")):
        turn = None
    c, s = cos(yaw), sin(yaw)
    whole = None if turn is None or around.yaw is None else yaw + turn
    return _Frame(around.x + x * c - y * s, around.y + x * s + y * c, around.z + z, whole)


def _shape(around: _Frame, said: Mapping[str, str], degrees: bool) -> tuple[Obstacle, float, float] | None:
    """Return the outline of a solid geom, its bottom and its top [m]; None if it has no collisions or an unknown shape.

    A geom that is turned about an axis other than the vertical becomes the ball around it. Raises ValueError or
    IndexError if its numbers are malformed.
    """
    if said.get("contype", "1") == "0" and said.get("conaffinity", "1") == "0":
        return None
    kind, size = said.get("type", "sphere"), _numbers(said.get("size", ""))
    if "fromto" in said:
        ends = _numbers(said["fromto"])
        middle = " ".join(str((a + b) / 2) for a, b in zip(ends[:3], ends[3:], strict=True))
        return _ball(_placed(around, {"pos": middle}, degrees), size[0] + dist(ends[:3], ends[3:]) / 2)
    frame = _placed(around, said, degrees)
    if kind == "plane" and frame.yaw is not None:  # MuJoCo's planes are infinite, whatever their drawn size
        return Obstacle(frame.x, frame.y, frame.yaw, inf, inf, 0.0), -inf, frame.z
    upright = {"box": (3, 2), "cylinder": (2, 1), "capsule": (2, 1), "sphere": (1, 0)}
    if kind not in upright:
        return None
    count, vertical = upright[kind]
    size = size[:count]
    height = size[vertical] + (size[0] if kind == "capsule" else 0.0)
    if frame.yaw is None:
        return _ball(frame, hypot(*size))
    length, width, reach = (size[0], size[1], 0.0) if kind == "box" else (0.0, 0.0, size[0])
    flat = Obstacle(frame.x, frame.y, frame.yaw, length, width, reach)
    return flat, frame.z - height, frame.z + height


def _ball(frame: _Frame, reach: float) -> tuple[Obstacle, float, float]:
    return Obstacle(frame.x, frame.y, 0.0, 0.0, 0.0, reach), frame.z - reach, frame.z + reach


def _numbers(text: str) -> list[float]:
    """Return the numbers in a text. Raises ValueError for other words and for infinite numbers."""
    found = [float(word) for word in text.split()]
    if any(not -inf < number < inf for number in found):
        raise ValueError(text)
    return found


def nearest(shapes: tuple[Obstacle, ...], begin: GroundPoint, end: GroundPoint, step: float = 0.02) -> float:
    """Return the smallest distance [m] of a straight walk from any object, checked about every `step` [m].

    Infinite if there are no objects.
    """
    count = max(1, round(hypot(end.x - begin.x, end.y - begin.y) / step))
    points = [
        GroundPoint(begin.x + (end.x - begin.x) * i / count, begin.y + (end.y - begin.y) * i / count)
        for i in range(count + 1)
    ]
    return min((shape.distance(point) for shape in shapes for point in points), default=inf)
