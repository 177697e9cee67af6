"""Command lines that are run one after another in one process, so that what Python imports is paid for once.

    with Warm() as warm:
        done = warm.run(["run", "minimal", "--only", "brain"], folder)

The result has the output, the exit code and, on request, the parts of its nodes. The process is a separate program:
signals, standard streams and the working folder are those of a terminal.
"""

import json
import os
import sys
import threading
import traceback
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any, NamedTuple, Self

import lumen
from tests import ROOT
from tests.golden import adapters_running
from tests.guarded import PIPE, Guarded

TICKS = 5
"""The number of ticks of each node before a process is examined: by then all parts that can start have started."""
PLAIN = {
    "COLUMNS": "100",
    "LANG": "C.UTF-8",
    "LC_ALL": "C.UTF-8",
    "NO_COLOR": "1",
    "PYTHONHASHSEED": "0",
    "TERM": "dumb",
    "TZ": "UTC",
}
"""Variables that may change the output of a command."""
DROPPED = ("LUMEN_", "PYTEST_", "PYTHON", "COV_", "XDG_")
OPEN = "open"
"""In place of a verb: call `lumen.open` with arguments in JSON, and tick until it is over."""
END_TIMEOUT = 60.0
"""Bound for the end of a command's threads [s]."""


class Done(NamedTuple):
    """A command that has ended; `nodes` describes its nodes, all after the same number of ticks.

    `left` are the threads that had not ended, if nodes were examined: other commands end with their process.
    """

    code: int
    out: str
    err: str
    nodes: list[dict[str, Any]]
    subscribed: list[str]
    threads: list[str]
    left: list[str]


class Warm:
    """A process that runs command lines of `lumen`."""

    def __init__(self, home: Path) -> None:
        self._home = home
        self._process = Guarded(
            [sys.executable, "-m", "tests.golden.warm", home],
            cwd=ROOT, stdin=PIPE, stdout=PIPE, text=True, env=environment(home),
        )  # fmt: skip

    def run(
        self,
        arguments: Sequence[object],
        folder: Path,
        *,
        nodes: int = 0,
        ends: bool = True,
        env: Mapping[str, str] | None = None,
    ) -> Done:
        """Run a command in a folder. With `nodes`, so many of its nodes are examined, and then ended if `ends`."""
        asked = {"arguments": [str(one) for one in arguments], "folder": str(folder), "nodes": nodes, "ends": ends}
        assert self._process.stdin
        assert self._process.stdout
        self._process.stdin.write(json.dumps({**asked, "env": dict(env or {})}) + "\n")
        self._process.stdin.flush()
        line = self._process.stdout.readline()
        assert line, f"the process that runs {arguments} ended: {self._process.wait()}"
        return Done(*json.loads(line))

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        assert self._process.stdin
        self._process.stdin.close()
        self._process.wait()
        assert self._process.stdout
        self._process.stdout.close()


def environment(home: Path) -> dict[str, str]:
    """Return an environment that is the same on each machine but for where programs are."""
    kept = {name: value for name, value in os.environ.items() if not name.startswith(DROPPED)}
    places = {"XDG_STATE_HOME": str(home / "state"), "XDG_CACHE_HOME": str(home / "cache"), "HOME": str(home)}
    return {**kept, **PLAIN, **places, "OPENBLAS_NUM_THREADS": "1"}


def _serve(home: Path) -> None:
    """Run the commands that come on standard input, one a line, until it closes."""
    asked, answers = os.fdopen(os.dup(0), "r"), os.fdopen(os.dup(1), "w")
    nowhere = os.open(os.devnull, os.O_RDONLY)
    os.dup2(nowhere, 0)
    for line in asked:
        answers.write(json.dumps(_run(json.loads(line), home)) + "\n")
        answers.flush()


def _run(asked: dict[str, Any], home: Path) -> Done:
    out, err = home / "out", home / "err"
    handles = [os.open(file, os.O_WRONLY | os.O_CREAT | os.O_TRUNC | os.O_APPEND) for file in (out, err)]
    for number, handle in enumerate(handles, 1):
        os.dup2(handle, number)
        os.close(handle)
    before = dict(os.environ)
    os.environ.update(asked["env"])
    os.chdir(asked["folder"])
    done = looked_at(lambda: _code(asked["arguments"]), asked["nodes"], ends=asked["ends"])
    sys.stdout.flush()
    sys.stderr.flush()
    os.chdir(home)
    os.environ.clear()
    os.environ.update(before)
    return done._replace(out=out.read_text("utf-8"), err=err.read_text("utf-8"))


def looked_at(do: Callable[[], int | None], nodes: int, *, ends: bool = True) -> Done:
    """Call `do` and look at that many of its nodes."""
    look = _Look(nodes, ends=ends)
    with adapters_running.looked_at(look) as traces:
        look.traces = traces
        code = do()
    left = [thread for thread in traces.threads if not _ended(thread)] if look.found else []
    threads, subscribed = look.told or (_names(traces.threads), traces.subscribed)
    return Done(code or 0, "", "", look.found, subscribed, threads, _names(left))


def _code(arguments: list[str]) -> int:
    try:
        if arguments[0] == OPEN:
            return _open(**json.loads(arguments[1]))
        return adapters_running.main(arguments)
    except SystemExit as error:
        return error.code if isinstance(error.code, int) else 1
    except BaseException:
        traceback.print_exc()
        return 1


def _open(path: str, **options: str) -> int:
    with lumen.open(path, **options) as exhibition:  # type: ignore[arg-type]
        while not exhibition.over:
            exhibition.tick()
    return 0


class _Look:
    """Looks at nodes once each has lived through some ticks; `told` are the threads and keys until then."""

    def __init__(self, wanted: int, *, ends: bool) -> None:
        self._wanted, self._ends = wanted, ends
        self._ticks: dict[Any, int] = {}
        self.found: list[dict[str, Any]] = []
        self.traces = adapters_running.Traces()
        self.told: tuple[list[str], list[str]] | None = None

    def __call__(self, node: Any) -> None:
        if len(self.found) == self._wanted:
            return
        self._ticks[node] = self._ticks.get(node, 0) + 1
        due = [one for one, ticks in self._ticks.items() if ticks >= TICKS]
        if len(due) < self._wanted:
            return
        self.found = [adapters_running.described(one) for one in due]
        self.told = _names(self.traces.threads), list(self.traces.subscribed)
        if self._ends:
            for one in due:
                adapters_running.end(one)


def _names(threads: Sequence[threading.Thread]) -> list[str]:
    """Return the names of threads, sorted; without timers, whose number depends on the speed of the machine."""
    return sorted(thread.name for thread in threads if not isinstance(thread, threading.Timer))


def _ended(thread: threading.Thread) -> bool:
    if isinstance(thread, threading.Timer):
        return True
    thread.join(END_TIMEOUT)
    return not thread.is_alive()


if __name__ == "__main__":
    _serve(Path(sys.argv[1]))
