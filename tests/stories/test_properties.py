"""`properties`: conditions that must always hold, in stories and in the exploration of a behaviour."""

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from lumen.cli.main import main
from lumen.insight.exploration import explore
from lumen.project import load
from lumen.run.exploring import explored
from lumen.run.rehearsal import rehearse
from lumen.statechart import Machine
from tests.stories.test_exploration import GO

DOOR = {
    "shut": {"on": {"go": "open"}},
    "open": {"on": {"back": "shut", "go": "wide"}, "after": {"20s": "shut"}},
    "wide": {"after": {"5s": "open"}},
}
PROPERTY = """\
properties:
  it opens once: {always: context.opened < 2}
  it is shut again: {whenever: In('open'), eventually: In('closed'), within: 19s}
"""


def broken(properties: dict[str, Any], states: dict[str, Any] = DOOR, **more: Any) -> list[tuple[str, list[str]]]:
    """Return the state and the path, stimulus by stimulus, of each property that does not hold."""
    machine = Machine.from_dict({"states": states, "properties": properties, **more})
    walked = explore(machine, GO)
    found = [f for f in walked.findings if f.kind == "property"]
    assert len(walked.kept) == len(properties) - len(found)
    return [(f.state, [step.stimulus.event.name for step in f.path if step.stimulus]) for f in found]


def test_a_condition_that_always_holds_and_one_that_does_not() -> None:
    assert broken({"one": {"always": "In('shut') || In('open') || In('wide')"}}) == []
    assert broken({"two": {"always": "!In('wide')"}}) == [("wide", ["go", "go"])]


def test_the_deadline_counts_from_when_the_condition_comes_to_hold() -> None:
    closes = {"whenever": "In('open')", "eventually": "In('shut')"}
    assert broken({"p": {**closes, "within": "20s"}}) == []
    assert broken({"p": {**closes, "within": "19s"}}) == [("open", ["go"])]
    wide = {"whenever": "In('wide')", "eventually": "In('shut')"}
    assert broken({"p": {**wide, "within": "25s"}}) == []
    assert broken({"p": {**wide, "within": "24s"}}) == [("open", ["go", "go", "after.5s.wide"])]


def test_without_whenever_it_counts_from_the_beginning() -> None:
    states = {"a": {"after": {"3s": "b"}}, "b": {"on": {"go": "b"}}}
    assert broken({"p": {"eventually": "In('b')", "within": "3s"}}, states) == []
    assert broken({"p": {"eventually": "In('b')", "within": "2s"}}, states) == [("a", [])]


def test_each_wait_of_a_way_counts_from_the_step_before_it() -> None:
    states = {"a": {"after": {"2s": "b"}}, "b": {"after": {"3s": "c"}}, "c": {}}
    machine = Machine.from_dict({"states": states, "properties": {"p": {"always": "!In('c')"}}})
    [found] = [f for f in explore(machine, GO).findings if f.kind == "property"]
    assert [step.stimulus.waited for step in found.path if step.stimulus] == [2.0, 3.0]


def test_what_a_property_reads_makes_configurations_differ() -> None:
    states = {"a": {"on": {"go": {"target": "a", "actions": {"assign": {"n": "context.n + 1"}}}}}}
    found = broken({"p": {"always": "context.n < 4"}}, states, context={"n": 0})
    assert found == [("a", ["go"] * 4)]


def test_a_robot_that_fails_is_tried_too() -> None:
    states = {
        "a": {"on": {"go": "b"}},
        "b": {"do": {"play": "dance"}, "onDone": "a", "onError": "c"},
        "c": {"on": {"back": "a"}},
    }
    [(state, way)] = broken({"p": {"whenever": "In('b')", "eventually": "In('a')", "within": "9s"}}, states)
    assert (state, way[0], way[1].split(".")[0]) == ("c", "go", "error")


def test_a_condition_without_a_value_does_not_hold() -> None:
    assert broken({"p": {"always": "context.who.name == 'Ada'"}}, context={"who": {}}) == [("shut", [])]


def test_how_far_the_search_came_is_told(story: Callable[..., Path], capsys: pytest.CaptureFixture[str]) -> None:
    root = story("  - wait: 1s\n")
    door = root / "behaviors/door.yaml"
    door.write_text(door.read_text() + "properties:\n  it has a number: {always: context.opened >= 0}\n")
    main(["test", str(root), "--explore", "--behavior", "door", "--format", "json"])
    assert json.loads(capsys.readouterr().out)["explore"]["kept"] == ["it has a number"]
    main(["test", str(root), "--explore", "--behavior", "door", "--bound", "2"])
    assert "`it has a number` holds in the 2 configurations explored" in capsys.readouterr().out


def test_a_story_may_have_properties_of_its_own(story: Callable[..., Path]) -> None:
    knock = "  - event: {name: knock, data: {who: Ada}}\n  - expect: {state: open}\n  - wait: 25s\n"
    head = "properties: {it is shut again: {whenever: In('open'), eventually: In('closed'), within: %s}}\n"
    for within, failed in (("20s", ""), ("19s", "the property `it is shut again`")):
        project = load(story(knock, head % within))
        gone = rehearse(project, project.stories["knocking"])
        assert (gone.failed.expected if gone.failed else "") == failed


@pytest.mark.parametrize("name", ["it opens once", "it is shut again"])
def test_a_counterexample_is_a_story_that_fails_by_the_same_property(story: Callable[..., Path], name: str) -> None:
    root = story("  - wait: 1s\n")
    door = root / "behaviors/door.yaml"
    kept = next(line for line in PROPERTY.splitlines() if name in line)
    door.write_text(f"{door.read_text()}properties:\n{kept}\n")
    finding = next(f for f in explored(load(root), "door", bound=1000).findings if f.kind == "property")
    assert finding.place.file == "behaviors/door.yaml"
    (root / "behaviors/stories/counterexample.yaml").write_text(finding.story)

    project = load(root)
    gone = rehearse(project, project.stories["counterexample"])

    assert gone.failed
    assert gone.failed.expected == f"the property `{name}`"
