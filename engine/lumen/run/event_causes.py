"""What caused an event that no message and no timer brought: a command, a person, the robot itself."""

from lumen.language.causes import Cause
from lumen.language.events import Event

_BY_PEOPLE = ("stop", "resume")
_FROM_THE_START = ("lost.command.", "brain.lost")
"""What is told where the behaviour was away, and goes on."""


def caused(event: Event) -> Event:
    """The event with its cause, which is left as it is where somebody has named one."""
    return event if event.cause else event._replace(cause=_cause(event))


def _cause(event: Event) -> Cause:
    _, separator, command = event.name.partition(".command.")
    if event.name.startswith(_FROM_THE_START):
        return Cause("start", command)
    if separator:
        return Cause("command", command)
    if event.name in _BY_PEOPLE:
        by = event.data.get("by", "") if isinstance(event.data, dict) else ""
        return Cause("person", sender=str(by))
    return Cause("robot")
