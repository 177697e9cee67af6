"""A ring holds the last minutes, keeps them if something happened, and stays within its limits."""

import errno
import math
from pathlib import Path
from typing import Any

import pytest

from lumen.features.mcap import ring as ringing
from lumen.features.mcap.files.rewriting import rewrite
from lumen.features.mcap.recordings_folder import RecordingsFolder
from lumen.features.mcap.recovering import RecordingRescue
from lumen.features.mcap.ring import RingTape
from lumen.language.people import PersonName
from lumen.language.retention import RecordingSettings
from tests.features.mcap.making import BEGAN, bodies, encoded, said, write


@pytest.fixture
def folder(tmp_path: Path) -> RecordingsFolder:
    return RecordingsFolder(tmp_path)


def live(tape: RingTape, first: int, last: int, step: int = 10) -> None:
    """Write a message every `step` [s] from `first` to `last` [s]."""
    for at in range(first, last, step):
        tape.write(encoded(said("lumen.a", {"at": at}, at)), BEGAN + at)
        tape.settle(BEGAN + at)


def times(path: Path) -> list[int]:
    return [body["at"] for _, body in bodies(path)]


def test_what_led_to_it_and_the_minute_after_it_are_kept(folder: RecordingsFolder) -> None:
    kept = list[Path]()
    tape = RingTape(folder, RecordingSettings(ring=120.0), kept=kept.append)
    live(tape, 0, 1000)
    tape.mark("fallen", BEGAN + 1000)
    assert kept == []
    live(tape, 1000, 1200)
    (path,) = kept
    assert path.name.endswith("-fallen.mcap")
    found = times(path)
    assert found == list(range(found[0], 1061, 10))
    assert 1000 - 120 - 2 * ringing.PIECE_PERIOD <= found[0] <= 1000 - 120
    tape.close()
    assert folder.parts() == []
    assert folder.files() == [path]


def test_a_recording_holds_what_begins_each_of_its_pieces(folder: RecordingsFolder) -> None:
    tape = RingTape(folder, RecordingSettings(ring=120.0), first=lambda: encoded(said("lumen.first", {"at": -1})))
    live(tape, 0, 100)
    pieces = len(folder.parts())
    assert pieces > 1
    tape.mark("mark", BEGAN + 90)
    tape.close()
    (path,) = folder.files()
    assert [topic for topic, _ in bodies(path)].count("lumen.first") == pieces


def test_what_happens_meanwhile_makes_it_longer_but_not_endless(folder: RecordingsFolder) -> None:
    kept = list[Path]()
    tape = RingTape(folder, RecordingSettings(ring=120.0), kept=kept.append)
    for at in range(0, 600, 30):
        live(tape, at, at + 30)
        tape.mark("error", BEGAN + at + 30)
    tape.close()
    assert len(kept) > 3
    found = [at for path in kept for at in times(path)]
    assert found == sorted(set(found))


def test_without_anything_happening_nothing_is_left(folder: RecordingsFolder) -> None:
    tape = RingTape(folder, RecordingSettings(ring=60.0))
    live(tape, 0, 600)
    assert len(folder.parts()) <= 5
    tape.close()
    assert folder.files() == folder.parts() == []


def test_the_oldest_are_deleted_where_they_are_too_many(folder: RecordingsFolder) -> None:
    tape = RingTape(folder, RecordingSettings(ring=60.0, size=0.004))
    for visit in range(4):
        live(tape, visit * 1000, visit * 1000 + 100)
        tape.mark("mark", BEGAN + visit * 1000 + 100)
        live(tape, visit * 1000 + 100, visit * 1000 + 200)
    tape.close()
    assert 1 <= len(folder.files()) < 4
    assert sum(file.stat().st_size for file in folder.files()) <= 4000


def test_a_run_that_was_killed_leaves_its_last_minutes(folder: RecordingsFolder, tmp_path: Path) -> None:
    tape = RingTape(folder, RecordingSettings(ring=60.0))
    live(tape, 0, 100)
    tape._file._writer.flush()  # type: ignore[union-attr]
    tape._file._file.flush()  # type: ignore[union-attr]
    (folder.ring / "999-cut.mcap").write_bytes(b"\x89MC")
    other = write(tmp_path / "elsewhere.mcap", said("lumen.b", {"at": 1}))
    note = folder.begin(other)
    other.write_bytes(other.read_bytes()[:-1000])
    assert note
    note.release()
    told = list[str]()
    rescue = RecordingRescue(folder, told.append)
    rescue.close()
    (path,) = folder.files()
    assert "crashed" in path.name
    assert times(path)[-1] == 90
    assert folder.parts() == []
    assert len(told) == 2
    assert "elsewhere.mcap was cut off and has been repaired" in told[0]
    assert RecordingRescue(folder, told.append)._thread.started is False


def test_a_disk_that_refuses_is_told_once_and_tried_again(
    folder: RecordingsFolder, tmp_path: Path, caplog: pytest.LogCaptureFixture
) -> None:
    (tmp_path / "recordings").write_text("in the way")
    tape = RingTape(folder, RecordingSettings(ring=60.0))
    live(tape, 0, 50)
    assert tape.trouble
    assert len(caplog.messages) == 1
    (tmp_path / "recordings").unlink()
    live(tape, 60, 100)
    assert tape.trouble == ""
    assert len(folder.parts()) >= 1
    tape.close()


class Refusing:
    """A `rewrite` that fails as often as it is told to."""

    def __init__(self, monkeypatch: pytest.MonkeyPatch, times: float) -> None:
        self.times, self._rewrite = times, rewrite
        monkeypatch.setattr(ringing, "rewrite", self)

    def __call__(self, *arguments: Any, **more: Any) -> Any:
        self.times -= 1
        if self.times >= 0:
            raise OSError(errno.ENOSPC, "No space left on device")
        return self._rewrite(*arguments, **more)


def test_a_recording_that_could_not_be_written_is_written_later(
    folder: RecordingsFolder, monkeypatch: pytest.MonkeyPatch
) -> None:
    Refusing(monkeypatch, 3)
    tape = RingTape(folder, RecordingSettings(ring=120.0))
    live(tape, 0, 300)
    tape.mark("fallen", BEGAN + 300)
    live(tape, 300, 600)
    (path,) = folder.files()
    found = times(path)
    assert path.name.endswith("-fallen.mcap")
    assert {*range(300 - 120, 300 + 60, 10)} <= {*found}, "the minutes before the mark, and the one after it"
    tape.close()
    assert folder.parts() == []


def test_a_recording_that_is_never_written_is_given_up_and_its_ring_stays_small(
    folder: RecordingsFolder, monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    Refusing(monkeypatch, math.inf)
    tape = RingTape(folder, RecordingSettings(ring=60.0))
    tape.mark("fallen", BEGAN)
    live(tape, 0, 2000)
    assert "the recording of `fallen` is given up" in caplog.text
    assert len(folder.parts()) <= 5
    assert folder.files() == []
    tape.close()


def test_a_recording_that_could_not_be_written_at_the_end_is_rescued_at_the_next_start(
    folder: RecordingsFolder, monkeypatch: pytest.MonkeyPatch
) -> None:
    tape = RingTape(folder, RecordingSettings(ring=120.0))
    live(tape, 0, 300)
    with monkeypatch.context() as broken:
        Refusing(broken, math.inf)
        tape.mark("fallen", BEGAN + 300)
        tape.close()
    told = list[str]()
    RecordingRescue(folder, told.append).close()
    (path,) = folder.files()
    assert times(path)[-1] == 290
    assert "the last minutes of the run" in told[0]


def test_forgetting_reaches_the_ring_and_what_was_kept(folder: RecordingsFolder) -> None:
    tape = RingTape(folder, RecordingSettings(ring=60.0))
    tape.write(encoded(said("lumen.heard", {"at": 1, "result": "I am Ani"})), BEGAN)
    tape.mark("mark", BEGAN)
    tape.settle(BEGAN + 100)
    tape.write(encoded(said("lumen.heard", {"at": 2, "result": "Ani again"})), BEGAN + 100)
    tape.forget([PersonName("Ani")])
    texts = [body["result"] for path in [*folder.files(), *folder.parts()] for _, body in bodies(path)]
    assert texts == ["I am", "again"]
    tape.close()
