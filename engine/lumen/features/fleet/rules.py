"""Rules for fleet.yaml: names must exist, steps must grow, and connections must be encrypted."""

import base64
import binascii
from collections.abc import Iterable, Mapping
from urllib.parse import urlsplit

from lumen.features.fleet.rollouts.conditions import condition_faults
from lumen.features.fleet.settings import Fleet
from lumen.language.addresses import credentials_of, loopback
from lumen.language.diagnostics import ERROR, WARNING, Code, NodePath, did_you_mean
from lumen.lint.routes import PASSWORD_IN_FILE
from lumen.project.document_report import DocumentReport
from lumen.project.draft import ProjectDraft
from lumen.project.expressions import place_within
from lumen.project.project_folders import FLEET_FILE

BAD_CONDITION = Code("bad-condition", "fleet", ERROR, "the condition that stops a rollout can't be evaluated")
BAD_FLEET_KEY = Code("bad-fleet-key", "fleet", ERROR, "the `key` in fleet.yaml is not a public key")
FLEET_IN_CLEAR = Code(
    "fleet-in-clear", "fleet", WARNING, "messages between the houses and the centre are not encrypted"
)
SHRINKING_STEP = Code("shrinking-step", "fleet", ERROR, "a rollout step is no larger than the step before it")
UNKNOWN_HOUSE = Code("unknown-house", "fleet", ERROR, "a name refers to a house or robot that is not in the fleet")
UNKNOWN_GROUP = Code("unknown-group", "fleet", ERROR, "a rollout step names a group that does not exist")
UNKNOWN_MEASURE = Code(
    "unknown-measure", "fleet", ERROR, "a measure counts nothing, or refers to a measure that does not exist"
)

KEY_BYTES = 32


def check(draft: ProjectDraft) -> None:
    """Report errors in a project's fleet, if the project has one."""
    fleet, report = draft.beside.get(FLEET_FILE), draft.reports.get(FLEET_FILE)
    if isinstance(fleet, Fleet) and report is not None:
        check_fleet(fleet, report)
        _at_home(draft, fleet)


def _at_home(draft: ProjectDraft, fleet: Fleet) -> None:
    """Report the house in lumen.yaml if the fleet lacks it, else the robots that the fleet's house lacks."""
    settings, main = draft.settings, draft.main
    data = main.document.data if main else None
    if settings is None or main is None or not isinstance(data, Mapping) or "house" not in data:
        return
    house = fleet.houses.get(settings.house)
    if house is None:
        hint = did_you_mean(settings.house, fleet.houses, "available:")
        main(UNKNOWN_HOUSE, ("house",), f"fleet.yaml has no house `{settings.house}`", hint)
        return
    for name in settings.robots:
        if name not in house.robots:
            hint = did_you_mean(name, house.robots, "the house has")
            main(UNKNOWN_HOUSE, ("house",), f"the house `{settings.house}` has no robot `{name}` in fleet.yaml", hint)


def check_fleet(fleet: Fleet, report: DocumentReport) -> None:
    """Report errors in a fleet; its folder need not contain a project."""
    _key(fleet, report)
    addresses: list[tuple[NodePath, str]] = [(("centre", "broker"), fleet.centre)] if fleet.centre else []
    addresses += [(("houses", name, "broker"), house.broker) for name, house in fleet.houses.items()]
    for where, address in addresses:
        _address(address, where, report)
    for name, group in fleet.groups.items():
        _known(group.robots, fleet.robots, "robot", ("groups", name, "robots"), report)
        _known(group.houses, fleet.houses, "house", ("groups", name, "houses"), report)
    for name, measure in fleet.measures.items():
        if not measure.event and not measure.enters:
            hint = "write `event: NAME`, or `enters: STATE`"
            report(UNKNOWN_MEASURE, ("measures", name), "the measure counts nothing", hint, key=True)
        if measure.per and measure.per not in fleet.measures:
            hint = did_you_mean(measure.per, fleet.measures, "available:")
            report(UNKNOWN_MEASURE, ("measures", name, "per"), f"there is no measure `{measure.per}`", hint)
    _steps(fleet, report)
    _condition(fleet, report)


def _key(fleet: Fleet, report: DocumentReport) -> None:
    if not fleet.key:
        return
    try:
        sound = len(base64.b64decode(fleet.key, validate=True)) == KEY_BYTES
    except (binascii.Error, ValueError):
        sound = False
    if not sound:
        hint = "run `lumen fleet keygen`, which makes a pair of keys and prints the line to write here"
        report(BAD_FLEET_KEY, ("key",), "this is not a public key: a public key is 32 bytes, encoded in base64", hint)


def _address(address: str, where: NodePath, report: DocumentReport) -> None:
    if credentials_of(address):
        hint = "delete them here, and write NAME:PASSWORD into a file that LUMEN_BUS_CREDENTIALS names"
        report(PASSWORD_IN_FILE, where, "a user name and a password are in a file that others can read", hint)
        return
    try:
        parts = urlsplit(address)
        host = parts.hostname or ""
    except ValueError:
        return
    if parts.scheme == "amqp" and not loopback(host):
        report(FLEET_IN_CLEAR, where, f"messages to {host} are not encrypted", "write amqps://")


def _known(names: Iterable[str], known: Iterable[str], what: str, where: NodePath, report: DocumentReport) -> None:
    there = list(known)
    for i, name in enumerate(names):
        if name not in there:
            hint = did_you_mean(name, there, "available:")
            report(UNKNOWN_HOUSE, (*where, i), f"the fleet has no {what} `{name}`", hint)


def _steps(fleet: Fleet, report: DocumentReport) -> None:
    """Report unknown groups, and shares that are not larger than the share before; groups can have any size."""
    last = 0.0
    for i, step in enumerate(fleet.rollout.steps):
        where: NodePath = ("rollout", "steps", i, "to")
        if step.group and step.group not in fleet.groups:
            hint = did_you_mean(step.group, [*fleet.groups, "all"], "available:")
            report(UNKNOWN_GROUP, where, f"there is no group `{step.group}`", hint)
        if not step.group:
            if step.share <= last:
                hint = f"write a share above {100.0 * last:g}%, or delete the step"
                report(SHRINKING_STEP, where, f"{step} is not larger than the step before", hint)
            last = step.share


def _condition(fleet: Fleet, report: DocumentReport) -> None:
    source, where = fleet.rollout.abort_if, ("rollout", "abort-if")
    for fault in condition_faults(source, fleet.measures) if source else ():
        place = place_within(report.document, where, source, fault.offset, fault.length)
        report.diagnostics.append(BAD_CONDITION.at(place, fault.message, fault.hint))
