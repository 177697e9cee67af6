"""A client of an exhibition's bus, in another process of the same machine."""

import json
import logging
import socket
import threading
import time
from collections import deque
from collections.abc import Callable, Mapping
from contextlib import suppress
from itertools import count
from typing import Any

from lumen.bus.bodies import check_key, check_subscription, encode
from lumen.bus.identities import origin_of
from lumen.bus.local.address import ANSWER_TIMEOUT, LocalAddress
from lumen.bus.local.frames import (
    CLIENT,
    RECEIVE_BYTES,
    SERVER,
    BadFrameError,
    frame,
    framed,
    nonce,
    proof,
    proves,
    unframed,
)
from lumen.errors import BusClosedError, BusError, BusRefusedError, BusUnreachableError, Refused
from lumen.language.routes import Route
from lumen.ports import Bus, Message, MessageHandler, Outgoing
from lumen.upkeep.drops import OTHERS, DropLog, Drops
from lumen.upkeep.threads import WatchedThread

MAX_UNSENT_BYTES = 64 * 1024 * 1024
"""The total size of the frames that may wait [bytes]; more drop the oldest."""


class SendBuffer:
    """A queue of frames: any thread puts, one thread takes."""

    def __init__(self, drops: Drops) -> None:
        self._frames: deque[bytes] = deque()
        self._bytes, self._drops = 0, drops
        self._ended = self._sending = False
        self._changed = threading.Condition()

    def put(self, frame: bytes) -> None:
        """Append a frame; drop and count the oldest ones if all exceed MAX_UNSENT_BYTES."""
        with self._changed:
            self._frames.append(frame)
            self._bytes += len(frame)
            while self._bytes > MAX_UNSENT_BYTES:
                self._bytes -= len(self._frames.popleft())
                self._drops.add(OTHERS, "the exhibition does not read them")
            self._changed.notify_all()

    def take(self) -> list[bytes]:
        """Wait for frames, and remove and return all of them; none after the end."""
        with self._changed:
            self._sending = False
            self._changed.notify_all()
            self._changed.wait_for(lambda: self._frames or self._ended)
            taken = list(self._frames)
            self._frames.clear()
            self._bytes, self._sending = 0, True
            return taken

    def emptied(self, timeout: float) -> bool:
        """Wait until everything has been taken and sent; return False if `timeout` [s] passed before."""
        with self._changed:
            return self._changed.wait_for(lambda: self._ended or not (self._frames or self._sending), timeout)

    def end(self) -> None:
        """End the waiting of `take`."""
        with self._changed:
            self._ended = True
            self._changed.notify_all()


CLOSE_TIMEOUT = 5.0
"""Longest time for closing [s]."""
MAX_UNHANDLED_MESSAGES = 20_000
"""The number of messages that may wait for a handler; one more drops the oldest."""

_log = logging.getLogger(__name__)


class LocalBusClient(Bus):
    """The bus of a `LocalBusServer`. Raises BusError if no server listens, or the server does not have the key.

    One thread sends, one receives, and one runs the handlers; if a handler is too slow, the oldest messages are
    dropped. `sender` is the name of this program in its messages.
    """

    def __init__(self, address: LocalAddress, sender: str = "") -> None:
        self.sender = sender
        self.gone = threading.Event()
        """Set when the exhibition ends; then nothing can be published any more."""
        self._wire, self._read = _connect(address)
        self._arriving, self._drops = threading.Condition(), DropLog(_log)
        self._unsent, self._closed = SendBuffer(self._drops), False
        self._handlers: dict[int, MessageHandler] = {}
        self._returned: Callable[[str], None] = lambda _: None
        self._answers: dict[int, tuple[threading.Event, list[str]]] = {}
        self._numbers, self._marked = count(), threading.Event()
        self._arrived: deque[tuple[MessageHandler, int, Message]] = deque(maxlen=MAX_UNHANDLED_MESSAGES)
        self._threads = [
            WatchedThread(f"lumen-local-{name}", work)
            for name, work in (("out", self._send), ("in", self._receive), ("handlers", self._handle))
        ]
        for thread in self._threads:
            thread.start()

    def carry(self, routes: Mapping[str, Route]) -> None:
        """Do nothing: the exhibition determines how messages are carried."""

    def prepare(self, routes: Mapping[str, Route]) -> None:
        """Do nothing: no preparation is needed."""

    def subscribe(self, pattern: str, handler: MessageHandler) -> Callable[[], None]:
        if self._closed:
            raise BusClosedError("the bus is closed: subscribing is no longer possible")
        check_subscription(pattern, handler)
        number = next(self._numbers)
        answered, reason = self._answers[number] = (threading.Event(), [])
        self._handlers[number] = handler
        self._put(frame("subscribe", number, pattern))
        answered.wait(ANSWER_TIMEOUT)
        if reason != [""]:
            del self._handlers[number]
            kind = BusClosedError if self.gone.is_set() else BusRefusedError if reason else BusUnreachableError
            raise kind(reason[0] if reason else f"the exhibition did not answer the subscription to `{pattern}`")

        def undo() -> None:
            if self._handlers.pop(number, None) and not self._closed:
                self._put(frame("unsubscribe", number))

        return undo

    def send(self, message: Outgoing) -> None:
        if self._closed:
            raise BusClosedError("the bus is closed: publishing is no longer possible")
        key, body, reply_to, correlation_id, ttl, *_ = message
        for name in (key, reply_to, correlation_id):
            check_key(name)
        if self.gone.is_set():
            raise BusClosedError("the exhibition has ended")
        origin = origin_of(message, self.sender)
        self._put(framed(["publish", key, reply_to, correlation_id, ttl, *origin], encode(body)))

    def returns(self, handler: Callable[[str], None]) -> None:
        """Call `handler` with the key of each published message that has no receiver."""
        self._returned = handler
        self._put(frame("returns"))

    def reply(self, message: Message, body: Any) -> None:
        if message.reply_to:
            self.publish(message.reply_to, body, correlation_id=message.correlation_id)

    def close(self) -> None:
        """Deliver what was published, also to this client's own subscribers, within 5 s, and disconnect."""
        if self._closed:
            return
        deadline = time.monotonic() + CLOSE_TIMEOUT
        inside = self._threads[2].current
        if not self.gone.is_set() and not inside:
            self._put(frame("mark"))
            self._marked.wait(CLOSE_TIMEOUT)
        self._closed = True
        self._unsent.emptied(max(0.0, deadline - time.monotonic()))
        self._end()
        for thread in self._threads:
            thread.join(max(0.0, deadline - time.monotonic()))
        self._wire.close()

    def _end(self) -> None:
        self.gone.set()
        with suppress(OSError):
            self._wire.shutdown(socket.SHUT_RDWR)
        for answered, _ in list(self._answers.values()):
            answered.set()
        self._marked.set()
        self._unsent.end()
        with self._arriving:
            self._arriving.notify_all()

    def _put(self, data: bytes) -> None:
        self._unsent.put(data)

    def _send(self) -> None:
        try:
            while not self.gone.is_set():
                for data in self._unsent.take():
                    self._wire.sendall(data)
        except OSError:
            self._end()

    def _receive(self) -> None:
        try:
            while True:
                for words in unframed(self._read):
                    self._take(words)
                data = self._wire.recv(RECEIVE_BYTES)
                if not data:
                    break
                self._read += data
        except Exception as error:  # any invalid data ends the connection, which wakes all waiting threads
            if not self._closed:
                _log.debug("the exhibition closed the connection: %r", error)
        self._end()

    def _take(self, words: list[Any]) -> None:
        match words:
            case ["message", number, key, reply_to, correlation_id, *origin, body] if handler := self._handlers.get(
                number
            ):
                with self._arriving:
                    arrived = (handler, number, Message(key, body, reply_to, correlation_id, *origin))
                    self._drops.push(self._arrived, arrived, lambda waiting: waiting[2].key, "its handler is too slow")
                    self._arriving.notify()
            case ["subscribed", number, reason] if waiting := self._answers.pop(number, None):
                waiting[1].append(reason)
                waiting[0].set()
            case ["refused", key, reason]:
                _log.warning("the exhibition refuses a message on %.100a: %s", key, reason)
            case ["returned", str(key)]:
                self._returned(key)
            case ["marked"]:
                with self._arriving:
                    self._arrived.append((lambda _: self._marked.set(), -1, Message("", None)))
                    self._arriving.notify()

    def _handle(self) -> None:
        while True:
            with self._arriving:
                self._arriving.wait_for(lambda: self._arrived or self.gone.is_set())
                if not self._arrived:
                    return
                handler, number, message = self._arrived.popleft()
            if number >= 0 and (number not in self._handlers or self._closed):
                continue
            try:
                handler(message)
            except Refused as error:
                with suppress(BusError):
                    self.reply(message, f"message refused: {error}")
            except Exception:
                _log.exception("a subscriber failed on `%s`", message.key)


def _connect(address: LocalAddress) -> tuple[socket.socket, bytearray]:
    """Return a connection on which both sides have proved the key, and further data received on it.

    Raises BusError if no exhibition answers, or the proof fails.
    """
    buffer = bytearray()
    try:
        wire = address.connect()
    except OSError as error:
        raise BusUnreachableError(f"no exhibition answers: {error.strerror or error}") from None
    try:
        question = nonce()
        match _next(wire, buffer):
            case ["prove", str(theirs)]:
                wire.sendall(frame("proof", proof(address.key, CLIENT, theirs), question))
            case _:
                raise BadFrameError("it does not ask for a proof of the key")
        match _next(wire, buffer):
            case ["proof", given] if proves(given, address.key, SERVER, question):
                wire.settimeout(None)
                return wire, buffer
        raise BadFrameError("it has not proved that it has the key")
    except (OSError, BadFrameError, json.JSONDecodeError) as error:
        wire.close()
        raise BusRefusedError(f"the program at that address is not the exhibition: {error}") from None


def _next(wire: socket.socket, buffer: bytearray) -> list[Any]:
    while True:
        for words in unframed(buffer):
            return words
        data = wire.recv(RECEIVE_BYTES)
        if not data:
            raise BadFrameError("it closed the connection")
        buffer += data
