"""What a motion file says, flattened: for every joint its keys in time, and the cues beside them."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from enum import StrEnum

from lumen.language.diagnostics import Path


class Interpolation(StrEnum):
    """How a joint comes to a key."""

    LINEAR = "linear"
    CUBIC = "cubic"
    MINIMUM_JERK = "minimum-jerk"
    BEZIER = "bezier"


@dataclass(frozen=True, slots=True)
class Key:
    """At `time` [s] the joint stands at `angle` [rad; a hand 0..1]; handles are (dt [s], da [rad]) for Bezier."""

    time: float
    angle: float
    interpolation: Interpolation = Interpolation.MINIMUM_JERK
    handle_in: tuple[float, float] = (0.0, 0.0)
    handle_out: tuple[float, float] = (0.0, 0.0)
    where: Path = field(default=(), compare=False)


@dataclass(frozen=True, slots=True)
class Cue:
    """At `time` [s] something besides joints: `kind` is `say`, `sound` or `leds`, `value` what the YAML gives it."""

    time: float
    kind: str
    value: object
    where: Path = field(default=(), compare=False)


@dataclass(frozen=True)
class Motion:
    """A gesture; `duration` [s]; `start` the posture it begins and, unless the file says otherwise, ends in."""

    name: str
    duration: float
    tracks: Mapping[str, tuple[Key, ...]]
    cues: tuple[Cue, ...] = ()
    start: str = ""
