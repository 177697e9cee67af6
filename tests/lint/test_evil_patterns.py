"""No pattern from a file, a message schema or an expression tries one alternative after another.

Each program below would take Python's `re` longer than the universe is old. It may use so many seconds of the processor
that a busy machine does not matter; then the system ends it.
"""

import sys
from pathlib import Path

import pytest

from tests import ROOT
from tests.copying import copied_project
from tests.guarded import run_guarded

BASE = Path(__file__).parent / "pages" / "base"

MAX_CPU = 20
"""The most CPU time that a program may use [s]; they need a second."""

EVIL = ["^(a+)+$", "^(a|aa)*b$", "^((a*)*)*b$", "^(a|a?)+b$", "^(.*)*(.*)*b$", "^" + "a?" * 30 + "a" * 30 + "b$"]
TEXT = "a" * 10_000 + "!"
SHORT = "a" * 100 + "!"

BUS = """
from dataclasses import replace
from lumen.bus import connect
from tests.exhibits import project

FACE = "lumen.visual.face.detection"
for pattern in EVIL:
    for schema in (
        {"properties": {"name": {"pattern": pattern}}},
        {"patternProperties": {pattern: False}, "additionalProperties": False},
        {"patternProperties": {pattern: False}, "unevaluatedProperties": False},
        {"propertyNames": {"not": {"pattern": pattern}, "maxLength": 3}},
        {"oneOf": [{"properties": {"name": {"pattern": pattern}}}, {"patternProperties": {pattern: False}}]},
    ):
        with_schema = replace(project(), messages={**project().messages, "face.detection": schema})
        refused = []
        bus = connect("memory://hall", with_schema, on_refused=lambda key, reason: refused.append(reason))
        bus.subscribe(FACE, lambda message: None)
        connect("memory://hall").publish(FACE, {"name": TEXT, TEXT: 1})
        assert len(refused) == 1 or "oneOf" in schema, (pattern, schema, refused)
        bus.close()
"""

GUARD = """
from lumen.statechart import Event, Interpreter, Machine

SAID = {"assign": {"said": "event.data.long"}}

for pattern in EVIL:
    asked = {"guard": f"event.data.short.matches('{pattern}')", "target": "wrong"}
    machine = Machine.from_dict({
        "context": {"said": None},
        "types": {"said": {"type": ["string", "null"], "pattern": pattern}},
        "states": {
            "idle": {"on": {"said": [asked, {"target": "right", "actions": SAID}]}},
            "right": {"on": {"error": "kept"}},
            "kept": None,
            "wrong": None,
        },
    })
    running = Interpreter(machine)
    running.start()
    running.send(Event("said", data={"short": SHORT, "long": TEXT}))
    assert running.configuration == {"kept"}, (pattern, running.configuration)
    assert running.context["said"] is None
"""

LINT = """
import json, sys
from pathlib import Path
from lumen.cli.main import main

root = Path(sys.argv[1])
for pattern in EVIL:
    schema = {"type": "object", "properties": {"said": {"type": "string", "pattern": pattern}}}
    keys = {**schema, "patternProperties": {pattern: False}, "additionalProperties": False}
    for name, what in (("said", schema), ("keys", keys)):
        (root / "schemas/messages" / f"{name}.schema.json").write_text(json.dumps(what))
    types = f"{{said: {{type: string, pattern: {json.dumps(pattern)}}}}}"
    guard = f"context.said.matches('{pattern}')"
    (root / "behaviors/tour.yaml").write_text(
        f"context: {{said: {SHORT}}}\\ntypes: {types}\\nstates:\\n  idle:\\n"
        f"    on: {{touched: {{guard: {json.dumps(guard)}, target: awake}}}}\\n  awake:\\n    after: {{20s: idle}}\\n"
    )
    for route in ("said", "keys"):
        (root / "behaviors/stories" / f"{route}.yaml").write_text(
            f"behavior: tour\\nsteps:\\n  - message: {{route: {route}, body: {{said: {TEXT}, {SHORT}: 1}}}}\\n"
        )
    print(pattern)
    main(["lint", "--format", "concise", str(root)])
"""


@pytest.mark.parametrize("code", [pytest.param(BUS, id="a message on the bus"), pytest.param(GUARD, id="a guard")])
def test_it_ends(code: str) -> None:
    thinks(code)


def test_lint_ends(tmp_path: Path) -> None:
    copied_project(BASE, tmp_path)
    for folder in ("schemas/messages", "behaviors/stories"):
        (tmp_path / folder).mkdir(parents=True)
    routes = "".join(f"  {name}: {{key: lumen.{name}, direction: in, schema: {name}}}\n" for name in ("said", "keys"))
    with (tmp_path / "lumen.yaml").open("a") as file:
        file.write(f"routes:\n{routes}")
    said = thinks(LINT, str(tmp_path))
    assert said.count("wrong-value") == 3 * len(EVIL)


def thinks(code: str, *words: str) -> str:
    """Return the program's output; it is killed if it computes for too long."""
    limit = f"import resource; resource.setrlimit(resource.RLIMIT_CPU, ({MAX_CPU}, {MAX_CPU}))\n"
    begin = f"EVIL, TEXT, SHORT = {EVIL!r}, {TEXT!r}, {SHORT!r}\n"
    done = run_guarded([sys.executable, "-c", limit + begin + code, *words], cwd=ROOT, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr[-2_000:] or f"ended by signal {-done.returncode}"
    return str(done.stdout)
