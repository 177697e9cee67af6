"""The server of an embedded bus: a thread through which other processes of this machine publish and subscribe.

A message for a client costs the exhibition one append; the thread encodes and sends it. A client that reads too slowly
loses the oldest messages, one that sends invalid data is disconnected, and a dead one is removed.
"""

import logging
import selectors
import socket
import time
from collections import deque
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path
from typing import Any

from lumen.bus.bodies import check_key, check_ttl, encode
from lumen.bus.identities import believed
from lumen.bus.local import address as addresses
from lumen.bus.local.frames import (
    CLIENT,
    RECEIVE_BYTES,
    SERVER,
    frame,
    framed,
    nonce,
    proof,
    proves,
    unframed,
)
from lumen.errors import BusError
from lumen.language.causes import MessageOrigin
from lumen.ports import Bus, KnowsListeners, Message
from lumen.upkeep.drops import OTHERS, DropLog, Drops
from lumen.upkeep.threads import WatchedThread

MAX_CLIENTS = 32
"""The number of connections at a time; further ones are closed at once."""
MAX_SUBSCRIPTIONS = 1_000
"""The number of subscriptions of one client; one more disconnects it."""
MAX_CLIENT_MESSAGES = 20_000
"""The number of messages that may wait for one client; one more drops the oldest."""
MAX_UNSENT_BYTES = 32 * 1024 * 1024
"""The total size of the frames that may wait for one client [bytes]; more drop the oldest."""
PROOF_TIMEOUT = 30.0
"""Longest time for a client to prove that it has the key [s]."""
FLUSH_MARK = "lumen.door.mark"
"""The key of a message which marks that everything published before it has arrived."""

_log = logging.getLogger(__name__)


class ClientConnection:
    """A connected process: its subscriptions, and the frames that wait to be sent to it."""

    def __init__(self, wire: socket.socket, drops: Drops) -> None:
        self.wire, self.question, self.known, self._drops = wire, nonce(), False, drops
        self.since = time.monotonic()
        self.undo: dict[int, Callable[[], None]] = {}
        self.returns = False
        self.arrived: deque[tuple[int, Message]] = deque(maxlen=MAX_CLIENT_MESSAGES)
        self.read, self.unsent, self.bytes, self.sent = bytearray(), deque[bytes](), 0, 0

    def send(self, data: bytes) -> None:
        """Queue a frame; above the limit, drop and count the oldest frame that is not partly sent."""
        self.unsent.append(data)
        self.bytes += len(data)
        # the first frame may be partly sent, and the last is the newest: drop those between
        while self.bytes > MAX_UNSENT_BYTES and len(self.unsent) > 2:
            begun = self.unsent.popleft()
            self.bytes -= len(self.unsent.popleft())
            self.unsent.appendleft(begun)
            self._drops.add(OTHERS, "the process that reads them is too slow")

    def flush(self) -> None:
        """Send as much as the socket accepts now. Raises OSError if the connection is broken."""
        with suppress(BlockingIOError):
            while self.unsent:
                first = self.unsent[0]
                self.sent += self.wire.send(memoryview(first)[self.sent :])
                if self.sent == len(first):
                    self.unsent.popleft()
                    self.bytes -= len(first)
                    self.sent = 0


class LocalBusServer:
    """A server that listens in `folder` until closed, and connects every process that has the key to the bus.

    `address` has what clients need to connect. Raises OSError if nothing can listen in the folder.
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
        self._clients: dict[socket.socket, ClientConnection] = {}
        self._marks: dict[str, Callable[[], None]] = {}
        self._undo = bus.subscribe(FLUSH_MARK, self._marked)
        self._ending, self._drops = False, DropLog(_log)
        self._thread = WatchedThread("lumen-local-server", self._run, vital=True)
        self._thread.start()

    def close(self) -> None:
        """Disconnect all clients and end; harmless when repeated."""
        if self._ending:
            return
        self._ending = True
        self._wake_up()
        self._thread.join()
        self._undo()
        self.address.remove()

    def _run(self) -> None:
        while not self._ending:
            for key, _ in self._selector.select(1.0):
                if key.fileobj is self._listener:
                    self._accept()
                elif key.fileobj is self._woken:
                    with suppress(BlockingIOError):
                        self._woken.recv(RECEIVE_BYTES)
                else:
                    self._receive(self._clients[key.fileobj])  # type: ignore[index]
            for client in list(self._clients.values()):
                self._serve(client)
            self._drops.tell()
        for client in list(self._clients.values()):
            self._serve(client)  # what was published just before the end
            self._disconnect(client)
        for end in (self._listener, self._wake, self._woken, self._selector):
            end.close()

    def _accept(self) -> None:
        with suppress(OSError):
            wire, _ = self._listener.accept()
            if len(self._clients) >= MAX_CLIENTS:
                wire.close()
                return
            wire.setblocking(False)
            client = self._clients[wire] = ClientConnection(wire, self._drops)
            self._selector.register(wire, selectors.EVENT_READ)
            client.send(frame("prove", client.question))

    def _receive(self, client: ClientConnection) -> None:
        try:
            data = client.wire.recv(RECEIVE_BYTES)
            client.read += data
            for words in unframed(client.read):
                self._take(client, words)
            if not data:
                self._disconnect(client)
        except BlockingIOError:
            return
        except OSError:
            self._disconnect(client)
        except Exception as error:  # any error that a frame causes disconnects its sender, but never ends the thread
            _log.warning(
                "a process was disconnected because it sent an invalid message to the exhibition: %s", str(error)[:200]
            )
            self._disconnect(client)

    def _take(self, client: ClientConnection, words: list[Any]) -> None:
        """Handle a client's frame. Raises ValueError or TypeError if it is invalid."""
        match words:
            case ["proof", given, question] if not client.known and proves(
                given, self.address.key, CLIENT, client.question
            ):
                client.known = True
                client.send(frame("proof", proof(self.address.key, SERVER, str(question))))
            case _ if not client.known:
                raise ValueError("it has not proved that it has the key")
            case ["subscribe", int(number), str(pattern)]:
                self._subscribe(client, number, pattern)
            case ["unsubscribe", int(number)] if number in client.undo:
                client.undo.pop(number)()
            case ["unsubscribe", int()]:
                pass
            case ["publish", str(key), str(reply_to), str(correlation_id), ttl, *origin, body]:
                self._publish(client, Message(key, body, reply_to, correlation_id, *believed(*origin)), ttl)
            case ["returns"]:
                client.returns = True
            case ["mark"]:
                mark = nonce()
                self._marks[mark] = lambda: client.arrived.append((-1, Message(FLUSH_MARK, mark)))
                self._bus.publish(FLUSH_MARK, mark)
            case _:
                raise ValueError(f"unknown frame {str(words[0])[:40]!r}")

    def _subscribe(self, client: ClientConnection, number: int, pattern: str) -> None:
        if number in client.undo or len(client.undo) >= MAX_SUBSCRIPTIONS:
            raise ValueError("too many subscriptions, or the same one twice")

        def arrived(message: Message) -> None:
            if message.key == FLUSH_MARK:
                return
            self._drops.push(
                client.arrived,
                (number, message),
                lambda waiting: waiting[1].key,
                "the process that reads them is too slow",
            )
            self._wake_up()

        try:
            client.undo[number] = self._bus.subscribe(pattern, arrived)
            client.send(frame("subscribed", number, ""))
        except BusError as error:
            client.send(frame("subscribed", number, str(error)))

    def _publish(self, client: ClientConnection, message: Message, ttl: Any) -> None:
        key, body, reply_to, correlation_id, id, sender, sent, cause = message
        try:
            for name in (key, reply_to, correlation_id):
                check_key(name)
            check_ttl(ttl)
            if client.returns and not self._heard(key):
                client.send(frame("returned", key))
            origin = MessageOrigin(id, sender, sent, cause)
            self._bus.publish(key, body, reply_to=reply_to, correlation_id=correlation_id, ttl=ttl, origin=origin)
        except BusError as error:
            client.send(frame("refused", key, str(error)))

    def _heard(self, key: str) -> bool:
        known = self._bus.ability(KnowsListeners)
        return known is None or known.heard(key)

    def _marked(self, message: Message) -> None:
        if mark := self._marks.pop(str(message.body), None):
            mark()
            self._wake_up()

    def _wake_up(self) -> None:
        """Wake the thread; if the socket to it is full, it is awake already."""
        with suppress(OSError):
            self._wake.send(b"!")

    def _serve(self, client: ClientConnection) -> None:
        """Send what has arrived for a client; remove one that is dead, or has not proved the key in time."""
        try:
            while client.arrived:
                number, message = client.arrived.popleft()
                if number < 0:
                    client.send(frame("marked"))
                else:
                    key, body, *around = message
                    client.send(framed(["message", number, key, *around], encode(body)))
            client.flush()
        except OSError:
            self._disconnect(client)
            return
        except Exception as error:
            _log.warning("a message could not be sent to another process: %s", str(error)[:200])
        if not client.known and time.monotonic() - client.since > PROOF_TIMEOUT:
            self._disconnect(client)
            return
        events = selectors.EVENT_READ | (selectors.EVENT_WRITE if client.unsent else 0)
        self._selector.modify(client.wire, events)

    def _disconnect(self, client: ClientConnection) -> None:
        if self._clients.pop(client.wire, None) is None:
            return
        for undo in client.undo.values():
            undo()
        with suppress(OSError):
            client.flush()
        self._selector.unregister(client.wire)
        client.wire.close()
