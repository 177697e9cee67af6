"""No process outlives the one that began it, when that is killed and can end nothing."""

import os
import signal
import sys
from collections.abc import Callable, Sequence
from contextlib import suppress
from pathlib import Path

import pytest

from tests import ROOT
from tests.golden.exhibitions import small
from tests.golden.warm import environment
from tests.guarded import DEVNULL, Guarded
from tests.rabbitmq import _free_ports
from tests.waiting import until

HANG = 300.0
"""A bound that only a hang reaches [s]."""
CONSOLE = "console: {{port: {port}}}\n"
pytestmark = pytest.mark.rest


def _exhibition(folder: Path, robots: int) -> tuple[list[str], str]:
    (port,) = _free_ports(1)
    project = small(folder / "small", robots=robots, more=CONSOLE.format(port=port))
    return ["run", str(project), "--robot", "recording", "--bus", "memory://"], "lumen console"


def _physics(folder: Path) -> tuple[list[str], str]:
    return ["lint", str(small(folder / "small")), "--physics", "--workers", "2"], "spawn_main"


COMMANDS: dict[str, Callable[[Path], tuple[list[str], str]]] = {
    "an exhibition and its console": lambda folder: _exhibition(folder, 1),
    "a house and its console": lambda folder: _exhibition(folder, 2),
    "lint in physics": _physics,
}


@pytest.mark.parametrize("name", COMMANDS)
def test_none_is_left_when_the_first_is_killed(name: str, tmp_path: Path) -> None:
    line, child = COMMANDS[name](tmp_path)
    command = [sys.executable, "-m", "lumen", *line]
    with Guarded(
        command, cwd=ROOT, env=environment(tmp_path), stdin=DEVNULL, stdout=DEVNULL, stderr=DEVNULL
    ) as process:
        until(lambda: process.poll() is not None or _any_is(child, _beneath(process.pid)), HANG)
        children = _beneath(process.pid)
        assert _any_is(child, children), f"`lumen {line[0]}` ended before it began `{child}`: {process.poll()}"
        begun = {pid: _began(pid) for pid in children}
        os.kill(process.pid, signal.SIGKILL)
        process.wait()
    until(lambda: not _left(begun), HANG)


def _beneath(pid: int) -> dict[int, str]:
    """Return the descendants of a process, with their command lines."""
    parents = {int(entry.name): _parent(int(entry.name)) for entry in Path("/proc").iterdir() if entry.name.isdigit()}
    found: dict[int, str] = {}
    above = {pid}
    while above := {child for child, parent in parents.items() if parent in above}:
        found |= {child: _command(child) for child in above}
    return found


def _any_is(child: str, processes: dict[int, str]) -> bool:
    return any(child in command for command in processes.values())


def _left(begun: dict[int, str]) -> list[int]:
    """Return those that still run: no zombies, and no new process with an old number."""
    return [pid for pid, began in begun.items() if began and _began(pid) == began and _state(pid) != "Z"]


def _fields(pid: int) -> Sequence[str]:
    with suppress(OSError):
        return Path(f"/proc/{pid}/stat").read_text("utf-8", "replace").rpartition(")")[2].split()
    return ()


def _state(pid: int) -> str:
    return next(iter(_fields(pid)), "Z")


def _parent(pid: int) -> int:
    fields = _fields(pid)
    return int(fields[1]) if fields else 0


def _began(pid: int) -> str:
    fields = _fields(pid)
    return fields[19] if fields else ""


def _command(pid: int) -> str:
    with suppress(OSError):
        return Path(f"/proc/{pid}/cmdline").read_text("utf-8", "replace").replace("\0", " ")
    return ""
