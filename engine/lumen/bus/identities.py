"""Ids of messages, and what is believed of the ids, senders and times that come in."""

from time import time as now

from lumen.language.causes import MessageOrigin
from lumen.language.numbers import is_number
from lumen.ports import NUMBERS, PREFIX, Outgoing

MAX_IDENTITY_BYTES = 255
"""How long an id or a sender may be [bytes]: AMQP's bound on a short string."""
MAX_TIME = 253_402_300_800.0
"""The end of the year 9999 [s since 1970]."""


def new_id() -> str:
    """An id that no other message has, in this run, another process, or after a restart."""
    return f"{PREFIX}-{next(NUMBERS)}"


def origin_of(message: Outgoing, sender: str) -> MessageOrigin:
    """Return the origin of a message; its id, sender and time are filled in if the message lacks them."""
    return MessageOrigin(message.id or new_id(), message.sender or sender, message.time or now(), message.cause)


def believed(id: object = "", sender: object = "", time: object = 0.0, cause: object = "") -> MessageOrigin:
    """What somebody said, who may say anything: what can't be is left out; without an id the message gets one."""
    return MessageOrigin(_text(id) or new_id(), _text(sender), _moment(time) or now(), _text(cause))


def _text(said: object) -> str:
    fits = isinstance(said, str) and said.isprintable() and len(said.encode()) <= MAX_IDENTITY_BYTES
    return str(said) if fits else ""


def _moment(said: object) -> float:
    return float(said) if is_number(said) and 0 < said < MAX_TIME else 0.0
