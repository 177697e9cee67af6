"""The choice among the robots of a project."""

from collections.abc import Sequence
from pathlib import Path

from lumen.errors import UsageError
from lumen.language.diagnostics import did_you_mean
from lumen.project.main_file import main_settings
from lumen.project.settings import Settings


def one_robot(root: Path, name: str = "") -> str:
    """Return the name of a robot's folder in the project's home; empty if lumen.yaml has one `robot:`.

    Without a name, the first robot is chosen. Raises UsageError for an unknown name.
    """
    settings = main_settings(root) or Settings()
    robots = list(settings.robots)
    if name and name not in robots:
        raise UsageError(f"there is no robot `{name}`: {did_you_mean(name, robots, 'there are')}")
    return (name or robots[0]) if settings.told_apart else ""


def robots_of(root: Path, names: str | None) -> Sequence[str]:
    """Return the robots in a comma-separated list of names, in the list's order; all of `robots:` if `names` is None.

    The result is empty if lumen.yaml has one `robot:`. Raises UsageError for an unknown name or an empty list.
    """
    settings = main_settings(root) or Settings()
    if names is None:
        return tuple(settings.robots) if settings.told_apart else ()
    wanted = tuple(dict.fromkeys(name.strip() for name in names.split(",") if name.strip()))
    if not wanted:
        raise UsageError(f"--robot-name must be one or more of {', '.join(settings.robots)}")
    return tuple(name for name in (one_robot(root, name) for name in wanted) if name)
