"""A robot's body without its simulation: joints, limits, parts, postures, camera."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from math import inf

from lumen.language.motions import MotionDefinition
from lumen.language.roles import Roles


@dataclass(frozen=True, slots=True)
class Joint:
    """A joint: its limits [rad], and its maximum speed [rad/s] and torque (`effort`, [N m]).

    The position of a hand is its opening, from 0 (closed) to 1 (open). A sliding joint has lengths [m], a speed [m/s]
    and a force [N].
    """

    name: str
    minimum: float
    maximum: float
    speed: float = inf
    effort: float = inf


@dataclass(frozen=True, slots=True)
class CoupledLimit:
    """Limits of `joint` by the angle of `on`: rows (angle of `on`, minimum, maximum) [rad], linear in between."""

    joint: str
    on: str
    rows: tuple[tuple[float, float, float], ...]


@dataclass(frozen=True, slots=True)
class Camera:
    """A pinhole camera on the head: size [px], angles of view [rad], position in the head [m], pitch down [rad].

    `neck` is the point where the axes of yaw and pitch meet, in the torso's frame [m]; the default is NAO's.
    """

    width: int
    height: int
    horizontal_fov: float
    vertical_fov: float
    position: tuple[float, float, float]
    pitch: float
    neck: tuple[float, float, float] = (0.0, 0.0, 0.1265)


@dataclass(frozen=True, slots=True)
class Ultrasound:
    """The range of the sonars."""

    minimum: float
    """The distance of the nearest echo [m]."""
    maximum: float
    """The distance of the farthest echo [m]."""
    cone: float
    """The full angle of the cone in which there are echoes [rad]."""


@dataclass(frozen=True, slots=True)
class LinkInertia:
    """A link's mass [kg], centre of mass [m], inertia about it (xx yy zz xy xz yz) [kg m^2], in its joint's axes."""

    mass: float
    centre: tuple[float, ...]
    inertia: tuple[float, ...]


@dataclass(frozen=True, slots=True)
class Body:
    """A robot model, `models/NAME.yaml`."""

    name: str
    mjcf: str
    """A file in the same folder, or `PACKAGE:PATH`; empty for a body that is never simulated."""
    joints: Mapping[str, Joint]
    """The joints by name, in the robot's own order."""
    parts: Mapping[str, tuple[str, ...]]
    """The joints of head, arms, legs and body."""
    postures: Mapping[str, Mapping[str, float]]
    """The angles of every joint, by posture [rad]."""
    coupled: tuple[CoupledLimit, ...]
    camera: Camera | None
    """The camera; a body whose eyes have a camera must have one. None without a camera."""
    tactile: tuple[str, ...]
    shared: Mapping[str, str] = field(default_factory=dict)
    """For each joint without a motor of its own, the joint whose motor also moves it."""
    hands: tuple[str, ...] = ()
    """The joints with an opening (0..1) instead of an angle."""
    slides: tuple[str, ...] = ()
    """The joints that move by a length [m]."""
    sonar: Ultrasound | None = None
    passages: tuple[MotionDefinition, ...] = ()
    """Motions between two postures (`start` and `end`), for robots that would fall on the direct way."""
    links: Mapping[str, LinkInertia] = field(default_factory=dict)
    """The inertia of links that differ from the MJCF, by name."""
    roles: Roles = field(default_factory=Roles)
    """The parts of the body by function."""
    gait: Mapping[str, Mapping[str, float]] = field(default_factory=dict)
    """For each pace, the parameters of walking that can't be derived from the legs, in SI units."""
    give: float = 0.0
    """The position error at which a servo gives its full torque [rad], for joints without an actuator in the MJCF.

    0 adds no servos.
    """
