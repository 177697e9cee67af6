"""Run a user's program for an exhibition: start it, restart it after pauses, and end it with all that it started.

The program is in its own process group, together with a shell that waits for the end of a pipe from this process. If
this process is gone, however it ended, the shell kills the group.
"""

import os
import shutil
import signal
import subprocess
import threading
import time
from collections import deque
from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress
from pathlib import Path
from typing import IO

from lumen.upkeep.ratelimit import Backoff
from lumen.upkeep.threads import WatchedThread

FIRST_PAUSE, LONGEST_PAUSE = 1.0, 60.0
"""The shortest and the longest pause before a program is started again [s]."""
STEADY = 60.0
"""The running time after which the pauses begin with the first again [s]."""
END_TIMEOUT = 2.0
"""The time limit for a program to exit after SIGTERM [s]."""
MAX_LINES, MAX_LINE = 200, 4_000
"""The maximum number of waiting lines, and of bytes in a line; further lines are counted, and longer ones split."""

_GUARD = """
exec 3<&0
( read -r _ <&3; kill -KILL 0 ) 2>/dev/null 1>&2 &
exec "$@" 3<&- </dev/null
"""
"""The shell's script: a child waits for the end of standard input, and the shell itself becomes the program."""


class SupervisedProcess:
    """A program that is kept running: `tick` starts it, and starts it again after its end.

    `command` is run in `folder`, with `environment` as its whole environment. All methods must be called on one thread.
    """

    def __init__(
        self,
        name: str,
        command: Sequence[str],
        folder: Path,
        environment: Mapping[str, str],
        *,
        clock: Callable[[], float] = time.monotonic,
    ) -> None:
        self.name, self.command, self._folder, self._environment = name, tuple(command), folder, dict(environment)
        self.began = 0.0
        """When the program was last started, by `clock` [s]."""
        self._clock, self._next = clock, 0.0
        self._backoff = Backoff(FIRST_PAUSE, LONGEST_PAUSE)
        self._process: subprocess.Popen[bytes] | None = None
        self._reader: WatchedThread | None = None
        self._lines: deque[str] = deque()
        self._left_out, self._lock, self._closed = 0, threading.Lock(), False
        self._last = ""

    @property
    def running(self) -> bool:
        """True if the program is running."""
        return self._process is not None and self._process.poll() is None

    @property
    def next(self) -> float:
        """When the program will be started again, by `clock` [s]; meaningless while it runs."""
        return self._next

    def tick(self) -> str:
        """Start the program when it is due; return the reason if it has ended or could not start, otherwise empty."""
        now = self._clock()
        if self._closed or self.running:
            return ""
        if self._process:
            return self._ended(self._process, now)
        return self._start(now) if now >= self._next else ""

    def lines(self) -> list[str]:
        """Return the lines that the program has printed since the last call, and a line about those left out.

        Empty lines are skipped, and each line is cut to 500 characters.
        """
        with self._lock:
            found, left_out, self._left_out = list(self._lines), self._left_out, 0
            self._lines.clear()
        return [*found, *([f"{left_out:,} more lines are left out"] if left_out else [])]

    def restart(self) -> None:
        """Kill the program; it is started again after a pause."""
        if self._process:
            _signal(self._process, signal.SIGKILL)

    def close(self) -> None:
        """End the program and everything that it started, for good; repeated calls do nothing.

        A running program gets SIGTERM. When it has ended, or after END_TIMEOUT, its process group gets SIGKILL.
        """
        self._closed = True
        if (process := self._process) is None:
            return
        self._process = None
        if process.poll() is None:
            _signal(process, signal.SIGTERM)
            with suppress(subprocess.TimeoutExpired):
                process.wait(END_TIMEOUT)
        self._release(process)

    def _start(self, now: float) -> str:
        command = [self.command[0], *self.command[1:]]
        if os.path.basename(command[0]) != command[0]:
            command[0] = str(self._folder / command[0])
        if shutil.which(command[0], path=self._environment.get("PATH")) is None:
            self._next = now + self._backoff.next()
            return f"can't be started: there is no program `{self.command[0]}`"
        guarded = ["/bin/sh", "-c", _GUARD, self.name, *command] if os.name == "posix" else command
        self.began = now
        try:
            self._process = subprocess.Popen(
                guarded,
                cwd=self._folder,
                env=self._environment,
                stdin=subprocess.PIPE,
                stdout=subprocess.PIPE,
                stderr=subprocess.STDOUT,
                start_new_session=True,
            )
        except (OSError, ValueError) as error:
            self._next = now + self._backoff.next()
            return f"can't be started: {getattr(error, 'strerror', None) or error}"
        output = self._process.stdout
        assert output
        self._reader = WatchedThread(f"lumen-module-{self.name}", lambda: self._read(output))
        self._reader.start()
        return ""

    def _ended(self, process: "subprocess.Popen[bytes]", now: float) -> str:
        """Kill the processes that the ended one left behind, schedule the next start, and return how it ended."""
        self._process = None
        self._release(process)
        if now - self.began >= STEADY:
            self._backoff.reset()
        self._next = now + self._backoff.next()
        with self._lock:
            last = f": {self._last}" if self._last and process.returncode else ""
        return f"{_ending(process.returncode)}{last}"

    def _read(self, output: IO[bytes]) -> None:
        with suppress(OSError, ValueError), output:
            while part := output.readline(MAX_LINE):
                text = part.decode("utf-8", "replace").rstrip()
                if not text:
                    continue
                with self._lock:
                    self._last = text[:200]
                    if len(self._lines) < MAX_LINES:
                        self._lines.append(text[:500])
                    else:
                        self._left_out += 1

    def _release(self, process: "subprocess.Popen[bytes]") -> None:
        """Kill the process and its group, and wait for its end and, for up to END_TIMEOUT, for its last lines.

        A program that it started in another group may keep the output open; the reader then reads on and closes it.
        """
        _signal(process, signal.SIGKILL)
        process.wait()
        if self._reader:
            self._reader.join(END_TIMEOUT)
            self._reader = None
        if process.stdin:
            with suppress(OSError):
                process.stdin.close()


def _ending(code: int) -> str:
    if code >= 0:
        return f"ended with exit code {code}"
    with suppress(ValueError):
        return f"was ended by {signal.Signals(-code).name}"
    return f"was ended by signal {-code}"


def _signal(process: "subprocess.Popen[bytes]", number: signal.Signals) -> None:
    """Send a signal to the process and its group, even if the first process of the group has just ended."""
    with suppress(OSError):
        os.killpg(process.pid, number) if hasattr(os, "killpg") else process.kill()
