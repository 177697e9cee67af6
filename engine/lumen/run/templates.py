"""Files that `lumen new function NAME` and the like write into a project: valid at once, and meant to be edited."""

import re
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import NamedTuple

from lumen.errors import UsageError
from lumen.expressions.function_table import all_functions
from lumen.language.folders import DRIVERS_FOLDER, FUNCTIONS_FOLDER
from lumen.language.modules import module_names
from lumen.project.main_file import main_settings
from lumen.project.project_folders import MAIN_FILE

FUNCTION = """\
{schema}# A function: call it in an expression or a text, as `{name}(hour())`. What it can do: docs/extending.md
description: {{en: The part of the day at an hour.}}
args: {{hour: number}}
expression: "hour < 12 ? 'morning' : hour < 18 ? 'afternoon' : 'evening'"
examples:                  # `lumen test` checks them
  - {{args: {{hour: 9}}, value: morning}}
  - {{args: {{hour: 20}}, value: evening}}
"""
MODULE = '''\
"""The module `{name}`: `lumen run` starts it, prints its lines, and ends it. What it can do: docs/extending.md"""

from lumen.bus import join

with join() as module:
    print(f"{name} is here, beside {{module.robot}}")
    module.subscribe("heard", lambda message: print("a visitor said:", message.body.get("result")))
    while module.wait(1.0):  # it also sends signs of life
        pass
'''
ROBOT = '''\
"""A robot that prints what it is to do: put the calls of your robot in place of the prints.

    lumen run --robot {name}
    pytest --lumen-robot {name}

What each method promises: `lumen.ports.Robot`, and docs/extending.md
"""

import time
from collections.abc import Sequence

from lumen.language.commands import Posture, Rest, Say, Stop
from lumen.language.events import Event
from lumen.language.projects import Project
from lumen.ports import Aim, Live, Perform, Reading, Record, RobotCommand, Sense


class {class_name}:
    """No method blocks: `start` begins a command, and `poll` later returns its end."""

    def __init__(self, project: Project) -> None:
        self._body, self._born = project.body, time.monotonic()
        self._running: dict[str, tuple[RobotCommand, float]] = {{}}  # each with when it ends [s]
        self._events: list[Event] = []
        self._begun: list[str] = []

    def start(self, id: str, command: RobotCommand) -> None:
        if isinstance(command, Aim | Live):  # many a second, and not answered
            return
        if isinstance(command, Posture) and command.name not in self._body.postures:
            reason = f"the body {{self._body.name}} has no posture {{command.name}}"
            self._events.append(Event(f"error.command.{{id}}", {{"reason": reason}}, self._now()))
            return
        if isinstance(command, Rest | Stop):
            for other, (running, _) in list(self._running.items()):
                if isinstance(command, Rest) or command.what == "all" or ends(command.what, running):
                    self.cancel(other)
        print(f"{name}: {{command}}")
        self._begun.append(id)
        self._running[id] = command, self._now() + seconds(command)

    def cancel(self, id: str) -> None:
        if self._running.pop(id, None):
            self._events.append(Event(f"cancelled.command.{{id}}", None, self._now()))

    def poll(self) -> Sequence[Event]:
        over = [id for id, (_, end) in self._running.items() if end <= self._now()]
        for id in over:
            del self._running[id]
            self._events.append(Event(f"done.command.{{id}}", None, self._now()))
        events, self._events = self._events, []
        return events

    def begun(self) -> Sequence[str]:
        begun, self._begun = self._begun, []
        return begun

    def read(self, sense: Sense) -> Reading | None:
        return None  # a robot without senses; `lumen.ports` has the readings, such as `Joints`

    def close(self) -> None:
        self._running.clear()

    def _now(self) -> float:
        return time.monotonic() - self._born


def seconds(command: RobotCommand) -> float:
    """How long a command takes."""
    if isinstance(command, Say):
        return 0.06 * len(command.text)
    if isinstance(command, Record):
        return command.duration
    return command.motion.duration if isinstance(command, Perform) else 0.2


def ends(what: str, running: RobotCommand) -> bool:
    """Whether `stop: WHAT` ends a command."""
    return (what == "say" and isinstance(running, Say)) or (what == "play" and isinstance(running, Perform))
'''
_NAME = re.compile(r"[A-Za-z_]\w*", re.ASCII)


class Written(NamedTuple):
    """The result of writing a template."""

    files: tuple[str, ...]
    """The files written or changed, relative to the project."""
    next: tuple[tuple[str, str], ...]
    """The next steps, each with its purpose."""


def write_template(kind: str, name: str, root: Path) -> Written:
    """Write the files of one of `TEMPLATES` into a project.

    Raises UsageError, and writes nothing, for a name that can't be used or if a file exists; also, with the program of
    a module written, if lumen.yaml must be changed by hand. Raises OSError if a file can't be written.
    """
    if not _NAME.fullmatch(name):
        raise UsageError(f"a {kind} can't be called `{name}`: write letters, digits and `_`, beginning with a letter")
    return TEMPLATES[kind](name, root)


def _function(name: str, root: Path) -> Written:
    if name in all_functions():
        raise UsageError(f"the function `{name}` comes with Lumen: choose another name")
    led = (root / "schemas/function.schema.json").is_file()
    schema = "# yaml-language-server: $schema=../schemas/function.schema.json\n" if led else ""
    file = f"{FUNCTIONS_FOLDER}/{name}.yaml"
    _write(root, {file: FUNCTION.format(schema=schema, name=name)})
    return Written(
        (file,),
        (
            ("a text or a guard", f"call it there, such as {{{{ {name}(hour()) }}}}"),
            ("lumen lint", "what is wrong, and where"),
            ("lumen test", "tries its examples, too"),
        ),
    )


def _module(name: str, root: Path) -> Written:
    if name in module_names():
        raise UsageError(f"the module `{name}` comes with Lumen: choose another name")
    entry = f"{name}: {{command: [python3, {name}.py], here: true, health: 5s}}"
    main = root / MAIN_FILE
    text = _with_module(main.read_text("utf-8"), name, entry)
    _write(root, {f"{name}.py": MODULE.format(name=name)})
    main.write_text(text, "utf-8")
    settings = main_settings(root)
    assert settings is not None  # the file could be read before the change
    if name not in settings.modules:  # `modules` is written in an unusual way
        raise UsageError(f"wrote {name}.py; now add this line to `modules:` of {MAIN_FILE}: {entry}")
    steps = (
        (f"{name}.py", "what the module does"),
        ("lumen run", "starts it, and prints its lines"),
        ("lumen status", "how it is"),
    )
    return Written((f"{name}.py", MAIN_FILE), steps)


def _with_module(text: str, name: str, entry: str) -> str:
    """Return lumen.yaml with an entry in `modules`; unchanged if `modules` is written in an unusual way.

    Raises UsageError if there already is a module of that name.
    """
    lines = text.splitlines(keepends=True)
    at = next((i for i, line in enumerate(lines) if re.match(r"modules\s*:", line)), None)
    if at is None:
        return f"{text if text.endswith(chr(10)) or not text else text + chr(10)}modules:\n  {entry}\n"
    if re.search(rf"(?m)^\s+{name}\s*:|[{{,]\s*{name}\s*:", "".join(lines[at:])):
        raise UsageError(f"{MAIN_FILE} has a module `{name}` already: choose another name")
    if re.fullmatch(r"modules\s*:\s*(#.*)?\s*", lines[at]):
        below = next((line for line in lines[at + 1 :] if line.strip() and not line.lstrip().startswith("#")), "")
        indent = below[: len(below) - len(below.lstrip())] or "  "
        lines.insert(at + 1, f"{indent}{entry}\n")
    else:
        lines[at] = re.sub(r"(modules\s*:\s*\{)\s*(\}?)", lambda m: f"{m[1]}{entry}{m[2] or ', '}", lines[at], count=1)
    return "".join(lines)


def _robot(name: str, root: Path) -> Written:
    class_name = "".join(word[:1].upper() + word[1:] for word in name.split("_")) or name
    file = f"{DRIVERS_FOLDER}/{name}.py"
    _write(root, {file: ROBOT.format(name=name, class_name=class_name)})
    steps = (
        (file, "what the robot does with each command"),
        (f"lumen run --robot {name}", "the exhibition, performed by it"),
        (f"pytest --lumen-robot {name}", "whether it keeps the promises of a robot"),
    )
    return Written((file,), steps)


def _write(root: Path, files: Mapping[str, str]) -> None:
    """Write new files. Raises UsageError, and writes nothing, if one exists already."""
    for file in files:
        if (root / file).exists():
            raise UsageError(f"{root / file} already exists: choose another name, or delete the file")
    for file, text in files.items():
        path = root / file
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text, "utf-8")


TEMPLATES: Mapping[str, Callable[[str, Path], Written]] = {
    "function": _function,
    "module": _module,
    "robot": _robot,
}
"""The function that writes the files of each `lumen new KIND NAME`."""
