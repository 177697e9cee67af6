"""Reads SCXML's transitions as `on`, `hears`, `always`, `after`, `onDone` and `onError`."""

import re
from collections.abc import Iterator
from functools import cached_property
from typing import Any

from lumen.features.formats_charts.ecmascript import ScriptError
from lumen.features.formats_charts.event_descriptors import normal, overlap
from lumen.features.formats_charts.foreign_states import ForeignState
from lumen.features.formats_charts.scxml.action_reader import ScxmlActionReader
from lumen.features.formats_charts.scxml.candidates import arrange
from lumen.features.formats_charts.scxml.heard_conditions import guard_in
from lumen.features.formats_charts.scxml.namespaces import LUMEN_NAMESPACE
from lumen.features.formats_charts.scxml.state_tree import ScxmlStateTree, regular
from lumen.language.diagnostics import Place
from lumen.project.formats.behavior_data import TransitionData, single
from lumen.project.formats.conversion_findings import ConversionFindings
from lumen.project.formats.xml_elements import XmlElement
from lumen.project.transitions import rivals
from lumen.talk.hearing import HEARD

_DESCRIPTOR = re.compile(r"\*|[^\s.*]+(\.[^\s.*]+)*")


class ScxmlTransitionReader:
    """Reads the transitions of one document."""

    def __init__(self, outline: ScxmlStateTree, contents: ScxmlActionReader, findings: ConversionFindings) -> None:
        self.outline, self.contents, self.findings = outline, contents, findings

    def of(self, node: ForeignState, afters: dict[str, str]) -> dict[str, Any]:
        """Return a state's transitions under Lumen's keys; `afters` maps the events of Lumen's timers to delays."""
        always: list[TransitionData] = []
        after: dict[str, list[TransitionData]] = {}
        rows: list[tuple[str, TransitionData]] = []
        hears: dict[str, list[TransitionData]] = {}
        places: dict[int, Place] = {}
        for element in node.source.of("transition"):
            row = self._row(node, element)
            if row is None:
                continue
            if key := _heard(element):
                hears.setdefault(key, []).append(row)
                continue
            places[id(row)] = element.place
            for descriptor in self._descriptors(element):
                if descriptor in afters:
                    after.setdefault(afters[descriptor], []).append(row)
                else:
                    rows.append((descriptor, row))
            if not element.get("event"):
                always += self._eventless(element, row)
        done, rows = self._done(node, rows)

        def leave_out(row: TransitionData) -> None:
            place = places.get(id(row), node.source.place)
            self.findings.lost(place, "the converted condition is too long", "split it into two transitions")

        data: dict[str, Any] = {"on": arrange(rows, leave_out)} if rows else {}
        if hears:
            data["hears"] = {key: single(found) for key, found in hears.items()}
        if always:
            data["always"] = single(always)
        if after:
            data["after"] = {text: single(found) for text, found in after.items()}
        return {**data, **done}

    def _eventless(self, element: XmlElement, row: TransitionData) -> Iterator[TransitionData]:
        if "target" in row or "guard" in row:
            yield row
        elif row:
            yield {"guard": "true", **row}
        else:
            self.findings.lost(
                element.place,
                "a transition without event, condition and target is left out: it would repeat without end",
            )

    def _descriptors(self, element: XmlElement) -> list[str]:
        found = [normal(word) for word in element.get("event").split()]
        found = [self.outline.events.get(word, word) for word in found]
        for word in found:
            if not _DESCRIPTOR.fullmatch(word):
                self.findings.lost(element.place, f"`{word}` is not an event", "write names separated by dots")
        return list(dict.fromkeys(word for word in found if _DESCRIPTOR.fullmatch(word)))

    def _done(
        self, node: ForeignState, rows: list[tuple[str, TransitionData]]
    ) -> tuple[dict[str, Any], list[tuple[str, TransitionData]]]:
        """Return `onDone` and `onError` for rows that can have no other meaning, and the remaining rows."""
        name = node.name or self.outline.title
        kind = "do" if not regular(node) else "state"
        has_do = bool(list(node.source.of(f"{{{LUMEN_NAMESPACE}}}do")))
        names = {f"done.{kind}.{name}": "onDone", f"error.do.{name}": "onError"}
        if not regular(node) and not has_do:
            return {}, rows
        found: dict[str, Any] = {}
        for event, key in names.items():
            mine = [row for descriptor, row in rows if descriptor == event]
            rivals = any(d != event and overlap(d, event) for d, _ in rows)
            shared = key == "onDone" and kind == "state" and name in self._dones
            if mine and not rivals and not shared:
                found[key] = single(mine)
                rows = [(d, row) for d, row in rows if d != event]
        return found, rows

    @cached_property
    def _dones(self) -> set[str]:
        """The prefixes, up to each dot, of the names of states with children.

        `done.state.a` also matches the event at the end of a state `a.b`.
        """
        names = (node.name.split(".") for node in self.outline.root.walk() if node.children)
        return {".".join(words[:n]) for words in names for n in range(1, len(words))}

    def _row(self, node: ForeignState, element: XmlElement) -> TransitionData | None:
        row: TransitionData = {}
        targets = self.targets(element)
        if targets is None:
            return None
        if "cond" in element.attributes:
            try:
                key, condition = _heard(element), element.get("cond")
                if condition := guard_in(key, condition) if key else condition:
                    row["guard"] = self.contents.condition(condition)
            except ScriptError as error:
                hint = "the transition is left out"
                self.findings.lost(
                    element.place, f"the condition `{_short(element.get('cond'))}` can't be converted: {error}", hint
                )
                return None
        if targets:
            row["target"] = self.named(node, targets)
        if actions := self.contents.block(element.children):
            row["actions"] = actions
        inside = bool(targets) and all(target.lies_below(node) for target in targets)
        if inside and node.source.tag != "parallel" and element.get("type") != "internal":
            row["reenter"] = True
        return row

    def targets(self, element: XmlElement) -> list[ForeignState] | None:
        """Return the states in `target`. Report and return None if one is missing or they can't be active together."""
        found = []
        for id in element.get("target").split():
            node = self.outline.by_id.get(id)
            if node is None:
                self.findings.lost(element.place, f"there is no state `{id}` to go to")
                return None
            found.append(node)
        if pair := rivals(found, lambda node: str(node.source.tag)):
            message = f"`{pair[0].name}` and `{pair[1].name}` can't be active together"
            self.findings.lost(element.place, message, "name states of different regions of a `<parallel>`")
            return None
        return found

    def named(self, source: ForeignState, targets: list[ForeignState], *, inside: bool = False) -> Any:
        """Return the source's reference to its target, or a list for several targets."""
        names = [source.calls(target, self.outline.title, inside=inside) for target in targets]
        return names[0] if len(names) == 1 else names


def _heard(element: XmlElement) -> str:
    """Return the key of the `hears` row from which Lumen wrote a transition, or empty."""
    return element.get(f"{{{LUMEN_NAMESPACE}}}hears") if element.get("event") == HEARD else ""


def _short(source: str) -> str:
    text = " ".join(source.split())
    return text if len(text) <= 60 else text[:59] + "…"
