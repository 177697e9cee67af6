"""Reads numbers in URDF and MJCF, and computes nested frames from positions and quaternions (w, x, y, z)."""

from dataclasses import dataclass
from math import cos, hypot, isfinite, pi, sin

from lumen.project.formats.conversion_findings import ConversionFindings
from lumen.project.formats.xml_elements import XmlElement

Vector = tuple[float, float, float]
Quaternion = tuple[float, float, float, float]

AXES: dict[str, Vector] = {"x": (1.0, 0.0, 0.0), "y": (0.0, 1.0, 0.0), "z": (0.0, 0.0, 1.0)}
UPRIGHT: Quaternion = (1.0, 0.0, 0.0, 0.0)


@dataclass(frozen=True, slots=True)
class NestedFrame:
    """A frame's position [m] and rotation, relative to its parent."""

    place: Vector = (0.0, 0.0, 0.0)
    turned: Quaternion = UPRIGHT

    def within(self, outer: "NestedFrame") -> "NestedFrame":
        """Return this frame, which is inside `outer`, relative to the parent of `outer`."""
        x, y, z = rotated(outer.turned, self.place)
        a, b, c = outer.place
        return NestedFrame((a + x, b + y, c + z), product(outer.turned, self.turned))


def product(a: Quaternion, b: Quaternion) -> Quaternion:
    """Return the product of two quaternions (w, x, y, z); of rotations, it is the one by `b`, then by `a`."""
    aw, ax, ay, az = a
    bw, bx, by, bz = b
    return (
        aw * bw - ax * bx - ay * by - az * bz,
        aw * bx + ax * bw + ay * bz - az * by,
        aw * by - ax * bz + ay * bw + az * bx,
        aw * bz + ax * by - ay * bx + az * bw,
    )


def rotated(q: Quaternion, v: Vector) -> Vector:
    """Return the vector `v`, rotated by the unit quaternion `q`."""
    w, x, y, z = q
    _, a, b, c = product(product(q, (0.0, *v)), (w, -x, -y, -z))
    return a, b, c


def dot(a: Vector, b: Vector) -> float:
    """Return the scalar product."""
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def turn(axis: Vector, angle: float) -> Quaternion:
    """Return the rotation about an axis by an angle [rad]; the identity if the axis has no length."""
    length = hypot(*axis)
    if not length:
        return UPRIGHT
    s = sin(angle / 2) / length
    return cos(angle / 2), axis[0] * s, axis[1] * s, axis[2] * s


def euler(angles: Vector, sequence: str = "xyz") -> Quaternion:
    """Return the rotation by three angles [rad] about the axes of `sequence`.

    Lower-case letters are rotated axes, and upper-case letters fixed axes.
    """
    q = UPRIGHT
    for letter, angle in zip(sequence, angles, strict=False):
        step = turn(AXES.get(letter.lower(), AXES["x"]), angle)
        q = product(q, step) if letter.islower() else product(step, q)
    return q


def between(start: Vector, end: Vector) -> Quaternion:
    """Return the smallest rotation from one direction to another.

    For opposite directions it is half a turn about x, or about y if `start` is nearer to x. It is the identity if a
    direction has no length.
    """
    lengths = hypot(*start) * hypot(*end)
    if not lengths:
        return UPRIGHT
    (a, b, c), (d, e, f) = start, end
    w = lengths + a * d + b * e + c * f
    if w < 1e-9 * lengths:
        axis = AXES[min("xyz", key=lambda name: abs(dot(AXES[name], start)))]
        share = dot(axis, start) / dot(start, start)
        return turn((axis[0] - share * a, axis[1] - share * b, axis[2] - share * c), pi)
    return unit((w, b * f - c * e, c * d - a * f, a * e - b * d))


def of_axes(x: Vector, y: Vector) -> Quaternion:
    """Return the rotation to the frame with this x axis, whose y axis is `y` without its share along `x`."""
    first = between(AXES["x"], x)
    cosine, sine = dot(rotated(first, AXES["y"]), y), dot(rotated(first, AXES["z"]), y)
    length, x_length = hypot(cosine, sine), hypot(*x)
    if length + cosine < 1e-9 * length or not x_length:
        return product(turn(x, pi), first)
    # Without an angle, since its sine and cosine would leave a residue in rotations by a quarter turn.
    a, b, c = (each / x_length * sine for each in x)
    return product(unit((length + cosine, a, b, c)), first)


def unit(q: Quaternion) -> Quaternion:
    """Return the quaternion scaled to length one; the identity if its length is zero."""
    length = hypot(*q)
    return (q[0] / length, q[1] / length, q[2] / length, q[3] / length) if length else UPRIGHT


class Numbers:
    """Reads numbers in attributes; invalid ones are reported and treated as missing."""

    def __init__(self, findings: ConversionFindings) -> None:
        self.findings = findings

    def all(self, element: XmlElement, name: str, count: int) -> tuple[float, ...] | None:
        """Return an attribute's `count` numbers, or None if it is missing or invalid; report an invalid one."""
        text = element.get(name)
        if not text:
            return None
        try:
            numbers = tuple(float(word) for word in text.replace(",", " ").split())
        except ValueError:
            numbers = ()
        if len(numbers) != count or not all(map(isfinite, numbers)):
            wanted = "a number" if count == 1 else f"{count} numbers"
            message = f'`{name}="{text[:40]}"` of `<{element.tag}>` is not {wanted}'
            self.findings.lost(element.place, message, "correct it in the model")
            return None
        return numbers

    def one(self, element: XmlElement, name: str) -> float | None:
        """Return an attribute's number, or None if it is missing or invalid."""
        found = self.all(element, name, 1)
        return found[0] if found else None

    def vector(self, element: XmlElement, name: str, otherwise: Vector) -> Vector:
        """Return an attribute's three numbers, or `otherwise` if it is missing or invalid."""
        found = self.all(element, name, 3)
        return (found[0], found[1], found[2]) if found else otherwise
