"""Valid bodies for the keys of the shipped project."""

from typing import Any

from lumen.bus.local.server import FLUSH_MARK
from lumen.language.projects import Project
from lumen.lint import check_files
from lumen.project.files import read_files
from lumen.run.reload.requests import COMMAND, STATUS
from tests import ROOT
from tests.attack.targets import SPOKEN

OTHERS = (COMMAND, STATUS, SPOKEN, FLUSH_MARK, "lumen.operator.answer", "lumen.nobody.knows", "avatar.NAO", "#", "*.*")
"""Keys that no route has."""


def sound() -> dict[str, Any]:
    """Return a valid body for each key of the shipped project, in either direction, and one for each of `OTHERS`."""
    project, _ = check_files(ROOT, read_files(ROOT))
    assert project
    shown = {route.key_for(project.robot): _example(project, route.schema) for route in project.routes.values()}
    return shown | dict.fromkeys(OTHERS) | {COMMAND: {"command": "reload", "now": True}}


def _example(project: Project, schema: str) -> Any:
    """Return the first example of a message's schema, or None if it has no examples."""
    found: Any = project.messages.get(schema, {}).get("examples", [None])
    return found[0]
