"""A recorder writes every message of a bus, delays no publisher, and reports a disk's fault once."""

import errno
import math
import threading
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

import pytest

from lumen.bus.memory import MemoryBus
from lumen.features.mcap import recorder as recording
from lumen.features.mcap.files.recorded import Recorded
from lumen.features.mcap.files.recording_file import RecordingFile
from lumen.features.mcap.recorder import Recorder
from lumen.features.mcap.recordings_folder import RecordingsFolder
from lumen.features.mcap.tape_file import FileTape
from lumen.journal.happenings import happening
from lumen.language.causes import MessageOrigin
from lumen.language.people import PersonName
from lumen.language.projects import Project
from lumen.ports import Message
from tests.features.mcap.making import bodies, picture, said
from tests.journal.making import minimal
from tests.tables import for_each
from tests.waiting import HANG, until


def project(**changes: object) -> Project:
    return replace(minimal(), **changes)  # type: ignore[arg-type]


def tape(path: Path) -> FileTape:
    return FileTape(path, RecordingsFolder(path.parent / ".lumen"))


def test_all_that_is_said_is_in_the_file(tmp_path: Path) -> None:
    bus, path = MemoryBus(), tmp_path / "a.mcap"
    recorder = Recorder(bus, project(), [tape(path)])
    recorder.start()
    for number in range(50):
        bus.publish("lumen.anything", {"number": number})
    bus.publish("lumen.visual.command", "look")
    recorder.close()
    expected: list[tuple[str, object]] = [("lumen.anything", {"number": number}) for number in range(50)]
    assert bodies(path) == [*expected, ("lumen.visual.command", "look")]
    assert recorder.dropped == 0


def test_without_the_camera_nobody_asks_for_images(tmp_path: Path) -> None:
    bus = MemoryBus()
    recorder = Recorder(bus, project(), [tape(tmp_path / "a.mcap")], camera=False)
    recorder.start()
    assert not bus.heard(picture().key)
    assert bus.heard(project().routes["heard"].key_for("NAO"))
    recorder.close()


class Held:
    """A tape on a disk that does not answer."""

    def __init__(self) -> None:
        self.trouble, self.free, self.count = "", threading.Event(), 0

    def write(self, items: Sequence[Recorded], now: float) -> None:
        assert self.free.wait(HANG)
        self.count += len(items)

    def mark(self, why: str, now: float) -> None: ...

    def settle(self, now: float) -> None: ...

    def forget(self, people: Sequence[PersonName]) -> None: ...

    def close(self) -> None: ...


def test_a_disk_that_does_not_answer_holds_up_nobody(
    monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    monkeypatch.setattr(recording, "MAX_WAITING", 100)
    bus, held = MemoryBus(), Held()
    recorder = Recorder(bus, project(), [held])
    recorder.start()
    for number in range(500):
        bus.publish("lumen.anything", {"number": number})  # were this to wait, nothing would ever free it
    held.free.set()
    recorder.close()
    assert held.count + recorder.dropped == 500
    assert recorder.dropped >= 300
    assert len([line for line in caplog.messages if "too slow" in line]) <= 2


def test_a_full_disk_is_told_once_and_what_was_written_is_recovered(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    bus, path = MemoryBus(), tmp_path / "a.mcap"
    recorder = Recorder(bus, project(), [tape(path)])
    recorder.start()
    bus.publish("lumen.anything", {"number": 1})
    until(lambda: b"lumen.anything" in path.read_bytes() or path.stat().st_size > 300)

    def full(*_: object) -> None:
        raise OSError(errno.ENOSPC, "No space left on device")

    monkeypatch.setattr(RecordingFile, "write", full)
    bus.publish("lumen.anything", {"number": 2})
    until(lambda: bool(recorder.trouble))
    bus.publish("lumen.anything", {"number": 3})
    recorder.close()
    assert "no space left" in recorder.trouble
    assert len([line for line in caplog.messages if "can't be written" in line]) == 1
    monkeypatch.undo()
    from lumen.features.mcap.files.rewriting import recover

    assert recover(path) == 1


def test_whom_the_memory_forgets_no_recording_names(tmp_path: Path) -> None:
    bus, path = MemoryBus(), tmp_path / "a.mcap"
    recorder = Recorder(bus, project(), [tape(path)])
    recorder.start()
    bus.publish("lumen.heard", {"result": "my name is Ani", "confidence": 1})
    bus.publish("lumen.heard", {"result": "hello"})
    bus.publish("lumen.NAO.persistence.forgotten", {"name": "Ani"})
    bus.publish("lumen.answer", {"ok": True, "about": "Ani"})
    recorder.close()
    assert b"Ani" not in b"".join(str(body).encode() for _, body in bodies(path))
    assert len(bodies(path)) == 4
    assert ("lumen.heard", {"result": "hello"}) in bodies(path)


@for_each(
    ("key", "body", "why"),
    [
        ("lumen.operator.request", {"ask": "mark", "text": "he waved"}, "mark he waved"),
        ("lumen.NAO.operator.request", {"ask": "mark"}, "mark"),
        ("lumen.NAO2.operator.request", {"ask": "mark"}, ""),
        ("lumen.operator.request", {"ask": "status"}, ""),
        ("lumen.config.status", {"verdict": "refused"}, "reload-refused"),
        ("lumen.config.status", {"verdict": "rolled back"}, "reload-rolled-back"),
        ("lumen.config.status", {"verdict": "applied"}, ""),
        ("lumen.state", {"robot": "NAO", "noticed": "fallen"}, "fallen"),
        ("lumen.state", {"robot": "NAO", "event": "error.execution"}, "error"),
        ("lumen.state", {"robot": "NAO", "answer": {"kind": "error", "id": "d1"}}, "error"),
        ("lumen.state", {"robot": "NAO", "event": "heard"}, ""),
        ("lumen.visual.command", "look", ""),
    ],
)
def test_what_happens_is_known_from_the_bus(key: str, body: object, why: str) -> None:
    assert happening(said(key, body), "NAO") == why


SENT = [2.5e11, -1.0, math.inf, -math.inf, math.nan]


@pytest.mark.parametrize(
    "message", [said("lumen.a", {"n": 2**63 - 1}), *(said("lumen.a", {})._replace(time=sent) for sent in SENT)]
)
def test_what_any_sender_may_say_is_written(tmp_path: Path, message: Message) -> None:
    bus, path = MemoryBus(), tmp_path / "a.mcap"
    recorder = Recorder(bus, project(), [tape(path)])
    recorder.start()
    bus.publish("lumen.a", message.body, origin=MessageOrigin(time=message.time))
    recorder.close()
    assert bodies(path) == [("lumen.a", message.body)]


def test_a_fault_with_one_message_costs_no_other(tmp_path: Path) -> None:
    def extra(message: Message, came: float) -> Sequence[Recorded]:
        raise RuntimeError("no such link")

    bus, path = MemoryBus(), tmp_path / "a.mcap"
    recorder = Recorder(bus, project(), [tape(path)], extra=extra)
    recorder.start()
    for number in range(10):
        bus.publish("lumen.a", {"number": number})
    recorder.close()
    assert [body["number"] for _, body in bodies(path)] == [*range(10)]
    assert recorder.dropped == 10
