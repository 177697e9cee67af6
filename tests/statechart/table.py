"""Cases from YAML: a small machine, its events, and the expected outcome."""

from collections.abc import Mapping
from dataclasses import fields
from pathlib import Path
from typing import Any

from lumen.language.commands import Cancel, Command, Log, Publish, Start
from lumen.project.yaml_reader import parse
from lumen.statechart import Interpreter, Machine, Step
from tests.scanning import matching

CASES = matching(Path(__file__).parent / "cases", "*.yaml")


def read(path: Path) -> Mapping[str, Any]:
    document, diagnostics = parse(path.name, path.read_bytes())
    assert document is not None
    assert not diagnostics
    return document.data


def play(case: Mapping[str, Any]) -> list[tuple[Mapping[str, Any], Mapping[str, Any]]]:
    """Return the expectation and the outcome of each step of a case, both with the expected keys only.

    Steps are `start` (again, from the beginning), `send` with `data`, and `wait` [s].
    """
    machine = Machine.from_dict(case["machine"], behaviors=case.get("behaviors"), words=case.get("words"))
    steps: list[Step] = []
    found = []
    interpreter: Interpreter | None = None
    for row in case["steps"]:
        steps.clear()
        if interpreter is None or "start" in row:
            interpreter = Interpreter(machine, observe=steps.append)
            interpreter.start()
        if "send" in row:
            steps.clear()
            interpreter.send(row["send"], row.get("data"))
        elif "wait" in row:
            steps.clear()
            interpreter.clock.wait(interpreter.clock.now() + row["wait"])
        expected = row.get("start") or row.get("expect") or {}
        seen = outcome(steps, interpreter)
        found.append((expected, {key: seen[key] for key in expected}))
    return found


def outcome(steps: list[Step], interpreter: Interpreter) -> dict[str, Any]:
    """Return everything that a case may expect of some steps; the configuration in document order."""
    commands = [command for step in steps for command in step.commands]
    return {
        "exited": [name for step in steps for name in step.exited],
        "entered": [name for step in steps for name in step.entered],
        "raised": [event.name for step in steps for event in step.raised],
        "log": [command.text for command in commands if isinstance(command, Log)],
        "commands": [shown(command) for command in commands if not isinstance(command, Log)],
        "configuration": interpreter.snapshot()["configuration"],
        "context": interpreter.context,
    }


def shown(command: Command) -> str:
    match command:
        case Start(id, body):
            told = [f.name for f in fields(body) if f.metadata.get("yaml", True)]
            values = [getattr(body, name) for name in told if name != "gestures" or getattr(body, name)]
            words = [f"{round(v, 5)}" if isinstance(v, float) else str(v) for v in values]
            if type(body).__name__ == "Say":
                words.reverse()
            return " ".join(["start", id, type(body).__name__, *words])
        case Cancel(id):
            return f"cancel {id}"
        case Publish(route, body):
            return f"publish {route} {body}"
        case Log(text):
            return f"log {text}"
