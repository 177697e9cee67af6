"""The settings in lumen.yaml, read without the other files of a project."""

from pathlib import Path

from lumen.project.built_file import Build, read_file
from lumen.project.files import Unreadable, read_main_file
from lumen.project.project_folders import MAIN_FILE, MAIN_KIND
from lumen.project.settings import Settings, build_settings


def main_settings(root: Path, robot: str = "") -> Settings | None:
    """Return the settings in lumen.yaml, whatever errors it has, without reading other files; None if it is unreadable.

    `robot` is the name of one of several robots; empty for the first.
    """
    content = read_main_file(root)
    if isinstance(content, Unreadable):
        return None
    main, _ = read_file(MAIN_FILE, content, MAIN_KIND, settings_builder(robot), robot)
    return main.built if main else None


def settings_builder(robot: str) -> Build[Settings]:
    """Return the function that builds the settings of one of several robots; of the first if the name is empty."""
    return lambda data, report, name: build_settings(data, report, robot=robot)
