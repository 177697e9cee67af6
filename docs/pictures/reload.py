"""Print the transcript in docs/reload.md: a person edits the files while the robot dances for a visitor.

    python docs/pictures/reload.py

The transcript has every line that the exhibition prints, and each command typed in another terminal, after a `$`.
"""

import shutil
import subprocess
import sys
import tempfile
import threading
import time
from pathlib import Path

ROOT = Path(__file__).parents[2]
PARTS = ("behaviors", "functions", "knowledge", "fuzzy", "motions", "schemas", "models", "lumen.yaml")
TOUR = "behaviors/tour.yaml"
WAIT = 60.0


class Visit:
    """`lumen run` in a copy of the project, with a visitor's typed words and edits of the files."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        run = [sys.executable, "-m", "lumen", "run", str(folder), "--robot", "recording", "--speed", "1"]
        self._process = subprocess.Popen(run, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)
        self._told: list[str] = []
        self.seen, self._ending = 0, False
        self._reader = threading.Thread(target=self._read)
        self._reader.start()

    def _read(self) -> None:
        assert self._process.stdout
        for line in self._process.stdout:
            if not self._ending:
                print(line, end="", flush=True)
            self._told.append(line)

    def until(self, words: str) -> None:
        """Wait until the exhibition has printed this since the last time."""
        deadline = time.monotonic() + WAIT
        while not (found := [i for i, line in enumerate(self._told) if i >= self.seen and words in line]):
            if time.monotonic() > deadline:
                raise SystemExit(f"{words!r} was not told")
            time.sleep(0.05)
        self.seen = found[0] + 1

    def types(self, text: str) -> None:
        assert self._process.stdin
        self._process.stdin.write(text + "\n")
        self._process.stdin.flush()

    def does(self, command: str) -> None:
        """Run a command in another terminal."""
        print(f"$ {command}", flush=True)
        lumen = f"{sys.executable} -m lumen"
        subprocess.run(command.replace("lumen", lumen, 1), shell=True, cwd=self.folder, check=False)

    def ends(self) -> None:
        self._ending = True
        self._process.terminate()
        self._reader.join()


def steps(visit: Visit) -> None:
    visit.until("ask_name")
    visit.types("my name is Ani")
    visit.until("how_are_you")
    visit.types("fine")
    visit.until("state    offer")
    visit.types("dance")
    visit.until("plays dance")
    visit.does(f"sed -i 's/Do you have a question for me?/Is there anything you wonder about?/' {TOUR}")
    visit.until("active")
    visit.does("sed -i 's/any_question/more_questions/g' behaviors/*.yaml behaviors/*/*.yaml")
    visit.until("active")
    visit.does(f"sed -i 's/stop: .#more_questions/stop: \"#more_qestions/' {TOUR}")
    visit.until("refused")
    visit.does(f"sed -i 's/more_qestions/more_questions/' {TOUR}")
    visit.until("those that run")
    visit.does("mv motions/dance.yaml ..")
    visit.until("refused")
    visit.does("mv ../dance.yaml motions/")
    visit.until("those that run")
    visit.does(f"sed -i 's/- {{play: dance}}/- {{play: photo}}/' {TOUR}")
    visit.until("waiting for")
    visit.does("lumen reload --status")
    seen = visit.seen
    visit.until("active")
    visit.seen = seen  # on a slow machine the story ends after the dance
    visit.until("does not hold")


def main() -> None:
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name) / "show"
        folder.mkdir()
        for part in PARTS:
            copied = ROOT / part
            if copied.is_dir():
                shutil.copytree(copied, folder / part)
            else:
                shutil.copy(copied, folder / part)
        visit = Visit(folder)
        try:
            steps(visit)
        finally:
            visit.ends()


if __name__ == "__main__":
    main()
