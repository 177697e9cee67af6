"""Events: the only input of a behaviour."""

from collections.abc import Mapping
from typing import Any, NamedTuple

from lumen.language.causes import Cause
from lumen.language.modules import module_names


class Event(NamedTuple):
    """Something that happened, named and timed; `event.name` and `event.data` in expressions.

    `data` is JSON data. `at` [s] is the time on the exhibition's clock, the only clock a step reads. `sendid` is
    the id of the timer or delayed `send` that raised it (SCXML 5.10.1), empty for events from outside. `cause` says who
    or what brought it about, None where nobody said; no expression reads it.
    """

    name: str
    data: Any = None
    at: float = 0.0
    sendid: str = ""
    cause: Cause | None = None


def _object(**fields: object) -> dict[str, object]:
    return {"type": "object", "properties": fields, "required": list(fields)}


def _said_by() -> dict[str, object]:
    """Return the schema of data with `by`, the person, which may be absent."""
    return {"type": "object", "properties": {"by": {"type": "string"}}}


CUE = "cue"
"""What a robot raises when a motion comes to words or a sound: its `motion`, `kind` (`say`, `sound`) and `value`.

It is for who runs the exhibition, not for its behaviour, which hears no such event.
"""

RECORDED = "recorded"
"""What a robot raises when it has listened: the body of the route `recording`. It is for modules, and no behaviour."""

FALLEN = "fallen"
"""The event of a robot that has fallen."""

HELD = "hold its head, or run `lumen resume`"
"""The end of the reason with which a robot that a person keeps still refuses to move."""

MISSED = "missed"
"""The field of `done.command.ID` that names the joints that missed the angles of a motion."""

RESULT = "result"
"""The field of `done.command.ID` that has what a verb of a feature returned."""

ARRIVED, LEFT, DOUBTFUL = "arrived", "left", "doubtful"
"""What is raised when the robot has come to one of the places, when it is no longer there, and where it can't tell.

`place` is which one, `doubt` how far from where it believes to be it may really be [m]: `doubtful` says that this is
more than the place's `within`.
"""

CLOCK_SET = "clock set"
"""The name and `sendid` of what is told to a behaviour where the clock on the wall was set: no transition hears of it.

Its data is when time 0 was by that clock, `epoch` [s since 1970, in UTC], and the `timezone` where it hangs.
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
    "motion.lost": _object(seconds={"type": "number"}),
    "motion.back": _object(seconds={"type": "number"}),
    "stop": _said_by(),
    "resume": _said_by(),
}


def robot_events() -> Mapping[str, Mapping[str, object]]:
    """Return the events that every robot raises by itself, each with the JSON Schema of its data.

    No behaviour has to declare them. If parts of the exhibition run in processes of their own, `robot`, `motion` and
    the modules can be lost and come back.
    """
    gone = _object(seconds={"type": "number"})
    return {
        **_ROBOT_EVENTS,
        **{f"{module}.{what}": gone for module in module_names() for what in ("lost", "back")},
    }
