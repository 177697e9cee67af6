"""The frames on the socket between an exhibition and a program of the same machine, in a visit.

The program is a module that sees and hears the visitor, and reads everything. Time is virtual: the exhibition continues
once a message of the module has arrived. Questions and proofs of the key, ids and times are drawn anew each time: only
that they are there is written. Telemetry is summed up for each 100 frames.
"""

import json
import os
import shutil
import struct
from collections.abc import Iterator
from datetime import UTC, datetime
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any
from unittest.mock import patch

import lumen
from lumen.bus import connect
from tests.golden.adapters import LocalAddress, LocalBusClient, LocalBusServer
from tests.golden.golden import PROJECTS
from tests.golden.tapped import TappedWire
from tests.golden.texts import digest, in_one_line, write
from tests.golden.transcripts import Transcript, steady, telemetry_of
from tests.waiting import Collector

SUITE = "rest"
SENDER = "golden module"
MARK = "lumen.golden.mark"
SAID = {
    "tour": ["my name is Budi", "I am fine", "please explain the exhibition", "no, thank you"],
    "museum": ["yes please", "next", "english", "next"],
}
BEGAN = datetime(2026, 6, 2, 8, 30, tzinfo=UTC).timestamp()
"""A Tuesday, when the museum is open."""
TOGETHER = 100
HANG = 300.0
"""The limit for a message on a crowded machine [s]: only a hang reaches it."""


def record(folder: Path) -> None:
    """Write for each visit the frames that the module sent, and those that it received."""
    for name, words in SAID.items():
        project = lumen.load(PROJECTS / name)
        with TemporaryDirectory() as temporary:
            root = Path(shutil.copytree(PROJECTS / name, Path(temporary) / name))
            wire = visit(root, name, project, words)
        telemetry = telemetry_of(project)
        write(folder / f"{name}_sent.txt", lines(wire.sent[0], telemetry))
        write(folder / f"{name}_received.txt", lines(wire.received[0], telemetry))


def visit(root: Path, name: str, project: lumen.Project, words: list[str]) -> TappedWire:
    """Let the module report a visitor."""
    address = f"memory://golden-local-{name}"
    door = LocalBusServer(connect(address, sender="door"), root)
    wire = TappedWire(door.address.path, str(root / "tap"))
    module = LocalBusClient(LocalAddress(path=str(root / "tap"), key=door.address.key), SENDER)
    watcher, arrived, handled = connect(address, sender="watcher"), Collector(), Collector()
    watcher.subscribe("#", lambda message: arrived(message) if message.sender == SENDER else None)
    watcher.subscribe(MARK, handled)
    module.returns(lambda key: None)
    undo = module.subscribe("lumen.#", lambda message: None)
    module.subscribe("#", lambda message: None)
    face, heard = (project.routes[route].key.replace("{robot}", project.robot) for route in ("face", "heard"))
    sent = 0

    def tell(key: str, body: dict[str, Any], **more: Any) -> None:
        nonlocal sent
        module.publish(key, body, **more)
        sent += 1
        arrived.wait(sent, HANG)
        watcher.publish(MARK, sent)  # which is delivered after the message, by whichever thread delivers
        handled.wait(sent, HANG)

    with (
        patch("time.time", lambda: BEGAN),
        patch.dict(os.environ, TZ="Etc/UTC"),
        lumen.open(root, bus=connect(address, sender="golden")) as exhibition,
    ):
        exhibition.run(1)
        for word in words:
            for x in range(100, 220, 20):
                tell(face, {"x": x, "y": 120}, ttl=1.0)
                exhibition.run(0.3)
            exhibition.run(6)
            tell(heard, {"result": word, "lang": "en"}, ttl=5.0)
            exhibition.run(1.5)
        tell("lumen.NAO.operator.request", {"ask": "status"}, reply_to="lumen.golden", correlation_id="17")
        exhibition.run(0.5)
        undo()
        tell("lumen.nobody", {"is": "there"})
    module.close()
    watcher.close()
    door.close()
    wire.close()
    return wire


def lines(data: bytes, telemetry: frozenset[str]) -> list[str]:
    """Return a line for each frame, except telemetry, which is summed up."""
    transcript = Transcript(telemetry)
    for number, (verb, *words) in enumerate(frames(data)):
        if verb in ("message", "publish"):
            head, body = list(words[:-1]), words[-1]
            key = head.pop(1 if verb == "message" else 0)
            head[-4], head[-2] = bool(head[-4]), head[-2] > 0  # id and time
            text = in_one_line(steady(body))
            said = {"head": head, "body": body if len(text) < 300 else digest([text])}
            transcript.add("receive" if verb == "message" else "publish", key, said)
        elif verb in ("prove", "proof"):
            transcript.lines.append(f"{verb} {len(words)} words")
        else:
            transcript.lines.append(f"{verb} {in_one_line(words)}")
        if number % TOGETHER == TOGETHER - 1:
            transcript.sum_up()
    transcript.sum_up()
    return transcript.lines


def frames(data: bytes) -> Iterator[list[Any]]:
    """Yield the frames, each a JSON array after its length."""
    at = 0
    while at < len(data):
        (length,) = struct.unpack_from(">I", data, at)
        yield json.loads(data[at + 4 : at + 4 + length])
        at += 4 + length
