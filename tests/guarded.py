"""Programs and folders that end with the process that started them, however that ends.

`atexit` and fixtures end what a test started as long as the test's own process ends in order; under `kill -9`, and in a
worker that xdist gives up, neither runs. So each process that starts a program here has a guardian beside it: a process
that holds the reading end of a pipe, hears of every process group and temporary folder, and, when the pipe closes,
kills the groups and deletes the folders. The system closes the pipe of any process that dies, so cleanup is automatic.

    with Guarded([sys.executable, "-m", "lumen", "run"], stdout=PIPE, text=True) as process: ...

A program is in a session of its own (Ctrl-C reaches only pytest), of which all that it starts is part, but for what
makes a session for itself; that must end by itself when its parent does.
"""

import atexit
import os
import select
import shutil
import signal
import subprocess
import sys
import tempfile
import time
from collections.abc import Sequence
from contextlib import suppress
from functools import cache
from pathlib import Path
from subprocess import DEVNULL, PIPE, STDOUT, CalledProcessError, CompletedProcess, TimeoutExpired
from typing import IO, Any, AnyStr

__all__ = [
    "DEVNULL",
    "PIPE",
    "STDOUT",
    "CalledProcessError",
    "CompletedProcess",
    "Guarded",
    "TimeoutExpired",
    "run_guarded",
    "temporary_folder",
]

PRUNE_INTERVAL = 1.0
"""The interval at which the guardian forgets ended groups, before the system reuses their numbers [s]."""
KILL_TIMEOUT = 3.0
"""The time to wait until killed processes are gone and write nothing more; some systems collect zombies late [s]."""


class Guarded(subprocess.Popen[AnyStr]):
    """A `subprocess.Popen` in a session of its own, which ends with this process."""

    def __init__(self, command: Sequence[object], **options: Any) -> None:
        guardian = _guardian()
        super().__init__([str(word) for word in command], start_new_session=True, **options)
        _tell(guardian, f"group {self.pid}")


def run_guarded(
    command: Sequence[object], *, input: Any = None, timeout: float | None = None, check: bool = False, **options: Any
) -> CompletedProcess[Any]:
    """Run a command as `subprocess.run` does, in a program that ends with this process."""
    if options.pop("capture_output", False):
        options |= {"stdout": PIPE, "stderr": PIPE}
    if input is not None:
        options["stdin"] = PIPE
    with Guarded(command, **options) as process:
        try:
            out, err = process.communicate(input, timeout=timeout)
        except BaseException:
            process.kill()
            raise
    if check and process.returncode:
        raise CalledProcessError(process.returncode, process.args, out, err)
    return CompletedProcess(process.args, process.returncode, out, err)


def temporary_folder(prefix: str) -> Path:
    """Return a new folder that is deleted when this process has ended, unless it is deleted before."""
    guardian = _guardian()
    folder = tempfile.mkdtemp(prefix=prefix)
    _tell(guardian, f"folder {folder}")
    return Path(folder)


def _tell(guardian: IO[bytes], line: str) -> None:
    guardian.write(line.encode() + b"\n")
    guardian.flush()


@cache
def _guardian() -> IO[bytes]:
    """Return the writing end of the pipe to this process's guardian; the first call starts it."""
    guardian = subprocess.Popen(
        [sys.executable, "-I", "-S", __file__], stdin=PIPE, stdout=DEVNULL, bufsize=0, start_new_session=True
    )
    assert guardian.stdin
    atexit.register(guardian.wait)
    atexit.register(guardian.stdin.close)
    return guardian.stdin


def guard() -> None:
    """Run as a guardian: register programs and folders until standard input closes, then end and delete them all."""
    for ignored in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
        signal.signal(ignored, signal.SIG_IGN)
    groups: set[int] = set()
    folders: set[str] = set()
    rest = b""
    while True:
        readable, _, _ = select.select([0], [], [], PRUNE_INTERVAL if groups else None)
        groups = {group for group in groups if _lives(group)}
        if readable:
            read = os.read(0, 1 << 16)
            if not read:
                break
            *lines, rest = (rest + read).split(b"\n")
            for kind, _, name in (line.decode().partition(" ") for line in lines):
                if kind == "group":
                    groups.add(int(name))
                else:
                    folders.add(name)
    _end(groups)
    for folder in folders:
        shutil.rmtree(folder, ignore_errors=True)


def _end(groups: set[int]) -> None:
    deadline = time.monotonic() + KILL_TIMEOUT
    for group in groups:
        with suppress(ProcessLookupError, PermissionError):
            os.killpg(group, signal.SIGKILL)
    while any(_lives(group) for group in groups) and time.monotonic() < deadline:
        time.sleep(0.01)


def _lives(group: int) -> bool:
    """Return whether a process of that group exists; a zombie counts."""
    try:
        os.killpg(group, 0)
    except ProcessLookupError:
        return False
    except PermissionError:  # macOS raises this for a group of zombies
        return True
    return True


if __name__ == "__main__":
    guard()
