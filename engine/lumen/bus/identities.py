"""Ids of messages, and the check of the ids, senders and times that arrive."""

from time import time as now

from lumen.language.causes import MessageOrigin
from lumen.language.numbers import is_number
from lumen.ports import NUMBERS, PREFIX, Outgoing

MAX_IDENTITY_BYTES = 255
"""Longest id or sender [bytes]: AMQP's limit for a short string."""
MAX_TIME = 253_402_300_800.0
"""The end of the year 9999 [s since 1970]."""


def new_id() -> str:
    """Return an id that no other message has, in this process, another one, or after a restart."""
    return f"{PREFIX}-{next(NUMBERS)}"


def origin_of(message: Outgoing, sender: str) -> MessageOrigin:
    """Return the origin of a message; a missing id, sender or time is filled in."""
    return MessageOrigin(message.id or new_id(), message.sender or sender, message.time or now(), message.cause)


def believed(id: object = "", sender: object = "", time: object = 0.0, cause: object = "") -> MessageOrigin:
    """Return an origin from unchecked data: invalid values are dropped, a missing id or time is filled in."""
    return MessageOrigin(_text(id) or new_id(), _text(sender), _moment(time) or now(), _text(cause))


def _text(said: object) -> str:
    fits = isinstance(said, str) and said.isprintable() and len(said.encode()) <= MAX_IDENTITY_BYTES
    return str(said) if fits else ""


def _moment(said: object) -> float:
    return float(said) if is_number(said) and 0 < said < MAX_TIME else 0.0
