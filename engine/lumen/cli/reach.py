"""The bus of an exhibition that runs somewhere else: a broker, or the door of one on this machine."""

import argparse
import os
from pathlib import Path
from typing import Any, NamedTuple

from lumen.bus import connect
from lumen.buses.local import LocalAddress, LocalBusClient
from lumen.errors import BusUnreachableError
from lumen.loading.packaged import find_project
from lumen.loading.project import main_settings
from lumen.ports import Bus
from lumen.robots.command_receiver import KEY, ROUTE
from lumen.runtime.home import ADDRESS_FILE, Home, home_of, homes


class Reached(NamedTuple):
    """A running exhibition's bus, the key under which its robot takes commands, and its broker's address, if any."""

    bus: Bus
    command: str
    broker: str = ""


def configure_reach(parser: argparse.ArgumentParser) -> None:
    parser.add_argument(
        "project", nargs="?", metavar="PROJECT", help="whose exhibition; default: the one here or above"
    )
    parser.add_argument("--bus", metavar="URL", help="where it runs; default: LUMEN_BUS, then this machine")


def reach(options: argparse.Namespace) -> Reached:
    """The bus of the exhibition that is meant. Raises BusError, saying what to do, where none is found."""
    root = find_project(options.project)
    found = _running(root)
    url = options.bus or os.environ.get("LUMEN_BUS") or ("" if found is None else str(found.get("bus", "")))
    if url and not url.startswith("memory:"):
        return Reached(connect(url), _command(root, found), url)
    if found is None:
        settings = main_settings(root)
        if settings and not settings.bus.startswith("memory:"):
            return Reached(connect(settings.bus), _command(root, None), settings.bus)
        raise BusUnreachableError(
            f"no exhibition of {root} runs on this machine: start it with `lumen run`, or say --bus URL"
        )
    return Reached(LocalBusClient(LocalAddress.of(found)), _command(root, found))


def _running(root: Path) -> dict[str, Any] | None:
    """What the exhibition of this project that runs on this machine has said of itself; None where none runs.

    An address that a killed run has left behind counts for nothing: nobody holds its home any more.
    """
    for home in (Home(home_of(root)), *homes()):
        found = _said(home)
        if found and _same_folder(found.get("root"), root) and home.held():
            return found
    return None


def _said(home: Home) -> dict[str, Any] | None:
    found = home.read_json(ADDRESS_FILE)
    return found if isinstance(found, dict) else None


def _same_folder(one: object, other: Path) -> bool:
    try:
        return isinstance(one, str) and os.path.samefile(one, other)
    except (OSError, ValueError):
        return False


def _command(root: Path, found: dict[str, Any] | None) -> str:
    """The key as the exhibition says, else as lumen.yaml does, however many errors it has."""
    if found and isinstance(found.get("command"), str):
        return str(found["command"])
    settings = main_settings(root)
    if settings is None:
        return KEY.replace("{robot}", "NAO")
    route = settings.routes.get(ROUTE)
    return route.key_for(settings.robot) if route else KEY.replace("{robot}", settings.robot)
