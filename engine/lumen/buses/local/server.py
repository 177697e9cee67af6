"""The door of an embedded bus: a thread that lets other processes of this machine publish and subscribe.

The exhibition pays an append for a message that somebody outside wants; the thread encodes and sends it. Who reads too
slowly loses the oldest messages, who speaks no sense is shown out, and who is dead is forgotten.
"""

import logging
import selectors
import socket
import threading
import time
from collections import deque
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path
from typing import Any

from lumen.buses.bodies import encode
from lumen.buses.local import address as addresses
from lumen.buses.local.frames import BadFrameError, frame, framed, nonce, proof, proves, unframed
from lumen.errors import BusError
from lumen.ports import Bus, Message

GUESTS = 32
PATTERNS = 1_000
WAITING = 20_000
BYTES = 32 * 1024 * 1024
KNOCKING = 5.0
"""How long a guest may take to show that it knows the key [s]."""
CHUNK = 1 << 16
MARK = "lumen.door.mark"

_log = logging.getLogger(__name__)


class ClientConnection:
    """A process that has come in: what it subscribed to, and what waits for it."""

    def __init__(self, wire: socket.socket) -> None:
        self.wire, self.asked, self.known = wire, nonce(), False
        self.since = time.monotonic()
        self.undo: dict[int, Callable[[], None]] = {}
        self.arrived: deque[tuple[int, Message]] = deque(maxlen=WAITING)
        self.read, self.leaving, self.bytes, self.sent = bytearray(), deque[bytes](), 0, 0

    def send(self, data: bytes) -> None:
        """Put it behind what waits; where that is too much, the oldest that has not begun to leave is dropped."""
        self.leaving.append(data)
        self.bytes += len(data)
        while self.bytes > BYTES and len(self.leaving) > 2:
            begun = self.leaving.popleft()
            self.bytes -= len(self.leaving.popleft())
            self.leaving.appendleft(begun)

    def flush(self) -> None:
        """Send what the wire takes now. Raises OSError where it is broken."""
        while self.leaving:
            first = self.leaving[0]
            try:
                self.sent += self.wire.send(memoryview(first)[self.sent :])
            except BlockingIOError:
                return
            if self.sent == len(first):
                self.leaving.popleft()
                self.bytes -= len(first)
                self.sent = 0


class LocalBusServer:
    """Listens in `folder` until closed, and lets everybody who knows the key onto the bus.

    `address` is where. Raises OSError where nothing can listen there.
    """

    def __init__(self, bus: Bus, folder: Path) -> None:
        self._bus = bus
        self._listener, self.address = addresses.listen(folder)
        self._listener.setblocking(False)
        self._wake, self._woken = socket.socketpair()
        for end in (self._wake, self._woken):
            end.setblocking(False)
        self._selector = selectors.DefaultSelector()
        self._selector.register(self._listener, selectors.EVENT_READ)
        self._selector.register(self._woken, selectors.EVENT_READ)
        self._guests: dict[socket.socket, ClientConnection] = {}
        self._marks: dict[str, Callable[[], None]] = {}
        self._undo = bus.subscribe(MARK, self._marked)
        self._ending = False
        self._thread = threading.Thread(target=self._run, name="lumen-door", daemon=True)
        self._thread.start()

    def close(self) -> None:
        """Show everybody out and end; harmless when repeated."""
        if self._ending:
            return
        self._ending = True
        self._rouse()
        self._thread.join()
        self._undo()
        self.address.remove()

    def _run(self) -> None:
        while not self._ending:
            for key, _ in self._selector.select(1.0):
                if key.fileobj is self._listener:
                    self._admit()
                elif key.fileobj is self._woken:
                    with suppress(BlockingIOError):
                        self._woken.recv(CHUNK)
                else:
                    self._hear(self._guests[key.fileobj])  # type: ignore[index]
            for guest in list(self._guests.values()):
                self._serve(guest)
        for guest in list(self._guests.values()):
            self._leave(guest)
        for end in (self._listener, self._wake, self._woken, self._selector):
            end.close()

    def _admit(self) -> None:
        with suppress(OSError):
            wire, _ = self._listener.accept()
            if len(self._guests) >= GUESTS:
                wire.close()
                return
            wire.setblocking(False)
            guest = self._guests[wire] = ClientConnection(wire)
            self._selector.register(wire, selectors.EVENT_READ)
            guest.send(frame("prove", guest.asked))

    def _hear(self, guest: ClientConnection) -> None:
        try:
            data = guest.wire.recv(CHUNK)
            guest.read += data
            for words in unframed(guest.read):
                self._take(guest, words)
            if not data:
                self._leave(guest)
        except BlockingIOError:
            return
        except OSError:
            self._leave(guest)
        except (BadFrameError, TypeError, ValueError) as error:
            _log.warning("a process that spoke no sense to the exhibition was shown out: %s", error)
            self._leave(guest)

    def _take(self, guest: ClientConnection, words: list[Any]) -> None:
        """Do what a guest asks; a ValueError or TypeError says that it makes no sense."""
        match words:
            case ["proof", given, asked] if not guest.known and proves(given, self.address.key, "guest", guest.asked):
                guest.known = True
                guest.send(frame("proof", proof(self.address.key, "door", str(asked))))
            case _ if not guest.known:
                raise ValueError("it does not know the key")
            case ["subscribe", int(number), str(pattern)]:
                self._subscribe(guest, number, pattern)
            case ["unsubscribe", int(number)] if number in guest.undo:
                guest.undo.pop(number)()
            case ["unsubscribe", int()]:
                pass
            case ["publish", str(key), str(reply_to), str(correlation_id), ttl, body]:
                self._publish(guest, key, body, reply_to, correlation_id, None if ttl is None else float(ttl))
            case ["mark"]:
                mark = nonce()
                self._marks[mark] = lambda: guest.arrived.append((-1, Message(MARK, mark)))
                self._bus.publish(MARK, mark)
            case _:
                raise ValueError(f"nobody understands `{str(words[0])[:40]}`")

    def _subscribe(self, guest: ClientConnection, number: int, pattern: str) -> None:
        if number in guest.undo or len(guest.undo) >= PATTERNS:
            raise ValueError("too many subscriptions, or one twice")

        def arrived(message: Message) -> None:
            if message.key == MARK:
                return
            guest.arrived.append((number, message))
            self._rouse()

        try:
            guest.undo[number] = self._bus.subscribe(pattern, arrived)
            guest.send(frame("subscribed", number, ""))
        except BusError as error:
            guest.send(frame("subscribed", number, str(error)))

    def _publish(
        self, guest: ClientConnection, key: str, body: Any, reply_to: str, correlation_id: str, ttl: float | None
    ) -> None:
        try:
            self._bus.publish(key, body, reply_to=reply_to, correlation_id=correlation_id, ttl=ttl)
        except BusError as error:
            guest.send(frame("refused", key, str(error)))

    def _marked(self, message: Message) -> None:
        if mark := self._marks.pop(str(message.body), None):
            mark()
            self._rouse()

    def _rouse(self) -> None:
        """Let the thread look around; it is awake where the wire to it is full."""
        with suppress(OSError):
            self._wake.send(b"!")

    def _serve(self, guest: ClientConnection) -> None:
        """Send on what has arrived for a guest; forget one that is dead, or that never said who it is."""
        try:
            while guest.arrived:
                number, message = guest.arrived.popleft()
                if number < 0:
                    guest.send(frame("marked"))
                else:
                    head = ["message", number, message.key, message.reply_to, message.correlation_id]
                    guest.send(framed(head, encode(message.body)))
            guest.flush()
        except OSError:
            self._leave(guest)
            return
        except BusError as error:
            _log.warning("a message could not leave by the door: %s", error)
        if not guest.known and time.monotonic() - guest.since > KNOCKING:
            self._leave(guest)
            return
        events = selectors.EVENT_READ | (selectors.EVENT_WRITE if guest.leaving else 0)
        self._selector.modify(guest.wire, events)

    def _leave(self, guest: ClientConnection) -> None:
        if self._guests.pop(guest.wire, None) is None:
            return
        for undo in guest.undo.values():
            undo()
        with suppress(OSError):
            guest.flush()
        self._selector.unregister(guest.wire)
        guest.wire.close()
