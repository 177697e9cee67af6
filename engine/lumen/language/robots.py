"""What is known of a robot's body without simulating it: joints, limits, parts, postures, camera."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from math import inf

from lumen.language.motions import MotionDefinition
from lumen.language.roles import Roles


@dataclass(frozen=True, slots=True)
class Joint:
    """A joint: limits [rad], greatest speed [rad/s], greatest torque [N m].

    A hand counts 0 closed to 1 open. A joint that slides has lengths [m], [m/s] and a force [N].
    """

    name: str
    minimum: float
    maximum: float
    speed: float = inf
    effort: float = inf


@dataclass(frozen=True, slots=True)
class CoupledLimit:
    """Limits of `joint` by where `on` stands: rows (angle of `on`, minimum, maximum) [rad], linear in between."""

    joint: str
    on: str
    rows: tuple[tuple[float, float, float], ...]


@dataclass(frozen=True, slots=True)
class Camera:
    """A pinhole camera on the head: size [px], angles of view [rad], place in its frame [m], pitch down [rad].

    `neck` is where the axes of yaw and pitch meet, in the torso's frame [m]: NAO's unless the body names another.
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
    """What the sonars hear: echoes from `minimum` to `maximum` [m] inside a cone of that full angle [rad]."""

    minimum: float
    maximum: float
    cone: float


@dataclass(frozen=True, slots=True)
class LinkInertia:
    """A link's mass [kg], centre of mass [m], inertia about it (xx yy zz xy xz yz) [kg m^2], in its joint's axes."""

    mass: float
    centre: tuple[float, ...]
    inertia: tuple[float, ...]


@dataclass(frozen=True, slots=True)
class Body:
    """A robot model: `models/NAME.yaml` beside its MJCF.

    `joints` keeps the robot's own order of names. `parts` maps head, arms, legs and body to joint names.
    `postures` maps a posture to angles [rad] of every joint. `shared` maps a joint to the one whose motor moves it too;
    `hands` are the joints that open (0..1) rather than turn, `slides` those that move by a length [m]. `passages` are
    the motions from one posture (`start`) to another (`end`) where a straight way would fall. `links` are those that
    differ from the MJCF. `roles` say what its parts are; one whose eyes have a camera has a `camera`. `gait` maps the
    name of a pace to what of it does not follow from the legs, in SI units. `mjcf` is a file beside it, or
    `PACKAGE:PATH`; empty for a body that is never simulated. `give` is how far off [rad] the servos give all their
    torque that joints get which have none in the MJCF; 0 where none is added.
    """

    name: str
    mjcf: str
    joints: Mapping[str, Joint]
    parts: Mapping[str, tuple[str, ...]]
    postures: Mapping[str, Mapping[str, float]]
    coupled: tuple[CoupledLimit, ...]
    camera: Camera | None
    tactile: tuple[str, ...]
    shared: Mapping[str, str] = field(default_factory=dict)
    hands: tuple[str, ...] = ()
    slides: tuple[str, ...] = ()
    sonar: Ultrasound | None = None
    passages: tuple[MotionDefinition, ...] = ()
    links: Mapping[str, LinkInertia] = field(default_factory=dict)
    roles: Roles = field(default_factory=Roles)
    gait: Mapping[str, Mapping[str, float]] = field(default_factory=dict)
    give: float = 0.0
