"""A roll back restores the files and keeps the newer ones; what can't be restored does not go live by itself."""

import os
from pathlib import Path
from typing import Any

import pytest

from lumen.project.files import fingerprint, read_files
from lumen.run.reload.restoring import restore
from tests.live.shows import Live

SORRY, PARDON = 'en: "I am sorry, I did not understand that."', 'en: "Come again, please?"'
LOVE = "questions: {en: [what is love], id: [apa itu cinta]}\nanswer: {en: A question., id: Pertanyaan.}\n"
OTHER = 'en: "Hello, dear visitor!"'


def active(live: Live) -> bool:
    """Return whether the files on the disk are those that run."""
    return live.show.loop.project.hash == fingerprint(read_files(live.folder))


def save(live: Live, name: str, text: str) -> None:
    draft = live.folder.parent / "draft"
    draft.write_text(text, "utf-8")
    draft.replace(live.folder / name)


def kept(live: Live, answer: dict[str, Any]) -> dict[str, str]:
    """Return the newer versions that the answer names, by their file's name."""
    paths = [note.rpartition(" ")[2] for note in answer["notes"] if "the newer version is in" in note]
    return {Path(path).name: (live.folder / path).read_text("utf-8") for path in paths}


@pytest.mark.slow
def test_the_files_are_those_before_and_the_next_save_does_not_undo_it(live: Live) -> None:
    tour = live.folder / "behaviors" / "tour.yaml"
    before = tour.read_text("utf-8")
    live.edit(SORRY, PARDON)
    live.until(lambda: active(live))
    newer = tour.read_text("utf-8")
    answer = live.ask("rollback")
    assert tour.read_text("utf-8") == before
    assert kept(live, answer) == {"tour.yaml": newer}
    assert active(live)
    save(live, "knowledge/love.yaml", LOVE)
    live.until(lambda: active(live))
    assert "love" in live.show.loop.project.knowledge
    assert PARDON not in tour.read_text("utf-8")


@pytest.mark.slow
def test_a_file_that_was_added_is_moved_away_and_comes_back_with_another_roll_back(live: Live) -> None:
    save(live, "knowledge/love.yaml", LOVE)
    live.until(lambda: active(live) and "love" in live.show.loop.project.knowledge)
    assert kept(live, live.ask("rollback")) == {"love.yaml": LOVE}
    assert not (live.folder / "knowledge" / "love.yaml").exists()
    live.ask("rollback")
    assert (live.folder / "knowledge" / "love.yaml").read_text("utf-8") == LOVE
    assert "love" in live.show.loop.project.knowledge


@pytest.mark.slow
def test_the_findings_are_those_of_the_files_that_run(live: Live) -> None:
    save(live, "knowledge/love.yaml", LOVE.replace(", id: [apa itu cinta]", ""))
    live.until(lambda: active(live))
    warned = live.ask("status")["last"]["diagnostics"]
    assert [one["code"] for one in warned if one["file"] == "knowledge/love.yaml"] == ["missing-language"]
    live.edit(SORRY, PARDON)
    live.until(lambda: PARDON[5:-1] in live.transcript or active(live))
    assert live.ask("rollback")["diagnostics"] == warned


@pytest.mark.slow
def test_newer_files_that_could_not_be_restored_wait_for_a_person(live: Live) -> None:
    tour, elsewhere = live.folder / "behaviors" / "tour.yaml", live.folder / "linked.txt"
    live.edit(SORRY, PARDON)
    live.until(lambda: active(live))
    tour.rename(elsewhere)
    tour.symlink_to(elsewhere)
    running = live.ask("rollback")["after"]
    assert live.show.loop.project.hash == running
    assert "still has the newer files (tour.yaml can't be written: it is a link)" in live.ask("status")["reason"]
    save(live, "knowledge/love.yaml", LOVE)
    live.until_told("staged: ")
    assert live.show.loop.project.hash == running
    assert live.ask("apply")["verdict"] == "applied"
    assert active(live)
    assert "newer" not in live.ask("status")["reason"]


def files_of(root: Path) -> dict[str, bytes]:
    return {path: (root / path).read_bytes() for path in ("lumen.yaml", "behaviors/a.yaml", "behaviors/b.yaml")}


@pytest.fixture
def root(tmp_path: Path) -> Path:
    (tmp_path / "behaviors").mkdir()
    for name in ("lumen.yaml", "behaviors/a.yaml", "behaviors/b.yaml"):
        (tmp_path / name).write_text(f"newer: {name}\n")
    return tmp_path


def test_all_files_are_restored_or_none(root: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    newer = files_of(root)
    replace, done = os.replace, list[str]()

    def full(source: str, target: str) -> None:
        done.append(str(target))
        if len(done) == 2:
            raise OSError(28, "No space left on device", str(target))
        replace(source, target)

    monkeypatch.setattr(os, "replace", full)
    found = restore(root, dict.fromkeys(newer, b"older: {}\n"))
    assert (found.paths, found.trouble) == ((), "b.yaml can't be written: no space left on device")
    assert files_of(root) == newer
    assert sorted(path.name for path in (root / "behaviors").iterdir()) == ["a.yaml", "b.yaml"]


def test_a_bundle_that_is_not_kept_changes_nothing(root: Path) -> None:
    assert restore(root, None).trouble == "the previous files are not kept"
    assert restore(root, read_files(root)).paths == ()
    assert not (root / ".lumen").exists()


def test_two_roll_backs_in_one_second_keep_both(root: Path) -> None:
    newer = read_files(root)
    first = restore(root, {**newer, "behaviors/a.yaml": b"one: {}\n"})
    second = restore(root, {**newer, "behaviors/a.yaml": b"two: {}\n"})
    assert (root / first.kept / "behaviors/a.yaml").read_bytes() == newer["behaviors/a.yaml"]
    assert (root / second.kept / "behaviors/a.yaml").read_bytes() == b"one: {}\n"
