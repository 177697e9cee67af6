"""Projection of points in the robot's torso frame into the image of its head camera, and its inverse for the head.

Frames are NAO's: x forward, y left, z up, in [m]. The head turns about the neck by yaw (positive to the left), then by
pitch (positive is down), in [rad]. In the image u grows to the right and v down, in [px], from the upper left corner.
"""

from math import asin, atan2, cos, hypot, sin, tan

from lumen.language.robots import Camera

Vector3 = tuple[float, float, float]
Matrix3 = tuple[Vector3, Vector3, Vector3]


def project(point: Vector3, camera: Camera) -> tuple[float, float] | None:
    """Return the pixel (u, v) of a point in the camera's frame; None behind the camera or outside the image.

    The camera's frame keeps the robot's axes: x points out of the lens, y left, z up.
    """
    pixel = _pixel(point, camera)
    inside = pixel and 0 <= pixel[0] < camera.width and 0 <= pixel[1] < camera.height
    return pixel if inside else None


def camera_pose(camera: Camera, yaw: float, pitch: float) -> tuple[Vector3, Matrix3]:
    """Return the camera's place in the torso frame [m], and its rotation: the columns are its x, y, z in that frame."""
    place, neck = _times(_head(yaw, pitch), camera.position), camera.neck
    return (neck[0] + place[0], neck[1] + place[1], neck[2] + place[2]), _head(yaw, pitch + camera.pitch)


def into_camera(point: Vector3, camera: Camera, yaw: float, pitch: float) -> Vector3:
    """Return a point of the torso frame in the camera's frame, with the head at `yaw`, `pitch`."""
    place, rotation = camera_pose(camera, yaw, pitch)
    offset = (point[0] - place[0], point[1] - place[1], point[2] - place[2])
    columns: Matrix3 = tuple(zip(*rotation, strict=True))  # type: ignore[assignment]
    return _times(columns, offset)


def seen(point: Vector3, camera: Camera, yaw: float, pitch: float) -> tuple[float, float] | None:
    """Return the pixel of a point of the torso frame, with the head at `yaw`, `pitch`; None if it is not visible."""
    return project(into_camera(point, camera, yaw, pitch), camera)


def centring(point: Vector3, camera: Camera) -> tuple[float, float]:
    """Return the yaw and pitch that centre a point of the torso frame in the image, ignoring joint limits.

    It is exact for a camera in the head's plane of symmetry, as in NAO; the point must be farther from the neck than
    the camera.
    """
    neck = camera.neck
    x, y, z = point[0] - neck[0], point[1] - neck[1], point[2] - neck[2]
    ahead = hypot(x, y)
    lift = sin(camera.pitch) * camera.position[0] + cos(camera.pitch) * camera.position[2]
    return atan2(y, x), asin(lift / hypot(ahead, z)) - atan2(z, ahead) - camera.pitch


def after_turning(
    pixel: tuple[float, float], camera: Camera, before: tuple[float, float], after: tuple[float, float]
) -> tuple[float, float] | None:
    """Return the pixel of a distant object, seen at `pixel`, after the head turns from one (yaw, pitch) to another.

    The pixel may lie outside the image; None if the object is no longer in front of the camera.
    """
    y = (1 - 2 * pixel[0] / camera.width) * tan(camera.horizontal_fov / 2)
    z = (1 - 2 * pixel[1] / camera.height) * tan(camera.vertical_fov / 2)
    ray = _times(_head(before[0], before[1] + camera.pitch), (1.0, y, z))
    columns: Matrix3 = tuple(zip(*_head(after[0], after[1] + camera.pitch), strict=True))  # type: ignore[assignment]
    return _pixel(_times(columns, ray), camera)


def _pixel(point: Vector3, camera: Camera) -> tuple[float, float] | None:
    """Return the pixel of a point in the camera's frame, inside the image or not; None behind the camera."""
    x, y, z = point
    if x <= 0:
        return None
    u = camera.width / 2 * (1 - y / (x * tan(camera.horizontal_fov / 2)))
    v = camera.height / 2 * (1 - z / (x * tan(camera.vertical_fov / 2)))
    return u, v


def _head(yaw: float, pitch: float) -> Matrix3:
    """Return the rows of the rotation by `yaw` about z, then by `pitch` about the new y."""
    cy, sy, cp, sp = cos(yaw), sin(yaw), cos(pitch), sin(pitch)
    return (cy * cp, -sy, cy * sp), (sy * cp, cy, sy * sp), (-sp, 0.0, cp)


def _times(matrix: Matrix3, vector: Vector3) -> Vector3:
    a, b, c = (row[0] * vector[0] + row[1] * vector[1] + row[2] * vector[2] for row in matrix)
    return a, b, c
