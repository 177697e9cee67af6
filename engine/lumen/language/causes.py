"""Who or what brought something about: who sent a message, which timer ran out, which command was answered."""

from typing import Literal, NamedTuple

CauseKind = Literal["message", "timer", "command", "robot", "person", "file", "start"]


class Cause(NamedTuple):
    """What made an event happen; it changes nothing of what a behaviour does with it.

    `id` is the message's, the timer's or the command's; of a `file` its name, of a `person` what they used. `key` is a
    message's routing key, `sender` the program that sent it, or the person's name where that is known. `time` is when
    it arrived [s since 1970, in UTC], 0 where nobody looked at a clock.
    """

    kind: CauseKind
    id: str = ""
    key: str = ""
    sender: str = ""
    time: float = 0.0


class MessageOrigin(NamedTuple):
    """Where a message says that it comes from: its `id`, the program that is its `sender`, and when it was sent.

    `time` is in [s since 1970, in UTC]. `cause` is what in the behaviour asked for it: the id of a command (`d3`), or
    the step that published it (`step 42`). What is empty, a bus fills in as far as it can.
    """

    id: str = ""
    sender: str = ""
    time: float = 0.0
    cause: str = ""


UNKNOWN_ORIGIN = MessageOrigin()
"""Nothing is said: the bus gives the message an id, its own sender and the time."""

PROGRAM, TERMINAL, VISITOR, OPERATOR = "the program", "a terminal", "the visitor", "the operator"
"""Senders that are no part of an exhibition: who opened it in Python, who types commands, who stands before it, and
who runs it.
"""
UNNAMED_PROGRAM = "a program on the bus"
"""The sender of a message that names neither a person nor a program."""
PEOPLE = frozenset((TERMINAL, VISITOR, OPERATOR))
"""Senders behind whose messages stands a person."""
