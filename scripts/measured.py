"""Measure a command, on the wall and in processor time: `python scripts/measured.py COMMAND …`.

The processor time is that of all processes that it starts.
"""

import ctypes
import os
import subprocess
import sys
import time
from collections.abc import Mapping, Sequence
from typing import NamedTuple

PR_SET_CHILD_SUBREAPER = 36


class Measured(NamedTuple):
    """A command's exit code, and its times on the wall and of the processor [s]."""

    code: int
    wall: float
    cpu: float

    def __str__(self) -> str:
        return f"{self.cpu / 60:.1f} minutes of processor time, {self.wall / 60:.1f} minutes on the wall"


def measured(command: Sequence[str], environment: Mapping[str, str] | None = None) -> Measured:
    """Run a command until all its processes have ended, those that outlive their parents included.

    On Linux, orphans become children of this process, which waits for them: a browser or a broker that was killed
    counts. Elsewhere they do not.
    """
    if sys.platform == "linux":
        ctypes.CDLL(None).prctl(PR_SET_CHILD_SUBREAPER, 1, 0, 0, 0)
    wall, cpu = time.monotonic(), _children()
    code = subprocess.run(command, env=environment, check=False).returncode
    try:
        while True:
            os.wait()
    except ChildProcessError:
        return Measured(code, time.monotonic() - wall, _children() - cpu)


def _children() -> float:
    times = os.times()
    return times.children_user + times.children_system


if __name__ == "__main__":
    taken = measured(sys.argv[1:])
    print(f"{' '.join(sys.argv[1:])}: {taken}", flush=True)
    sys.exit(taken.code)
