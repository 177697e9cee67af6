"""Files saved in all the ways in which they are: one verdict for each content that stays, none for what passes.

The quiet period is measured by a clock that only the tests advance. A machine that stops between two writes changes no
verdict.
"""

import os
import threading
from collections.abc import Callable, Iterator
from pathlib import Path
from queue import SimpleQueue

import pytest

from lumen.project.files import Unreadable, fingerprint, read_files
from lumen.project.project_folders import FOLDERS, ProjectFolder
from lumen.run.watcher import FileWatcher, SavedFiles, WatchedFiles, watched_folders
from tests.waiting import HANG, until

QUIET = 0.1
TOUR, DANCE = "behaviors/tour.yaml", "motions/dance.yaml"


def fill(folder: Path, text: str = "first") -> Path:
    for path in ("lumen.yaml", TOUR, "behaviors/stories/visitor.yaml", DANCE):
        (folder / path).parent.mkdir(parents=True, exist_ok=True)
        (folder / path).write_text(f"{text} {path}", "utf-8")
    return folder


class Clock:
    """A stand-in for the module `time`, with the watcher's time."""

    def __init__(self) -> None:
        self.now = 100.0

    def monotonic(self) -> float:
        return self.now


@pytest.fixture(autouse=True)
def clock(monkeypatch: pytest.MonkeyPatch) -> Clock:
    found = Clock()
    monkeypatch.setattr("lumen.run.watcher.time", found)
    return found


class Watched:
    """A watched project, and the verdicts on its files."""

    def __init__(self, root: Path, clock: Clock) -> None:
        self.root, self.clock, self.looks = root, clock, 0
        self.watcher: FileWatcher[SavedFiles] = self.watch()
        read = self.watcher._read

        def looked() -> WatchedFiles:
            found = read()
            self.looks += 1
            return found

        self.watcher._read = looked  # type: ignore[method-assign]
        self.watcher.start()

    def watch(self) -> FileWatcher[SavedFiles]:
        return FileWatcher(self.root, read_files(self.root), lambda saved: saved, quiet=QUIET)

    def next(self) -> SavedFiles:
        """Wait for the next verdict, however long its quiet period is, and return it."""
        results = self.watcher.results
        until(lambda: not results.empty(), meanwhile=lambda: self.pause(QUIET / 3), what="a verdict")
        return results.get()

    def looked(self) -> None:
        """Wait until the watcher has read what the files are now."""
        before = self.looks
        until(lambda: self.watcher._hint.set() or self.looks >= before + 2, every=0.001, what="two looks at the files")

    def last(self, text: str = "the last word") -> list[SavedFiles]:
        """Return all verdicts up to that on a file written now."""
        (self.root / "lumen.yaml").write_text(text, "utf-8")
        found = [self.next()]
        while found[-1].files["lumen.yaml"] != text.encode():
            found.append(self.next())
        return found

    def pause(self, seconds: float) -> None:
        """Let so much time pass after the watcher has read the files, and let it heed that."""
        self.looked()
        self.clock.now += seconds
        self.looked()


@pytest.fixture
def watched(tmp_path: Path, clock: Clock) -> Iterator[Watched]:
    one = Watched(fill(tmp_path / "show"), clock)
    yield one
    one.watcher.close()


def in_place(watched: Watched) -> None:
    (watched.root / TOUR).write_text("new", "utf-8")


def truncated_first(watched: Watched) -> None:
    with (watched.root / TOUR).open("w") as file:
        for part in ("n", "e", "w"):
            file.flush()
            watched.pause(QUIET / 3)
            file.write(part)


def as_vim_does(watched: Watched) -> None:
    file = watched.root / TOUR
    (file.parent / "4913").touch()
    (file.parent / "4913").unlink()
    os.replace(file, file.with_name("tour.yaml~"))
    watched.pause(QUIET / 2)
    file.write_text("new", "utf-8")
    file.with_name("tour.yaml~").unlink()


def as_emacs_does(watched: Watched) -> None:
    file = watched.root / TOUR
    lock = file.with_name(".#tour.yaml")
    lock.symlink_to("somebody@somewhere.1234")
    file.with_name("#tour.yaml#").write_text("half", "utf-8")
    watched.pause(2 * QUIET)
    in_place(watched)
    file.with_name("#tour.yaml#").unlink()
    lock.unlink()


def by_another_name(watched: Watched) -> None:
    draft = watched.root / "behaviors" / "tour.yaml.tmp"
    draft.write_text("new", "utf-8")
    os.replace(draft, watched.root / TOUR)


def in_a_renamed_folder(watched: Watched) -> None:
    """Move the folder away, change it there, and move it back within the longer quiet period of vanished files."""
    folder = watched.root / "behaviors"
    folder.rename(watched.root / "elsewhere")
    watched.pause(1.2 * QUIET)
    (watched.root / "elsewhere" / "tour.yaml").write_text("new", "utf-8")
    (watched.root / "elsewhere").rename(folder)


@pytest.mark.parametrize(
    "save", [in_place, truncated_first, as_vim_does, as_emacs_does, by_another_name, in_a_renamed_folder]
)
def test_one_verdict_for_one_save(watched: Watched, save: Callable[[Watched], None]) -> None:
    save(watched)
    saved = watched.next()
    assert saved.changed == (TOUR,)
    assert saved.files[TOUR] == b"new"
    assert len(watched.last()) == 1


def test_files_saved_one_after_the_other_are_judged_together(watched: Watched) -> None:
    paths = ("lumen.yaml", TOUR, "behaviors/stories/visitor.yaml", DANCE)
    for path in paths:
        (watched.root / path).write_text("new", "utf-8")
        watched.pause(0.4 * QUIET)
    assert watched.next().changed == tuple(sorted(paths))


def test_what_is_saved_as_it_was_is_not_judged(watched: Watched) -> None:
    before = (watched.root / TOUR).read_text("utf-8")
    (watched.root / TOUR).write_text(before, "utf-8")
    watched.pause(3 * QUIET)
    assert len(watched.last()) == 1


def test_a_file_that_is_gone_for_good_is_noticed(watched: Watched) -> None:
    (watched.root / DANCE).unlink()
    saved = watched.next()
    assert saved.changed == (DANCE,)
    assert DANCE not in saved.files
    assert saved.quiet - saved.seen >= 2 * QUIET


def test_a_folder_that_comes_later_is_watched(watched: Watched) -> None:
    (watched.root / "fuzzy").mkdir()
    (watched.root / "fuzzy" / "head.yaml").write_text("new", "utf-8")
    assert watched.next().changed == ("fuzzy/head.yaml",)
    (watched.root / "fuzzy" / "head.yaml").write_text("newer", "utf-8")
    assert watched.next().files["fuzzy/head.yaml"] == b"newer"


@pytest.mark.parametrize("folder", FOLDERS, ids=lambda folder: folder.path)
def test_a_nested_folder_that_comes_later_is_watched(watched: Watched, folder: ProjectFolder) -> None:
    file = f"{folder.path}/faq{folder.endings[0]}"
    (watched.root / file).parent.mkdir(parents=True, exist_ok=True)
    (watched.root / file).write_text("new", "utf-8")
    assert watched.next().changed == (file,)
    assert watched.root / folder.path in watched_folders(watched.root)
    (watched.root / file).write_text("newer", "utf-8")
    assert watched.next().files[file] == b"newer"


def test_what_can_not_be_read_is_told_and_mended(watched: Watched) -> None:
    (watched.root / TOUR).unlink()
    (watched.root / TOUR).mkdir()
    assert isinstance(watched.next().files[TOUR], Unreadable)
    (watched.root / TOUR).rmdir()
    in_place(watched)
    assert watched.next().files[TOUR] == b"new"


def test_a_project_that_is_a_link_is_switched(tmp_path: Path, clock: Clock) -> None:
    for name in ("one", "two"):
        fill(tmp_path / name, name)
    (tmp_path / "show").symlink_to(tmp_path / "one")
    watched = Watched(tmp_path / "show", clock)
    (tmp_path / "next").symlink_to(tmp_path / "two")
    os.replace(tmp_path / "next", tmp_path / "show")
    saved = watched.next()
    assert fingerprint(saved.files) == fingerprint(read_files(tmp_path / "two"))
    (tmp_path / "two" / TOUR).write_text("new", "utf-8")
    assert watched.next().files[TOUR] == b"new"
    watched.watcher.close()


def test_files_that_are_links_are_switched_together(tmp_path: Path, clock: Clock) -> None:
    """As Kubernetes mounts a ConfigMap: `..data` is a link that is replaced."""
    root = fill(tmp_path / "show")
    for name in ("one", "two"):
        (root / "motions" / f"..{name}").mkdir()
        (root / "motions" / f"..{name}" / "dance.yaml").write_text(name, "utf-8")
    (root / "motions" / "..data").symlink_to("..one")
    (root / DANCE).unlink()
    (root / DANCE).symlink_to("..data/dance.yaml")
    watched = Watched(root, clock)
    (root / "motions" / "..next").symlink_to("..two")
    os.replace(root / "motions" / "..next", root / "motions" / "..data")
    assert watched.next().files[DANCE] == b"two"
    watched.watcher.close()


def test_who_asks_gets_an_answer_whether_something_changed_or_not(watched: Watched) -> None:
    watched.watcher.request("please")
    saved = watched.next()
    assert (saved.asked, saved.changed) == ("please", ())


def test_a_judge_that_fails_ends_nothing(tmp_path: Path, clock: Clock, caplog: pytest.LogCaptureFixture) -> None:
    root, failed = fill(tmp_path / "show"), threading.Event()

    def judge(saved: SavedFiles) -> bytes:
        if saved.files[TOUR] == b"bad":
            failed.set()
            raise ValueError("a fault of ours")
        return saved.files[TOUR]

    watcher: FileWatcher[bytes] = FileWatcher(root, read_files(root), judge, quiet=QUIET)
    watcher.start()
    (root / TOUR).write_text("bad", "utf-8")
    until(failed.is_set, meanwhile=lambda: passing(clock), what="a judge that fails")
    (root / TOUR).write_text("good", "utf-8")
    until(lambda: not watcher.results.empty(), meanwhile=lambda: passing(clock), what="a verdict")
    assert watcher.results.get() == b"good"
    assert "a fault of ours" in caplog.text
    watcher.close()


def passing(clock: Clock) -> None:
    """Let real time pass, and the watcher's time faster."""
    threading.Event().wait(0.001)
    clock.now += QUIET / 10


def test_what_takes_long_is_begun_while_the_files_settle(tmp_path: Path, clock: Clock) -> None:
    root, order = fill(tmp_path / "show"), list[str]()

    def judge(saved: SavedFiles) -> SavedFiles:
        order.append("judged")
        return saved

    watcher = FileWatcher(root, read_files(root), judge, quiet=QUIET, noticed=lambda: order.append("noticed"))
    watcher.start()
    (root / TOUR).write_text("new", "utf-8")
    until(lambda: not watcher.results.empty(), meanwhile=lambda: passing(clock), what="a verdict")
    watcher.close()
    assert not any(thread.is_alive() for thread in watcher._threads)
    assert order == ["noticed", "judged"]


def test_only_a_change_or_a_request_ends_a_check_at_leisure(tmp_path: Path, clock: Clock) -> None:
    root, ask, answers = fill(tmp_path / "show"), SimpleQueue[bool](), SimpleQueue[bool]()

    def leisure(saved: SavedFiles, urgent: Callable[[], bool]) -> None:
        while ask.get():
            answers.put(urgent())

    watcher = FileWatcher(root, read_files(root), lambda saved: saved, quiet=QUIET, leisure=leisure)

    def urgent() -> bool:
        ask.put(True)
        return answers.get(timeout=HANG)

    def save(path: str) -> None:
        (root / path).write_text("new", "utf-8")
        until(lambda: not watcher.results.empty(), meanwhile=lambda: passing(clock), what="a verdict")
        watcher.results.get()

    watcher.start()
    save(TOUR)
    watcher._hint.set()  # as each second
    assert not urgent()
    (root / DANCE).write_text("newer", "utf-8")
    watcher._hint.set()
    assert [urgent(), urgent()] == [True, True]
    ask.put(False)
    save(DANCE)
    assert not urgent()
    watcher.request("please")
    assert urgent()
    for _ in range(2):  # this check, and that of the request
        ask.put(False)
    watcher.close()


END = "\nits last line\n"


class Judged(Watched):
    """A watched project with a quiet period longer than any test, which is judged before that is over."""

    def __init__(self, root: Path, clock: Clock) -> None:
        for path in (TOUR, DANCE):
            (root / path).write_text(f"first{END}", "utf-8")
        self.judged = list[bytes]()
        super().__init__(root, clock)

    def watch(self) -> FileWatcher[SavedFiles]:
        return FileWatcher(self.root, read_files(self.root), self.judge, quiet=QUIET, good=self.is_good)

    def judge(self, saved: SavedFiles) -> SavedFiles:
        self.judged.append(saved.files[TOUR])
        return saved

    def is_good(self, saved: SavedFiles) -> bool:
        return b"bad" not in saved.files[TOUR]


@pytest.fixture
def judged(tmp_path: Path, clock: Clock, monkeypatch: pytest.MonkeyPatch) -> Iterator[Judged]:
    monkeypatch.setattr("lumen.run.watcher.SHORT_QUIET_FRACTION", 0.0)
    one = Judged(fill(tmp_path / "show"), clock)
    yield one
    one.watcher.close()


def took(saved: SavedFiles) -> float:
    return saved.quiet - saved.seen


def test_one_good_file_that_is_whole_waits_for_nothing(judged: Judged) -> None:
    (judged.root / TOUR).write_text(f"new{END}", "utf-8")
    assert judged.next().files[TOUR] == f"new{END}".encode()
    assert judged.judged == [f"new{END}".encode()]


@pytest.mark.parametrize(
    "halves",
    [
        ("ne", f"w{END}"),
        ("new\n", END),
        (f"new{END[:-1]}", "\n"),
        (f"first{END}an", f"other{END}"),
        ("", f"new{END}"),
    ],
)
def test_half_of_a_file_is_not_judged(judged: Judged, halves: tuple[str, str]) -> None:
    with (judged.root / TOUR).open("w") as file:
        for half in halves:
            file.write(half)
            file.flush()
            judged.pause(QUIET / 2)
    whole = "".join(halves).encode()
    assert judged.next().files[TOUR] == whole
    assert judged.judged == [whole]


def test_a_file_that_is_bad_alone_waits_for_the_others_and_is_judged_once(judged: Judged) -> None:
    bad, good = f"bad{END}", f"good{END}"
    (judged.root / TOUR).write_text(bad, "utf-8")
    judged.pause(QUIET / 2)
    (judged.root / DANCE).write_text(good, "utf-8")
    assert judged.next().changed == (TOUR, DANCE)
    (judged.root / TOUR).write_text(good, "utf-8")
    assert judged.next().changed == (TOUR,)
    (judged.root / TOUR).write_text(bad, "utf-8")
    assert took(judged.next()) < QUIET  # judged at once, and told when nothing had come after it
    assert judged.judged[-1] == bad.encode() != judged.judged[-2]


def test_what_changes_while_it_is_judged_is_judged_again(judged: Judged) -> None:
    (judged.root / TOUR).write_text(f"new{END}", "utf-8")
    judged.next()
    usual, once = judged.watcher._judge, iter(["newest"])

    def judge(saved: SavedFiles) -> SavedFiles:
        for text in once:
            (judged.root / TOUR).write_text(f"{text}{END}", "utf-8")
        return usual(saved)

    judged.watcher._judge = judge
    (judged.root / TOUR).write_text(f"newer{END}", "utf-8")
    assert judged.next().files[TOUR] == f"newest{END}".encode()
    assert [text.split()[0] for text in judged.judged] == [b"new", b"newer", b"newest"]
