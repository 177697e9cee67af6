"""`lumen doctor --robot reachy`."""

import json
from threading import Event
from typing import Any

import pytest

from lumen.cli.main import main
from tests.features.reachy.fake import FakeDaemon


def examined(capsys: pytest.CaptureFixture[str], url: str) -> tuple[int, dict[str, tuple[str, str]]]:
    code = main(["doctor", "--robot", "reachy", "--robot-url", url, "--format", "json"])
    found: list[dict[str, Any]] = json.loads(capsys.readouterr().out)["findings"]
    return code, {each["what"]: (each["severity"], each["text"]) for each in found}


def test_a_daemon_and_what_uses_it(daemon: FakeDaemon, capsys: pytest.CaptureFixture[str]) -> None:
    daemon.media = True
    code, found = examined(capsys, daemon.url)
    assert code == 0
    assert found["daemon"] == ("ok", f"`reachy_mini` (a simulation) at {daemon.url}, version 1.13.0")
    assert {name: severity for name, (severity, _) in found.items()} == dict.fromkeys(
        ("daemon", "robot", "other apps", "loudspeaker"), "ok"
    )


def test_another_program_and_a_daemon_without_sound(daemon: FakeDaemon, capsys: pytest.CaptureFixture[str]) -> None:
    daemon.moves["another"] = Event()
    code, found = examined(capsys, daemon.url)
    assert code == 1
    assert found["other apps"][0] == found["loudspeaker"][0] == "warning"


def test_no_daemon(capsys: pytest.CaptureFixture[str]) -> None:
    gone = FakeDaemon()
    gone.close()
    code, found = examined(capsys, gone.url)
    assert code == 1
    assert "does not answer" in found["daemon"][1]


def test_what_is_no_address(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["doctor", "--robot", "reachy", "--robot-url", "tcp://x"]) == 2
    assert "is no address of a daemon" in capsys.readouterr().err
