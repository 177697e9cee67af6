"""Options that choose the exhibition and the robot for a subcommand."""

import argparse
from collections.abc import Callable

from lumen.cli.projects import shown_project
from lumen.run.reaching import Reached, reach_exhibition, robots_meant


def configure_reach(parser: argparse.ArgumentParser) -> None:
    """Add the options that choose an exhibition and a robot of it."""
    parser.add_argument(
        "project", nargs="?", metavar="PROJECT", help="the exhibition's folder (default: this folder or one above)"
    )
    parser.add_argument("--bus", metavar="URL", help="the exhibition's bus (default: LUMEN_BUS, then this machine)")
    configure_robot_name(parser)


def configure_robot_name(parser: argparse.ArgumentParser) -> None:
    """Add the option that chooses one of several robots."""
    what = "a robot in `robots:` (default: all for status, stop, resume and model, else the first that is running)"
    parser.add_argument("--robot-name", metavar="NAME", default="", help=what)


def for_each_robot(options: argparse.Namespace, do: Callable[[argparse.Namespace], int]) -> int:
    """Call `do` for each chosen robot, with its name in `options.robot_name`; return the highest exit code."""
    codes = []
    for name in names_meant(options):
        options.robot_name = name
        codes.append(do(options))
    return max(codes)


def names_meant(options: argparse.Namespace) -> list[str]:
    """Return the name in --robot-name, else all names in `robots:`; one empty name if lumen.yaml has no `robots:`."""
    return [options.robot_name] if options.robot_name else robots_meant(options.project, options.bus) or [""]


def reach(options: argparse.Namespace) -> Reached:
    """Return the bus of the chosen exhibition. Raises BusError, with a hint, if no exhibition is running.

    If it is the shipped exhibition, or the copy of it, that is printed on standard error.
    """
    shown_project(options.project)
    return reach_exhibition(options.project, options.bus, getattr(options, "robot_name", ""))
