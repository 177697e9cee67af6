"""Servers that receive alerts, and an environment without the settings of this machine."""

from collections.abc import Callable, Iterator

import pytest

from tests.features.alerts.servers import Web


@pytest.fixture(autouse=True)
def no_settings(monkeypatch: pytest.MonkeyPatch) -> None:
    for name in ("LUMEN_ALERT_TOKEN", "LUMEN_ALERT_URL", "LUMEN_SMTP_USER", "LUMEN_SMTP_PASSWORD", "LUMEN_BUS"):
        monkeypatch.delenv(name, raising=False)


@pytest.fixture
def web() -> Iterator[Callable[..., Web]]:
    """Return a function that makes web servers, which are closed after the test."""
    made: list[Web] = []

    def make(*statuses: int) -> Web:
        made.append(Web(*statuses))
        return made[-1]

    yield make
    for one in made:
        one.close()
