"""The frames that an exhibition sends to RabbitMQ in the first seconds of a visit.

A tick begins when all messages of the one before have reached the broker, and those that it delivers are handled. So
neither threads nor the speed of the machine change the frames. Ids, times, tags and the names that the broker gives to
queues (`amq.gen`) are left out. The clock of deadlines is a thousand times slower, and `expiration` is rounded up to
100 ms. Declarations are sorted, since several connections send them in no promised order; so are a tick's messages.
"""

import json
import shutil
import threading
import time
from collections.abc import Callable
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any
from unittest.mock import patch

import lumen
from lumen.bus import Bus, Message, connect
from lumen.ports import Outgoing
from tests.golden.adapters import matches
from tests.golden.golden import PROJECTS
from tests.golden.tapped import TappedWire, amqp_frames
from tests.golden.texts import in_one_line, write
from tests.golden.transcripts import VISITS, TranscribedBus, Transcript, telemetry_of
from tests.rabbitmq import RabbitMQ

SUITE = "rest"
SECONDS = 16.0
HANG = 600.0
"""The limit for a visit on a crowded machine [s]: only a hang reaches it."""
PAUSE = 0.002
SLOWER = 1000.0
NO_HEARTBEAT = "?heartbeat=0"
"""No heartbeat, since the clock by which it would beat is slow."""


class LockstepBus(TranscribedBus):
    """Counts the messages published, the deliveries expected, and those handled."""

    def __init__(self, bus: Bus, transcript: Transcript, real: Callable[[], float]) -> None:
        super().__init__(bus, transcript)
        self.published = self.expected = self.handled = 0
        self.real, self.began, self.pause = real, real(), threading.Event()
        self._patterns: list[str] = []
        self._counting = threading.Lock()

    def subscribe(self, pattern: str, handler: Callable[[Message], None]) -> Callable[[], None]:
        def counted(message: Message) -> None:
            try:
                handler(message)
            finally:
                with self._counting:
                    self.handled += 1

        undo = super().subscribe(pattern, counted)
        with self._counting:
            self._patterns.append(pattern)

        def undone() -> None:
            with self._counting:
                self._patterns.remove(pattern)
            undo()

        return undone

    def send(self, message: Outgoing) -> None:
        with self._counting:
            self.published += 1
            self.expected += sum(matches(pattern, message.key) for pattern in self._patterns)
        super().send(message)
        if threading.current_thread() is threading.main_thread():
            self.settle()

    def settle(self) -> None:
        """Return when all deliveries are handled, as on the bus of one process."""
        while self.handled < self.expected:
            assert self.real() < self.began + HANG, f"{self.handled} of {self.expected} messages were handled"
            self.pause.wait(PAUSE)


def record(folder: Path) -> None:
    """Write for each visit the declarations and the messages."""
    broker = RabbitMQ()
    broker.start()
    try:
        for name in VISITS:
            visit(folder, name, broker)
    finally:
        broker.stop()


def visit(folder: Path, name: str, broker: RabbitMQ) -> None:
    """Play the visit of a project, and write its declarations and messages."""
    wire, watcher = TappedWire(broker.port), connect(broker.url + NO_HEARTBEAT, sender="watcher")
    watcher.subscribe("#", lambda message: None)
    real, began = time.monotonic, time.monotonic()
    sent = Transcript(telemetry_of(lumen.load(PROJECTS / name)))
    with TemporaryDirectory() as temporary, patch("time.monotonic", lambda: began + (real() - began) / SLOWER):
        root = Path(shutil.copytree(PROJECTS / name, Path(temporary) / name))
        url = broker.url.replace(f":{broker.port}/", f":{wire.port}/") + NO_HEARTBEAT
        bus = LockstepBus(connect(url, sender="golden"), Transcript(frozenset()), real)
        reader = FrameReader(wire)
        with lumen.open(root, bus=bus, story=VISITS[name][0]) as exhibition:  # type: ignore[arg-type]
            sent.now = lambda: exhibition.now
            while exhibition.now < SECONDS:
                exhibition.tick()
                bus.settle()
                while reader.published() < bus.published:
                    assert real() < began + HANG, f"{reader.published()} of {bus.published} messages were sent"
                    bus.pause.wait(PAUSE)
                for key, said in sorted(reader.taken(), key=lambda message: (message[0], in_one_line(message[1]))):
                    sent.add("publish", key, said)
    watcher.close()
    wire.close()
    sent.sum_up()
    write(folder / f"{name}_published.txt", sent.lines)
    write(folder / f"{name}_declared.txt", reader.declared())


class FrameReader:
    """Reads the frames that a client sent over a wire, each once."""

    def __init__(self, wire: TappedWire) -> None:
        self._wire = wire
        self._at: dict[int, int] = {}
        self._coming: dict[tuple[int, int], list[Any]] = {}
        self._messages: list[tuple[str, dict[str, Any]]] = []
        self._declared: set[str] = set()
        self._count = 0

    def published(self) -> int:
        """Return the number of messages sent so far."""
        self._read()
        return self._count

    def taken(self) -> list[tuple[str, dict[str, Any]]]:
        """Return the messages since the last call: the key, and the contents of the frames."""
        messages, self._messages = self._messages, []
        return messages

    def declared(self) -> list[str]:
        """Return the requests to the broker except messages, sorted."""
        self._read()
        return sorted(self._declared)

    def _read(self) -> None:
        for number, data in enumerate(list(self._wire.sent)):
            begun = at = self._at.get(number, 0)
            for end, frame in amqp_frames(bytes(data[begun:])):
                at = begun + end
                self._take(number, frame)
            self._at[number] = at

    def _take(self, number: int, frame: Any) -> None:
        place = (number, getattr(frame, "channel_number", 0))
        method = getattr(frame, "method", None)
        if method is not None and method.NAME == "Basic.Publish":
            self._coming[place] = [method]
        elif method is not None:
            self._other(method)
        elif hasattr(frame, "properties"):
            self._coming[place] += [frame, b""]
            if not frame.body_size:
                self._whole(place)
        elif place in self._coming and hasattr(frame, "fragment"):
            self._coming[place][2] += frame.fragment
            if len(self._coming[place][2]) >= self._coming[place][1].body_size:
                self._whole(place)

    def _whole(self, place: tuple[int, int]) -> None:
        method, head, body = self._coming.pop(place)
        said = {name: value for name, value in vars(head.properties).items() if value is not None}
        for drawn in ("message_id", "timestamp", "correlation_id"):
            said |= {drawn: True} if drawn in said else {}
        if "expiration" in said:
            said["expiration"] = -(-int(said["expiration"]) // 100) * 100
        said |= {"exchange": method.exchange, "mandatory": method.mandatory}
        text = body.decode("utf-8", "backslashreplace")
        said["body"] = json.loads(text) if said.get("content_type") == "application/json" else text
        self._count += method.exchange == "amq.topic"
        self._messages.append((method.routing_key, said))

    def _other(self, method: Any) -> None:
        if method.NAME.split(".")[0] not in ("Exchange", "Queue", "Basic", "Confirm"):
            return
        if method.NAME in ("Basic.Ack", "Basic.Reject", "Basic.Nack", "Basic.Cancel"):
            return
        said = {name: value for name, value in vars(method).items() if value and name not in ("ticket", "consumer_tag")}
        if str(said.get("queue", "")).startswith("amq.gen"):
            said["queue"] = "amq.gen"
        self._declared.add(f"{method.NAME} {in_one_line(dict(sorted(said.items())))}")
