"""Reads an XState machine configuration as the data of a behaviour file."""

from collections.abc import Mapping
from typing import Any

from lumen.features.formats_charts.foreign_states import passing_key
from lumen.features.formats_charts.xstate.action_reader import XStateActionReader
from lumen.features.formats_charts.xstate.constants import constant_data
from lumen.features.formats_charts.xstate.descriptors import bare, is_descriptor, longest_first, own_event
from lumen.features.formats_charts.xstate.invoke_reader import XStateInvokeReader
from lumen.features.formats_charts.xstate.json_source import parse_json
from lumen.features.formats_charts.xstate.known import STATE_KINDS, is_version_4, losses
from lumen.features.formats_charts.xstate.names import XStateNames
from lumen.features.formats_charts.xstate.state_tree import XStateNode, XStateStateTree
from lumen.features.formats_charts.xstate.transition_reader import XStateTransitionReader
from lumen.language.diagnostics import Diagnostic, NodePath
from lumen.language.machines import RESUME_WORDS
from lumen.language.numbers import is_number
from lumen.project.formats.behavior_data import ActionData, TransitionData, quoted, single
from lumen.project.formats.conversion_findings import ConversionFindings, broken
from lumen.talk.hearing import HEARD

_MACHINE = ("types", "events", "phrases", "answers", "lists", "properties", "renamed")


def read_xstate(file: str, content: bytes, title: str) -> tuple[dict[str, Any], list[Diagnostic]]:
    """Return the data of a behaviour file, and findings about lost and changed parts.

    `title` is the behaviour's name if the machine has no id. Raises ForeignFileError if the file is not the
    configuration of a machine with states.
    """
    source = parse_json(file, content)
    if (
        not isinstance(source.data, dict)
        or not isinstance(source.data.get("states"), dict)
        or not source.data["states"]
    ):
        hint = "the file must contain the object that is passed to `createMachine`"
        raise broken(source.place(()), "not-xstate", "this is not an XState machine: it has no `states`", hint)
    if isinstance(source.data.get("order"), int) and isinstance(source.data.get("transitions"), list):
        hint = "save JSON.stringify(machine.config)"
        raise broken(
            source.place(()),
            "not-xstate",
            "this is not a machine's configuration, but the result of JSON.stringify(machine)",
            hint,
        )
    findings = ConversionFindings()
    for place, message in source.repeated:
        findings.lost(place, message, "only the last one is used: delete the others")
    outline = XStateStateTree(source, title, findings)
    if not outline.root.regular:
        raise broken(source.place(("states",)), "not-xstate", "the machine has no states")
    context = _context(source.data, findings, outline)
    parts = XStateActionReader(source, context, XStateNames(outline), findings)
    return _XStateReader(outline, parts, findings).data()


def _context(data: Mapping[str, Any], findings: ConversionFindings, outline: XStateStateTree) -> dict[str, Any]:
    context = data.get("context", {})
    if not isinstance(context, dict):
        findings.lost(outline.source.place(("context",)), "the context is not an object")
        return {}
    sound = {key: value for key, value in context.items() if key.isidentifier() and key.isascii()}
    for key in context.keys() - sound.keys():
        findings.lost(
            outline.source.place(("context", key)), f"`{key}` can't be a context key", "use letters, digits and `_`"
        )
    return sound


class _XStateReader:
    """Reads the states of one file, from the outermost state to the innermost."""

    def __init__(self, outline: XStateStateTree, parts: XStateActionReader, findings: ConversionFindings) -> None:
        self.outline, self.parts, self.findings = outline, parts, findings
        self.transitions = XStateTransitionReader(outline, parts, is_version_4(outline.source.data))
        self.invocations = XStateInvokeReader(parts, self.transitions)
        self.first: dict[XStateNode, str] = {}
        self.passed: dict[XStateNode, dict[str, Any]] = {}

    def data(self) -> tuple[dict[str, Any], list[Diagnostic]]:
        own = _lumen(self.outline.root)
        surroundings = {key: own[key] for key in _MACHINE if isinstance(own.get(key), dict)}
        self.parts.surroundings = surroundings
        state = self._state(self.outline.root)
        states = state.pop("states")
        data: dict[str, Any] = {"id": self.outline.title} if self.outline.title else {}
        if self.parts.context:
            data["context"] = self.parts.context
        if types := self.parts.wide | surroundings.get("types", {}):
            surroundings["types"] = types
        return {**data, **surroundings, **state, "states": states}, self.findings.diagnostics

    def _state(self, state: XStateNode) -> dict[str, Any]:
        source, where = state.source, state.where
        self._unmeant(state)
        data: dict[str, Any] = {}
        if state.parent and state.id:
            data["id"] = state.id
        if isinstance(source.get("description"), str):
            data["description"] = source["description"]
        if state.kind in ("parallel", "final", "history"):
            data["type"] = state.kind
        if state.kind == "history":
            return {**data, **self._history(state)}
        if state.kind == "compound":
            data["initial"] = self.first[state] = self._initial(state)
        for key in ("entry", "exit"):
            if key in source and (actions := self.parts.actions(source[key], (*where, key))):
                data[key] = actions
        if state.kind == "final":
            return {**data, **self._output(state)}
        data.update(self._behaviour(state))
        if state.regular:
            data["states"] = {c.key: self._state(c) for c in state.children if isinstance(c, XStateNode)}
            data["states"].update(self.passed.get(state, {}))
        return data

    def _unmeant(self, state: XStateNode) -> None:
        """Report a state's keys and values that are not converted."""
        source, kind = state.source, state.kind
        place = f"{kind} state" if kind in ("parallel", "final", "history") else "state"
        place = place if state.parent else "machine"
        for key, message, hint in losses(place, source):
            if source[key] not in (None, {}, []):
                self.parts.lost((*state.where, key), message, hint)
        for key, value in source.items():
            where = (*state.where, key)
            if key == "tags":
                self.parts.changed(where, "`tags` are left out", "test the state itself with `In('state')`")
            elif key == "meta" and set(value if isinstance(value, dict) else {"": 0}) != {"lumen"}:
                self.parts.changed(where, "`meta` is not carried over")
            elif key in ("output", "data") and kind != "final":
                what = "a machine" if not state.parent else "a state that is not final"
                self.parts.lost(where, f"{what} can't have `{key}`", "give each of its final states an `output`")
            elif key == "type" and value and value not in STATE_KINDS:
                self.parts.lost(where, f"unknown type of state `{value}`", f"write one of {', '.join(STATE_KINDS)}")
            elif (key, value) in (("type", "atomic"), ("type", "final")) and kind not in ("atomic", "final"):
                self.parts.lost(where, f"`type: {value}` is wrong: the state has inner states", "delete it")
            elif key == "initial" and kind == "atomic":
                self.parts.lost(where, "`initial` is left out: the state has no inner states", "delete it")
            elif key == "parallel" and not isinstance(value, bool):
                self.parts.lost(where, f"`parallel` can't be `{value}`", "write true or false")
            elif key == "history" and value not in (True, "shallow", "deep"):
                self.parts.lost(where, f"`history` can't be `{value}`", 'write "shallow" or "deep"')
            elif key in ("id", "description") and not isinstance(value, str):
                self.parts.lost(where, f"`{key}` is not a string", "put it in quotes")
            elif key == "data" and kind == "final" and "output" in source:
                self.parts.lost(where, "`data` beside `output` is left out", "delete one of them")
        for key, value in _lumen(state).items():
            if not self._is_own(state, key, value):
                self.parts.lost(
                    (*state.where, "meta", "lumen", key), f"`{key}` of `meta.lumen` has no counterpart in Lumen"
                )

    def _is_own(self, state: XStateNode, key: str, value: Any) -> bool:
        """Return whether an entry of a state's `meta.lumen` is valid there."""
        match key:
            case "onReload":
                return isinstance(value, str) and self.outline.resolve(state, value) is not None
            case "resume":
                return value in RESUME_WORDS
            case "buttons":
                return isinstance(value, list)
            case "output":
                return state.kind == "final" and self.parts.fits({"type": "final", "output": value})
            case "invoke":
                return isinstance(value, dict)
        return not state.parent and key in _MACHINE and isinstance(value, dict)

    def _history(self, state: XStateNode) -> dict[str, Any]:
        data: dict[str, Any] = {"history": "deep"} if state.source.get("history") == "deep" else {}
        if "target" in state.source:
            found = self.transitions.targets(state, state.source["target"], (*state.where, "target"))
            home = state.parent
            if found and any(target.kind == "history" for target in found):
                self.parts.lost((*state.where, "target"), "a history can't lead to a history", "name a state")
            elif found and all(target.lies_below(home) for target in found if home is not None):
                data["target"] = self.transitions.named(state, found)
            elif found:
                self.parts.lost((*state.where, "target"), "the history's target is outside its parent state")
        return data if "target" in data else data | self._default(state)

    def _default(self, state: XStateNode) -> dict[str, Any]:
        """Return the default `target` of a history: the states in which its parent begins.

        If the parent begins with a history, report that and return the first regular child.
        """
        home = state.parent
        assert isinstance(home, XStateNode)  # the machine itself is never read as a history
        if home.kind == "compound":
            if not any(c.key == self.first[home] and c not in home.regular for c in home.children):
                return {"target": self.first[home]}
            self.parts.lost(
                state.where, "this history leads to a history, the first state of its parent", "give it a `target`"
            )
            return {"target": self.transitions.named(state, home.regular[:1])}
        return {"target": self.transitions.named(state, list(home.regular))}

    def _initial(self, state: XStateNode) -> str:
        """Return a reference to the state entered first, or to an additional state that first runs actions.

        An invalid target is reported and replaced by the first inner state.
        """
        where = (*state.where, "initial")
        first = state.regular[0]
        data = state.source.get("initial", first.original)
        for key, message, hint in losses("initial", data if isinstance(data, dict) else ()):
            self.parts.lost((*where, key), message, hint)
        target = data.get("target") if isinstance(data, dict) else data
        found = state.child(target) if isinstance(target, str) else None
        if found is None:
            found = self.outline.resolve(state, target) if isinstance(target, str) and target[:1] in "#." else None
        if found is None or not found.lies_below(state):
            self.parts.lost(where, f"`{target}` is not inside this state", "the first inner state is entered instead")
            found = first
        name = state.calls(found, self.outline.title, inside=True)
        actions = self.parts.actions(data.get("actions"), (*where, "actions")) if isinstance(data, dict) else []
        return self._pass_through(state, found, actions) if actions else name

    def _pass_through(self, home: XStateNode, target: XStateNode, actions: list[ActionData]) -> str:
        passed = self.passed.setdefault(home, {})
        key = passing_key(home, passed)
        self.parts.changed((*home.where, "initial"), f"these actions become a separate state, `{key}`")
        name = target.key if target.parent is home else f"#{target.name}"
        passed[key] = {"always": {"target": name, "actions": actions}}
        return key

    def _output(self, state: XStateNode) -> dict[str, Any]:
        key = next((key for key in ("output", "data") if key in state.source), "")
        if not key:
            return {}
        own = _lumen(state)
        if "output" in own and self.parts.fits({"type": "final", "output": own["output"]}):
            if state.source[key] != constant_data(own["output"]):
                message = f"`{key}` differs from `meta.lumen.output`, which is used"
                self.parts.changed((*state.where, key), message, "make both equal")
            return {"output": own["output"]}
        return {"output": quoted(state.source[key])}

    def _behaviour(self, state: XStateNode) -> dict[str, Any]:
        data: dict[str, Any] = {}
        own = _lumen(state)
        if isinstance(own.get("onReload"), str) and (found := self.outline.resolve(state, own["onReload"])):
            data["onReload"] = state.calls(found, self.outline.title)
        if own.get("resume") in RESUME_WORDS:
            data["resume"] = own["resume"]
        if isinstance(own.get("buttons"), list):
            data["buttons"] = own["buttons"]
        invocations = self.invocations.of(state, own)
        data.update(invocations.data)
        if "onDone" in state.source and state.kind == "atomic":
            self.parts.lost((*state.where, "onDone"), "`onDone` is left out: the state has no inner states")
        elif "onDone" in state.source and (rows := self.transitions.rows(state, "onDone")):
            data["onDone"] = single(rows)
        data.update(self._on(state, invocations.waits))
        if always := self._always(state):
            data["always"] = single(always)
        if after := self._after(state):
            data["after"] = after
        return data

    def _on(self, state: XStateNode, waits: dict[str, list[TransitionData]]) -> dict[str, Any]:
        """Return `on`, which includes the candidates in `waits`, and `hears`; either is left out if empty."""
        rows: dict[str, list[TransitionData]] = {}
        hears: dict[str, list[TransitionData]] = {}
        for event, where, data in self._table(state, "on", "event"):
            descriptor = self.parts.names.event(event)
            if event == "":
                continue  # version 4's `always`
            if "*" in event and not own_event(event) and descriptor != event:
                self.parts.changed(where, f"the events `{event}` are renamed to `{descriptor}`")
            if not is_descriptor(descriptor):
                self.parts.lost(where, f"`{event}` is not an event", "write names separated by dots")
                continue
            if descriptor.startswith("xstate."):
                self.parts.lost(where, f"Lumen never raises `{event}`", "the transition is kept, but never taken")
            for row in self.transitions.under(state, where, data, heard=bare(descriptor) == HEARD):
                if key := row.pop("hears", ""):
                    hears.setdefault(key, []).append(row)
                else:
                    rows.setdefault(descriptor, []).append(row)
        for descriptor, found in waits.items():
            if found:
                rows.setdefault(descriptor, []).extend(found)
        on = {descriptor: single(rows[descriptor]) for descriptor in longest_first(list(rows))}
        heard = {key: single(found) for key, found in hears.items()}
        return ({"on": on} if on else {}) | ({"hears": heard} if heard else {})

    def _always(self, state: XStateNode) -> list[TransitionData]:
        rows = self.transitions.rows(state, "always") if "always" in state.source else []
        for event, where, data in self._table(state, "on", "event") if "on" in state.source else ():
            if event == "":
                rows += self.transitions.under(state, where, data, eventless=True)
        return rows

    def _table(self, state: XStateNode, key: str, named: str) -> list[tuple[str, NodePath, Any]]:
        """Return the keys of `on` or `after`, their places and transitions; report invalid items.

        Version 4 also allows a list of transitions, each with its key under `named`.
        """
        table, where = state.source.get(key), (*state.where, key)
        if isinstance(table, dict):
            return [(name, (*where, name), rows) for name, rows in table.items()]
        found: list[tuple[str, NodePath, Any]] = []
        for number, row in enumerate(table) if isinstance(table, list) else ():
            name = row.get(named) if isinstance(row, dict) else None
            if isinstance(name, str) or is_number(name):
                rest = {key: value for key, value in row.items() if key != named}
                found.append((str(name), (*where, number), rest))
            else:
                self.parts.lost((*where, number), f"this is not a transition: it has no `{named}`")
        if table is not None and not isinstance(table, list):
            self.parts.lost(where, f"`{key}` is not an object", "write each event or delay as a key")
        return found

    def _after(self, state: XStateNode) -> dict[str, Any]:
        found: dict[str, list[TransitionData]] = {}
        for text, where, rows in self._table(state, "after", "delay"):
            if (delay := self.parts.delay(text, where)) is not None:
                found.setdefault(delay, []).extend(self.transitions.under(state, where, rows))
        return {delay: single(rows) for delay, rows in found.items() if rows}


def _lumen(state: XStateNode) -> Mapping[str, Any]:
    """Return `meta.lumen`, or an empty map."""
    meta = state.source.get("meta")
    own = meta.get("lumen") if isinstance(meta, dict) else None
    return own if isinstance(own, dict) else {}
