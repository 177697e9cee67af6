"""Measure the wall time and the processor time of a command: `python scripts/measured.py COMMAND …`.

The processor time is that of all processes that it starts.
"""

from __future__ import annotations

import ctypes
import os
import signal
import subprocess
import sys
import time
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import NamedTuple

PR_SET_CHILD_SUBREAPER = 36
PATIENCE = 60.0
"""The time that remaining processes have to end by themselves [s]."""


class Measured(NamedTuple):
    """A command's exit code, its wall time and its processor time [s]."""

    code: int
    wall: float
    cpu: float

    def __str__(self) -> str:
        return f"{self.cpu / 60:.1f} minutes of processor time, {self.wall / 60:.1f} minutes on the wall"


def measured(command: Sequence[str], environment: Mapping[str, str] | None = None) -> Measured:
    """Run a command until all its processes have ended; kill and name those that do not end.

    On Linux, orphans become children of this process, which waits for them: a browser or a broker that was killed
    counts. Elsewhere they do not.
    """
    if sys.platform == "linux":
        ctypes.CDLL(None).prctl(PR_SET_CHILD_SUBREAPER, 1, 0, 0, 0)
    wall, cpu = time.monotonic(), _children()
    process = subprocess.Popen(command, env=environment)
    code = process.wait()
    left = _left(time.monotonic() + PATIENCE)
    if left:
        print(f"left behind by {' '.join(command)}: {', '.join(left)}", file=sys.stderr)
    return Measured(code, time.monotonic() - wall, _children() - cpu)


def _left(deadline: float) -> list[str]:
    """Wait for the orphans; kill and return those that still exist after the deadline."""
    killed: list[str] = []
    while True:
        try:
            pid, _ = os.waitpid(-1, os.WNOHANG)
        except ChildProcessError:
            return killed
        if pid == 0 and time.monotonic() > deadline:
            for child in _own_children():
                killed.append(f"{child} {_name(child)}")
                os.kill(child, signal.SIGKILL)
            os.wait()
        elif pid == 0:
            time.sleep(0.1)


def _own_children() -> list[int]:
    return [int(child) for child in Path(f"/proc/self/task/{os.getpid()}/children").read_text().split()]


def _name(pid: int) -> str:
    return Path(f"/proc/{pid}/comm").read_text().strip()


def _children() -> float:
    times = os.times()
    return times.children_user + times.children_system


if __name__ == "__main__":
    taken = measured(sys.argv[1:])
    print(f"{' '.join(sys.argv[1:])}: {taken}", flush=True)
    sys.exit(taken.code)
