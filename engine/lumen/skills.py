"""The Python side of a skill: `@skill` marks the function that performs it, and a `CurrentCall` is its first argument.

A skill runs in a process of its own. Messages between it and the exhibition are lines of JSON (docs/skills.md).
"""

import json
import linecache
import os
import sys
import threading
import traceback
from collections import deque
from collections.abc import Callable, Mapping
from types import ModuleType
from typing import Any, TypeVar

from lumen.language.durations import seconds

Function = TypeVar("Function", bound=Callable[..., Any])

_functions: dict[str, Callable[..., Any]] = {}


def skill(function: Function) -> Function:
    """Mark the function that performs the skill of its name; it is returned unchanged.

    It gets a `CurrentCall`, then the arguments of the manifest by their names. It returns a dict that fits `out` of the
    manifest, or None. An exception makes the skill fail with the exception's text.
    """
    _functions[function.__name__] = function
    return function


class CurrentCall:
    """One call of a skill. `skill` is its name, `arguments` are those of the behaviour with the manifest's defaults."""

    def __init__(self, skill: str, arguments: Mapping[str, Any], send: Callable[[dict[str, Any]], None]) -> None:
        self.skill, self.arguments = skill, dict(arguments)
        self._send = send
        self._changed = threading.Condition()
        self._cancelled = False
        self._wanted = self._waited = 0

    @property
    def cancelled(self) -> bool:
        """Whether the skill should end: it was stopped, or its state was left. 500 ms later its process is killed."""
        return self._cancelled

    def wait(self, duration: float | str) -> bool:
        """Wait by the robot's clock; return False, at once, if the call is or gets cancelled.

        `duration` is in [s], or a text such as `500ms` or `2min`. Raises ValueError if it is neither.
        """
        length = seconds(duration) if isinstance(duration, str) else float(duration)
        if length is None or not 0 <= length < float("inf"):
            raise ValueError(f"`{duration}` is not a duration: write a number of seconds, or a text such as `2s`")
        with self._changed:
            if self._cancelled:
                return False
            self._wanted += 1
            self._send({"wait": length})
            self._changed.wait_for(lambda: self._cancelled or self._waited >= self._wanted)
            return not self._cancelled

    def progress(self, fraction: float, text: str = "") -> None:
        """Report how far the skill is (0..1), and what it does now; the transcript shows it."""
        self._send({"progress": float(fraction), "text": str(text)})

    def say(self, text: str, language: str = "") -> None:
        """Have the robot say a text, in the language that it speaks if no other is given. This does not wait."""
        self._send({"say": str(text), "language": str(language)})

    def publish(self, route: str, body: Any = None) -> None:
        """Send JSON data on a route of lumen.yaml. This does not wait."""
        self._send({"publish": str(route), "body": body})

    def _go(self) -> None:
        with self._changed:
            self._waited += 1
            self._changed.notify_all()

    def _cancel(self) -> None:
        with self._changed:
            self._cancelled = True
            self._changed.notify_all()


def serve() -> None:
    """Perform the calls that come as lines on standard input, until that is closed: the process of a skill runs this.

    Output of the code goes to standard error: standard output carries the answers.
    """
    _Server().run()


class _Server:
    """Loads a file, then performs one call at a time on this thread; another thread reads the messages."""

    def __init__(self) -> None:
        self._input = os.fdopen(os.dup(0), "r", encoding="utf-8")
        self._output = os.fdopen(os.dup(1), "w", encoding="utf-8")
        nothing = os.open(os.devnull, os.O_RDONLY)
        os.dup2(nothing, 0)
        os.dup2(2, 1)
        sys.stdout.reconfigure(line_buffering=True)  # type: ignore[union-attr]  # it is a TextIOWrapper
        self._lock, self._come = threading.Lock(), threading.Condition()
        self._orders: deque[dict[str, Any]] = deque()
        self._call: CurrentCall | None = None
        self._current = 0
        self._file = ""

    def run(self) -> None:
        threading.Thread(target=self._read, daemon=True, name="lumen-orders").start()
        while True:
            with self._come:
                self._come.wait_for(lambda: self._orders)
                order = self._orders.popleft()
            if "load" in order:
                self._load(order["load"], order["file"])
            else:
                self._perform(order)

    def _read(self) -> None:
        for line in self._input:
            message = json.loads(line)
            if "skill" in message:  # set here: its cancel may be the next line
                self._call = CurrentCall(message["skill"], message["arguments"], self._sender(message["call"]))
                self._current = message["call"]
            if "skill" in message or "load" in message:
                with self._come:
                    self._orders.append(message)
                    self._come.notify()
            elif (call := self._call) and message.get("call") == self._current:
                call._go() if "go" in message else call._cancel()
        os._exit(0)  # the exhibition has ended, whatever the code does now

    def _load(self, source: str, file: str) -> None:
        self._file = file
        sys.path.insert(0, os.path.dirname(file))
        linecache.cache[file] = (
            len(source),
            None,
            source.splitlines(keepends=True),
            file,
        )  # a traceback shows these lines
        module = ModuleType("__skill__")
        module.__file__ = file
        sys.modules["__skill__"] = module
        try:
            exec(compile(source, file, "exec"), module.__dict__)
        except BaseException as error:
            self._answer({"loaded": False, "error": self._described(error)})
        else:
            self._answer({"loaded": True})

    def _perform(self, order: Mapping[str, Any]) -> None:
        call, id = self._call, order["call"]
        assert call is not None
        try:
            function = _functions.get(call.skill)
            if function is None:
                raise LookupError(f"no function `{call.skill}` is marked with @skill")
            result = function(call, **call.arguments)
            answer = json.dumps({"call": id, "result": {} if result is None else result}, allow_nan=False)
        except BaseException as error:
            answer = json.dumps({"call": id, "error": self._described(error)})
        self._call = None
        self._write(answer)

    def _described(self, error: BaseException) -> str:
        """Print the traceback from the user's code on; return its last line, with the place in that code."""
        frames = traceback.extract_tb(error.__traceback__)
        own = [number for number, frame in enumerate(frames) if frame.filename == self._file]
        sys.stdout.flush()
        kept = frames[own[0] :] if own else frames
        lines = ["Traceback (most recent call last):\n", *traceback.format_list(kept)]
        last = traceback.format_exception_only(error)
        sys.stderr.write("".join([*lines, *last]))
        sys.stderr.flush()
        line = error.lineno if isinstance(error, SyntaxError) else frames[own[-1]].lineno if own else None
        place = f"{os.path.basename(self._file)}:{line}: " if line else ""
        return place + " ".join(last[-1].split())

    def _sender(self, id: int) -> Callable[[dict[str, Any]], None]:
        return lambda message: self._answer({"call": id, **message})

    def _answer(self, message: Mapping[str, Any]) -> None:
        self._write(json.dumps(message, allow_nan=False))

    def _write(self, line: str) -> None:
        with self._lock:
            self._output.write(f"{line}\n")
            self._output.flush()
