"""Ids of messages, and what is believed of the ids, senders and times that come in."""

import secrets
from itertools import count
from time import time as now

from lumen.language.causes import MessageOrigin
from lumen.language.numbers import is_number

MAX_IDENTITY_BYTES = 255
"""How long an id or a sender may be [bytes]: AMQP's bound on a short string."""
MAX_TIME = 253_402_300_800.0
"""The end of the year 9999 [s since 1970]."""

PREFIX, NUMBERS = secrets.token_hex(5), count(1)
"""What every id of this process begins with, and what makes it one of its own."""


def new_id() -> str:
    """An id that no other message has, in this run, another process, or after a restart."""
    return f"{PREFIX}-{next(NUMBERS)}"


def filled(origin: MessageOrigin, sender: str) -> MessageOrigin:
    """What a message of ours says of itself; what `origin` leaves empty is filled in."""
    id, own, time, cause = origin
    return MessageOrigin(id or new_id(), own or sender, time or now(), cause)


def believed(id: object = "", sender: object = "", time: object = 0.0, cause: object = "") -> MessageOrigin:
    """What somebody said, who may say anything: what can't be is left out; without an id the message gets one."""
    return MessageOrigin(_text(id) or new_id(), _text(sender), _moment(time) or now(), _text(cause))


def _text(said: object) -> str:
    fits = isinstance(said, str) and said.isprintable() and len(said.encode()) <= MAX_IDENTITY_BYTES
    return str(said) if fits else ""


def _moment(said: object) -> float:
    return float(said) if is_number(said) and 0 < said < MAX_TIME else 0.0
