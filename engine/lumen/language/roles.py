"""The functions of a body's parts, `roles` of `models/NAME.yaml`. Skills, motions and life use them instead of names.

Directions are those of NAO for every body: a positive yaw is to the left, a positive pitch down or forward, a positive
roll to the left. Only the head's positive roll is to the right, about the axis that points ahead.
"""

from collections.abc import Mapping
from dataclasses import dataclass, field

from lumen.feature import BaseRow, table

LEFT, RIGHT = SIDES = ("left", "right")

HEAD_ROLES = ("yaw", "pitch")
"""The joints by which a head looks somewhere."""
HEAD_MOVES = ("roll", "x", "y", "z")
"""Other joints of a head: `roll` tilts it; `x` (ahead), `y` (left) and `z` (up) are sliding joints."""
ARM_ROLES = ("shoulder-pitch", "shoulder-roll", "elbow-yaw", "elbow-roll", "wrist-yaw")
LEG_ROLES = ("hip-yaw", "hip-roll", "hip-pitch", "knee", "ankle-pitch", "ankle-roll")
"""The joints of a leg from the hip to the sole; walking on feet needs all six."""

JOINT_PATHS = (
    *(f"head.{name}" for name in (*HEAD_ROLES, *HEAD_MOVES)),
    "body.yaw",
    *(f"arms.{side}.{name}" for side in SIDES for name in ARM_ROLES),
    *(f"{kind}.{side}" for kind in ("hands", "antennas") for side in SIDES),
    *(f"legs.{side}.{name}" for side in SIDES for name in LEG_ROLES),
)
"""Every role that a joint can have, as messages, motions and docs write it: `arms.left.shoulder-pitch`."""

HEAD_YAW, HEAD_PITCH = "head.yaw", "head.pitch"


FIXED = "fixed"
"""The default kind of a body's base."""


@dataclass(frozen=True, slots=True)
class JointRole:
    """The joint that has a role; `reversed` is true if its positive direction is the opposite of the role's."""

    joint: str
    reversed: bool = False

    @property
    def sign(self) -> float:
        """The factor that converts an angle of the role to one of the joint: 1 or -1."""
        return -1.0 if self.reversed else 1.0


@dataclass(frozen=True, slots=True)
class Base:
    """The base of a body, which carries it and may move it about."""

    kind: str = FIXED
    """The name of a feature's row in the table `bases`."""
    left: str = ""
    """The joint of the left driven wheel in the MJCF; empty if the base has no wheels."""
    right: str = ""
    """The joint of the right driven wheel in the MJCF; empty if the base has no wheels."""
    speed: float = 0.0
    """The maximum speed [m/s]."""
    turn: float = 0.0
    """The maximum rate of turning [rad/s]."""

    @property
    def row(self) -> BaseRow:
        """The feature's row of the base's `kind`."""
        row: BaseRow = table("bases")[self.kind]
        return row


@dataclass(frozen=True, slots=True)
class EyeRoles:
    """The parts of the MJCF that are the robot's eyes and face."""

    camera: str = ""
    """The name of the camera that the robot sees with; empty for none."""
    face: str = ""
    """The name of the link that carries the face; empty for none."""


@dataclass(frozen=True, slots=True)
class SensorRoles:
    """Sensors of the MJCF by kind."""

    gyro: str = ""
    """The name of the gyroscope."""
    accelerometer: str = ""
    """The name of the accelerometer."""
    sonar: Mapping[str, str] = field(default_factory=dict)
    """The site of each sonar, by side."""
    force: Mapping[str, tuple[str, ...]] = field(default_factory=dict)
    """The sites of the force sensors of each sole, by side."""


@dataclass(frozen=True)
class Roles:
    """The parts of a body by function.

    All may be absent; the body can't perform actions that need an absent part.
    """

    torso: str = ""
    """The name of the torso's link in the MJCF (x ahead, y left, z up); empty for none."""
    head: Mapping[str, JointRole] = field(default_factory=dict)
    body: Mapping[str, JointRole] = field(default_factory=dict)
    eyes: EyeRoles = EyeRoles()
    arms: Mapping[str, Mapping[str, JointRole]] = field(default_factory=dict)
    hands: Mapping[str, JointRole] = field(default_factory=dict)
    antennas: Mapping[str, JointRole] = field(default_factory=dict)
    legs: Mapping[str, Mapping[str, JointRole]] = field(default_factory=dict)
    soles: Mapping[str, str] = field(default_factory=dict)
    """The site of each sole (x ahead, z up), by side."""
    base: Base = Base()
    sensors: SensorRoles = SensorRoles()
    lights: Mapping[str, tuple[str, ...]] = field(default_factory=dict)
    """The materials of the MJCF that show each group of lights."""
    paths: Mapping[str, JointRole] = field(init=False, compare=False)
    """Every role that a joint of this body has, by its path, in the order of `JOINT_PATHS`."""

    def __post_init__(self) -> None:
        limbs = {f"{kind}.{side}.": limb for kind in ("arms", "legs") for side, limb in getattr(self, kind).items()}
        grouped = {"head.": self.head, "body.": self.body, "hands.": self.hands, "antennas.": self.antennas, **limbs}
        found = {prefix + name: role for prefix, roles in grouped.items() for name, role in roles.items()}
        object.__setattr__(self, "paths", {path: found[path] for path in JOINT_PATHS if path in found})

    def joint(self, path: str) -> JointRole | None:
        """Return the joint of a role such as `head.yaw`; None if this body lacks it."""
        return self.paths.get(path)

    def path(self, joint: str) -> str:
        """Return the role of the joint of that name; empty if it has no role."""
        return next((path for path, role in self.paths.items() if role.joint == joint), "")

    def head_joints(self, yaw: float, pitch: float) -> dict[str, float]:
        """Return the angle [rad] of each joint that turns the head and that the body has, for this yaw and pitch."""
        wanted = ((self.joint(HEAD_YAW), yaw), (self.joint(HEAD_PITCH), pitch))
        return {role.joint: role.sign * angle for role, angle in wanted if role}

    def head_angles(self, angles: Mapping[str, float]) -> tuple[float, float]:
        """Return the yaw and pitch of the head [rad] at these joint angles; 0 for a joint that the body lacks."""
        yaw, pitch = (self.joint(path) for path in (HEAD_YAW, HEAD_PITCH))
        return (
            yaw.sign * angles.get(yaw.joint, 0.0) if yaw else 0.0,
            pitch.sign * angles.get(pitch.joint, 0.0) if pitch else 0.0,
        )

    def name(self, path: str) -> str:
        """Return the name of the joint of a role such as `head.yaw`; empty if this body lacks it."""
        role = self.paths.get(path)
        return role.joint if role else ""
