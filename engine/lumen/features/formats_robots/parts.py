"""What a robot's model says of its parts, whichever format it stands in."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

from lumen.features.formats_robots.orientation import Vector
from lumen.language.diagnostics import Place


@dataclass(frozen=True, slots=True)
class ModelJoint:
    """A hinge: where it stands and its axis in the robot's frame, all joints at zero [m]; limits, speed, torque in SI.

    `low` and `high` are None for one that turns for ever, `speed` and `effort` where nothing is said. `link` is what it
    moves. `follows` is a joint that this one equals (another's motor moves both), `servo` whether a position servo of
    its name drives it, `wheel` whether a velocity motor does.
    """

    name: str
    link: str
    place: Place
    position: Vector
    axis: Vector
    low: float | None = None
    high: float | None = None
    speed: float | None = None
    effort: float | None = None
    follows: str = ""
    servo: bool = False
    wheel: bool = False


@dataclass(frozen=True, slots=True)
class ModelCamera:
    """A camera: its link, its place there [m], where it looks in the link's axes, vertical angle of view [rad]."""

    name: str
    link: str
    position: Vector
    ahead: Vector
    fovy: float


@dataclass(frozen=True)
class RobotModel:
    """A robot: hinges in the file's order, links with the link around each, and names of what else roles may ask for.

    `sites` maps a site to its link; `sensors` are the first of each kind; `materials` are names.
    """

    name: str
    file: str
    root: Place
    joints: Sequence[ModelJoint]
    links: Mapping[str, str]
    cameras: Sequence[ModelCamera] = ()
    sites: Mapping[str, str] = field(default_factory=dict)
    sensors: Mapping[str, str] = field(default_factory=dict)
    materials: Sequence[str] = ()

    def carries(self, link: str, other: str) -> bool:
        """Whether `other` is that link or hangs on it."""
        seen = set[str]()
        while other and other not in seen:
            if other == link:
                return True
            seen.add(other)
            other = self.links.get(other, "")
        return False


def follows(follower: str, leader: str) -> tuple[str, str]:
    """The message and the hint for a joint that follows another one with a factor or an offset."""
    message = f"`{follower}` follows `{leader}` with a factor or an offset: only the model moves it"
    return message, "in motions, use the joint that it follows"
