"""Events: the only input of a behaviour."""

from collections.abc import Mapping
from typing import Any, NamedTuple

from lumen.language.causes import Cause
from lumen.language.modules import module_names


class Event(NamedTuple):
    """An event of the world or of the behaviour itself.

    Expressions read its name and data as `event.name` and `event.data`.
    """

    name: str
    """The name, with words separated by dots."""
    data: Any = None
    """The event's data, as JSON data; None without data."""
    at: float = 0.0
    """The time on the exhibition's clock, the only clock that a step reads [s]."""
    sendid: str = ""
    """The id of the timer or delayed `send` that raised the event (SCXML 5.10.1); empty for events from outside."""
    cause: Cause | None = None
    """The cause; None if it is unknown. No expression reads it."""


def _object(**fields: object) -> dict[str, object]:
    return {"type": "object", "properties": fields, "required": list(fields)}


def _said_by() -> dict[str, object]:
    """Return the JSON Schema of data with an optional `by`, the name of a person."""
    return {"type": "object", "properties": {"by": {"type": "string"}}}


CUE = "cue"
"""The event of a robot whose motion reaches words, a sound or a skill; its data are `motion`, `kind` and `value`.

It informs the operator; the behaviour does not receive it.
"""

RECORDED = "recorded"
"""The event of a robot that has listened: the body of the route `recording`. Only modules receive it."""

FALLEN = "fallen"
"""The event of a robot that has fallen."""

HELD = "hold its head, or run `lumen resume`"
"""The hint at the end of the reason why a robot that a person stopped refuses to move."""

MISSED = "missed"
"""The field of `done.command.ID` that names the joints that missed the angles of a motion."""

RESULT = "result"
"""The field of `done.command.ID` with the result of an added verb."""

ARRIVED, LEFT, DOUBTFUL = "arrived", "left", "doubtful"
"""The events of a robot that has reached a place, has left it, or is no longer sure that it is there.

`place` is the name of the place, and `doubt` the possible error of the robot's believed position [m]. `doubtful` is
raised when that error exceeds the place's `within`.
"""

CLOCK_SET = "clock set"
"""The name and `sendid` of the notice that the wall clock was set, which no transition receives.

Its data are `epoch`, the time of that clock at time 0 [s since 1970, in UTC], and its `timezone`.
"""

_ROBOT_EVENTS: Mapping[str, Mapping[str, object]] = {
    "touched": _object(sensor={"type": "string"}),
    "released": _object(sensor={"type": "string"}),
    FALLEN: _object(),
    "battery.low": _object(percentage={"type": "integer"}),
    "battery.full": _object(percentage={"type": "integer"}),
    "motors.hot": _object(joint={"type": "string"}, temperature={"type": "number"}),
    ARRIVED: _object(place={"type": "string"}, doubt={"type": "number"}),
    LEFT: _object(place={"type": "string"}, doubt={"type": "number"}),
    DOUBTFUL: _object(place={"type": "string"}, doubt={"type": "number"}),
    "brain.lost": _object(seconds={"type": "number"}),
    "robot.lost": _object(seconds={"type": "number"}),
    "robot.back": _object(seconds={"type": "number"}),
    "robot.busy": _object(reason={"type": "string"}),
    "robot.free": _object(seconds={"type": "number"}),
    "motion.lost": _object(seconds={"type": "number"}),
    "motion.back": _object(seconds={"type": "number"}),
    "stop": _said_by(),
    "resume": _said_by(),
}


def robot_events() -> Mapping[str, Mapping[str, object]]:
    """Return the events about any robot that a behaviour need not declare, each with the JSON Schema of its data.

    Not all of them come from the robot: people cause `stop` and `resume`, and the engine raises `brain.lost`. The
    `lost` and `back` events of `robot`, `motion` and the modules report that they have gone or come back.
    """
    gone = _object(seconds={"type": "number"})
    return {
        **_ROBOT_EVENTS,
        **{f"{module}.{what}": gone for module in module_names() for what in ("lost", "back")},
    }
