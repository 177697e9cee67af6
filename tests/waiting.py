"""Waiting for a condition, with a bound that only a hang reaches: no test sleeps."""

import inspect
import linecache
import reprlib
import threading
import time
from collections.abc import Callable
from typing import Any

HANG = 300.0
"""The bound of every wait for something real: a slow and loaded machine stays far below it [s]."""
UNLIMITED = 10 * HANG
"""A limit of the engine that a test takes away [s]: a test that waits for it fails each time, not now and then."""
IDLE = 9.0
"""The pause between two looks, in multiples of the time that a look took."""
LONGEST_PAUSE = 0.25
"""The longest such pause [s]."""

APART = 'until [ "$(cut -d " " -f 6 /proc/$!/stat)" = $! ]; do :; done'
"""In the shell: wait until the program that `setsid` begins in the background has a session of its own."""


class Collector:
    """A handler that keeps the messages that it is handed, and lets a test wait for them."""

    def __init__(self) -> None:
        self.messages: list[Any] = []
        self._changed = threading.Condition()

    def __call__(self, message: Any) -> None:
        with self._changed:
            self.messages.append(message)
            self._changed.notify_all()

    def __repr__(self) -> str:
        shown = [getattr(message, "body", message) for message in self.messages[-3:]]
        return f"<{len(self.messages)} messages, the last of them {reprlib.repr(shown)}>"

    @property
    def bodies(self) -> list[Any]:
        return [message.body for message in self.messages]

    def wait(self, count: int, timeout: float = HANG) -> list[Any]:
        """Return the bodies once there are `count` of them; fail after `timeout` [s]."""
        with self._changed:
            arrived = self._changed.wait_for(lambda: len(self.messages) >= count, timeout)
        assert arrived, f"waited {timeout:g} s for {count} messages; received {self!r}"
        return self.bodies


def until(
    condition: Callable[[], object],
    timeout: float = HANG,
    *,
    every: float = 0.01,
    what: str | None = None,
    meanwhile: Callable[[], object] | None = None,
    shown: Callable[[], object] | None = None,
) -> None:
    """Return once the condition holds, which is tested after pauses of `every` [s]; fail after `timeout` [s].

    The failure names the condition: in the words of `what`, else by its source text, with the variables it reads; and
    it ends with what `shown` returns, as a transcript. `meanwhile` is called between two looks, in place of a pause.
    A condition that takes long, as one in a browser does, is followed by a longer pause, which leaves the machine to
    the awaited work.
    """
    deadline = time.monotonic() + timeout
    pause = threading.Event()
    while True:
        began = time.monotonic()
        seen = condition()
        if seen:
            return
        now = time.monotonic()
        if now >= deadline:
            failure = f"waited {timeout:g} s for: {what or source_of(condition)}; {_last(condition, seen)}"
            raise AssertionError(f"{failure}\n{shown()}" if shown else failure)
        if meanwhile:
            meanwhile()
        else:
            pause.wait(max(every, min(IDLE * (now - began), LONGEST_PAUSE)))


def finished(thread: threading.Thread) -> None:
    """Wait until the thread has ended; fail if it hangs."""
    until(lambda: thread.is_alive() or thread not in threading.enumerate())  # listed, it may not have started yet
    thread.join(HANG)
    assert not thread.is_alive(), f"waited {HANG:g} s for the end of the thread {thread.name}"


def threads(prefix: str = "") -> set[threading.Thread]:
    """Return the threads whose names begin with `prefix`. Compare sets, since those of other tests may end late."""
    return {thread for thread in threading.enumerate() if thread.name.startswith(prefix)}


def source_of(condition: Callable[[], object]) -> str:
    """Return a lambda's expression as written, a function's name and its first line of documentation, else a repr."""
    function = inspect.unwrap(getattr(condition, "__func__", condition))
    code = getattr(function, "__code__", None)
    if code is None:
        return repr(condition)
    if code.co_name != "<lambda>":
        summary = (inspect.getdoc(function) or "").partition("\n")[0]
        return f"{function.__qualname__}(){summary and ': ' + summary}"
    spots = [(line, start, end_line, end) for line, end_line, start, end in code.co_positions() if line and end]
    if not spots:
        return repr(condition)
    (first, start, *_), (last, end) = min(spots), max(spot[2:] for spot in spots)
    lines = [linecache.getline(code.co_filename, number).encode() for number in range(first, last + 1)]
    lines[-1] = lines[-1][:end]
    lines[0] = lines[0][start:]
    return " ".join(b" ".join(lines).decode(errors="replace").split())


def _last(condition: Callable[[], object], seen: object) -> str:
    """Describe what the last look returned, and the variables around the condition."""
    text = f"last: {reprlib.repr(seen)}"
    try:
        variables = inspect.getclosurevars(condition).nonlocals
    except TypeError:  # a builtin, or an object that is called
        return text
    return ", ".join([text, *(f"{name} = {reprlib.repr(value)}" for name, value in variables.items())])
