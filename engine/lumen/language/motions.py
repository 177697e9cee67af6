"""A motion file as values, flattened: the keys of each joint over time, and the cues that accompany them."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from enum import StrEnum

from lumen.language.commands import Do
from lumen.language.diagnostics import NodePath

SKILL_CUE = "skill"
"""The kind of the cues that begin skills."""


class Interpolation(StrEnum):
    """The curve on which a joint moves to a key."""

    LINEAR = "linear"
    CUBIC = "cubic"
    MINIMUM_JERK = "minimum-jerk"
    BEZIER = "bezier"


@dataclass(frozen=True, slots=True)
class Keyframe:
    """A key of a joint.

    Handles are (dt [s], da [rad]), as in NAOqi's `angleInterpolationBezier`. A handle with dt = 0 is chosen so that the
    curve is smooth and does not overshoot.
    """

    time: float
    """The time at which the joint reaches the angle [s]."""
    angle: float
    """The angle [rad; a hand 0..1]."""
    interpolation: Interpolation = Interpolation.MINIMUM_JERK
    """The curve from the previous key to this one."""
    handle_in: tuple[float, float] = (0.0, 0.0)
    """The Bezier handle before the key, with dt < 0."""
    handle_out: tuple[float, float] = (0.0, 0.0)
    """The Bezier handle after the key, with dt > 0."""
    where: NodePath = field(default=(), compare=False)


@dataclass(frozen=True, slots=True)
class Cue:
    """An action that accompanies the movement of a motion."""

    time: float
    """The time from the beginning [s]."""
    kind: str
    """`say`, `sound`, `leds`, `hold`, or `skill` for a cue that begins a skill."""
    value: object
    """The value in the file; for a skill a map of its name (`skill`) and its `arguments`."""
    where: NodePath = field(default=(), compare=False)


def skill_cue(command: Do, where: NodePath = ()) -> Cue:
    """Return the cue at time 0 that begins a skill."""
    return Cue(0.0, SKILL_CUE, {"skill": command.skill, "arguments": dict(command.arguments)}, where)


def skill_of(kind: object, value: object) -> Do | None:
    """Return the command of the skill that a cue of this kind and value begins; None for any other cue."""
    match value:
        case {"skill": str(name), "arguments": Mapping() as arguments} if kind == SKILL_CUE:
            return Do(name, arguments)
    return None


@dataclass(frozen=True)
class MotionDefinition:
    """A motion: the keys over time of each joint that it moves, and the cues that accompany them.

    Keys of one track have increasing times above 0: the angle of a joint at time 0 is known only when the motion is
    played.
    """

    name: str
    duration: float
    """The motion's duration [s]."""
    tracks: Mapping[str, tuple[Keyframe, ...]]
    cues: tuple[Cue, ...] = ()
    start: str = ""
    """The posture in which the motion begins; empty if the file names none."""
    end: str = ""
    """The posture to which the motion returns; empty if the file names none."""
    origin: Mapping[str, float] = field(default_factory=dict)
    """The angles of `start` [rad], for the joints of `tracks`."""
