"""The findings of `lumen doctor` about messages on the bus."""

from datetime import UTC, datetime, timedelta
from unittest.mock import Mock

import pytest

from lumen.bus import Message
from lumen.cli import doctor
from tests.exhibits import project
from tests.tables import for_each

NOW = datetime(2026, 5, 20, 10, 0, tzinfo=UTC)


@for_each(
    "late, severity, text",
    [
        (0.9, "ok", "this machine's clock and the robot's are 0.9 s apart"),
        (-0.9, "ok", "this machine's clock and the robot's are 0.9 s apart"),
        (1.1, "warning", "this machine's clock and the robot's are 1.1 s apart"),
        (-1.1, "warning", "this machine's clock and the robot's are 1.1 s apart"),
    ],
)
def test_clocks_more_than_a_second_apart_are_worth_a_warning(
    late: float, severity: str, text: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(doctor, "datetime", Mock(now=lambda zone: NOW, fromisoformat=datetime.fromisoformat))
    body = {"datePublished": (NOW - timedelta(seconds=late)).isoformat()}
    bus = Mock()
    bus.subscribe = lambda key, handler: handler(Message(key, body))
    found = list(doctor._life(bus, project()))
    senses, clocks = [(one.what, one.severity, one.text) for one in found]
    assert senses[:2] == ("senses", "ok")
    assert senses[2].startswith("messages arrive on ")
    assert clocks == ("clocks", severity, text)
