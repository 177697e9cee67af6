"""A ring holds the last minutes, keeps them if something happened, and stays within its limits."""

from pathlib import Path

import pytest

from lumen.features.mcap import ring as ringing
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
