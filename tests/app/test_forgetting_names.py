"""The queue of names to forget: it loses no name, and leaves the files of a running exhibition to that exhibition."""

from collections.abc import Callable
from pathlib import Path

import pytest

from lumen.bus import connect
from lumen.language.people import PersonName
from lumen.project.home import Home
from lumen.run.forgetting import files
from lumen.run.forgetting.added import Forgetting, ForgottenPlace
from lumen.run.forgetting.files import forget_in
from lumen.run.parts.forgetting import FORGETTING_SPACING, MAX_PENDING_NAMES, ForgettingPart
from lumen.run.snapshot_store import SNAPSHOT_FILE
from tests.exhibits import project

KEY = "lumen.NAO.persistence.forgotten"


def test_names_are_forgotten_one_at_a_time_and_each_once() -> None:
    bus, forgotten = connect("memory://"), list[str]()

    def forget(person: PersonName) -> None:
        forgotten.append(person.key)

    part = ForgettingPart(project(), bus, forget)
    for name in ("Ani", "ani", "Ani", "Ünal", *(f"Nobody {n}" for n in range(300))):
        bus.publish(KEY, {"name": name})
        part.tick(0.0, ())
    assert len(forgotten) == 1
    part.tick(FORGETTING_SPACING, ())
    assert len(forgotten) == 2
    part.close()
    assert forgotten[:2] == ["ani", "ani"]
    assert "ünal" in forgotten
    assert len(forgotten) == MAX_PENDING_NAMES + 1
    bus.close()


class Waiting:
    """A clock for the waiting process; in each of its pauses the other process works."""

    def __init__(self, work: Callable[[], object]) -> None:
        self.now, self.pauses, self._work = 0.0, 0, work

    def monotonic(self) -> float:
        return self.now

    def time(self) -> float:
        return self.now

    def sleep(self, seconds: float) -> None:
        self.now += seconds
        self.pauses += 1
        self._work()


def forgotten(folder: Path, monkeypatch: pytest.MonkeyPatch, work: Callable[[], object]) -> tuple[Forgetting, Waiting]:
    """Return the result of forgetting Ani while another process holds the home, and the clock of the wait."""
    running, waiting, found = Home(folder), Waiting(work), Forgetting()
    assert running.hold()
    monkeypatch.setattr(files, "time", waiting)
    (folder / SNAPSHOT_FILE).write_text('{"snapshot": {"context": {"visitor": "Ani"}}}')
    forget_in(folder, "Ani", found)
    running.release()
    return found, waiting


def test_the_file_of_a_running_exhibition_is_left_to_it(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    texts = iter(['{"visitor": "Ani"}', "{}"])
    found, waiting = forgotten(tmp_path, monkeypatch, lambda: (tmp_path / SNAPSHOT_FILE).write_text(next(texts)))
    assert waiting.pauses == 2
    assert found.left == []


def test_a_running_exhibition_that_does_not_forget_is_named(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    found, waiting = forgotten(tmp_path, monkeypatch, lambda: None)
    assert files.PATIENCE <= waiting.now < files.PATIENCE + 1.0
    assert found.left == [ForgottenPlace(SNAPSHOT_FILE, "the running exhibition has not forgotten the name")]
