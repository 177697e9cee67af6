"""A question to a running exhibition over the bus, and its answers."""

import queue
import time
import uuid
from collections.abc import Iterator
from math import inf
from typing import Any

from lumen.errors import BusClosedError, BusUnreachableError
from lumen.language.routing_keys import OPERATOR_ANSWER, OPERATOR_REQUEST, key_of_robot
from lumen.ports import BlockableBus, Bus, EndsWithExhibition, ReturningBus

OPERATOR_ANSWERS = OPERATOR_ANSWER
"""The key on which the answers of a running exhibition arrive."""
FIRST_ANSWER_TIMEOUT = 30.0
"""The longest wait for the first answer [s]: the exhibition may load files for it, on a small, busy machine."""

LOOK = 0.5
"""The longest wait [s] of a command that ends on Ctrl-C, or with the exhibition: Python handles a signal from just
before a wait only after it."""
NOBODY = object()
"""Queued in place of an answer if the broker returned the message as undeliverable."""


def operator_key(robot: str) -> str:
    """Return the key of operators' requests to a robot's exhibition."""
    return key_of_robot(OPERATOR_REQUEST, robot)


def send_request(bus: Bus, key: str, body: Any, reply_to: str, *, first: float = FIRST_ANSWER_TIMEOUT) -> Iterator[Any]:
    """Publish a message, and yield its answers as they arrive.

    The iteration does not end by itself, and waits for later answers without limit: the caller leaves it after the last
    one. Raises BusUnreachableError if no answer arrives within `first` [s] (the broker may be blocking publishers), or
    if the message comes back undelivered; BusClosedError if the exhibition ends.
    """
    answers: queue.SimpleQueue[Any] = queue.SimpleQueue()
    mark = str(uuid.uuid4())
    undo = bus.subscribe(reply_to, lambda m: answers.put(m.body) if m.correlation_id == mark else None)
    if returning := bus.ability(ReturningBus):
        returning.returns(lambda returned: answers.put(NOBODY) if returned == key else None)
    bus.publish(key, body, reply_to=reply_to, correlation_id=mark)
    ends, until = bus.ability(EndsWithExhibition), time.monotonic() + first
    try:
        while True:
            gone = ends and ends.gone.is_set()  # its last answers may still be waiting for their handler
            try:
                if (answer := answers.get(timeout=max(0.0, min(LOOK, until - time.monotonic())))) is NOBODY:
                    break
            except queue.Empty:
                if gone:
                    raise BusClosedError("the exhibition has ended") from None
                if time.monotonic() >= until:
                    break
            else:
                yield answer
                until = inf
        if (broker := bus.ability(BlockableBus)) and broker.blocked:
            raise BusUnreachableError(f"the broker is short of {broker.blocked} and accepts no messages")
        raise BusUnreachableError(f"no answer came on `{key}`: check that an exhibition is running on that bus")
    finally:
        undo()
