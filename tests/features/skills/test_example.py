"""The example: four skills, of which one is in JavaScript and asks a web service."""

import threading
from collections.abc import Iterator
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from pathlib import Path

import pytest

from lumen.cli.main import main
from lumen.features.skills import performer
from tests import ROOT
from tests.copying import copied_project
from tests.features.skills.changing import found
from tests.features.skills.stage import stage
from tests.provided import program
from tests.waiting import UNLIMITED

EXAMPLE = ROOT / "examples/skills"
ASKED, NEVER = threading.Event(), threading.Event()


class Service(BaseHTTPRequestHandler):
    """Answers with a joke; about `nothing` it never answers."""

    def do_GET(self) -> None:
        ASKED.set()
        if "nothing" in self.path:
            NEVER.wait()
        self.send_response(200)
        self.end_headers()
        self.wfile.write(b'{"joke": "Ha ' + self.path.encode() + b'"}')

    def log_message(self, *_: object) -> None:
        """Print nothing."""


@pytest.fixture
def service(monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    ASKED.clear()
    NEVER.clear()
    server = ThreadingHTTPServer(("127.0.0.1", 0), Service)
    thread = threading.Thread(target=server.serve_forever)
    thread.start()
    monkeypatch.setenv("JOKE_URL", f"http://127.0.0.1:{server.server_port}/")
    yield
    NEVER.set()
    server.shutdown()
    thread.join()
    server.server_close()


def test_the_example_is_sound_and_its_stories_pass(tmp_path: Path) -> None:
    root = copied_project(EXAMPLE, tmp_path / "skills")
    assert found(root) == []
    assert main(["test", str(root)]) == 0


@pytest.mark.process
def test_its_programs_run(tmp_path: Path, service: None) -> None:
    program("node")
    root = copied_project(EXAMPLE, tmp_path / "skills")
    for file, limit in (("joke.mjs", "3000"), ("ticket.py", "timeout=10")):  # on a busy machine they take longer
        text = (root / "skills" / file).read_text()
        assert limit in text
        (root / "skills" / file).write_text(text.replace(limit, f"{limit}000"))
    with stage(root) as made:
        assert made.perform("joke", topic="robots") == {"text": "Ha /?topic=robots"}
        assert made.perform("fog", duration="20ms", power=60) == {"litres": 0.06}
        assert made.perform("lamp", colour="gold") == {}
        assert made.perform("ticket", text="Ha") == {"lines": 1}
        assert made.told == ["fog machine: ON 60", "fog machine: OFF", "lamp: #ffb000", "Ha", "100%"]


@pytest.mark.process
def test_the_joke_ends_when_it_is_cancelled(tmp_path: Path, service: None, monkeypatch: pytest.MonkeyPatch) -> None:
    program("node")
    monkeypatch.setattr(performer, "GRACE", UNLIMITED)
    with stage(copied_project(EXAMPLE, tmp_path / "skills")) as made:
        id = made.start("joke", topic="nothing")
        made.until(ASKED.is_set)
        made.executor.cancel(id)
        made.until(lambda: not made.workshop.is_busy("joke"))
        assert made.reported == []


@pytest.mark.process
def test_the_lamp_says_why_it_cannot_reach_its_broker(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("LAMP_BROKER", "127.0.0.1:1")
    with stage(copied_project(EXAMPLE, tmp_path / "skills")) as made:
        assert made.perform("lamp", colour="blue").startswith("`lamp` failed: lamp.py:19: ConnectionRefusedError")
