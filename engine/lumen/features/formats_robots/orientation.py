"""Nested frames: positions and quaternions (w, x, y, z), as in URDF and MJCF."""

from dataclasses import dataclass
from math import cos, hypot, sin

Vector = tuple[float, float, float]
Quaternion = tuple[float, float, float, float]

AXES: dict[str, Vector] = {"x": (1.0, 0.0, 0.0), "y": (0.0, 1.0, 0.0), "z": (0.0, 0.0, 1.0)}
UPRIGHT: Quaternion = (1.0, 0.0, 0.0, 0.0)


@dataclass(frozen=True, slots=True)
class NestedFrame:
    """The position [m] and rotation of a frame in its parent's."""

    place: Vector = (0.0, 0.0, 0.0)
    turned: Quaternion = UPRIGHT

    def within(self, outer: "NestedFrame") -> "NestedFrame":
        """Return this frame in the frame that `outer` is given in."""
        x, y, z = rotated(outer.turned, self.place)
        a, b, c = outer.place
        return NestedFrame((a + x, b + y, c + z), product(outer.turned, self.turned))


def product(a: Quaternion, b: Quaternion) -> Quaternion:
    """Return the rotation by `b`, then by `a`."""
    aw, ax, ay, az = a
    bw, bx, by, bz = b
    return (
        aw * bw - ax * bx - ay * by - az * bz,
        aw * bx + ax * bw + ay * bz - az * by,
        aw * by - ax * bz + ay * bw + az * bx,
        aw * bz + ax * by - ay * bx + az * bw,
    )


def rotated(q: Quaternion, v: Vector) -> Vector:
    """Return the rotated vector."""
    w, x, y, z = q
    _, a, b, c = product(product(q, (0.0, *v)), (w, -x, -y, -z))
    return a, b, c


def turn(axis: Vector, angle: float) -> Quaternion:
    """Return the rotation about an axis by that angle [rad]; the identity if the axis has no length."""
    length = hypot(*axis)
    if not length:
        return UPRIGHT
    s = sin(angle / 2) / length
    return cos(angle / 2), axis[0] * s, axis[1] * s, axis[2] * s


def euler(angles: Vector, sequence: str = "xyz") -> Quaternion:
    """Return three rotations [rad] about the axes of `sequence`: small letters are rotated axes, capitals fixed
    ones.
    """
    q = UPRIGHT
    for letter, angle in zip(sequence, angles, strict=False):
        step = turn(AXES.get(letter.lower(), AXES["x"]), angle)
        q = product(q, step) if letter.islower() else product(step, q)
    return q


def between(start: Vector, end: Vector) -> Quaternion:
    """Return the smallest rotation from one direction to another; half a turn about x if they are opposite."""
    lengths = hypot(*start) * hypot(*end)
    if not lengths:
        return UPRIGHT
    (a, b, c), (d, e, f) = start, end
    w = lengths + a * d + b * e + c * f
    if w < 1e-9 * lengths:
        return 0.0, 1.0, 0.0, 0.0
    return unit((w, b * f - c * e, c * d - a * f, a * e - b * d))


def of_axes(x: Vector, y: Vector) -> Quaternion:
    """Return the rotation to the frame with these x and y axes."""
    first = between(AXES["x"], x)
    up = rotated(first, AXES["y"])
    return product(between(up, y), first)


def unit(q: Quaternion) -> Quaternion:
    """Return the quaternion scaled to length one; the identity if its length is zero."""
    length = hypot(*q)
    return (q[0] / length, q[1] / length, q[2] / length, q[3] / length) if length else UPRIGHT
