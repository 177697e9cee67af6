"""Running exhibitions of a copy of the shipped project, that are attacked, asked, stopped and measured."""

import os
import shutil
import sys
from collections.abc import Mapping
from itertools import count
from pathlib import Path
from typing import Any, NamedTuple

from lumen.errors import BusError
from lumen.project.files import read_files
from lumen.project.home import ADDRESS_FILE, Home
from lumen.run.asking import send_request
from lumen.run.reaching import Reached, reach_exhibition
from lumen.run.reload.requests import COMMAND
from lumen.run.reload_journal import Journal
from tests import ROOT
from tests.guarded import DEVNULL, STDOUT, Guarded, TimeoutExpired, temporary_folder
from tests.waiting import HANG, Collector, until

PARTS = ("behaviors", "functions", "knowledge", "fuzzy", "motions", "schemas", "models")
SPOKEN, ANSWERS = "lumen.audio.text.stream", "lumen.attack.checked"
SPEED = "4"
PATIENCE = BEGINNING = HANG
"""The time limit for an answer, and for a start, on a busy machine [s]."""
TRIES = 3
"""The number of attempts to speak a text: a stop by an attack, or by the behaviour, may cancel one at that moment."""


class BrokenError(AssertionError):
    """A target that no longer works after an attack."""


class Size(NamedTuple):
    """The resources that a process uses: memory [MB], threads, open files and sockets."""

    memory: float
    threads: int
    handles: int


class Exhibition:
    """`lumen run` with the recording robot, four times as fast as real time, on a bus by its address.

    It reloads the files saved in `folder`. `check` raises BrokenError if it no longer works.
    """

    def __init__(self, url: str) -> None:
        self.folder = temporary_folder("lumen-attack-")
        self.sound: Mapping[str, bytes] = read_files(ROOT)
        for part in PARTS:
            shutil.copytree(ROOT / part, self.folder / part)
        shutil.copy(ROOT / "lumen.yaml", self.folder)
        self._told, self._home = self.folder / ".told", Home(self.folder / ".lumen")
        self._read, self._numbers = 0, count()
        line = [sys.executable, "-m", "lumen", "run", self.folder, "--robot", "recording", "--speed", SPEED]
        with self._told.open("wb") as told:
            self.process = Guarded[bytes]([*line, "--bus", url], stdin=DEVNULL, stdout=told, stderr=STDOUT)
        self._reached = self._begun()
        self.bus, self._spoken = self._reached.bus, Collector()
        self.bus.subscribe(SPOKEN, self._spoken)

    def check(self) -> None:
        """Raise BrokenError unless it obeys a stop, moves again, speaks and journals a text, and no part failed."""
        for ask_one in (self._rests, self._speaks, self._reloads):
            self.lives()
            try:
                ask_one()
            except BusError as error:
                self.lives()
                raise BrokenError(f"{ask_one.__name__.strip('_')}: {error}\n{self._tail()}") from None
        self.lives()

    def lives(self) -> None:
        """Raise BrokenError if the process has ended or has printed a traceback."""
        if (code := self.process.poll()) is not None:
            raise BrokenError(f"the exhibition ended with {code}\n{self._tail()}")
        with self._told.open("rb") as told:
            told.seek(self._read)
            new = told.read()
        if b"Traceback" in new:
            raise BrokenError(f"a fault of ours:\n{new.decode('utf-8', 'replace')[-4_000:]}")
        self._read += new.rfind(b"\n") + 1

    def asked(self, key: str, body: Any) -> Any:
        """Return the first answer; raise BusError if none arrives in time."""
        return next(send_request(self.bus, key, body, ANSWERS, first=PATIENCE))

    def size(self) -> Size:
        """Return the resources that its process uses now."""
        process = Path(f"/proc/{self.process.pid}")
        status = dict(line.split(":\t", 1) for line in (process / "status").read_text().splitlines() if ":\t" in line)
        return Size(int(status["VmRSS"].split()[0]) / 1024, int(status["Threads"]), len(os.listdir(process / "fd")))

    def close(self) -> None:
        self.bus.close()
        self.process.terminate()
        try:
            self.process.wait(PATIENCE)
        except TimeoutExpired:
            self.process.kill()
            self.process.wait()
        shutil.rmtree(self.folder, ignore_errors=True)

    def dropped(self) -> str:
        """Return the line about dropped messages that it printed when it ended, or an empty string."""
        lines = self._told.read_text("utf-8", "replace").splitlines()
        return next((line.strip() for line in lines if "dropped messages" in line), "")

    def _begun(self) -> Reached:
        try:
            until(lambda: self._address().get("command") or self.process.poll() is not None, BEGINNING)
            return reach_exhibition(str(self.folder), None)
        except (AssertionError, BusError) as error:
            raise BrokenError(f"no exhibition began: {error}\n{self._tail()}") from None

    def _address(self) -> dict[str, Any]:
        """Return its address and its routing keys, read anew because saved files may change them."""
        found = self._home.read_json(ADDRESS_FILE)
        return found if isinstance(found, dict) else {}

    def _rests(self) -> None:
        key = self._address()["stop"]
        wanted(self.asked(key, order("motion", "rest", by="the attack")), "command finished", "a stop")
        stopped = self.asked(key, order("motion", "stopped"))
        if not (isinstance(stopped, dict) and stopped["stopped_by"]):
            raise BrokenError(f"a robot that rests is not stopped: {stopped}")
        wanted(self.asked(key, order("motion", "resume", by="the attack")), "command finished", "`resume`")

    def _speaks(self) -> None:
        text = f"ok {next(self._numbers)}"
        said = order("texttospeech", "say", text=text, language="en") | {"replace": True}
        answers = (self.asked(self._address()["command"], said) for _ in range(TRIES))
        wanted(next((a for a in answers if a != "command cancelled"), ""), "command finished", "`say`")
        try:
            until(lambda: any(text in str(body) for body in self._spoken.bodies), PATIENCE)
        except AssertionError:
            raise BrokenError(f"`{text}` was not spoken") from None
        self._spoken.messages.clear()
        if not any(entry.get("command") == f"says “{text}”" for entry in Journal(self._home.folder).entries()):
            raise BrokenError(f"that somebody let it say `{text}` is not in the journal")

    def _reloads(self) -> None:
        """Request the status of the exhibition: the behaviour's own tick answers it."""
        self.asked(COMMAND, {"command": "status"})

    def _tail(self) -> str:
        return self._told.read_text("utf-8", "replace")[-4_000:]


def order(kind: str, method: str, **parameter: str) -> dict[str, Any]:
    """Return a command as a module sends it."""
    return {"type": kind, "method": method, "parameter": parameter}


def wanted(answer: object, right: str, what: str) -> None:
    if answer != right:
        raise BrokenError(f"{what} was answered {str(answer)[:300]!r}")


def save(path: Path, content: bytes) -> None:
    """Write the file, in new folders if necessary."""
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_bytes(content)
