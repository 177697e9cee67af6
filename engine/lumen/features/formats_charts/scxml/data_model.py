"""Converts an SCXML document's data model to Lumen's context."""

import re
from collections.abc import Iterator
from typing import Any

from lumen.expressions import unparse
from lumen.expressions.kinds import kind_of
from lumen.features.formats_charts.ecmascript import ScriptError, ScriptNames, parse_script, read_value
from lumen.features.formats_charts.ecmascript.constants import constant
from lumen.features.formats_charts.ecmascript.kind_inference import UNKNOWN_KIND, kind
from lumen.features.formats_charts.scxml.state_tree import STATES, ScxmlStateTree
from lumen.project.formats.conversion_findings import ConversionFindings
from lumen.project.formats.foreign_json import foreign_json
from lumen.project.formats.unused_names import unused_name
from lumen.project.formats.xml_elements import XmlElement

_UNFIT = re.compile(r"\W+", re.ASCII)
_NOTHING = object()

MAX_KIND_PASSES = 10
"""The most passes over the assignments; in the last one, all assigned keys are allowed any kind."""


class ScxmlDataModel:
    """A document's context, converted from all of its `<data>`."""

    def __init__(self, outline: ScxmlStateTree, findings: ConversionFindings) -> None:
        self.findings = findings
        self.first: dict[str, Any] = {}
        """The first values of all keys; None if a value is lost or must be computed."""
        self.late: dict[str, str] = {}
        """The expressions for first values that must be computed, in document order."""
        self.wide: dict[str, dict[str, Any]] = {}
        """Keys that receive values of several kinds: `types` in the behaviour file allows them any value."""
        self.keys: dict[str, str] = {}
        """Lumen's keys, by the ids of `<data>`."""
        self.taken: set[str] = set()
        elements = [element for element in _data(outline.scxml) if self._declare(element)]
        states = {outline.title: outline.title} | {id: node.name or outline.title for id, node in outline.by_id.items()}
        self.kinds: dict[str, str] = {}
        self.names = ScriptNames(self.keys, self.kinds, states, outline.events, outline.title)
        for element in elements:
            self._value(element)
        self._late_binding(outline, elements)
        self._widen(outline)

    def _declare(self, element: XmlElement) -> bool:
        """Assign a key to a `<data>`. Report it and return False if an earlier `<data>` has the same id."""
        id = element.get("id")
        if id in self.keys:
            hint = "give each its own id: data is visible in the whole chart"
            self.findings.lost(element.attribute_place("id"), f"a second `<data>` has the id `{id}`", hint)
            return False
        wanted = re.sub(r"^(?=\d)", "_", _UNFIT.sub("_", id)) or "_"
        self.keys[id] = unused_name(wanted, self.taken.__contains__, len(self.taken))
        self.taken.add(self.keys[id])
        return True

    def _value(self, element: XmlElement) -> None:
        key = self.keys[element.get("id")]
        self.kinds.pop(key, None)
        value = self.first[key] = self._first(element)
        if value is not None:
            self.kinds[key] = kind_of(value)

    def _first(self, element: XmlElement) -> Any:
        id = element.get("id")
        if "src" in element.attributes:
            hint = f"write the value here instead of `{element.get('src')}`"
            self.findings.lost(element.place, f"the first value of `{id}` is in another file", hint)
            return None
        if "expr" in element.attributes:
            return self._expression(element, element.get("expr"))
        if element.children:
            self.findings.lost(element.place, f"the first value of `{id}` is XML", "write it as JSON")
            return None
        return written(element.text)

    def _expression(self, element: XmlElement, source: str) -> Any:
        try:
            tree = parse_script(source)
            value = constant(tree, _NOTHING)
            if value is not _NOTHING:
                return value
            self.late[self.keys[element.get("id")]] = unparse(read_value(source, self.names))
        except ScriptError as error:
            self.findings.lost(element.place, f"the first value of `{element.get('id')}`, `{source}`: {error}")
        return None

    def _late_binding(self, outline: ScxmlStateTree, elements: list[XmlElement]) -> None:
        if outline.scxml.get("binding") != "late":
            return
        first = {id(element) for element in _top_data(outline.scxml)}
        for element in (each for each in elements if id(each) not in first):
            hint = "in Lumen, all values exist from the beginning"
            self.findings.lost(
                element.place, f'`binding="late"` of `{element.get("id")}` has no counterpart in Lumen', hint
            )

    def _widen(self, outline: ScxmlStateTree) -> None:
        """Move the keys that are assigned a value of another kind than the first from `kinds` to `wide`."""
        assigned = [e for e in outline.scxml.walk() if e.tag == "assign" and e.get("location") in self.keys]
        for turn in range(MAX_KIND_PASSES):
            before = len(self.wide)
            for element in assigned:
                key = self.keys[element.get("location")]
                kept = self.kinds.get(key)
                if kept is not None and (turn == MAX_KIND_PASSES - 1 or self._kind(element) != kept):
                    self.wide[key] = {}
                    del self.kinds[key]
            if len(self.wide) == before:
                return

    def _kind(self, element: XmlElement) -> str:
        try:
            if "expr" not in element.attributes:
                return kind_of(written(element.text))
            return kind(read_value(element.get("expr"), self.names), self.names.kinds)
        except ScriptError:
            return kind_of(self.first[self.keys[element.get("location")]])
        except RecursionError:
            return UNKNOWN_KIND


def written(text: str) -> Any:
    """Return the value of inline content (SCXML B.2.8.1); None if it is blank.

    The content is JSON, a list or object in ECMAScript's form, or else text, in which whitespace is collapsed.
    """
    stripped = text.strip()
    if not stripped:
        return None
    with_constant = _constant(stripped)
    return " ".join(stripped.split()) if with_constant is _NOTHING else with_constant


def _constant(text: str) -> Any:
    try:
        return foreign_json(text)
    except (ValueError, RecursionError):
        pass
    try:
        return constant(parse_script(text), _NOTHING) if text[0] in "[{" else _NOTHING
    except ScriptError:
        return _NOTHING


def _top_data(scxml: XmlElement) -> Iterator[XmlElement]:
    for model in scxml.of("datamodel"):
        yield from (data for data in model.of("data") if data.get("id"))


def _data(scxml: XmlElement) -> Iterator[XmlElement]:
    """Yield every `<data>` with an id: the document's, then those of its states."""
    yield from _top_data(scxml)
    for state in scxml.walk():
        if state is not scxml and state.tag in STATES:
            yield from _top_data(state)
