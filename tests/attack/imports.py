"""The lane that attacks `lumen import` with files of other tools."""

import json
import sys

from tests import ROOT
from tests.attack.attacks import Attack, Kind
from tests.attack.targets import PATIENCE, BrokenError, Size
from tests.guarded import PIPE, Guarded, temporary_folder


class Imports:
    """Files of other tools, read by `lumen import` in a child process (`importing.py`)."""

    kinds = (Kind.FOREIGN,)
    batch = 100

    def __init__(self) -> None:
        self._folder = temporary_folder("lumen-attack-")
        line = [sys.executable, "-m", "tests.attack.importing", self._folder]
        self._child = Guarded[str](line, stdin=PIPE, stdout=PIPE, text=True, cwd=ROOT)
        self._size = Size(0.0, 0, 0)

    def strike(self, attack: Attack) -> str:
        assert self._child.stdin
        assert self._child.stdout
        self._child.stdin.write(f"{attack.number}\n")
        self._child.stdin.flush()
        line = self._child.stdout.readline()
        if not line:
            raise BrokenError(f"who imports ended with {self._child.wait(PATIENCE)}")
        answer = json.loads(line)
        if answer["trouble"]:
            raise BrokenError(answer["trouble"])
        self._size = Size(*answer["size"])
        return f"ended with {answer['code']}"

    def check(self) -> None:
        """Do nothing: `strike` has checked that each answer came in time."""

    def size(self) -> Size:
        return self._size

    def close(self) -> None:
        self._child.kill()
        self._child.wait()
