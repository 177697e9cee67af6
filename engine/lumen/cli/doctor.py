"""`lumen doctor`: check whether an exhibition's bus can be used, and whether all its parts are on the bus."""

import argparse
import json
import os
import shutil
import sys
import threading
from collections.abc import Iterable, Iterator
from contextlib import closing, suppress
from datetime import UTC, datetime
from typing import Any, NamedTuple

from lumen.bus import connect
from lumen.bus.addresses import within_process
from lumen.bus.brokers import Probe, probe_of, side_queues
from lumen.bus.validated import by_key
from lumen.cli.reach import reach
from lumen.cli.terminal import coloured, paint
from lumen.errors import BusError
from lumen.feature import VerbRow, owner, table
from lumen.language.added_verbs import PerformedByModule
from lumen.language.modules import own_modules
from lumen.language.projects import Project
from lumen.language.routes import Direction
from lumen.lint import check_files
from lumen.ports import Bus
from lumen.project.broken_features import called
from lumen.project.files import read_files
from lumen.project.running_project import own_project
from lumen.robot.robot_routes import COMMAND_ROUTE
from lumen.run.attendance import RobotAttendance
from lumen.run.delegated_tracking import MOTION_ROUTE as MOTION
from lumen.run.setup import robot_options

LISTENING = 2.0
SKEW = 1.0
"""The difference between two clocks [s] above which the finding is a warning."""
SIGNS = {"ok": ("ok", "green"), "note": ("--", "dim"), "warning": ("??", "yellow"), "error": ("!!", "red")}


class Finding(NamedTuple):
    """The result of one check."""

    what: str
    """The subject of the check, such as `broker` or `clocks`."""
    severity: str
    """`ok`, `note`, `warning` or `error`: a key of SIGNS."""
    text: str
    """The result, in words."""


def configure(parser: argparse.ArgumentParser) -> None:
    """Add the options of `lumen doctor` to its parser."""
    parser.description = (
        "Check the bus of an exhibition: whether the broker is running, is new enough and lets Lumen read and send,"
        " whether the clocks agree, and which routes no process serves."
        " With --robot, check whether that robot can be reached."
    )
    parser.add_argument(
        "project", nargs="?", metavar="PROJECT", help="the project's folder (default: this folder or one above)"
    )
    parser.add_argument(
        "--bus", metavar="URL", help="the bus (default: LUMEN_BUS, then the one in lumen.yaml, then this machine)"
    )
    robots = [name for name, row in table("robots").items() if row.examine]
    parser.add_argument("--robot", choices=robots, help="check whether this robot can be reached, in place of the bus")
    examined = {option.name for row in table("robots").values() if row.examine for option in row.options}
    for option in (option for option in robot_options() if option.name in examined):
        parser.add_argument(option.flag, dest=option.destination, metavar=option.metavar, help=option.help)
    parser.add_argument("--format", choices=("text", "json"), default="text", help="output format (default: text)")


def run(options: argparse.Namespace) -> int:
    """Print the findings; return 1 if one is a warning or an error, else 0.

    Raises BusError if there is no bus to check.
    """
    if options.robot:
        return _told(options, [Finding(*found) for found in _robot(options)])
    root = own_project(options.project)
    project = check_files(root, read_files(root))[0]
    url = options.bus or os.environ.get("LUMEN_BUS") or (project.bus if project else "memory://")
    probe = probe_of(url)
    return _told(options, list(_broker(probe, url, project) if probe else _other(options, url, project)))


def _robot(options: argparse.Namespace) -> Iterable[tuple[str, str, str]]:
    """Return the findings of the robot's feature."""
    given = {option.name: value for option in robot_options() if (value := getattr(options, option.destination, None))}
    found: Iterable[tuple[str, str, str]] = called(
        owner("robots", options.robot), table("robots")[options.robot].examine, given
    )
    return found


def _told(options: argparse.Namespace, findings: list[Finding]) -> int:
    """Print the findings; return 1 if one is a warning or an error, else 0."""
    bad = any(finding.severity in ("warning", "error") for finding in findings)
    if options.format == "json":
        print(json.dumps({"ok": not bad, "findings": [finding._asdict() for finding in findings]}))
    else:
        for finding in findings:
            sign, colour = SIGNS[finding.severity]
            print(f"{paint(sign, colour, on=coloured(sys.stdout))} {finding.what}: {finding.text}")
    return int(bad)


def _broker(opened: Probe, url: str, project: Project | None) -> Iterator[Finding]:
    with closing(opened) as probe:
        yield Finding("broker", "ok", f"{probe.product} {probe.version} at {probe.address}, as `{probe.user}`")
        if not url.startswith("amqps:") and not probe.place.startswith(("127.", "localhost", "[::1]")):
            yield Finding("broker", "warning", "the connection is not encrypted: use amqps://")
        if blocked := probe.taking():
            yield Finding("broker", "error", blocked)
            return
        if project is None:
            yield Finding("project", "error", "its files have errors: run `lumen lint`")
            return
        yield from _permissions(probe, project)
        with closing(connect(url)) as bus:
            attendance = RobotAttendance(bus, project)
            yield from _life(bus, project)
            yield from _obeying(probe, attendance, project)
            yield from _modules(attendance, project)
            yield from _skills(attendance, project)
        yield from _served(probe, project)
        faults = list(probe.misdeclared())
        yield from (Finding("dead letters", "error", fault) for fault in faults)
        if not faults:
            yield Finding("dead letters", "ok", f"unusable and undeliverable messages are kept in {side_queues(url)}")


def _other(options: argparse.Namespace, url: str, project: Project | None) -> Iterator[Finding]:
    if within_process(url):
        opened, what = reach(options).bus, "an exhibition with an embedded bus is running on this machine"
    else:
        opened, what = connect(url), f"the bus `{url.partition(':')[0]}://` can be reached"
    with closing(opened) as bus:
        yield Finding("bus", "ok", what)
        if project is None:
            yield Finding("project", "error", "its saved files have errors: run `lumen lint`")
        else:
            attendance = RobotAttendance(bus, project)
            yield from _life(bus, project)
            yield from _modules(attendance, project)
            yield from _skills(attendance, project)


def _permissions(probe: Probe, project: Project) -> Iterator[Finding]:
    refused = False
    for key, route in by_key(project).items():
        reading = route.direction is Direction.IN
        if reason := probe.reading(key) if reading else probe.writing(key):
            refused = True
            yield Finding("permissions", "error", f"`{route.name}` can't be {'read' if reading else 'sent'}: {reason}")
    if not refused:
        yield Finding("permissions", "ok", f"this user is allowed to use all {len(project.routes)} routes")


def _life(bus: Bus, project: Project) -> Iterator[Finding]:
    """Listen to the senses for LISTENING [s]; report those that do not arrive, and the difference of the clocks.

    Only routes with a period of at most half of that time count as senses.
    """
    routes, heard, skews = by_key(project), set[str](), list[float]()
    complete = threading.Event()

    def listen(message: Any) -> None:
        heard.add(message.key)
        if (skew := _skew(message.body)) is not None:
            skews.append(skew)
        if senses.keys() <= heard and skews:
            complete.set()

    senses = {key: route for key, route in routes.items() if route.every and route.every <= LISTENING / 2}
    for key in senses:
        with suppress(BusError):  # a route that this user may not read is reported by _permissions
            bus.subscribe(key, listen)
    complete.wait(LISTENING)
    silent = [route.name for key, route in senses.items() if key not in heard]
    if silent:
        text = f"no message came on {_names(silent)} in {LISTENING:g} s: check that the robot's process is running"
        yield Finding("senses", "warning", text)
    elif senses:
        yield Finding("senses", "ok", f"messages arrive on {_names([route.name for route in senses.values()])}")
    if not skews:
        yield Finding("clocks", "note", "no message had a timestamp to compare")
        return
    skew = min(skews, key=abs)
    text = f"this machine's clock and the robot's are {abs(skew):.1f} s apart"
    yield Finding("clocks", "warning" if abs(skew) > SKEW else "ok", text)


def _obeying(probe: Probe, attendance: RobotAttendance, project: Project) -> Iterator[Finding]:
    """Report whether the robot is alive if a process receives its commands; yield nothing if no process does."""
    route = project.routes.get(COMMAND_ROUTE)
    if route is None or not probe.served(project.key_of(COMMAND_ROUTE), route).readers:
        return
    if attendance.robot():
        yield Finding("robot", "ok", f"{project.robot} is connected")
    else:
        taken = f"a process receives `{COMMAND_ROUTE}`"
        text = f"{taken}, but {project.robot} shows no sign of life: end that process and start it again"
        yield Finding("robot", "warning", text)


def _modules(attendance: RobotAttendance, project: Project) -> Iterator[Finding]:
    """Report for each of the project's own modules whether it shows signs of life, else whether its program exists."""
    own = own_modules(project.modules)
    lacking = attendance.lacking(own) if own else set[str]()
    for name, module in own.items():
        program = module.command[0]
        if name not in lacking:
            yield Finding("modules", "ok", f"`{name}` shows signs of life")
        elif module.here and not _found(program, project):
            yield Finding("modules", "error", f"`{name}` can't be started: there is no program `{program}`")
        else:
            hint = "`lumen status` prints why" if module.here else f"start it: {' '.join(module.command)}"
            yield Finding("modules", "warning", f"`{name}` shows no sign of life: {hint}")


def _skills(attendance: RobotAttendance, project: Project) -> Iterator[Finding]:
    """Report for each of the project's skills whether the robot's process has its program, or its module is alive."""
    modules = {name: module for name, row in project.verbs.items() if (module := _module_of(row))}
    lacking = attendance.lacking(set(modules.values())) if modules else set[str]()
    for name, module in modules.items():
        if module in lacking:
            text = f"`{name}` fails: the module `{module}` shows no sign of life"
            yield Finding("skills", "warning", text)
        else:
            yield Finding("skills", "ok", f"`{name}` is performed by the module `{module}`")
    own = [name for name in project.verbs if name not in modules]
    installed = attendance.await_skills() if own else None
    if own and installed is None:
        yield Finding("skills", "note", f"no running process has the programs of {_names(own)}")
        return
    for name in own:
        if installed and name in installed:
            yield Finding("skills", "ok", f"the program of `{name}` is installed (hash {str(installed[name])[:12]})")
        else:
            text = f"the robot's process has no program of `{name}`: copy its files there, and reload"
            yield Finding("skills", "warning", text)


def _module_of(row: VerbRow) -> str:
    """Return the module that performs a skill; empty if a program does."""
    return row.details.module if isinstance(row.details, PerformedByModule) else ""


def _found(program: str, project: Project) -> bool:
    if os.path.basename(program) != program:
        program = os.path.join(project.root, program)
    path = os.pathsep.join((os.path.dirname(sys.executable), os.environ.get("PATH", os.defpath)))
    return shutil.which(program, path=path) is not None


def _served(probe: Probe, project: Project) -> Iterator[Finding]:
    """Report which routes with messages that must arrive have a reader.

    A missing motion module is only a note: the brain replaces it.
    """
    taken: list[str] = []
    for key, route in by_key(project).items():
        if not route.must_arrive or route.direction is not Direction.IN:
            continue
        served = probe.served(key, route)
        if served.readers:
            taken.append(route.name)
        elif route.name == MOTION:
            yield Finding("routes", "note", "no motion module is running: the brain plays motions itself")
        else:
            waiting = f"; messages waiting: {served.waiting}" if served.waiting else ""
            yield Finding("routes", "warning", f"no process serves `{route.name}` ({key}){waiting}")
    if taken:
        yield Finding("routes", "ok", f"served: {_names(taken)}")


def _skew(body: Any) -> float | None:
    """Return the time from a body's `datePublished` to this machine's clock [s]; None if it has no valid date."""
    date = body.get("datePublished") if isinstance(body, dict) else None
    if not isinstance(date, str):
        return None
    try:
        at = datetime.fromisoformat(date)
    except ValueError:
        return None
    return (datetime.now(UTC) - (at if at.tzinfo else at.replace(tzinfo=UTC))).total_seconds()


def _names(names: list[str]) -> str:
    return ", ".join(f"`{name}`" for name in names)
