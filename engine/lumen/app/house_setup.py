"""Who plays in a house: the robots, each with its clock, and the hall around them."""

from collections.abc import Mapping

from lumen.app.setup import Setup, set_up
from lumen.errors import UsageError
from lumen.language.projects import Project
from lumen.language.stories import Story


def set_up_house(
    kind: str, projects: Mapping[str, Project], speed: str, stories: Mapping[str, Story | None]
) -> dict[str, Setup]:
    """The robots of that kind, by name, on their feet. Raises UsageError where there can't be several."""
    if kind == "naoqi":
        raise UsageError("each real robot has a process of its own: say --robot-name NAME, and --robot-url for it")
    return {name: set_up(kind, project, speed, stories[name]) for name, project in projects.items()}
