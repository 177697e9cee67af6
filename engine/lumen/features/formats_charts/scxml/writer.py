"""Writes a machine as an SCXML document."""

import json
from collections.abc import Container, Iterator, Sequence
from typing import Any

from lumen.features.formats_charts.ecmascript import ScriptError, Vocabulary
from lumen.features.formats_charts.ecmascript.kind_inference import kinds_of
from lumen.features.formats_charts.ecmascript.script_parser import is_reserved
from lumen.features.formats_charts.heard_rows import LOST_ELSEWHERE, as_guard, in_asked_order, key_of
from lumen.features.formats_charts.scxml.action_writer import ScxmlActionWriter
from lumen.features.formats_charts.scxml.heard_conditions import HEARS, row_condition
from lumen.features.formats_charts.scxml.namespaces import LUMEN_NAMESPACE, SCXML_INVOKE_TYPE, SCXML_NAMESPACE
from lumen.features.formats_charts.scxml.xml_tags import XmlTag
from lumen.language.actions import Template
from lumen.language.diagnostics import Diagnostic
from lumen.language.machines import Hears, MachineDefinition, State, StateKind, Transition
from lumen.project.formats.behavior_data import plain_block, plain_button, plain_phrases, plain_properties
from lumen.project.formats.conversion_findings import ExportReport, PlaceOfPath
from lumen.project.formats.durations import duration

_TAGS = {StateKind.PARALLEL: "parallel", StateKind.FINAL: "final", StateKind.HISTORY: "history"}


def write_scxml(machine: MachineDefinition, place: PlaceOfPath) -> tuple[str, list[Diagnostic]]:
    """Return the document, and findings about parts that are missing from it or that only Lumen understands.

    Robot verbs, `do`, phrases and answers, which SCXML lacks, are in a separate namespace. Lumen reads them back
    without loss, and other tools ignore them.
    """
    report = ExportReport(place)
    document = _ScxmlWriter(machine, report).tag()
    lines = ['<?xml version="1.0" encoding="UTF-8"?>', *document.lines()]
    return "\n".join(lines) + "\n", report.diagnostics


class _ScxmlWriter:
    """Writes the states of one machine."""

    def __init__(self, machine: MachineDefinition, report: ExportReport) -> None:
        self.machine, self.report = machine, report
        names = {state.name for state in machine.states.values() if state.path}
        self.ids = {path: state.name for path, state in machine.states.items()}
        while self.ids[""] in names:
            self.ids[""] += "_"
        keys = {key: _free(key, machine.context) for key in machine.context}
        self.vocabulary = Vocabulary(kinds_of(machine.context, machine.types), keys, self.ids)
        self.orders = ScxmlActionWriter(self.vocabulary, report)
        root = machine.root
        self.wrapped = root.kind is StateKind.PARALLEL or any(
            (root.transitions, root.entry, root.exit, root.do, root.invoke, root.buttons, root.on_reload, root.resume)
        )

    def tag(self) -> XmlTag:
        root, ids = self.machine.root, self.ids
        data = [self._data(key, value) for key, value in self.machine.context.items()]
        children = [*self._own(), *([XmlTag("datamodel", {}, data)] if data else [])]
        initial = ""
        if self.wrapped:
            children += self._wrapped(self._state(root))
        else:
            initial = self._ids(root.initial)
            children += [self._state(self.machine.states[path]) for path in self._below(root)]
        attributes = {
            "xmlns": SCXML_NAMESPACE,
            "xmlns:lumen": LUMEN_NAMESPACE,
            "version": "1.0",
            "datamodel": "ecmascript",
            "name": ids[""],
            "initial": initial,
        }
        return XmlTag("scxml", attributes, children)

    def _data(self, key: str, value: Any) -> XmlTag:
        return XmlTag("data", {"id": self.vocabulary.keys[key], "expr": self.orders.literal(value)})

    def _own(self) -> Iterator[XmlTag]:
        """Yield `lumen:machine` with the machine's parts that SCXML lacks, if it has any."""
        machine = self.machine
        phrases = {name: plain_phrases(table, anyhow=name in machine.anyhow) for name, table in machine.phrases.items()}
        answers = {
            name: [{"phrases": plain_phrases(row.phrases), "value": row.value} for row in rows]
            for name, rows in machine.answers.items()
        }
        types = {self.vocabulary.keys.get(key, key): schema for key, schema in machine.types.items()}
        parts = {
            "types": types, "events": machine.events, "phrases": phrases, "answers": answers,
            "lists": {name: list(entries) for name, entries in machine.lists.items()},
            "properties": plain_properties(machine), "renamed": machine.renamed,
        }  # fmt: skip
        if found := {key: part for key, part in parts.items() if part}:
            for key in sorted(found.keys() & {"phrases", "answers", "lists", "properties"}):
                self.report.foreign(f"`{key}`", (key,))
            yield _json("machine", found)

    def _below(self, state: State) -> Iterator[str]:
        """Return an iterator over the paths of all children in document order, including histories."""
        return (path for path, child in self.machine.states.items() if child.parent == state.path and path)

    def _ids(self, paths: Sequence[str]) -> str:
        return " ".join(self.ids[path] for path in paths)

    def _state(self, state: State) -> XmlTag:
        attributes = {"id": self.ids[state.path]}
        if not state.path:
            attributes["lumen:root"] = "true"
        elif state.name not in (state.path, state.path.rpartition(".")[2]):
            attributes["lumen:key"] = state.path.rpartition(".")[2]
        if state.kind is StateKind.HISTORY:
            attributes["type"] = "deep" if state.deep else "shallow"
            default = [XmlTag("transition", {"target": self._ids(state.initial)})] if state.initial else []
            return XmlTag("history", attributes, default)
        if state.kind is StateKind.COMPOUND:
            attributes["initial"] = self._ids(state.initial)
        children = [*self._blocks(state), *self._transitions(state), *self._invokes(state)]
        if state.output is not None:
            children += self._output(state)
        if state.kind is StateKind.FINAL and self._is_region(state):
            message = (
                f"`{state.name}` is a final state in a parallel state: it becomes a state with an inner final state"
            )
            self.report.changed(message, state.where)
            return XmlTag(
                "state", attributes, [*self._blocks(state), XmlTag("final", {"id": f"{attributes['id']}._end"})]
            )
        children += [self._state(self.machine.states[path]) for path in self._below(state)]
        return XmlTag(_TAGS.get(state.kind, "state"), attributes, children)

    def _blocks(self, state: State) -> Iterator[XmlTag]:
        if state.do:
            self.report.foreign("`do`", (*state.where, "do"))
            yield _json("do", plain_block(state.do))
        ours: dict[str, str] = {}
        if state.on_reload:
            self.report.foreign("`onReload`", (*state.where, "onReload"))
            ours["onReload"] = self.ids[state.on_reload]
        if state.resume:
            self.report.foreign("`resume`", (*state.where, "resume"))
            ours["resume"] = state.resume
        if state.buttons:
            self.report.foreign("`buttons`", (*state.where, "buttons"))
            yield _json("buttons", [plain_button(button) for button in state.buttons])
        if ours:
            yield _json("state", ours)
        timers = {t.event: t.delay for t in state.transitions if isinstance(t.delay, float)}
        for event, delay in timers.items():
            name = self._event(state, event)
            send = XmlTag("send", {"event": name, "id": name, "delay": duration(delay * 1000)})
            yield XmlTag("onentry", {}, [send])
            yield XmlTag("onexit", {}, [XmlTag("cancel", {"sendid": name})])
        for tag, steps in (("onentry", state.entry), ("onexit", state.exit)):
            if block := self.orders.block(steps):
                yield XmlTag(tag, {}, block)

    def _invokes(self, state: State) -> Iterator[XmlTag]:
        """Yield an `<invoke>` of each invoked behaviour's exported file; report input that can't be expressed."""
        for invoke in state.invoke:
            file = f"{invoke.behavior}.scxml"
            try:
                params = [
                    XmlTag("param", {"name": key, "expr": self.orders.value(value)})
                    for key, value in invoke.input.items()
                ]
            except ScriptError as error:
                self.report.lost(f"`invoke` of `{invoke.behavior}` is left out: {error}", invoke.where)
                continue
            hint = f"run `lumen export scxml {invoke.behavior} -o {file}`"
            self.report.changed(f"`invoke` of `{invoke.behavior}` needs the file `{file}`", invoke.where, hint)
            yield XmlTag(
                "invoke", {"type": SCXML_INVOKE_TYPE, "id": invoke.id, "src": file, "autoforward": "true"}, params
            )

    def _event(self, state: State, event: str) -> str:
        """Return an event's name in the document.

        The state's own events (`after`, `onDone`) end with its id in the document.
        """
        return event.removesuffix(state.name) + self.ids[state.path] if event.endswith(f".{state.name}") else event

    def _transitions(self, state: State) -> Iterator[XmlTag]:
        for transition in in_asked_order(state.transitions):
            if transition.schedule:
                message = f"`at: {transition.schedule.text}` is left out: SCXML has no time of day"
                self.report.lost(message, transition.where)
                continue
            if isinstance(transition.delay, Template):
                message = f"`after: {transition.delay.shown}` is left out: a computed delay can't be converted"
                self.report.lost(message, transition.where)
                continue
            attributes = {"event": self._event(state, transition.event) if transition.exact else transition.event}
            try:
                if transition.hears:
                    attributes |= self._heard(transition, transition.hears)
                elif transition.guard:
                    attributes["cond"] = self.orders.expression(transition.guard)
            except ScriptError as error:
                what = f"`{transition.hears.title}`" if transition.hears else f"the transition on `{transition.event}`"
                self.report.lost(f"{what} is left out: {error}", transition.where)
                continue
            if transition.offer:
                self.report.changed("`offer` is left out: SCXML has no language model", transition.where)
            if transition.approve:
                self.report.lost("`approve` is left out: SCXML has no approval by a person", transition.where)
            attributes["target"] = self._ids(transition.targets)
            if self._inside(state, transition) and not transition.reenter:
                attributes["type"] = "internal"
            yield XmlTag("transition", attributes, self.orders.block(transition.actions))

    def _heard(self, transition: Transition, row: Hears) -> dict[str, str]:
        """Return the attributes for a row of `hears`, whose condition only Lumen understands.

        Raises ScriptError if the row can't be expressed as a condition.
        """
        if key := key_of(row):
            guard = self.orders.expression(transition.guard) if transition.guard else ""
            self.report.changed(f"`{row.title}` becomes a condition `{HEARS}`", transition.where, LOST_ELSEWHERE)
            return {"lumen:hears": key, "cond": row_condition(key, guard)}
        condition = as_guard(transition)
        if condition is None:
            raise ScriptError(f"`{row.way}` with phrases from a list entry has no counterpart in SCXML")
        self.report.changed(f"`{row.title}` becomes the guard `{condition.source}`", transition.where, LOST_ELSEWHERE)
        return {"cond": self.orders.expression(condition)}

    def _wrapped(self, state: XmlTag) -> Iterator[XmlTag]:
        """Yield the root as a state of the document, and a final state if the root can end."""
        root, id, mark = self.machine.root, self.ids[""], {"lumen:end": "true"}
        yield state
        if root.kind is StateKind.PARALLEL or any(
            self.machine.states[p].kind is StateKind.FINAL for p in root.children
        ):
            leaving = {"event": f"done.state.{id}", "target": f"{id}._end", **mark}
            state.children.insert(0, XmlTag("transition", leaving))
            yield XmlTag("final", {"id": f"{id}._end", **mark})

    def _is_region(self, state: State) -> bool:
        return state.parent is not None and self.machine.states[state.parent].kind is StateKind.PARALLEL

    def _inside(self, state: State, transition: Transition) -> bool:
        below = f"{state.path}." if state.path else ""
        targets = transition.targets
        return state.kind is StateKind.COMPOUND and bool(targets) and all(t and t.startswith(below) for t in targets)

    def _output(self, state: State) -> Iterator[XmlTag]:
        try:
            yield XmlTag("donedata", {}, self.orders.data(state.output))
        except ScriptError as error:
            self.report.lost(f"the output of `{state.name}` is left out: {error}", (*state.where, "output"))


def _free(key: str, others: Container[str]) -> str:
    """Return a context key's name in ECMAScript, with `_` appended while it is reserved or another key."""
    name = key
    while is_reserved(name) or (name != key and name in others):
        name += "_"
    return name


def _json(name: str, data: Any) -> XmlTag:
    return XmlTag(f"lumen:{name}", {}, [], json.dumps(data, ensure_ascii=False))
