"""Which of the robots of a project is meant."""

from collections.abc import Sequence
from pathlib import Path

from lumen.errors import UsageError
from lumen.language.diagnostics import did_you_mean
from lumen.project.building import main_settings
from lumen.project.settings import Settings


def one_robot(root: Path, name: str = "") -> str:
    """What the robot's folder in the home of the project is called: empty where lumen.yaml has one `robot:`.

    Without a name it is the first. Raises UsageError for one that is not there.
    """
    settings = main_settings(root) or Settings()
    robots = list(settings.robots)
    if name and name not in robots:
        raise UsageError(f"there is no robot `{name}`: {did_you_mean(name, robots, 'there are')}")
    return (name or robots[0]) if settings.told_apart else ""


def robots_of(root: Path, names: str | None) -> Sequence[str]:
    """Those robots of `robots:` that a list of names means, in its order; all of them without one.

    Empty where lumen.yaml has one `robot:`. Raises UsageError for a name that is not there.
    """
    settings = main_settings(root) or Settings()
    if names is None:
        return tuple(settings.robots) if settings.told_apart else ()
    wanted = tuple(dict.fromkeys(name.strip() for name in names.split(",") if name.strip()))
    if not wanted:
        raise UsageError(f"--robot-name must be one or more of {', '.join(settings.robots)}")
    return tuple(name for name in (one_robot(root, name) for name in wanted) if name)
