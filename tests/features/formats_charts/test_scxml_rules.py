"""Exported SCXML follows W3C's schema: the allowed elements and attributes of each element, and unique ids."""

import re
import xml.etree.ElementTree as ET
from collections.abc import Iterator
from typing import Any

import pytest
from hypothesis import given, settings

from lumen.features.formats_charts.scxml import write_scxml
from lumen.features.formats_charts.scxml.namespaces import SCXML_NAMESPACE
from lumen.project.formats.conversion_findings import dotted
from lumen.statechart import Machine
from tests import ROOT
from tests.formats.making import charts

CONTENT = {"raise", "if", "send", "log", "assign", "cancel", "elseif", "else", "script", "foreach"}
STATES = {"state", "parallel", "history", "datamodel", "onentry", "onexit", "transition", "invoke"}
WITHIN: dict[str, set[str]] = {
    "scxml": {"state", "parallel", "final", "datamodel", "script"},
    "state": {*STATES, "final", "initial"}, "parallel": STATES, "final": {"onentry", "onexit", "donedata"},
    "history": {"transition"}, "transition": CONTENT, "onentry": CONTENT, "onexit": CONTENT, "if": CONTENT,
    "datamodel": {"data"}, "donedata": {"param", "content"}, "send": {"param", "content"}, "invoke": {"param"},
}  # fmt: skip
ATTRIBUTES: dict[str, set[str]] = {
    "scxml": {"initial", "name", "version", "datamodel"}, "state": {"id", "initial"}, "parallel": {"id"},
    "final": {"id"}, "history": {"id", "type"}, "transition": {"event", "cond", "target", "type"}, "raise": {"event"},
    "if": {"cond"}, "elseif": {"cond"}, "log": {"label", "expr"}, "data": {"id", "expr"}, "cancel": {"sendid"},
    "assign": {"location", "expr"}, "param": {"name", "expr"}, "content": {"expr"},
    "send": {"event", "target", "id", "delay"}, "invoke": {"type", "src", "id", "autoforward"},
}  # fmt: skip
ID = re.compile(r"[A-Za-z_][\w.-]*")


def faults(text: str) -> list[str]:
    """List the violations of the schema; elements and attributes of other namespaces are ignored."""
    root = ET.fromstring(text)
    elements = [e for e in root.iter() if _name(e)]
    ids = [e.get("id", "") for e in elements if _name(e) in ("state", "parallel", "final", "history")]
    found = [fault for element in elements for fault in _faults(element)]
    found += [f"`{id}` is no id" for id in ids if not ID.fullmatch(id)]
    found += [f"`{id}` stands twice" for id in set(ids) if ids.count(id) > 1]
    named = [e.get(key, "") for e in elements for key in ("target", "initial") if _name(e) != "send"]
    return found + [f"there is no `{id}`" for names in named for id in names.split() if id not in ids]


def _name(element: ET.Element) -> str:
    return (
        element.tag.removeprefix(f"{{{SCXML_NAMESPACE}}}") if element.tag.startswith(f"{{{SCXML_NAMESPACE}}}") else ""
    )


def _faults(element: ET.Element) -> Iterator[str]:
    name = _name(element)
    yield from (f"{name}/@{key}" for key in element.attrib if key[0] != "{" and key not in ATTRIBUTES.get(name, set()))
    below = [_name(child) for child in element]
    yield from (f"{name}/{child}" for child in below if child and child not in WITHIN.get(name, set()))
    if name == "transition" and not {"event", "cond", "target"} & set(element.attrib):
        yield "a transition without anything"
    if {"param", "content"} <= set(below):
        yield f"{name} with both"
    if "initial" in element.attrib and not {"state", "parallel", "final", "history"} & set(below):
        yield f"`initial` of an atomic {name}"
    if "else" in below and below.index("else") < max((i for i, n in enumerate(below) if n == "elseif"), default=0):
        yield "elseif after else"


@pytest.mark.slow
@settings(max_examples=25, deadline=None)
@given(chart=charts())
def test_any_machine(chart: dict[str, Any]) -> None:
    assert faults(write_scxml(Machine.from_dict(chart), dotted("machine"))[0]) == []


def test_the_tour_and_what_invokes() -> None:
    tour = Machine.load(ROOT / "behaviors/tour.yaml")
    invoking = {"states": {"a": {"invoke": {"behavior": "quiz", "input": {"n": "1 + 1"}, "onDone": "a"}}}}
    quiz: dict[str, Any] = {"context": {"n": 0}, "states": {"q": None}}
    host = Machine.from_dict(invoking, behaviors={"quiz": quiz})
    for machine in (tour, host):
        assert faults(write_scxml(machine, dotted("machine"))[0]) == []


def test_faults_are_found() -> None:
    state = '<state id="1"><onentry><state/></onentry><transition/></state>'
    text = f'<scxml xmlns="{SCXML_NAMESPACE}" initial="b">{state}</scxml>'
    assert set(faults(text)) == {
        "onentry/state",
        "a transition without anything",
        "`1` is no id",
        "`` is no id",
        "there is no `b`",
    }
