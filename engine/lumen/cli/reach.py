"""Which exhibition a verb is about."""

import argparse
from collections.abc import Callable

from lumen.cli.projects import shown_project
from lumen.run.reaching import Reached, reach_exhibition, robots_meant


def configure_reach(parser: argparse.ArgumentParser) -> None:
    parser.add_argument(
        "project", nargs="?", metavar="PROJECT", help="the exhibition's folder (default: this folder or one above)"
    )
    parser.add_argument("--bus", metavar="URL", help="the exhibition's bus (default: LUMEN_BUS, then this machine)")
    configure_robot_name(parser)


def configure_robot_name(parser: argparse.ArgumentParser) -> None:
    what = "a robot in `robots:` (default: all for status, stop, resume and model, else the first that is running)"
    parser.add_argument("--robot-name", metavar="NAME", default="", help=what)


def for_each_robot(options: argparse.Namespace, do: Callable[[argparse.Namespace], int]) -> int:
    """Do it for each robot that is meant, which is `robot_name` then; the highest code of them."""
    codes = []
    for name in names_meant(options):
        options.robot_name = name
        codes.append(do(options))
    return max(codes)


def names_meant(options: argparse.Namespace) -> list[str]:
    """The robot that is named, else all of the house; one empty name where lumen.yaml has one `robot:`."""
    return [options.robot_name] if options.robot_name else robots_meant(options.project) or [""]


def reach(options: argparse.Namespace) -> Reached:
    """The bus of the exhibition that is meant. Raises BusError, saying what to do, where none is found."""
    shown_project(options.project)
    return reach_exhibition(options.project, options.bus, getattr(options, "robot_name", ""))
