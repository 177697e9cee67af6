"""A project that is edited in every way in which people and programs save files; a third of the edits is broken."""

import os
import random
import shutil
import sys
import tempfile
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[1]))

from tests.guarded import PIPE, Guarded, run_guarded

from lumen.project.files import fingerprint, read_files

ROOT = Path(__file__).parents[1]
STORIES = ("known_visitor", "refuses", "unknown_visitor")
TOUR, MAIN = "behaviors/tour.yaml", "lumen.yaml"
FIVE = (MAIN, TOUR, *(f"behaviors/stories/{name}.yaml" for name in STORIES))

COUNTER = """
  load:
    initial: counting
    states:
      counting: {on: {load: {actions: {assign: {loaded: "context.loaded + 1"}}}}}
"""
ROUTE = "  load: {key: lumen.load, direction: in, event: load}\n"
BREAKS: tuple[tuple[str, str, str], ...] = (
    (TOUR, "target: ask_name", "target: ask_nmae"),
    (TOUR, "id: tour\n", "id: tour\n\tx: 1\n"),
    (TOUR, "{play: sing}", "{play: sign}"),
    (MAIN, "languages: [en, id]", "languages: [en, id"),
    (MAIN, "behavior: tour", "behaviour: tour"),
)


class Writer:
    """Edits a project as people and programs do, with several files `pause` [s] apart."""

    def __init__(self, root: Path, seed: int, pause: float) -> None:
        self.root, self.random, self.pause = root, random.Random(seed), pause
        self.number = 0
        self.mending: tuple[str, ...] = ()
        self.ways: list[Callable[[dict[str, str]], None]] = [
            self.in_place, self.truncated, self.atomically, self.one_after_the_other, self.checked_out,
        ]  # fmt: skip

    def edit(self) -> tuple[str, bool, int]:
        """Make the next edit; return the hash of the files, whether they are valid, and how many were written."""
        self.number += 1
        broken = self.number % 3 == 0
        way = self.ways[self.number % len(self.ways)]
        chosen = FIVE if way in self.ways[3:] else (self.random.choice(FIVE),)
        files = {path: self.marked(path) for path in (*self.mending, *chosen)}
        self.mending = ()
        if broken:
            path, old, new = self.random.choice(BREAKS)
            text = files.get(path) or self.marked(path)
            assert old in text, (path, old)
            files[path] = text.replace(old, new, 1)
            self.mending = (path,)
        way(files)
        return fingerprint(read_files(self.root)), not broken, len(files)

    def marked(self, path: str) -> str:
        """Return the original file with the number of this edit in one of its texts."""
        text = self.read_first(path)
        old = {MAIN: "name: Lumen at", TOUR: "en: Never mind."}.get(path, "title: ")
        assert old in text, path
        return text.replace(old, f"{old} {self.number} ".rstrip(), 1)

    def read_first(self, path: str) -> str:
        """Return the original text of a file."""
        return (self.root.parent / "first" / path).read_text("utf-8")

    def in_place(self, files: dict[str, str]) -> None:
        """Write files in place."""
        for path, text in files.items():
            with (self.root / path).open("r+", encoding="utf-8") as file:
                file.write(text)
                file.truncate()

    def truncated(self, files: dict[str, str]) -> None:
        """Write files in two halves after truncation."""
        for path, text in files.items():
            with (self.root / path).open("w", encoding="utf-8") as file:
                file.flush()
                time.sleep(0.05)
                file.write(text[: len(text) // 2])
                file.flush()
                time.sleep(0.05)
                file.write(text[len(text) // 2 :])

    def atomically(self, files: dict[str, str]) -> None:
        """Write files as vim does: the old file becomes a backup, and a new one gets its name."""
        for path, text in files.items():
            file = self.root / path
            (file.parent / "4913").touch()
            (file.parent / "4913").unlink()
            os.replace(file, file.with_name(f"{file.name}~"))
            time.sleep(0.02)
            draft = file.with_name(f".{file.name}.swp")
            draft.write_text(text, "utf-8")
            os.replace(draft, file)
            file.with_name(f"{file.name}~").unlink()

    def one_after_the_other(self, files: dict[str, str]) -> None:
        """Write files one after another, with pauses."""
        for path, text in files.items():
            (self.root / path).write_text(text, "utf-8")
            if path != list(files)[-1]:
                time.sleep(self.pause)

    def checked_out(self, files: dict[str, str]) -> None:
        """Commit the files in another clone, and check the revision out."""
        for path, text in files.items():
            (self.root.parent / "work" / path).write_text(text, "utf-8")
        _git(self.root.parent / "work", "commit", "-qam", f"edit {self.number}")
        _git(self.root, "fetch", "-q", "origin")
        _git(self.root, "checkout", "-qf", "origin/HEAD")


class Colleague:
    """A writer in a process of its own, like people's editors; `good` has the hashes of all valid states."""

    def __init__(self, root: Path, seed: int, pause: float) -> None:
        self.good = {fingerprint(read_files(root))}
        words = [sys.executable, __file__, str(root), str(seed), str(pause)]
        self._process = Guarded(words, stdin=PIPE, stdout=PIPE, text=True)

    def edit(self) -> tuple[str, bool, int]:
        """Request the next edit; return the hash of the files, whether they are valid, and how many were written."""
        assert self._process.stdin
        assert self._process.stdout
        print("edit", file=self._process.stdin, flush=True)
        if not (answer := self._process.stdout.readline()):
            raise RuntimeError(f"the writer ended with {self._process.wait(10)}")
        hash, said, count = answer.split()
        if said == "good":
            self.good.add(hash)
        return hash, said == "good", int(count)

    def close(self) -> None:
        """End the writer's process."""
        self._process.communicate()


@contextmanager
def project() -> Iterator[Path]:
    """Yield a copy of the shipped tour that counts events, as a clone of a git repository."""
    with tempfile.TemporaryDirectory(prefix="lumen-reload-") as name:
        folder = Path(name)
        first = folder / "first"
        parts = ("behaviors", "functions", "knowledge", "fuzzy", "motions", "schemas", "models")
        for part in filter(lambda part: (ROOT / part).is_dir(), parts):  # another checkout's project may lack some
            shutil.copytree(ROOT / part, first / part)
        for story in (first / "behaviors" / "stories").glob("*.yaml"):
            if story.stem not in STORIES:
                story.unlink()
        main = (ROOT / MAIN).read_text("utf-8").replace("story: visitor", "story: refuses")
        (first / MAIN).write_text(main.replace("routes:\n", f"routes:\n{ROUTE}", 1), "utf-8")
        tour = (ROOT / TOUR).read_text("utf-8").replace("context:\n", "context:\n  loaded: 0\n", 1)
        (first / TOUR).write_text(tour.rstrip("\n") + "\n" + COUNTER, "utf-8")
        shutil.copytree(first, folder / "work")
        _git(folder / "work", "init", "-q", "-b", "main")
        _git(folder / "work", "add", ".")
        _git(folder / "work", "commit", "-qm", "first")
        _git(folder, "clone", "-q", "work", "show")
        yield folder / "show"


def _git(folder: Path, *words: str) -> None:
    who = [
        "-c",
        "user.name=soak",
        "-c",
        "user.email=soak@localhost",
        "-c",
        "gc.auto=0",
        "-c",
        "init.defaultBranch=main",
    ]
    run_guarded(["git", *who, *words], cwd=folder, check=True, capture_output=True)


def main() -> None:
    """Make an edit for each line of the standard input, and print the state of the files."""
    root, seed, pause = sys.argv[1:]
    writer = Writer(Path(root), int(seed), float(pause))
    for _ in sys.stdin:
        hash, good, count = writer.edit()
        print(hash, "good" if good else "bad", count, flush=True)


if __name__ == "__main__":
    main()
