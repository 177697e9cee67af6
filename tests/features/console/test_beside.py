"""The console beside an exhibition: it starts with it, starts again if it dies, and ends with it."""

import os
import signal
import socket
from math import inf
from pathlib import Path
from types import SimpleNamespace

import pytest

from lumen.features.console import part as console
from lumen.features.console.part import ConsolePart
from tests.features.console.pages import Browser
from tests.waiting import until


def free_port() -> int:
    with socket.create_server(("127.0.0.1", 0)) as listener:
        return int(listener.getsockname()[1])


@pytest.mark.slow
def test_it_is_begun_begun_again_and_ended(copy: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(console, "FIRST_PAUSE", 0.1)
    port, told = free_port(), list[str]()
    main = copy / "lumen.yaml"
    main.write_text(f"console: {{port: {port}}}\n" + main.read_text("utf-8"), "utf-8")
    part, browser = ConsolePart(copy, "memory://", told.append), Browser(f"http://127.0.0.1:{port}/")

    def serves() -> bool:
        part.tick(0.0, ())
        try:
            return browser.get("/api/now").status == 200
        except OSError:
            return False

    until(serves)
    until(lambda: serves() and f"The console is at http://127.0.0.1:{port}/ (Ctrl-C ends it)" in told)
    first = part.pid
    assert first
    os.kill(first, signal.SIGKILL)

    def another() -> bool:
        part.tick(0.0, ())
        return part.pid not in (None, first)

    until(another)
    until(serves)
    assert any(line.startswith("the console has ended (exit code -9)") for line in told)
    part.close()
    with pytest.raises(OSError, match="refused"):
        browser.get("/api/now")


def test_a_line_that_it_repeats_is_told_once() -> None:
    told = list[str]()
    part = ConsolePart(Path(), "memory://", told.append)
    part._looked = inf  # it is not begun here
    for lines in (["one", "one", "two"], ["two", "one"], ["one"]):
        part._lines += lines
        part.tick(0.0, ())
    assert told == ["one", "two", "one"]


def test_it_restarts_after_a_second_then_after_two(monkeypatch: pytest.MonkeyPatch) -> None:
    told, moments = list[str](), iter((1.0, 2.0, 3.0, 4.0))

    class Ended:
        stdout = stdin = None

        def poll(self) -> int:
            return 3

    monkeypatch.setattr("subprocess.Popen", lambda *_, **__: Ended())
    monkeypatch.setattr(console, "time", SimpleNamespace(monotonic=lambda: next(moments)))
    part = ConsolePart(Path(), "memory://", told.append)
    for _ in range(4):
        part.tick(0.0, ())
    assert told == [f"the console has ended (exit code 3); it restarts in {pause} s" for pause in (1, 2)]


@pytest.mark.slow
def test_why_it_cannot_begin_is_told(copy: Path) -> None:
    told = list[str]()
    with socket.create_server(("127.0.0.1", 0)) as taken:
        port = taken.getsockname()[1]
        main = copy / "lumen.yaml"
        main.write_text(f"console: {{port: {port}}}\n" + main.read_text("utf-8"), "utf-8")
        part = ConsolePart(copy, "memory://", told.append)

        def ended() -> bool:
            part.tick(0.0, ())
            return any("restarts in" in line for line in told)

        until(ended)
        until(lambda: part.tick(0.0, ()) or any(f"port {port} of 127.0.0.1 is not available" in line for line in told))
        part.close()
