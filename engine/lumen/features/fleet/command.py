"""`lumen fleet`: update the robots of many houses."""

import argparse
import getpass
import os
import signal
from collections.abc import Mapping
from functools import partial
from pathlib import Path
from typing import Any

from lumen.bus import Bus, connect
from lumen.cli.formats import configure_format, print_object
from lumen.errors import BusUnreachableError, ProjectError, UsageError
from lumen.features.fleet.bundle import messages_of
from lumen.features.fleet.serving import ServedCentre, fleet_in
from lumen.features.fleet.signing import Signer, generate
from lumen.features.fleet.text import fleet_lines, log_lines
from lumen.insight.changes import changes, risk, summary
from lumen.language.counts import counted
from lumen.language.fleet_keys import ORDER
from lumen.lint import check_files
from lumen.project.project_folders import FLEET_FILE
from lumen.project.units import seconds
from lumen.run.asking import OPERATOR_ANSWERS, send_request
from lumen.run.versions import version

WHATS: Mapping[str, str] = {
    "keygen": "make the key that signs bundles",
    "serve": "run the centre",
    "publish": "send a project to the centre as a bundle",
    "try": "let all robots try a bundle without switching to it",
    "rollout": "roll a bundle out to the robots, step by step",
    "log": "list incidents, and what was counted for each bundle",
    "status": "show the houses, the robots and the rollout",
    "pause": "pause the rollout",
    "go": "continue a rollout that is paused, or that waits because its result is unknown",
    "abort": "abort the rollout, and roll its robots back",
    "pin": "leave a robot out of rollouts",
    "unpin": "let a robot join rollouts again",
    "diff": "list what a bundle would change",
    "take-over": "take over from a centre that is no longer running",
}
LINES = {"status": fleet_lines, "log": log_lines}
KEY_FILE = "fleet.key"
ANSWER_TIMEOUT = 15.0


def configure(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of `lumen fleet` to the parser."""
    add = parser.add_argument
    add("what", choices=WHATS, metavar="WHAT", help="; ".join(f"{what}: {says}" for what, says in WHATS.items()))
    add("name", nargs="?", metavar="NAME", help="rollout, try, diff: a bundle's hash; pin: HOUSE/ROBOT")
    add("--project", metavar="DIR", help="the folder with fleet.yaml (default: this folder)")
    add("--bus", metavar="URL", help="the broker (default: LUMEN_BUS, then the one in fleet.yaml)")
    add("--key", metavar="FILE", type=Path, help=f"the private key (default: {KEY_FILE} in that folder)")
    add("--first", metavar="TO", help="rollout: the first step: a group, a share such as 10%%, or all")
    add("--then", metavar="TO", action="append", default=[], help="rollout: the next step; may be repeated")
    add("--pause", metavar="30min", help="rollout: how long each step is watched")
    add("--abort-if", metavar="TEXT", help="rollout: roll its robots back if this condition holds (see fleet.yaml)")
    add(
        "--try",
        dest="try_first",
        action="store_true",
        help="rollout: let all robots try the bundle before the first step",
    )
    add("--against", metavar="HASH", help="diff: the bundle to compare with (default: the last proved one)")
    configure_format(parser)


def run(options: argparse.Namespace) -> int:
    """Run the subcommand `options.what` and return 0. Raises UsageError, ProjectError or BusError if it fails."""
    root = Path(options.project or ".")
    match options.what:
        case "keygen":
            return _keygen(options, root)
        case "serve":
            return _serve(options, root)
        case "publish":
            answer = _publish(options, root)
        case "rollout":
            answer = _asked(options, root, {"bundle": _named(options), **_plan(options)})
        case "try":
            answer = _asked(options, root, {"bundle": _named(options)})
        case "diff":
            return _diff(options, root)
        case "pin" | "unpin":
            answer = _asked(options, root, {"robot": _named(options)})
        case "log":
            told = _asked(options, root, {}, "status")
            answer = {name: told[name] for name in ("incidents", "kinds", "numbers")}
        case _:
            answer = _asked(options, root, {})
    if options.format == "json":
        print_object(answer)
    elif options.what in LINES:
        print("\n".join(LINES[options.what](answer)))
    else:
        print(answer.get("bundle") or "done")
    return 0


def _keygen(options: argparse.Namespace, root: Path) -> int:
    file = options.key or root / KEY_FILE
    public = generate(file)
    if options.format == "json":
        print_object({"file": str(file), "key": public})
    else:
        print(f"{file} is the private key: let only the centre read it.\nAdd to fleet.yaml:\n\nkey: {public}")
    return 0


def _serve(options: argparse.Namespace, root: Path) -> int:
    bus = _connected(_address(options, root), "centre")
    try:
        tell = partial(print, flush=True)
        served = ServedCentre(root, _signer(options, root), bus, tell, _address(options, root))
    except BaseException:
        bus.close()
        raise
    for number in (signal.SIGINT, signal.SIGTERM):
        signal.signal(number, lambda *_: served.end())
    print(
        f"the centre of {counted(len(served.centre.fleet.robots), 'robot')}, on {bus_name(_address(options, root))}",
        flush=True,
    )
    try:
        served.run()
    finally:
        served.close()
    return 0


def bus_name(url: str) -> str:
    """Return an address without its user and password."""
    return url.rpartition("@")[2]


def _publish(options: argparse.Namespace, root: Path) -> dict[str, Any]:
    """Lint the project, send it to the centre as a bundle, and return the centre's answer.

    Raises ProjectError before sending if the project has errors.
    """
    found = version(options.name, root) if options.name else version(None, root)
    files = {path: content for path, content in found.files.items() if path != FLEET_FILE}
    answer: dict[str, Any] = {}
    for body in messages_of(files, _signer(options, root)):
        answer = _asked(options, root, {"bundle": body})
    return answer


def _plan(options: argparse.Namespace) -> dict[str, Any]:
    steps = [*([options.first] if options.first else []), *options.then]
    plan: dict[str, Any] = {"steps": steps} if steps else {}
    if options.pause is not None:
        pause = seconds(options.pause)
        if pause is None:
            raise UsageError(f"invalid `--pause {options.pause}`: write a duration such as 30min or 90s")
        plan["pause"] = pause
    plan |= {"try": True} if options.try_first else {}
    return plan | ({"abort-if": options.abort_if} if options.abort_if is not None else {})


def _diff(options: argparse.Namespace, root: Path) -> int:
    proved = [] if options.against else _asked(options, root, {}, "status")["proved"]
    base = options.against or next(reversed(proved), "")
    if not base:
        raise UsageError("no bundle is proved yet: pass `--against HASH` to choose the one to compare with")
    projects = []
    for name in (base, _named(options)):
        files = _asked(options, root, {"bundle": name}, "files")["files"]
        project, diagnostics = check_files(root, {path: text.encode() for path, text in files.items()})
        if project is None:
            raise ProjectError(diagnostics)
        projects.append(project)
    found = changes(*projects)
    if options.format == "json":
        print_object(
            {"changes": [str(change) for change in found], "risk": str(risk(found)), "summary": summary(found)}
        )
    else:
        print("\n".join(map(str, found)) or "no differences")
    return 0


def _asked(options: argparse.Namespace, root: Path, body: Mapping[str, Any], what: str = "") -> dict[str, Any]:
    """Return the centre's answer to a request, without `ok`.

    Raises UsageError, with the centre's reason, for a refusal, and BusError if no centre answers.
    """
    url = _address(options, root)
    bus = _connected(url, "lumen fleet")
    question = {"ask": what or options.what, "by": getpass.getuser(), **body}
    try:
        answer = next(send_request(bus, ORDER, question, OPERATOR_ANSWERS, first=ANSWER_TIMEOUT))
    except BusUnreachableError:
        raise BusUnreachableError(f"no centre answers on {bus_name(url)}: start it with `lumen fleet serve`") from None
    finally:
        bus.close()
    if not isinstance(answer, dict) or not answer.pop("ok", False):
        raise UsageError(str(answer.get("reason")) if isinstance(answer, dict) else "the centre's answer is not valid")
    return answer


def _connected(url: str, sender: str) -> Bus:
    """Return a connection to the centre's bus. Raises BusError, with the remedy, if that fails."""
    try:
        return connect(url, sender=sender)
    except BusUnreachableError as error:
        raise BusUnreachableError(f"{error} (set the centre's broker with --bus, LUMEN_BUS or fleet.yaml)") from None


def _address(options: argparse.Namespace, root: Path) -> str:
    url = options.bus or os.environ.get("LUMEN_BUS") or fleet_in(root).centre
    if not url:
        raise UsageError("no broker is set: pass `--bus URL`, or write `centre: {broker: …}` in fleet.yaml")
    return str(url)


def _signer(options: argparse.Namespace, root: Path) -> Signer:
    return Signer(options.key or root / KEY_FILE)


def _named(options: argparse.Namespace) -> str:
    if not options.name:
        what = "HOUSE/ROBOT" if "pin" in options.what else "a bundle's hash, as `lumen fleet publish` prints it"
        raise UsageError(f"lumen fleet {options.what} needs {what}")
    return str(options.name)
