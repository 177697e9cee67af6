"""The functions of a project, from their files to what runs: loaded, tried, compared, reloaded."""

import json
import shutil
import xml.etree.ElementTree as ET
from pathlib import Path

import pytest

from lumen.cli.main import main
from lumen.errors import ProjectError
from lumen.expressions import Scope
from lumen.insight.changes import Risk, changes, risk
from lumen.insight.explaining.conditions import parts
from lumen.language.events import Event
from lumen.lint import check_files
from lumen.project import load
from lumen.project.files import read_files
from lumen.statechart import Machine, initial, step
from tests import ROOT

BEHAVIOR = """\
context: {guests: 0}
states:
  waiting:
    on:
      face: {guard: "is_room(context.guests, 4)", target: greeting, actions: {assign: {guests: more(context.guests)}}}
  greeting: {do: {say: {en: "{{ greeting('Budi', hour()) }}!"}}, onDone: waiting}
"""
FUNCTIONS = {
    "greeting": """\
description: {en: How to greet someone., id: Salam.}
args: {name: text, hour: number}
expression: "part_of_day(hour) + ', ' + name"
examples:
  - {args: {name: Budi, hour: 9}, value: "Good morning, Budi"}
  - args: {name: Ana, hour: 20}
    value: Good evening, Ana
""",
    "part_of_day": "args: {hour: number}\nexpression: \"hour < 12 ? 'Good morning' : 'Hello'\"\n",
    "is_room": "args: {guests: number, most: number}\nexpression: guests >= 0 && guests < most\n",
    "more": "args: {n: number}\nexpression: n + 1\nexamples: [{args: {n: 1}, value: 2}]\n",
}


@pytest.fixture
def root(tmp_path: Path) -> Path:
    """A project with four functions, of which one calls another."""
    root = tmp_path / "hall"
    shutil.copytree(ROOT / "examples/minimal", root, ignore=shutil.ignore_patterns(".lumen", "stories"))
    (root / "functions").mkdir()
    for name, text in FUNCTIONS.items():
        (root / f"functions/{name}.yaml").write_text(text)
    for file in (root / "behaviors").glob("*.yaml"):
        file.write_text(BEHAVIOR)
    main_file = root / "lumen.yaml"
    lines = [line for line in main_file.read_text().splitlines() if not line.startswith("story:")]
    main_file.write_text("\n".join(lines) + "\n")
    return root


def write(root: Path, name: str, old: str, new: str) -> None:
    file = root / f"functions/{name}.yaml"
    assert old in file.read_text()
    file.write_text(file.read_text().replace(old, new))


def test_a_function_runs_in_guards_values_and_texts(root: Path) -> None:
    machine = load(root).machine
    start = initial(machine)
    taken = step(machine, start.snapshot, Event("face", {}))
    assert taken.snapshot.context["guests"] == 1
    assert taken.entered == ("greeting",)


def test_what_the_definition_says(root: Path) -> None:
    function = load(root).functions["greeting"]
    assert function.signature == "greeting(name, hour)"
    assert function.returns == ("text",)
    assert function.described("id") == "Salam."
    assert function.described("de") == "How to greet someone."
    assert function.expanded == "(hour < 12 ? 'Good morning' : 'Hello') + ', ' + name"


def test_a_changed_function_is_a_changed_behavior(root: Path) -> None:
    """The journal and the reload know a behaviour by its hash; one that calls other functions keeps its hash."""
    before = load(root)
    write(root, "part_of_day", "12", "11")
    after = load(root)
    assert after.machine.hash != before.machine.hash
    found = changes(before, after)
    assert risk(found) is Risk.BEHAVIOR
    assert "function `part_of_day` is now `hour < 11 ? 'Good morning' : 'Hello'`, not" in " ".join(map(str, found))


def test_other_examples_change_nothing_that_runs(root: Path) -> None:
    before = load(root)
    write(root, "more", "value: 2", "value: 2.0")
    write(root, "more", "n: 1}", "n: 0}")
    after = load(root)
    assert [(c.sentence, c.risk) for c in changes(before, after)] == [
        ("function `more` has other examples", Risk.COSMETIC)
    ]
    assert after.machine.hash == before.machine.hash


def test_why_names_the_call_and_its_values(root: Path) -> None:
    guard = load(root).machine.states["waiting"].transitions[0].guard
    assert guard
    found = parts(guard, Scope(context={"guests": 7}))
    assert [(part.text, part.holds) for part in found] == [("context.guests >= 0", True), ("context.guests < 4", False)]
    assert guard.shown == "is_room(context.guests, 4)"


def test_lumen_test_tries_the_examples(root: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["test", str(root)]) == 1
    assert capsys.readouterr().out.splitlines() == [
        "",
        "functions: 2 of 3 examples",
        "  functions/greeting.yaml:6:5: `greeting('Ana', 20)`: it is 'Hello, Ana', but should be 'Good evening, Ana'",
    ]


def test_examples_are_counted_with_the_stories(root: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (root / "behaviors/stories").mkdir()
    story = root / "behaviors/stories/nobody.yaml"
    story.write_text("steps: [{expect: {state: waiting}}]\n")
    assert main(["test", str(root)]) == 1
    assert capsys.readouterr().out.splitlines()[-1].startswith("1 story and 3 examples, 1 failed: ")


def test_examples_for_other_programs(root: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["test", str(root), "--format", "json"]) == 1
    found = json.loads(capsys.readouterr().out)["examples"]
    assert [each["call"] for each in found if not each["passed"]] == ["greeting('Ana', 20)"]
    assert {each["file"] for each in found} == {"functions/greeting.yaml", "functions/more.yaml"}
    assert main(["test", str(root), "--format", "junit"]) == 1
    suites = ET.fromstring(capsys.readouterr().out).findall("testsuite")
    assert [(suite.get("name"), suite.get("tests"), suite.get("failures")) for suite in suites] == [
        ("functions", "3", "1")
    ]


def test_an_example_without_a_value_is_told(root: Path, capsys: pytest.CaptureFixture[str]) -> None:
    write(root, "more", "n + 1", "10 / (n - 1) + n")
    assert main(["test", str(root)]) == 1
    assert "`more(1)`: it has no value, but should be 2: " in capsys.readouterr().out


def test_a_broken_function_is_one_finding(root: Path) -> None:
    write(root, "part_of_day", "'Hello'", "'Hello' +")
    project, found = check_files(root, read_files(root))
    assert project is None
    assert [(d.code, d.place.file) for d in found] == [("expression-syntax", "functions/part_of_day.yaml")]


def test_a_behavior_without_its_project_finds_its_functions(root: Path) -> None:
    machine = Machine.load(root / "behaviors/hello.yaml")
    assert machine.states["waiting"].transitions[0].guard == load(root).machine.states["waiting"].transitions[0].guard
    write(root, "more", "n + 1", "n + ")
    with pytest.raises(ProjectError, match=r"functions/more.yaml:2:15: error \[expression-syntax\]"):
        Machine.load(root / "behaviors/hello.yaml")
