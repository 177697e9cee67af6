"""A wire between a client and a server that records the client's bytes."""

import socket
import threading
from collections.abc import Iterator
from contextlib import suppress

CHUNK = 1 << 16


class TappedWire:
    """Listens on `port` of loopback, or on `path`, and forwards to `target`.

    `sent` and `received` have the bytes that the client of each connection sent and received.
    """

    def __init__(self, target: int | str, path: str = "") -> None:
        self.sent: list[bytearray] = []
        self.received: list[bytearray] = []
        self._target = target
        self._listener = socket.socket(socket.AF_UNIX if path else socket.AF_INET)
        self._listener.bind(path or ("127.0.0.1", 0))
        self._listener.listen(16)
        self.port = 0 if path else int(self._listener.getsockname()[1])
        self._ends = [self._listener]
        self._threads = [threading.Thread(target=self._admit, daemon=True)]
        self._threads[0].start()

    def close(self) -> None:
        """End all connections and threads."""
        for end in self._ends:
            with suppress(OSError):
                end.shutdown(socket.SHUT_RDWR)
            end.close()
        for thread in self._threads:
            thread.join()

    def _admit(self) -> None:
        with suppress(OSError):
            while True:
                near, _ = self._listener.accept()
                local = isinstance(self._target, str)
                far = socket.socket(socket.AF_UNIX if local else socket.AF_INET)
                far.connect(self._target if local else ("127.0.0.1", self._target))
                self._ends += [near, far]
                sent, received = bytearray(), bytearray()
                self.sent.append(sent)
                self.received.append(received)
                for source, sink, kept in ((near, far, sent), (far, near, received)):
                    self._threads.append(threading.Thread(target=_forward, args=(source, sink, kept), daemon=True))
                    self._threads[-1].start()


def _forward(source: socket.socket, sink: socket.socket, kept: bytearray) -> None:
    with suppress(OSError):
        while data := source.recv(CHUNK):
            kept += data
            sink.sendall(data)
    for end in (source, sink):
        with suppress(OSError):
            end.shutdown(socket.SHUT_RDWR)


def amqp_frames(data: bytes) -> Iterator[tuple[int, object]]:
    """Yield the frames that a client of AMQP sent, each with the position of its end, as pika reads them."""
    from pika import frame

    at = 0
    while at < len(data):
        read, found = frame.decode_frame(bytes(data[at : at + (1 << 20)]))
        if not read:
            return
        at += read
        yield at, found
