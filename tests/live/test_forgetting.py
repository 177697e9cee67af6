"""A forgotten name is in no byte of the files that the exhibition keeps, however the exhibition ended."""

import io
import json
import os
import signal
import sys
import time
import unicodedata
import zipfile
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from lumen.bus import Bus
from lumen.bus.local import LocalAddress, LocalBusClient
from lumen.cli.main import main
from lumen.errors import BusError
from lumen.journal.journal_file import JOURNAL_SUFFIX, unpack
from lumen.run.reload_journal import Journal
from tests import ROOT
from tests.copying import copied_project
from tests.features.alerts.halls import Hall
from tests.features.alerts.servers import Web
from tests.guarded import PIPE, STDOUT, Guarded
from tests.waiting import HANG, until

GUEST = """
id: guest
context: {visitor: "", talks: 0}
initial: waits
states:
  waits:
    on:
      heard:
        - guard: contains(event.data.result, 'my name is')
          actions:
            - assign: {visitor: "after(event.data.result, 'my name is')"}
            - send: {event: later, delay: 2h, data: {who: event.data.result}}
            - publish: {route: social_expression, body: {text: "'met ' + context.visitor"}}
            - raise: met
      later: {}
      met: {target: knows}
  knows:
    do: [{say: "Hello {{ context.visitor }}"}]
    on: {heard: {actions: {assign: {talks: context.talks + 1}}}}
"""


@pytest.fixture
def copy(whole: Path) -> Path:
    main_file = whole / "lumen.yaml"
    text = main_file.read_text("utf-8").replace("behavior: tour", "behavior: guest").replace("story: visitor", "#")
    text = text.replace("memory: {here: false", "social: {here: true}\n  memory: {here: true")
    main_file.write_text(text, "utf-8")
    for path in (whole / "behaviors").rglob("*.yaml"):
        path.unlink()
    (whole / "behaviors/guest.yaml").write_text(GUEST, "utf-8")
    return whole


@contextmanager
def running(copy: Path) -> Iterator[tuple[Guarded[str], Bus]]:
    """An exhibition in a process of its own, which already receives messages, and its bus."""
    begun = time.time()
    command = [sys.executable, "-m", "lumen", "run", copy, "--robot", "recording"]
    with Guarded(command, stdin=PIPE, stdout=PIPE, stderr=STDOUT, text=True) as process:
        buses: list[Bus] = []

        def reached() -> bool:
            assert process.poll() is None, process.stdout and process.stdout.read()
            with suppress(OSError, ValueError, BusError):
                address = json.loads((copy / ".lumen/door.json").read_text("utf-8"))
                alive = json.loads((copy / ".lumen/alive.json").read_text("utf-8"))["time"] > begun
                if address["process"] == process.pid and alive:
                    buses.append(LocalBusClient(LocalAddress.of(address)))
            return bool(buses)

        try:
            until(reached)
            yield process, buses[0]
        finally:
            for bus in buses:
                bus.close()
            process.kill()


def found(copy: Path, name: str) -> list[str]:
    """Return the files under `.lumen` that have the name in any form: also packed, and as JSON escapes it."""
    forms = {form(kind) for kind in (name, name.upper(), name.lower(), name.casefold()) for form in (_nfc, _nfd)}
    sought = {form.encode(code) for form in forms for code in ("utf-8", "utf-16-le", "utf-32-le")}
    sought |= {json.dumps(form)[1:-1].encode() for form in forms}
    return [
        where
        for path in sorted((copy / ".lumen").rglob("*"))
        if path.is_file()
        for where, content in _contents(path)
        if any(form in content for form in sought)
    ]


def _nfc(text: str) -> str:
    return unicodedata.normalize("NFC", text)


def _nfd(text: str) -> str:
    return unicodedata.normalize("NFD", text)


def _contents(path: Path) -> Iterator[tuple[str, bytes]]:
    try:
        content = path.read_bytes()
    except FileNotFoundError:
        return  # a draft, which is the file by now
    yield path.name, content
    if path.suffix == JOURNAL_SUFFIX:
        texts = (text for text, _ in unpack(content, content.index(b"\n") + 1))
        yield "journal", b"".join(texts)
    if zipfile.is_zipfile(io.BytesIO(content)):
        with zipfile.ZipFile(io.BytesIO(content)) as archive:
            yield from ((f"{path.name}: {member}", archive.read(member)) for member in archive.namelist())


def stands(copy: Path) -> dict[str, Any]:
    """Return the snapshot as it was written."""
    found: dict[str, Any] = json.loads((copy / ".lumen/snapshot.json").read_text("utf-8"))["snapshot"]
    return found


def hear(bus: Bus, text: str) -> None:
    bus.publish("lumen.audio.speech.recognition", {"name": "visitor", "result": text})


def faces(copy: Path, name: str) -> None:
    """Let the eyes know a face by that name."""
    names, times = np.array([name], dtype=np.str_), np.array([1e12])
    np.savez_compressed(copy / ".lumen/faces.npz", names=names, times=times, faces=np.zeros((1, 96, 96), np.uint8))


@pytest.mark.slow
def test_no_byte_of_a_forgotten_name_is_left_after_a_crash(copy: Path, capsys: pytest.CaptureFixture[str]) -> None:
    home = copy / ".lumen"
    with running(copy) as (process, bus):
        hear(bus, "my name is Ünal Çelik")
        kept = ("memory.db-wal", "posts.jsonl", "snapshot.json", "journal")
        until(lambda: set(kept) <= set(found(copy, "Ünal Çelik")))
        process.send_signal(signal.SIGKILL)
        process.wait()
    faces(copy, "ÜNAL ÇELİK".replace("İ", "I"))
    (home / "snapshot.json.new").write_bytes((home / "snapshot.json").read_bytes()[:-30])
    with (home / "journal.jsonl").open("ab") as journal:
        journal.write('{"note": "Ünal Çelik"}\n{"note": "cut short, Ünal Çelik'.encode())
    assert main(["memory", "forget", _nfd("ünal çelik"), "--project", str(copy), "--format", "json"]) == 0
    told = json.loads(capsys.readouterr().out)
    assert {place["where"] for place in told["deleted"]} == {
        *("memory.db", "faces.npz", "posts.jsonl", "journal.jsonl", "snapshot.json", "journal")
    }
    assert (told["visitors"], told["pictures"], told["left"]) == (1, 1, [])
    assert found(copy, "Ünal Çelik") == []
    with running(copy) as (process, bus):
        hear(bus, "hello")
        until(lambda: stands(copy)["context"]["talks"])
        assert stands(copy)["configuration"] == ["knows"], "it has gone on where it was"
        process.send_signal(signal.SIGTERM)
        process.communicate()
    assert found(copy, "Ünal Çelik") == []
    assert os.path.exists(home / "snapshot.json")


@pytest.mark.slow
def test_who_stands_there_is_forgotten_by_an_exhibition_that_runs(
    copy: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    with running(copy) as (process, bus):
        hear(bus, "my name is İpek")
        until(lambda: {"snapshot.json", "posts.jsonl"} <= set(found(copy, "İpek")))
        with monkeypatch.context() as patient:
            patient.setattr("lumen.features.visitors.command.ANSWER_TIMEOUT", HANG)
            patient.setattr("lumen.run.forgetting.files.PATIENCE", HANG)
            assert main(["memory", "forget", "ipek", "--project", str(copy)]) == 0
        told = capsys.readouterr().out
        assert "STILL THERE" not in told
        assert "deleted: the running memory: visitors: 1" in told
        assert found(copy, "İpek") == []
        hear(bus, "and I am still here")
        until(lambda: stands(copy)["context"]["talks"])
        until(lambda: found(copy, "and I am still here"))
        process.send_signal(signal.SIGKILL)
        process.wait()
    assert found(copy, "İpek") == []
    assert found(copy, "and I am still here") == ["journal"], "the memory notes nothing more of this visit"
    assert main(["memory", "forget", "ipek", "--project", str(copy)]) == 1
    assert "has nothing about ipek" in capsys.readouterr().out


@pytest.mark.network
def test_a_journal_without_a_row_is_named_among_what_a_broker_keeps(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    folder = copied_project(ROOT / "examples" / "minimal", tmp_path / "minimal")
    hello = folder / "behaviors" / "hello.yaml"
    said = "[{publish: {route: journal, body: {visitor: \"'Budi'\"}}}, {play: wave}"
    hello.write_text(hello.read_text("utf-8").replace("[{play: wave}", said), "utf-8")
    unreachable = ["--bus", "amqp://127.0.0.1:1/", "--format", "json"]
    assert main(["memory", "forget", "budi", "--project", str(folder), *unreachable]) == 1
    elsewhere = {place["where"] for place in json.loads(capsys.readouterr().out)["elsewhere"]}
    assert "the broker's stream of `journal`" in elsewhere


def test_a_robot_without_its_brain_forgets_what_it_was_told_to_say(tmp_path: Path) -> None:
    web = Web()
    hall = Hall(tmp_path, web)
    robot = hall.part("robot")
    hall.until(lambda: robot.presence and robot.presence.settled)
    (tmp_path / ".lumen").mkdir(exist_ok=True)
    journal = Journal(tmp_path / ".lumen")
    journal.write({"command": "says “Hello Ünal”"})
    journal.write({"command": "says “Hello Ünalan”"})
    hall.bus.publish("lumen.TINY.persistence.forgotten", {"name": "ünal"})
    hall.until(lambda: [entry["command"] for entry in journal.entries()] == ["says “Hello Ünalan”"])
    hall.close()
    web.close()
