"""`lumen memory`: lists what the database module has stored, and forgets a visitor permanently."""

import argparse
import json
import os
from collections.abc import Iterator
from contextlib import suppress
from pathlib import Path

from lumen.bus.addresses import within_process
from lumen.cli.projects import shown_project
from lumen.cli.reach import configure_robot_name
from lumen.errors import BusClosedError, BusUnreachableError, UsageError
from lumen.features.visitors.memory import DATABASE_FILE
from lumen.features.visitors.module import Store
from lumen.language.counts import counted
from lumen.language.iso_time import local_time
from lumen.language.people import name_key
from lumen.language.routing_keys import default_key
from lumen.ports import Bus
from lumen.project.building import draft
from lumen.project.files import read_files
from lumen.project.home import home_of
from lumen.project.main_file import main_settings
from lumen.project.settings import Settings
from lumen.run.asking import OPERATOR_ANSWERS, send_request
from lumen.run.forgetting.added import (
    FORGOT,
    OF_A_PACKAGE,
    Forgetting,
    ForgottenPlace,
    forgetting_packages,
    of_package,
    out_of_reach,
)
from lumen.run.forgetting.files import forget_in, naming_inputs
from lumen.run.one_robot import one_robot
from lumen.run.parts.forgetting import FORGETTING_SPACING
from lumen.run.reaching import reach_exhibition

ANSWER_TIMEOUT = 2.0
"""The time in which a running exhibition's memory must answer [s]; without an answer, all modules are notified."""

WHATS = ("visitors", "journal", "forget")
PLACES = {"deleted": "deleted", "asked": "asked", "left": "STILL THERE", "elsewhere": "not here"}
"""The lists of places in a `Forgetting`, with their titles."""


def configure(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of `lumen memory` to the parser."""
    add = parser.add_argument
    add("what", choices=WHATS, help="list the visitors or the journal, or forget a visitor permanently")
    add(
        "name",
        nargs="?",
        metavar="NAME",
        help="forget: the visitor; journal: list only entries about this visitor",
    )
    add(
        "--project",
        metavar="PROJECT",
        help="the project's folder (default: this folder or one above, else the shipped project)",
    )
    add("--bus", metavar="URL", help="forget: the exhibition's bus (default: LUMEN_BUS, then this machine)")
    configure_robot_name(parser)
    add("--limit", metavar="N", type=int, default=50, help="journal: the newest N entries (default: 50)")
    add("--format", choices=("text", "json"), default="text", help="output format (default: text)")


def run(options: argparse.Namespace) -> int:
    """List the stored data or forget a visitor; return the exit code. Raises UsageError if nothing can be listed."""
    root = shown_project(options.project)
    folder = home_of(root, one_robot(root, options.robot_name))
    if options.what == "forget":
        return _forget(options, root, folder)
    file = folder / DATABASE_FILE
    if not file.exists():
        raise UsageError(f"nothing is remembered: there is no {file}")
    store = Store(file)
    try:
        return _list(options, store, file)
    finally:
        store.close()


def _list(options: argparse.Namespace, store: Store, file: Path) -> int:
    """Print the visitors or entries, and return 0. Raises ModuleError if the database is unusable."""
    rows = (
        store.visitors()
        if options.what == "visitors"
        else store.journal(visitor=options.name or "", limit=options.limit)
    )
    if options.format == "json":
        print(json.dumps(rows, ensure_ascii=False))
        return 0
    for row in rows:
        print(_visitor(row) if options.what == "visitors" else _entry(row))
    print(f"{len(rows)} {'visitors' if options.what == 'visitors' else 'entries'}; {file}")
    return 0


def _forget(options: argparse.Namespace, root: Path, folder: Path) -> int:
    """Forget a visitor and print the result; return 0 if data was deleted and none within reach is left, else 1.

    Raises UsageError without a name.
    """
    if not name_key(options.name or ""):
        raise UsageError("name the visitor: `lumen memory forget NAME`")
    found, settings = Forgetting(), main_settings(root, one_robot(root, options.robot_name))
    named, packages = naming_inputs(folder, options.name), forgetting_packages()
    broker, whole = _tell_running(options, settings, found, packages), draft(read_files(root)).settings
    forget_in(folder, options.name, found)
    named -= naming_inputs(folder, options.name) | {place.where for place in found.deleted}
    found.deleted += [ForgottenPlace(file, "the name, by the running exhibition") for file in sorted(named)]
    found.elsewhere += [of_package(package, OF_A_PACKAGE) for package in packages]
    found.elsewhere += out_of_reach(whole.routes.values() if whole else (), broker)
    if options.format == "json":
        print(json.dumps(_told(found), ensure_ascii=False))
    else:
        for line in _lines(options.name, folder, found):
            print(_plain(line))
    return 0 if found.deleted and not found.left else 1


def _tell_running(
    options: argparse.Namespace, settings: Settings | None, found: Forgetting, packages: dict[str, str]
) -> str:
    """Let the running exhibition forget the visitor too; return the broker's address, empty without a broker.

    The packages that it called are removed from `packages`.
    """
    try:
        reached = reach_exhibition(options.project, options.bus, options.robot_name)
    except BusUnreachableError as error:
        url = options.bus or os.environ.get("LUMEN_BUS") or (settings.bus if settings else "")
        if url and not within_process(url):
            found.left.append(ForgottenPlace("the running exhibition", str(error)))
        return "" if within_process(url) else url
    try:
        _request(reached.bus, settings or Settings(), options.name, found)
        if packages:
            _ask_packages(reached.bus, _key(settings or Settings(), "forgotten"), options.name, found, packages)
    finally:
        reached.bus.close()
    return reached.broker


def _ask_packages(bus: Bus, key: str, name: str, found: Forgetting, packages: dict[str, str]) -> None:
    """Wait until the running exhibition has called the packages; move them from `packages` to the result."""
    timeout = ANSWER_TIMEOUT + FORGETTING_SPACING
    with suppress(BusUnreachableError, BusClosedError):
        answer = next(send_request(bus, key, {"name": name}, OPERATOR_ANSWERS, first=timeout))
        for package in sorted(packages.keys() & answer["packages"].keys()):
            fault = answer["packages"][package]
            (found.left if fault else found.asked).append(of_package(package, fault or FORGOT))
            del packages[package]


def _request(bus: Bus, settings: Settings, name: str, found: Forgetting) -> None:
    """Send the request to the running memory, which notifies the other modules; without an answer, notify them here."""
    try:
        answer = next(
            send_request(
                bus, _key(settings, "fact"), {"method": "forget", "name": name}, OPERATOR_ANSWERS, first=ANSWER_TIMEOUT
            )
        )
    except BusUnreachableError:
        bus.publish(_key(settings, "forgotten"), {"name": name})
        return
    match answer:
        case {"ok": True, "visitors": int(visitors), "entries": int(entries)}:
            found.visitors, found.entries = visitors, entries
            if visitors or entries:
                what = f"visitors: {visitors}, entries of the journal: {entries}"
                found.deleted.append(ForgottenPlace("the running memory", what))
        case _:
            reason = answer.get("reason") if isinstance(answer, dict) else answer
            found.left.append(ForgottenPlace("the running memory", str(reason)[:500]))


def _key(settings: Settings, route: str) -> str:
    row = settings.routes.get(route)
    return row.key_for(settings.robot) if row else default_key(route, settings.robot)


def _told(found: Forgetting) -> dict[str, object]:
    return {
        **{"visitors": found.visitors, "entries": found.entries, "pictures": found.pictures},
        **{name: [place._asdict() for place in getattr(found, name)] for name in PLACES},
        "others": list(found.others),
    }


def _lines(name: str, folder: Path, found: Forgetting) -> Iterator[str]:
    visitors, pictures = counted(found.visitors, "visitor"), counted(found.pictures, "picture")
    counts = f"{visitors}, {counted(found.entries, 'entry', 'entries')}, {pictures}"
    yield f"forgot {name}: {counts}" if found.deleted else f"{folder} has nothing about {name}"
    for kind, title in PLACES.items():
        yield from (f"  {title}: {where}: {what}" for where, what in getattr(found, kind))
    if found.others:
        yield f"  still remembered, because their names only contain this name: {', '.join(found.others)}"


def _visitor(row: dict[str, object]) -> str:
    return _plain(f"{_when(row['last'])}  {row['name']}, visits: {row['visits']}")


def _entry(row: dict[str, object]) -> str:
    about = f" [{row['visitor']}]" if row["visitor"] else ""
    return _plain(f"{_when(row['time'])}  {row['kind']:<10} {row['text']}{about}")


def _when(moment: object) -> str:
    return local_time(float(str(moment)))


def _plain(text: str) -> str:
    """Return the text with unprintable characters, which could control a terminal, replaced."""
    return "".join(sign if sign.isprintable() else "\N{REPLACEMENT CHARACTER}" for sign in text)
