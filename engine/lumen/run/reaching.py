"""The bus of an exhibition that runs elsewhere: a broker, or the local address of an embedded bus."""

import os
from pathlib import Path
from typing import Any, NamedTuple

from lumen.bus import connect
from lumen.bus.addresses import within_process
from lumen.bus.local import LocalAddress, LocalBusClient
from lumen.errors import BusUnreachableError
from lumen.language.causes import TERMINAL
from lumen.language.routing_keys import default_key
from lumen.ports import Bus
from lumen.project.home import ADDRESS_FILE, Home, homes, homes_of
from lumen.project.main_file import main_settings
from lumen.project.running_project import running_project
from lumen.project.settings import Settings
from lumen.robot.robot_routes import COMMAND_ROUTE, STOP_ROUTE
from lumen.run.one_robot import one_robot, robots_of


class Reached(NamedTuple):
    """The bus of a running exhibition, and the names that its users need."""

    bus: Bus
    robot: str
    command: str
    """The key on which the robot receives commands."""
    stop: str
    """The key on which the robot receives stops."""
    broker: str = ""
    """The address of the broker; empty for an embedded bus."""
    home: str = ""
    """The name of the robot's own folder if the project has `robots:`; else empty."""


def reach_exhibition(project: str | None, bus: str | None, robot: str = "") -> Reached:
    """Connect to the exhibition of a project, by default the project here or above; `bus` is the address, if known.

    Of several robots, the exhibition is that of `robot`; by default that of the first robot that runs here, else of the
    first robot. Raises UsageError for an unknown robot, BusError, with advice, if no exhibition is found.
    """
    root = running_project(project)
    wanted = one_robot(root, robot)
    found = _running(root, wanted if robot else "")
    home = _home(found) or wanted
    url = bus or os.environ.get("LUMEN_BUS") or str((found or _running(root) or {}).get("bus", ""))
    if url and not within_process(url):
        return Reached(connect(url, sender=TERMINAL), _robot(root, found, home), *_keys(root, found, home), url, home)
    if found is None:
        settings = main_settings(root, home)
        if settings and not within_process(settings.bus):
            keys = _keys(root, None, home)
            return Reached(connect(settings.bus, sender=TERMINAL), settings.robot, *keys, settings.bus, home)
        raise BusUnreachableError(
            f"no exhibition of {root.absolute()} is running on this machine:"
            " start it with `lumen run`, or pass --bus URL"
        )
    opened = LocalBusClient(LocalAddress.of(found), TERMINAL)
    return Reached(opened, _robot(root, found, home), *_keys(root, found, home), home=home)


def robots_meant(project: str | None, bus: str | None) -> list[str]:
    """Return all robots of `robots:`; empty with one `robot:`.

    Without a broker, whose robots may run on other machines, leave out those that do not run here, if any does. `bus`
    is the address, if known.
    """
    root = running_project(project)
    robots = robots_of(root, None)
    here = {name: found for name in robots if (found := _running(root, name))}
    urls = (bus or os.environ.get("LUMEN_BUS"), *(str(found.get("bus", "")) for found in here.values()))
    return list(robots if any(url and not within_process(url) for url in urls) else here or robots)


def _running(root: Path, robot: str = "") -> dict[str, Any] | None:
    """Return the data that the project's running exhibition on this machine has published; None if none runs.

    Of several robots, the data is that of `robot`, if one is given. An address left by a killed run is ignored, because
    no process holds its home any more.
    """
    for home in (*homes_of(root), *homes()):
        found = _said(home)
        if found and robot in ("", found.get("robot")) and _same_folder(found.get("root"), root) and home.held():
            return found
    return None


def runs_here(root: Path) -> bool:
    """Return whether an exhibition of the project in `root` is running on this machine."""
    return _running(root) is not None


def _said(home: Home) -> dict[str, Any] | None:
    found = home.read_json(ADDRESS_FILE)
    return found if isinstance(found, dict) else None


def _same_folder(one: object, other: Path) -> bool:
    try:
        return isinstance(one, str) and os.path.samefile(one, other)
    except (OSError, ValueError):
        return False


def _home(found: dict[str, Any] | None) -> str:
    """Return the name of the running robot's folder; empty if it has no folder of its own."""
    return str(found.get("home", "")) if found else ""


def _robot(root: Path, found: dict[str, Any] | None, home: str) -> str:
    """Return the robot's name from the exhibition, else from lumen.yaml, even if that file has errors."""
    if found and isinstance(found.get("robot"), str):
        return str(found["robot"])
    settings = main_settings(root, home)
    return settings.robot if settings else Settings.robot


def _keys(root: Path, found: dict[str, Any] | None, home: str) -> tuple[str, str]:
    """Return the keys for commands and stops from the exhibition, else from lumen.yaml, even if it has errors."""
    if found and isinstance(found.get("command"), str) and isinstance(found.get("stop"), str):
        return found["command"], found["stop"]
    settings = main_settings(root, home)
    robot = settings.robot if settings else "NAO"
    rows = settings.routes if settings else {}
    command, stop = (
        rows[route].key_for(robot) if route in rows else default_key(route, robot)
        for route in (COMMAND_ROUTE, STOP_ROUTE)
    )
    return command, stop
