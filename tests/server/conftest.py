"""A server whose threads are waited for, however late the machine begins them."""

import pytest

from lumen.robot import server
from lumen.robot.sense_publisher import SensePublisher
from tests.waiting import UNLIMITED


@pytest.fixture(autouse=True)
def patient(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(server, "THREAD_START_TIMEOUT", UNLIMITED)
    monkeypatch.setattr(server, "FIRST_IMAGE_TIMEOUT", UNLIMITED)
    monkeypatch.setattr(server, "SENSES_CLOSE_TIMEOUT", UNLIMITED)
    monkeypatch.setattr(SensePublisher, "PATIENCE", UNLIMITED)
