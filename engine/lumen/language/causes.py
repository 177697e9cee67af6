"""The cause of an event: the sender of a message, the timer that ended, the command that was answered."""

from typing import Literal, NamedTuple

CauseKind = Literal["message", "timer", "command", "robot", "person", "file", "start"]


class Cause(NamedTuple):
    """The cause of an event, which has no influence on the behaviour."""

    kind: CauseKind
    id: str = ""
    """The id of the message, timer or command; the name of a `file`; the means that a `person` used."""
    key: str = ""
    """The routing key of a message."""
    sender: str = ""
    """The program that sent a message, or the person's name if that is known."""
    time: float = 0.0
    """When the event arrived [s since 1970, in UTC]; 0 if no clock was read."""


class MessageOrigin(NamedTuple):
    """The origin that a message declares. A bus fills in the fields that are empty, as far as it can."""

    id: str = ""
    sender: str = ""
    """The program that sent the message."""
    time: float = 0.0
    """The time at which the message was sent [s since 1970, in UTC]."""
    cause: str = ""
    """The part of the behaviour that caused the message: the id of a command (`d3`), or a step (`step 42`)."""


UNKNOWN_ORIGIN = MessageOrigin()
"""An empty origin: the bus gives the message an id, its own sender and the time."""

PROGRAM, TERMINAL, VISITOR, OPERATOR = "the program", "a terminal", "the visitor", "the operator"
"""The senders outside an exhibition; `PROGRAM` is the Python program that opened it."""
UNNAMED_PROGRAM = "a program on the bus"
"""The sender of a message that names neither a person nor a program."""
PEOPLE = frozenset((TERMINAL, VISITOR, OPERATOR))
"""Senders that are people."""
