"""The museum, with links to devices."""

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import pytest

from lumen.features.show import mqtt
from lumen.features.show.settings import Show
from lumen.language.projects import Project
from tests.features.show.linked import MESSAGES, ROUTES


@pytest.fixture(autouse=True)
def _password(tmp_path: Any, monkeypatch: pytest.MonkeyPatch) -> None:
    file = tmp_path / "mqtt"
    file.write_text("guest:guest\n")
    monkeypatch.setenv(mqtt.CREDENTIALS_VARIABLE, str(file))


@pytest.fixture
def museum(project: Project) -> Callable[..., Project]:
    def make(**links: Any) -> Project:
        messages = {**project.messages, **MESSAGES}
        linked = project.with_section("modules.show", Show(**links))
        return replace(linked, routes={**project.routes, **ROUTES}, messages=messages)

    return make
