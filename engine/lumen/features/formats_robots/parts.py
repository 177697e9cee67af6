"""A robot's model, independent of its file format."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

from lumen.features.formats_robots.orientation import Vector
from lumen.language.diagnostics import Place


@dataclass(frozen=True, slots=True)
class ModelJoint:
    """A hinge joint of an imported robot."""

    name: str
    link: str
    """The link that the joint moves."""
    place: Place
    position: Vector
    """The position in the robot's frame, with all joints at zero [m]."""
    axis: Vector
    """The axis in the robot's frame, with all joints at zero."""
    low: float | None = None
    """The lower limit [rad], None without limits."""
    high: float | None = None
    """The upper limit [rad], None without limits."""
    speed: float | None = None
    """The greatest speed [rad/s], None if unknown."""
    effort: float | None = None
    """The greatest torque [N m], None if unknown."""
    follows: str = ""
    """The joint whose angle this joint equals, since one motor moves both; empty for none."""
    servo: bool = False
    """Whether a position servo with the joint's name drives it."""
    wheel: bool = False
    """Whether a velocity motor drives the joint."""


@dataclass(frozen=True, slots=True)
class ModelCamera:
    """A camera of an imported robot."""

    name: str
    link: str
    position: Vector
    """The position in the link's frame [m]."""
    ahead: Vector
    """The direction of view in the link's frame."""
    fovy: float
    """The vertical angle of view [rad]."""


@dataclass(frozen=True)
class RobotModel:
    """The joints, links, cameras and sensors of an imported robot."""

    name: str
    file: str
    root: Place
    joints: Sequence[ModelJoint]
    """The hinges, in the file's order."""
    links: Mapping[str, str]
    """The parent of each link; empty for the root."""
    cameras: Sequence[ModelCamera] = ()
    sites: Mapping[str, str] = field(default_factory=dict)
    """The link of each site."""
    sensors: Mapping[str, str] = field(default_factory=dict)
    """The name of the first sensor of each kind."""
    materials: Sequence[str] = ()
    """The names of materials."""

    def carries(self, link: str, other: str) -> bool:
        """Return whether `other` is `link` or a descendant of it."""
        seen = set[str]()
        while other and other not in seen:
            if other == link:
                return True
            seen.add(other)
            other = self.links.get(other, "")
        return False


def follows(follower: str, leader: str) -> tuple[str, str]:
    """Return the message and the hint for a joint that follows another with a factor or an offset."""
    message = f"`{follower}` follows `{leader}` with a factor or an offset: only the model moves it"
    return message, "in motions, use the joint that it follows"
