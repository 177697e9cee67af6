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
