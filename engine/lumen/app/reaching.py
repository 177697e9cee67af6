"""The bus of an exhibition that runs somewhere else: a broker, or the door of one on this machine."""

import os
from pathlib import Path
from typing import Any, NamedTuple

from lumen.bus import connect
from lumen.buses.local import LocalAddress, LocalBusClient
from lumen.errors import BusUnreachableError
from lumen.language.causes import TERMINAL
from lumen.language.routing_keys import default_key
from lumen.loading.packaged import find_project
from lumen.loading.project import main_settings
from lumen.loading.settings import Settings
from lumen.ports import Bus
from lumen.robots.robot_routes import COMMAND_ROUTE, STOP_ROUTE
from lumen.runtime.home import ADDRESS_FILE, Home, home_of, homes


class Reached(NamedTuple):
    """A running exhibition's bus, its robot, the keys under which that takes commands, and its broker's address."""

    bus: Bus
    robot: str
    command: str
    stop: str
    broker: str = ""


def reach_exhibition(project: str | None, bus: str | None) -> Reached:
    """The bus of the exhibition of a project (default: the one here or above), which `bus` may be the address of.

    Raises BusError, saying what to do, where none is found.
    """
    root = find_project(project)
    found = _running(root)
    url = bus or os.environ.get("LUMEN_BUS") or ("" if found is None else str(found.get("bus", "")))
    if url and not url.startswith("memory:"):
        return Reached(connect(url, sender=TERMINAL), _robot(root, found), *_keys(root, found), url)
    if found is None:
        settings = main_settings(root)
        if settings and not settings.bus.startswith("memory:"):
            return Reached(connect(settings.bus, sender=TERMINAL), settings.robot, *_keys(root, None), settings.bus)
        raise BusUnreachableError(
            f"no exhibition of {root.absolute()} runs on this machine: start it with `lumen run`, or say --bus URL"
        )
    return Reached(LocalBusClient(LocalAddress.of(found), TERMINAL), _robot(root, found), *_keys(root, found))


def _running(root: Path) -> dict[str, Any] | None:
    """What the exhibition of this project that runs on this machine has said of itself; None where none runs.

    An address that a killed run has left behind counts for nothing: nobody holds its home any more.
    """
    for home in (Home(home_of(root)), *homes()):
        found = _said(home)
        if found and _same_folder(found.get("root"), root) and home.held():
            return found
    return None


def runs_here(root: Path) -> bool:
    """Whether an exhibition of the project in that folder runs on this machine."""
    return _running(root) is not None


def _said(home: Home) -> dict[str, Any] | None:
    found = home.read_json(ADDRESS_FILE)
    return found if isinstance(found, dict) else None


def _same_folder(one: object, other: Path) -> bool:
    try:
        return isinstance(one, str) and os.path.samefile(one, other)
    except (OSError, ValueError):
        return False


def _robot(root: Path, found: dict[str, Any] | None) -> str:
    """The robot's name, as the exhibition says, else as lumen.yaml does despite its errors."""
    if found and isinstance(found.get("robot"), str):
        return str(found["robot"])
    settings = main_settings(root)
    return settings.robot if settings else Settings.robot


def _keys(root: Path, found: dict[str, Any] | None) -> tuple[str, str]:
    """The keys for commands and for what stops, as the exhibition says, else as lumen.yaml does despite its errors."""
    if found and isinstance(found.get("command"), str) and isinstance(found.get("stop"), str):
        return found["command"], found["stop"]
    settings = main_settings(root)
    robot = settings.robot if settings else "NAO"
    rows = settings.routes if settings else {}
    command, stop = (
        rows[route].key_for(robot) if route in rows else default_key(route, robot)
        for route in (COMMAND_ROUTE, STOP_ROUTE)
    )
    return command, stop
