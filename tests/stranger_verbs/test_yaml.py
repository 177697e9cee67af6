"""A verb of a package in the YAML: in lint, in the editor, in diffs, in stories and in replay."""

import json
from pathlib import Path
from typing import Any

import pytest
from written_distribution import on_path, write_distribution

from lumen.cli.main import main
from lumen.features.console.entry_words import told_of
from lumen.features.editor.schemas import description_at, keys_at, values_at
from lumen.insight.changes.actions import described
from lumen.insight.explaining.words import of_deed
from lumen.language.actions import Action
from lumen.language.command_data import command_data
from lumen.language.commands import Do, Start
from lumen.language.events import RESULT, Event
from lumen.lint import check_files
from lumen.project.added_verbs import time_taken
from lumen.project.files import read_files
from lumen.project.formats.behavior_data import plain_action
from lumen.project.schema import load_schema
from lumen.statechart import Machine, deserialize, initial, serialize, step
from tests.stranger_verbs.conftest import HERE
from tests.tables import for_each

BLINK = Do("blink", {"times": 3, "eye": "both"})


def action(data: Any) -> Action:
    """Return the action that the loader makes of this data."""
    return machine({"do": [data]}).states["a"].do[0].action


def machine(state: dict[str, Any]) -> Machine:
    context = {"eye": "left", "blinked": 0}
    return Machine.from_dict({"id": "m", "context": context, "states": {"a": state, "b": {}}}, "m")


def findings(project: Path, old: str, new: str) -> list[str]:
    """Return the findings of lint after a text of the project's behaviour is replaced."""
    text = (HERE / "project/behaviors/blinking.yaml").read_text("utf-8")
    assert old in text
    (project / "behaviors/blinking.yaml").write_text(text.replace(old, new, 1), "utf-8")
    found = check_files(project, read_files(project))[1]
    return [f"{each.code} | {each.message} | {each.hint}" for each in found]


@for_each(
    ("data", "arguments"),
    [
        ({"blink": 3}, {"times": 3, "eye": "both"}),
        ({"blink": {"eye": "left", "times": 1}}, {"times": 1, "eye": "left"}),
        ({"wiggle": True}, {}),
        ({"wiggle": None}, {}),
    ],
)
def test_a_verb_is_read_with_its_short_form_and_its_defaults(data: dict[str, Any], arguments: dict[str, Any]) -> None:
    (verb,) = data
    read = action(data)
    assert read == Do(verb, arguments)
    assert list(read.arguments) == list(arguments)
    assert action(plain_action(read)) == read


def test_it_reads_well_in_transcripts_and_diffs() -> None:
    assert of_deed(BLINK) == "does blink with times 3, eye both"
    assert described(BLINK) == "does `blink` with times 3, eye both"
    assert of_deed(Do("wiggle", {})) == "does wiggle"


def test_how_long_it_takes_is_computed_from_its_arguments() -> None:
    assert [time_taken(Do("blink", {"times": times})) for times in (1, 3)] == [0.5, 1.5]
    assert time_taken(Do("squint", {"length": "300ms"})) == 0.3
    assert time_taken(Do("wiggle", {})) == 2.0


@for_each(
    ("actions", "found"),
    [
        ("[{rest: true}, {wiggle: true}]", True),
        ("[{rest: true}, {blink: 1}]", False),
        ("[{rest: true}, {wake: true}, {wiggle: true}]", False),
        ("[{wiggle: true}, {rest: true}]", False),
    ],
)
def test_lint_reports_a_verb_that_moves_a_robot_at_rest(project: Path, actions: str, found: bool) -> None:
    reported = findings(project, "do: {wiggle: true}", f"do: {actions}")
    assert any("it can't perform `wiggle`" in finding for finding in reported) is found


def test_a_sound_project_has_no_findings(project: Path) -> None:
    assert findings(project, "blink: 2", "blink: 2") == []


@for_each(
    ("old", "new", "finding"),
    [
        ("blink: 2", "blnk: 2", "unknown-key | `blnk` is not a key of `entry` | did you mean `blink`?"),
        ("blink: 2", "blink: 0", "wrong-value | `blink` is 0, but should be at least 1 | How often"),
        ("eye: left", "eyes: left", "unknown-key | `eyes` is not a key of `blink` | did you mean `eye`?"),
        (
            "blink: 2",
            "squint: soon",
            "bad-duration | `soon` is not a duration | write a number and its unit, such as `500ms`, `20s` or `2min`",
        ),
        (
            "blink: 2",
            "squint: 2",
            "wrong-type | `squint` should be a text, not a number | write the unit too: `2s`, or `2ms`",
        ),
        ("times: 3, ", "", "missing-key | `blink` needs the key `times` | How often"),
        ("wiggle: true", "wiggle: {far: 2}", "wrong-value | `wiggle` can't be `{'far': 2}` | allowed: `true`"),
        (
            "onDone: {target: greeted",
            "after: {2s: waiting}\n    onDone: {target: greeted",
            "cut-short | `greeting` is left after 2 s, but its `do` takes about 2.2 s | write at least 3s",
        ),
        (
            "event.data.blinked",
            "event.data.blinks",
            "unknown-field | `event.data` has no `blinks` | did you mean `blinked`?",
        ),
        (
            "context.who",
            "context.whom",
            "unknown-context-key | the context has no `whom` | did you mean `who`? `context` has `blinked`, `who`",
        ),
    ],
)
def test_lint_reports_what_is_wrong_with_it(project: Path, old: str, new: str, finding: str) -> None:
    assert findings(project, old, new)[:1] == [finding]


def test_the_editor_completes_it_and_describes_it() -> None:
    entry = ("states", "waiting", "entry")
    assert {"blink", "wiggle", "say"} <= keys_at("behavior", entry).keys()
    assert set(keys_at("behavior", (*entry, "blink"))) == {"times", "eye", "for"}
    assert values_at("behavior", (*entry, "blink", "eye")) == ["left", "right", "both"]
    assert description_at("behavior", (*entry, "blink")) == "Blink with the eyes."
    assert description_at("behavior", (*entry, "blink", "times")) == "How often."


def test_the_schemas_of_behaviours_and_stories_contain_it() -> None:
    assert "blink" in load_schema("behavior")["$defs"]["action"]["properties"]
    assert "blink" in load_schema("story")["properties"]["robot"]["propertyNames"]["enum"]


def test_a_step_fills_in_its_arguments() -> None:
    state = {"entry": {"blink": {"times": 1, "for": "{{ context.eye }} eye"}}}
    (start,) = initial(machine(state)).commands
    assert start == Start("c1", Do("blink", {"times": 1, "eye": "both", "for": "left eye"}))


def test_the_end_of_a_do_brings_its_result_also_the_second_and_third_time() -> None:
    assign = {"assign": {"blinked": "event.data.blinked"}}
    told = machine({"do": {"blink": 2}, "onDone": {"target": ".", "actions": assign}})
    taken = initial(told)
    for number in range(1, 5):
        taken = step(told, taken.snapshot, Event(f"done.command.d{number}", {RESULT: {"blinked": number}}, 1.0))
        assert taken.snapshot.context["blinked"] == number
        assert [command.id for command in taken.commands] == [f"d{number + 1}"]


@pytest.mark.process
def test_a_story_performs_it_as_long_as_it_takes_with_the_result_of_its_schema(
    project: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["run", str(project), "--story", "visitor", "--robot", "recording", "--speed", "max"]) == 0
    lines = [line.split(maxsplit=2) for line in capsys.readouterr().out.splitlines() if line[:3] == " 0:"]
    assert ["0:00.9", "robot", "does blink with times 3, eye left, for Budi"] in lines
    assert ["0:04.5", "state", "greeted  (done)"] in lines


@pytest.mark.process
def test_a_run_is_replayed_exactly_by_the_results_in_its_journal(
    project: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["run", str(project), "--story", "visitor", "--robot", "recording", "--speed", "max"]) == 0
    assert main(["replay", "--project", str(project)]) == 0
    assert "1 the same" in capsys.readouterr().out


def failure_of(project: Path, expected: str, robot: object = None) -> str:
    """Return why a story fails that expects this of the greeted visitor; empty if it passes."""
    story = f"steps: [{{visitor: arrives}}, {{expect: {expected}}}]\nrobot: {json.dumps(robot or {})}\n"
    (project / "behaviors/stories/visitor.yaml").write_text(story, "utf-8")
    report = project / "report.json"
    main(["test", str(project), "--format", "json", "-o", str(report)])
    (row,) = json.loads(report.read_text("utf-8"))["stories"]
    found = row.get("failure", {})
    return f"{found.get('expected', '')}: {found.get('was', '')}" if found else ""


@for_each(
    ("robot", "failure"),
    [
        ({"blink": "500ms"}, ""),
        ({"blink": {"takes": "500ms", "result": {"blinked": 2}}}, ""),
        ({"blink": {"result": {"blinked": 1}}}, "blinked = 2 within 30 s: it is 1"),
        ({"blink": "hangs"}, "state `greeted`"),
        ({"blink": "fails"}, "state `greeted`"),
    ],
)
def test_a_story_says_how_it_ends(project: Path, robot: object, failure: str) -> None:
    found = failure_of(project, "{state: greeted, context: {blinked: 2}}", robot)
    assert found[: len(failure)] == failure if failure else not found


@for_each(
    ("did", "failure"),
    [
        ("blink", ""),
        ("{blink: 3}", ""),
        ("{blink: {eye: left, for: Budi}}", ""),
        ("{blink: {eye: right}}", "the robot to finish `blink` with {'eye': 'right'}"),
        ("wiggle", "the robot to finish `wiggle`"),
    ],
)
def test_a_story_expects_it(project: Path, did: str, failure: str) -> None:
    found = failure_of(project, f"{{state: greeted, did: {did}}}")
    assert found[: len(failure)] == failure if failure else not found


@pytest.mark.process
def test_a_story_of_a_recorded_visit_contains_its_result(
    project: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["run", str(project), "--story", "visitor", "--robot", "recording", "--speed", "max"]) == 0
    capsys.readouterr()
    assert main(["story", "--project", str(project), "-o", str(tmp_path / "visit.yaml")]) == 0
    assert "robot: {blink: {result: {blinked: 2}}}" in (tmp_path / "visit.yaml").read_text("utf-8")


@for_each(
    ("row", "fault"),
    [
        ('"say": VerbRow(performer="a")', "its verb `say` is ignored: a verb of Lumen has that name"),
        (
            '"hop": VerbRow(performer="a", arguments={"required": 3})',
            "its verb `hop` is ignored: `arguments` is not a JSON Schema",
        ),
        (
            '"hop": VerbRow(performer="a", result={"properties": {"x": {"type": "metre"}}})',
            "its verb `hop` is ignored: `result` is not a JSON Schema",
        ),
        (
            '"hop": VerbRow(performer="a", parts=("legs", "feet"))',
            "its verb `hop` is ignored: `parts` has `feet`, which is no part of a body: there are `arms`, ",
        ),
        (
            '"hop": VerbRow(performer="a", takes="long")',
            "its verb `hop` is ignored: `takes` is `long`, which is no duration",
        ),
        (
            '"hop": VerbRow(performer="a", takes="{{ hops( }}s")',
            "its verb `hop` is ignored: `takes` is faulty: the expression ends too early",
        ),
    ],
)
def test_a_row_that_cannot_be_used_is_a_finding_and_the_rest_goes_on(
    project: Path, tmp_path: Path, row: str, fault: str
) -> None:
    manifest = f"from lumen.feature import Feature, VerbRow\nFEATURE = Feature(name='hopper', verbs={{{row}}})\n"
    write_distribution(tmp_path / "more", "lumen-hopper", "lumen_hopper:FEATURE", {"lumen_hopper.py": manifest})
    with on_path(tmp_path / "more"):
        (finding,) = findings(project, "blink: 2", "blink: 2")
    assert finding.startswith(f"broken-feature | the installed package `lumen-hopper` 1.0 is faulty: {fault}")


def test_a_body_without_its_parts_leaves_it_out(project: Path) -> None:
    main = project / "lumen.yaml"
    main.write_text(main.read_text("utf-8").replace("model: nao", "model: lantern"), "utf-8")
    found = [finding for finding in findings(project, "wiggle", "tiptoe") if "tiptoe" in finding]
    assert found == [
        "left-out | Lantern has no legs, so it leaves out `tiptoe` | add joints to `legs` under `parts` of its body"
    ]


def test_the_console_shows_it_in_the_journal() -> None:
    commands = [command_data(Start("d1", BLINK)), command_data(Start("d2", Do("wiggle", {})))]
    assert told_of({"heard": "face", "commands": commands})["text"] == "face: blink times 3, eye both, wiggle"


@for_each(("resume", "begins"), [("again", [Start("d2", BLINK)]), ("after", []), ("", [])])
def test_one_that_the_robot_forgot_is_resumed_as_its_state_says(resume: str, begins: list[Start]) -> None:
    told = machine({"do": {"blink": 3}, **({"resume": resume} if resume else {})})
    kept = json.loads(json.dumps(serialize(told, initial(told).snapshot)))
    taken = step(told, deserialize(told, kept), Event("lost.command.d1", {"reason": "it restarted"}, 1.0))
    assert list(taken.commands) == begins
