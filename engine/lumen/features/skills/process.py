"""A skill's process: a program under limits that performs one call at a time and exchanges lines of JSON."""

import json
import os
import resource
import select
import signal
import subprocess
import threading
import time
import uuid
from collections import deque
from collections.abc import Callable, Iterable, Mapping, Sequence
from contextlib import closing, suppress
from pathlib import Path
from typing import IO, Any

from lumen.errors import RobotFailedError
from lumen.upkeep.regular_files import MEGABYTE
from lumen.upkeep.threads import WatchedThread

GRACE = 0.5
"""The time that a program has to end a cancelled call, or to exit, before it is killed [s]."""
MAX_OUTPUT_BYTES = 1 * MEGABYTE
"""The maximum output of a program for one call, including answers [bytes]."""
MAX_UNREAD_MESSAGES = 1_000
MAX_PRINTED_LINES = 40
"""The most printed lines that are shown within `PRINT_PERIOD`; further lines are only counted."""
PRINT_PERIOD = 1.0
MAX_PRINTED_CHARACTERS = 300
WRITE_PATIENCE = 1.0
"""The time limit for a program to read its input [s]."""
DRAIN = 0.05
"""The time to wait for a program's last output [s]."""
HEADROOM = 4
"""The multiple of `memory` that a program can reserve; its actual use is measured."""

_MARK = "LUMEN_SKILL"
"""The environment variable that identifies a program's children, even outside its process group."""
_ENDS, _NEWS = ("result", "error"), ("wait", "progress", "say", "publish", "loaded")


class SkillProcess:
    """A program, started in `folder` in a new process group; `tell` receives the lines that it prints.

    `memory` is its limit [MB]. `ended` is the reason for its end; empty while it runs. Raises RobotFailedError if it
    can't be started.
    """

    def __init__(
        self, skill: str, command: Sequence[str], folder: str, memory: float, tell: Callable[[str], None]
    ) -> None:
        self.skill, self.ended, self.last_line = skill, "", ""
        self.title = f"the program of `{skill}`"
        self._memory, self._tell = memory * MEGABYTE, tell
        self._mark = uuid.uuid4().hex
        self._messages: deque[Mapping[str, Any]] = deque()
        self._changed = threading.Condition()
        self._wake: Callable[[], None] = lambda: None
        self._call = self._output = self._printed = self._hidden = 0
        self._since = 0.0
        self._over = False
        self._killing = threading.Lock()
        environment = {**os.environ, _MARK: self._mark, "PYTHONUNBUFFERED": "1"}
        try:
            self._popen = subprocess.Popen(
                command,
                cwd=folder,
                env=environment,
                stdin=subprocess.PIPE,
                stdout=subprocess.PIPE,
                stderr=subprocess.PIPE,
                start_new_session=True,
            )
        except (OSError, ValueError) as error:
            reason = getattr(error, "strerror", None) or str(error)
            message = f"the program of `{skill}` can't be started: {command[0]}: {reason.lower()}"
            raise RobotFailedError(message) from None
        self._input, self._groups = self._stream(self._popen.stdin).fileno(), [self._popen.pid]
        os.set_blocking(self._input, False)
        with suppress(OSError, ValueError):
            most = int(self._memory * HEADROOM)
            resource.prlimit(self._popen.pid, resource.RLIMIT_DATA, (most, most))
            resource.prlimit(self._popen.pid, resource.RLIMIT_CORE, (0, 0))
        self._thread = WatchedThread(f"lumen-program-{skill}", self._read)
        self._thread.start()

    @property
    def pid(self) -> int:
        return self._popen.pid

    @property
    def alive(self) -> bool:
        return not self.ended

    def begin(self, skill: str, arguments: Mapping[str, Any], wake: Callable[[], None]) -> None:
        """Have the program perform a call; `wake` is called on another thread when its messages arrive.

        Raises RobotFailedError if the program does not read its input.
        """
        with self._changed:
            self._call += 1
            self._messages = deque(each for each in self._messages if "ended" in each)
            self._output, self._wake, self._over = 0, wake, False
        self.send({"call": self._call, "skill": skill, "arguments": dict(arguments)})

    def expect(self, wake: Callable[[], None]) -> None:
        """Call `wake` when messages arrive before the first call, or immediately if there are any already."""
        with self._changed:
            self._wake = wake
            here = bool(self._messages)
        if here:
            wake()

    def send(self, message: Mapping[str, Any]) -> None:
        """Send a message, unless the program has ended. Raises RobotFailedError if it does not read its input."""
        line = json.dumps(message, ensure_ascii=False).encode() + b"\n"
        deadline = time.monotonic() + WRITE_PATIENCE
        while line:
            try:
                line = line[os.write(self._input, line) :]
            except BlockingIOError:
                left = deadline - time.monotonic()
                if left <= 0 or not _ready((self._input,), select.POLLOUT, left):
                    raise RobotFailedError(f"the program of `{self.skill}` does not read its input") from None
            except (OSError, ValueError):
                return  # the program has ended, which the reading thread reports

    def order(self, **message: Any) -> None:
        """Send a message about the call. Raises RobotFailedError if the program does not read its input."""
        self.send({"call": self._call, **message})

    def has_news(self) -> bool:
        return bool(self._messages)

    def take(self) -> list[Mapping[str, Any]]:
        """Return the call's messages since the last `take`; the final message has `result`, `error` or `ended`."""
        with self._changed:
            taken = list(self._messages)
            self._messages.clear()
        return taken

    def await_end(self, timeout: float) -> bool:
        """Wait at most `timeout` [s] of real time for the end of the call; return whether it has ended."""
        with self._changed:
            return self._changed.wait_for(lambda: self._over or bool(self.ended), timeout)

    @property
    def fault(self) -> str:
        """The reason to kill the program, if it and its children use more than `memory`; else empty."""
        if self.ended:
            return ""
        used = sum(_pages(pid) for pid in _family(self._popen.pid)) * resource.getpagesize() / self._memory
        return f"it used {used:.1f} times the memory that it may" if used > 1.0 else ""

    def close(self) -> None:
        """End the program: close its input, and kill it if it has not ended after `GRACE`."""
        with suppress(OSError, ValueError):
            self._stream(self._popen.stdin).close()
        with self._changed:
            self._changed.wait_for(lambda: bool(self.ended), GRACE)
        self.kill()

    def kill(self, reason: str = "") -> None:
        """Kill the program and all its children; `ended` becomes `reason`, unless the program ended earlier."""
        with self._changed:
            self.ended = self.ended or reason or "it was ended"
        with self._killing:
            with suppress(OSError, IndexError):  # only once: the number may be another program's later
                os.killpg(self._groups.pop(), signal.SIGKILL)
            for pid in _marked(self._mark):
                with suppress(OSError):
                    os.kill(pid, signal.SIGKILL)
            with suppress(subprocess.TimeoutExpired):
                self._popen.wait(GRACE)

    def _read(self) -> None:
        """Read the program's output until it has ended; this thread sleeps while there is no output."""
        with closing(self._stream(self._popen.stdout)) as answers, closing(self._stream(self._popen.stderr)) as prints:
            # Prints are first: the lines before an answer are then shown before the answer has an effect.
            takers = {prints.fileno(): _Lines(self._print), answers.fileno(): _Lines(self._line)}
            while answers.fileno() in takers and not self.ended:
                if not self._take(takers, GRACE) and self._popen.poll() is not None:
                    break  # a child of the program keeps its output open
            # The prints before it closed its standard output, and what it wrote before it ended; not if it was killed.
            rest = {stream: taker for stream, taker in takers.items() if stream == prints.fileno() or not self.ended}
            if rest:
                self._take(rest, DRAIN)
        if not self.ended:
            self.kill(self._exit())
        self._put({"ended": self.ended})

    def _take(self, takers: "dict[int, _Lines]", timeout: float) -> bool:
        """Wait at most `timeout` [s] for output and pass it to its taker; return whether there was any.

        Closed streams are removed from `takers`. A program with more than MAX_OUTPUT_BYTES is killed.
        """
        for stream in (ready := _ready(takers, select.POLLIN, timeout)):
            content = os.read(stream, 65_536)
            self._output += len(content)
            takers[stream].take(content)
            if not content:
                del takers[stream]
            elif self._output > MAX_OUTPUT_BYTES:
                self.kill(f"it printed more than {MAX_OUTPUT_BYTES // MEGABYTE} MB during a call")
        return bool(ready)

    def _stream(self, stream: IO[bytes] | None) -> IO[bytes]:
        assert stream
        return stream

    def _exit(self) -> str:
        """Return the reason why the program ended; it has closed its standard output."""
        try:
            code = self._popen.wait(GRACE)
        except subprocess.TimeoutExpired:
            return "it closed its standard output without an answer"
        last = f" after the line `{self.last_line.strip()}`" if self.last_line else ""
        if code < 0:
            return f"it was ended by {signal.Signals(-code).name}{last}"
        return f"it ended with exit code {code}{last}"

    def _line(self, line: str) -> None:
        """Process a line of the program's standard output: a message, or printed text."""
        try:
            message = json.loads(line) if line.startswith("{") else None
        except (ValueError, RecursionError):
            message = None
        kind = next((key for key in (*_ENDS, *_NEWS) if isinstance(message, dict) and key in message), "")
        if not kind or message is None:
            return self._print(line)
        if message.get("call", self._call) != self._call or (self._over and kind != "loaded"):
            return self._print(f"an answer came after the end of its call, and is ignored: {line}")
        self._put(message, over=kind in _ENDS)

    def _put(self, message: Mapping[str, Any], *, over: bool = False) -> None:
        with self._changed:
            self._over = self._over or over
            if len(self._messages) < MAX_UNREAD_MESSAGES or over or "ended" in message:
                self._messages.append(message)
            self._changed.notify_all()
            wake = self._wake
        wake()

    def _print(self, line: str) -> None:
        if not (text := line.rstrip()):
            return
        self.last_line = text[:MAX_PRINTED_CHARACTERS]
        now = time.monotonic()
        if now - self._since > PRINT_PERIOD:
            if self._hidden:
                self._tell(f"… and {self._hidden} more lines")
            self._since, self._printed, self._hidden = now, 0, 0
        if self._printed < MAX_PRINTED_LINES:
            self._printed += 1
            self._tell(self.last_line)
        else:
            self._hidden += 1


class _Lines:
    """Splits the content of a stream into lines."""

    def __init__(self, take: Callable[[str], None]) -> None:
        self._line, self._incomplete_line = take, b""

    def take(self, content: bytes) -> None:
        """Process more content of the stream; empty content means that the stream has ended."""
        *lines, self._incomplete_line = (self._incomplete_line + content).split(b"\n")
        if not content:
            lines, self._incomplete_line = [*lines, self._incomplete_line], b""
        for line in lines:
            self._line(line.decode("utf-8", "replace"))


def _ready(streams: Iterable[int], event: int, timeout: float | None) -> list[int]:
    """Wait at most `timeout` [s], None for no limit; return the streams ready for `event`, in their order."""
    poll = select.poll()
    for stream in streams:
        poll.register(stream, event)
    found = {stream for stream, _ in poll.poll(None if timeout is None else timeout * 1_000)}
    return [stream for stream in streams if stream in found]


def _pages(pid: int) -> int:
    """Return the memory of a process, in pages; 0 if it has ended, or if the system does not report it."""
    try:
        return int(Path(f"/proc/{pid}/statm").read_bytes().split()[1])
    except (OSError, ValueError, IndexError):
        return 0


def _family(pid: int) -> list[int]:
    """Return the ids of a process and of all its descendants."""
    found, waiting = list[int](), [pid]
    while waiting:
        found.append(waiting.pop())
        with suppress(OSError, ValueError):
            children = Path(f"/proc/{found[-1]}/task/{found[-1]}/children").read_bytes()
            waiting += [int(child) for child in children.split()]
    return found


def _marked(mark: str) -> list[int]:
    """Return the ids of the processes that have a program's mark in their environment."""
    wanted, found = f"{_MARK}={mark}".encode(), list[int]()
    with suppress(OSError):
        for name in os.listdir("/proc"):
            if name.isdecimal():
                with suppress(OSError):
                    if wanted in Path(f"/proc/{name}/environ").read_bytes().split(b"\0"):
                        found.append(int(name))
    return found
