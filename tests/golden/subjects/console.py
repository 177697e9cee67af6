"""Answers of the console in a scripted visit: the state of a robot, its events, and each command.

An exhibition and its console run as processes of their own, in real time. The behaviour waits for events alone, and
each step of the visit for the one before, so that only times differ: those, ages, numbers of processes, ports, random
names, and readings of the robot's senses are left out. Entries and commands have a file each: their order is not fixed.
"""

import json
import re
import shutil
import sys
import tempfile
from collections.abc import Callable
from pathlib import Path
from typing import Any

from tests import ROOT
from tests.golden.exhibitions import plain, small
from tests.golden.served import HANG, Answer, Served
from tests.golden.warm import environment
from tests.guarded import PIPE, STDOUT, run_guarded
from tests.waiting import until

SUITE = "rest"
BEHAVIOR = """\
entry: {wake: true}
context: {visitor: "", visits: 0}
phrases: {bye: {en: [goodbye, bye]}}
states:
  closed:
    buttons: [{label: {en: Open}, event: opens, key: o}]
    on: {opens: {target: open, actions: {assign: {visits: context.visits + 1}}}}
  open:
    initial: idle
    buttons:
      - {label: {en: Close}, event: closes, confirm: hold}
      - {label: {en: Call Ani}, event: calls, data: {name: Ani}}
    on: {closes: closed}
    states:
      idle:
        on:
          calls: {target: talking, actions: {assign: {visitor: event.data.name}}}
          heard: [{guard: "heard(event.data.result, 'bye')", target: leaving, approve: {by: operator}}]
      talking: {do: {say: {en: "Nice to meet you, {{ context.visitor }}."}}, onDone: idle}
      leaving: {do: [{play: wave}, {say: {en: Goodbye!}}], onDone: idle}
"""
LAST = "nothing.takes.this"
"""The last event of the visit."""
PINS = {"LUMEN_PIN_SHOW": "show-1234", "LUMEN_PIN_OPERATOR": "operator-1234", "LUMEN_PIN_AUTHOR": "author-1234"}
HEADERS = ("cache-control", "content-type", "lumen-state", "retry-after")
"""Headers that a page or a proxy reads."""
GUARDS = (
    "content-security-policy",
    "x-frame-options",
    "x-content-type-options",
    "referrer-policy",
    "permissions-policy",
)
"""Those that guard a browser; they are the same for all answers, and kept of the page alone."""
UNFIXED = {
    *("time", "at", "at_time", "since", "began", "due", "ends", "until", "from_time", "seconds", "ahead"),
    *("process", "host", "session", "realtime", "seen", "senses", "digest", "took", "progress", "probation"),
}
"""Keys whose values depend on when, how fast or where; only that they are there is kept."""


def record(folder: Path) -> None:
    with tempfile.TemporaryDirectory() as place:
        here = Path(place).resolve()
        _visit(here, folder)
        _roles(here, folder)


def _exhibition(folder: Path, more: str = "") -> Path:
    project = small(folder, more=more)
    shutil.rmtree(project / "behaviors/stories")
    main = project / "lumen.yaml"
    main.write_text(re.sub(r"(story: visitor|  face: ).*\n", "", main.read_text("utf-8")), "utf-8")
    (project / "behaviors/hello.yaml").write_text(BEHAVIOR, "utf-8")
    return project


def _visit(here: Path, folder: Path) -> None:
    project = _exhibition(here / "visit" / "small")
    with Served(project, here / "visit") as served, served.listening("/api/events?after=0") as events:
        pages = _Pages(project)
        pages.add("now, closed", served.settled(_in("closed")))
        pages.add("command event, a button", served.command("event", event="opens"))
        pages.add("now, open", served.settled(_in("open.idle")))
        pages.add("command event, with data", served.command("event", event="calls", data={"name": "Ani"}))
        pages.add("now, after a talk", served.settled(_in("open.idle")))
        pages.add("command event, which waits", served.command("event", event="heard", data={"result": "goodbye"}))
        waiting = served.settled(lambda robot: bool(robot["waiting"]))
        pages.add("now, something waits", waiting)
        approval = waiting["waiting"][0]["id"]
        pages.add("command approve", served.command("approve", approval=approval, go=True))
        pages.add("now, after it", served.settled(_in("open.idle")))
        for name, fields in RIGHT.items():
            pages.add(f"command {name}", served.command(**fields))
            served.settled(_in("open"))
        pages.add("command rest", served.command("rest"))
        pages.add("now, at rest", served.settled(lambda robot: robot["stopped"]))
        pages.add("command say, at rest", served.command("say", text="No."))
        pages.add("command resume", served.command("resume"))
        pages.add("now, resumed", served.settled(lambda robot: not robot["stopped"]))
        for name, fields in WRONG.items():
            pages.add(f"wrong: {name}", served.command(**fields))
        for name, (method, path, data, headers) in ASKED.items():
            pages.add(f"asked: {name}", served.ask(method, path, data, **headers))
        pages.say("a console on a port that is in use", _second(served, here))
        until(lambda: any(data.get("heard") == LAST for _, data in events), HANG)
        pages.write(folder / "answers.txt")
        entries = [data for kind, data in events if kind == "entry"]
        commands = [data for kind, data in events if kind == "command"]
    _write(folder / "events-entries.txt", [_line(project, entry) for entry in entries])
    _write(folder / "events-commands.txt", [_line(project, command) for command in commands])


RIGHT: dict[str, dict[str, Any]] = {
    "say": {"command": "say", "text": "Mind the step."},
    "motion": {"command": "motion", "name": "wave"},
    "posture": {"command": "posture", "name": "Stand"},
    "mark": {"command": "mark", "text": "here"},
    "goto": {"command": "goto", "state": "open.idle"},
    "autonomy": {"command": "autonomy", "level": "alone"},
    "autonomy, back": {"command": "autonomy", "level": "ask"},
    "model": {"command": "model", "on": False},
    "dry-run": {"command": "dry-run"},
    "reload": {"command": "reload"},
}
WRONG: dict[str, dict[str, Any]] = {
    "no command": {"command": None},
    "unknown command": {"command": "fly"},
    "unknown robot": {"command": "say", "text": "Hello", "robot": "Pepper"},
    "no text": {"command": "say"},
    "a text of blanks": {"command": "say", "text": "  "},
    "a text that is too long": {"command": "say", "text": "a" * 1_001},
    "a number as text": {"command": "say", "text": 3},
    "unknown motion": {"command": "motion", "name": "wavee"},
    "unknown posture": {"command": "posture", "name": "Handstand"},
    "unknown state": {"command": "goto", "state": "opn"},
    "unknown event": {"command": "event", "event": LAST},
    "data of an event that are none": {"command": "event", "event": "opens", "data": [1]},
    "no such approval": {"command": "approve", "approval": "1", "go": True},
    "an approval without go": {"command": "approve", "approval": "1"},
    "unknown autonomy": {"command": "autonomy", "level": "maybe"},
    "a model that is neither": {"command": "model", "on": "yes"},
    "nothing to apply": {"command": "apply"},
    "nothing to refuse": {"command": "refuse"},
    "nothing to roll back": {"command": "rollback"},
    "now that is no truth value": {"command": "reload", "now": "yes"},
}
SAME = {"id": "golden-1", "command": "say", "text": "Not said."}
ASKED: dict[str, tuple[str, str, Any, dict[str, str]]] = {
    "an id that was": ("POST", "/api/commands", SAME, {}),
    "an id that is none": ("POST", "/api/commands", {**SAME, "id": "a b"}, {}),
    "no id": ("POST", "/api/commands", {"command": "rest"}, {}),
    "no JSON": ("POST", "/api/commands", b"{", {}),
    "a list": ("POST", "/api/commands", [], {}),
    "an empty body": ("POST", "/api/commands", b"", {}),
    "no JSON by its type": ("POST", "/api/commands", b"command=rest", {"Content_Type": "text/plain"}),
    "a body that is too large": ("POST", "/api/commands", b'"' + b"a" * 70_000 + b'"', {}),
    "another method": ("GET", "/api/commands", None, {}),
    "now by POST": ("POST", "/api/now", {}, {}),
    "another host": ("GET", "/api/now", None, {"Host": "evil.example"}),
    "another page": ("POST", "/api/commands", SAME, {"Origin": "http://evil.example"}),
    "an unknown path": ("GET", "/api/later", None, {}),
    "a page": ("HEAD", "/", None, {}),
}


def _second(served: Served, here: Path) -> str:
    """Start one more console on the port of the first; return its output and exit code."""
    line = [sys.executable, "-m", "lumen", "console", served.project, "--port", served.port]
    done = run_guarded(line, cwd=ROOT, env=environment(here / "visit"), stdout=PIPE, stderr=STDOUT, text=True)
    return f"exit code {done.returncode}\n{done.stdout}".replace(str(served.port), "<port>")


def _roles(here: Path, folder: Path) -> None:
    pins = ", ".join(f"{name.rpartition('_')[2].lower()}: ${name}" for name in PINS)
    project = _exhibition(here / "roles" / "small", f"console: {{port: 8080, pins: {{{pins}}}}}\n")
    with Served(project, here / "roles", "--speed", "4", pins=PINS) as served:
        pages = _Pages(project)
        pages.add("now, without a role", served.ask("GET", "/api/now"))
        for role, pin in {"nobody": "", **{name.rpartition("_")[2].lower(): pin for name, pin in PINS.items()}}.items():
            named = {"Authorization": f"Bearer {pin}"} if pin else {}
            for number, (command, fields) in enumerate(ALLOWED.items()):
                data = {"id": f"{role}-{number}", "command": command, **fields}
                answer = served.ask("POST", "/api/commands", data, **named)
                pages.add(f"{role}: {command}", answer)
        pages.add("sign in with no PIN", served.ask("POST", "/api/session", {}))
        pages.add("sign in with a wrong PIN", served.ask("POST", "/api/session", {"pin": "wrong"}))
        pages.add("sign in", served.ask("POST", "/api/session", {"pin": PINS["LUMEN_PIN_SHOW"], "name": "Ani"}))
        pages.add("sign out", served.ask("DELETE", "/api/session"))
        pages.write(folder / "roles.txt")


ALLOWED: dict[str, dict[str, Any]] = {
    "mark": {"text": "x"},
    "event": {"event": "is.no.button"},
    "autonomy": {"level": "alone"},
    "dry-run": {},
    "rest": {},
    "resume": {},
}


class _Pages:
    """Answers in order, each under a title."""

    def __init__(self, project: Path) -> None:
        self._project, self._blocks = project, list[str]()

    def add(self, title: str, found: Answer | dict[str, Any]) -> None:
        if isinstance(found, dict):
            lines = _lines(self._project, found)
        else:
            kind = found.headers.get("content-type", "")
            names = HEADERS if "json" in kind else (*HEADERS, *GUARDS)
            headers = [f"{name}: {found.headers[name]}" for name in names if name in found.headers]
            body = _lines(self._project, found.data) if found.body and "json" in kind else [f"{len(found.body)} bytes"]
            lines = [f"status {found.status}", *headers, *(body if "json" in kind else [])]
        self._blocks.append("\n".join([f"# {title}", "", *lines, ""]))

    def say(self, title: str, text: str) -> None:
        self._blocks.append(f"# {title}\n\n{plain(text, self._project)}")

    def write(self, file: Path) -> None:
        _write(file, self._blocks)


def _in(state: str) -> Callable[[dict[str, Any]], bool]:
    return lambda robot: f'"{state}"' in json.dumps(robot["states"])


def _lines(project: Path, data: Any) -> list[str]:
    """Return a line for each key of an object; the position is left out, since it is that of the last written entry."""
    fixed = _fixed({**data, "position": "…"} if isinstance(data, dict) and "position" in data else data)
    if not isinstance(fixed, dict):
        return [plain(_json(fixed), project)]
    return [f"{key}: {plain(_json(value), project)}" for key, value in fixed.items()]


def _line(project: Path, data: Any) -> str:
    return plain(_json(_fixed(data)), project)


def _fixed(data: Any) -> Any:
    if isinstance(data, dict):
        return {key: "…" if _unfixed(key, value) else _fixed(value) for key, value in data.items()}
    return [_fixed(one) for one in data] if isinstance(data, list) else data


def _unfixed(key: str, value: Any) -> bool:
    return key == "probation" or (key in UNFIXED and value is not None)


def _json(data: Any) -> str:
    return json.dumps(data, ensure_ascii=False, sort_keys=True)


def _write(file: Path, lines: list[str]) -> None:
    file.write_text("\n".join(lines) + "\n", "utf-8")
