"""An XState machine configuration as the data of a behaviour file."""

from collections.abc import Mapping
from typing import Any

from lumen.formats.behavior_data import ActionData, TransitionData, quoted, single
from lumen.formats.conversion_findings import ConversionFindings, broken
from lumen.formats.foreign_states import passing_key
from lumen.formats.xstate.action_reader import XStateActionReader
from lumen.formats.xstate.descriptors import bare, descriptor_of, invoke_id, longest_first, translated
from lumen.formats.xstate.invoke_reader import XStateInvokeReader
from lumen.formats.xstate.json_source import parse_json
from lumen.formats.xstate.state_tree import XStateNode, XStateStateTree
from lumen.formats.xstate.transition_reader import XStateTransitionReader
from lumen.interpreters.talk.hearing import HEARD
from lumen.language.diagnostics import Diagnostic
from lumen.language.machines import RESUME_WORDS

_KINDS = ("atomic", "compound", "parallel", "final", "history")
_FOLLOWING = ("on", "always", "after", "invoke", "onDone")
_MEANT = {
    "id", "key", "type", "initial", "states", "on", "always", "after", "entry", "exit", "onDone", "invoke", "history",
    "parallel", "target", "output", "context", "meta", "description", "$schema", "version",
}  # fmt: skip
_MACHINE = ("types", "events", "phrases", "answers", "lists", "properties", "renamed")


def read_xstate(file: str, content: bytes, title: str) -> tuple[dict[str, Any], list[Diagnostic]]:
    """The data of our file, and everything that is not, or not quite, in it; raises ForeignFileError.

    `title` is the behaviour's name where the machine has no id.
    """
    source = parse_json(file, content)
    if (
        not isinstance(source.data, dict)
        or not isinstance(source.data.get("states"), dict)
        or not source.data["states"]
    ):
        hint = "the file should be the object that `createMachine` is given"
        raise broken(source.place(()), "not-xstate", "this is no machine of XState: it has no `states`", hint)
    if isinstance(source.data.get("order"), int) and isinstance(source.data.get("transitions"), list):
        hint = "write JSON.stringify(machine.config)"
        raise broken(source.place(()), "not-xstate", "this is a machine taken apart: JSON.stringify(machine)", hint)
    findings = ConversionFindings()
    outline = XStateStateTree(source, title, findings)
    if not outline.root.regular:
        raise broken(source.place(("states",)), "not-xstate", "the machine has no states")
    context = _context(source.data, findings, outline)
    return _XStateReader(outline, XStateActionReader(source, context, findings), findings).data()


def _context(data: Mapping[str, Any], findings: ConversionFindings, outline: XStateStateTree) -> dict[str, Any]:
    context = data.get("context", {})
    if not isinstance(context, dict):
        findings.lost(outline.source.place(("context",)), "the context is no object")
        return {}
    sound = {key: value for key, value in context.items() if key.isidentifier() and key.isascii()}
    for key in context.keys() - sound.keys():
        findings.lost(outline.source.place(("context", key)), f"`{key}` can't be a context key", "use letters and `_`")
    return sound


class _XStateReader:
    """Reads the states of one file, from the outside to the inside."""

    def __init__(self, outline: XStateStateTree, parts: XStateActionReader, findings: ConversionFindings) -> None:
        self.outline, self.parts, self.findings = outline, parts, findings
        self.transitions = XStateTransitionReader(outline, parts)
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
        for key, value in state.source.items():
            where = (*state.where, key)
            if key == "tags":
                self.parts.changed(where, "`tags` mean nothing here", "ask for the state itself with `In('state')`")
            elif key == "meta" and set(value if isinstance(value, dict) else {"": 0}) != {"lumen"}:
                self.parts.changed(where, "`meta` is not carried over")
            elif key == "output" and state.kind != "final":
                self.parts.lost(where, "`output` of a machine", "give each of its final states an `output`")
            elif key == "type" and value and value not in _KINDS:
                self.parts.lost(where, f"there is no kind of state `{value}`", f"one of {', '.join(_KINDS)}")
            elif key in _FOLLOWING and state.kind == "final" and value:
                self.parts.lost(where, f"`{key}` of a final state: nothing follows it here", "let it be no final state")
            elif key not in _MEANT:
                self.parts.lost(where, f"`{key}` has no counterpart")

    def _history(self, state: XStateNode) -> dict[str, Any]:
        data: dict[str, Any] = {"history": "deep"} if state.source.get("history") == "deep" else {}
        if "target" in state.source:
            found = self.transitions.targets(state, state.source["target"], (*state.where, "target"))
            home = state.parent
            if found and all(target.lies_below(home) for target in found if home is not None):
                data["target"] = self.transitions.named(state, found)
            elif found:
                self.parts.lost((*state.where, "target"), "a history leads to a state beside its own parent")
        return data if "target" in data else data | self._default(state)

    def _default(self, state: XStateNode) -> dict[str, Any]:
        """Where a history leads that names no target: as its parent begins."""
        home = state.parent
        assert isinstance(home, XStateNode)  # the machine itself is never read as a history
        if home.kind == "compound":
            return {"target": self.first[home]}
        return {"target": self.transitions.named(state, list(home.regular))}

    def _initial(self, state: XStateNode) -> str:
        """The key of the child entered first; where actions are done on the way, of a state that does them."""
        where = (*state.where, "initial")
        first = state.regular[0]
        data = state.source.get("initial", first.original)
        target = data.get("target") if isinstance(data, dict) else data
        found = state.child(target) if isinstance(target, str) else None
        if found is None:
            found = self.outline.resolve(state, target) if isinstance(target, str) and target[:1] in "#." else None
        if found is None or not found.lies_below(state):
            self.parts.lost(where, f"`{target}` is no state in this one", "the first one is entered")
            found = first
        name = state.calls(found, self.outline.title, inside=True)
        actions = self.parts.actions(data.get("actions"), (*where, "actions")) if isinstance(data, dict) else []
        return self._pass_through(state, found, actions) if actions else name

    def _pass_through(self, home: XStateNode, target: XStateNode, actions: list[ActionData]) -> str:
        passed = self.passed.setdefault(home, {})
        key = passing_key(home, passed)
        self.parts.changed((*home.where, "initial"), f"what is done here becomes a state of its own, `{key}`")
        name = target.key if target.parent is home else f"#{target.name}"
        passed[key] = {"always": {"target": name, "actions": actions}}
        return key

    def _output(self, state: XStateNode) -> dict[str, Any]:
        if "output" not in state.source:
            return {}
        own = _lumen(state)
        if "output" in own and self.parts.fits({"type": "final", "output": own["output"]}):
            return {"output": own["output"]}
        return {"output": quoted(state.source["output"])}

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
            self.parts.lost((*state.where, "onDone"), "`onDone` of a state that has no states")
        elif "onDone" in state.source and (rows := self.transitions.rows(state, "onDone")):
            data["onDone"] = single(rows)
        data.update(self._on(state, invocations.waits))
        if always := self._always(state):
            data["always"] = single(always)
        if after := self._after(state):
            data["after"] = after
        return data

    def _on(self, state: XStateNode, waits: dict[str, list[TransitionData]]) -> dict[str, Any]:
        """The candidates of each event, and those of the ends that are waited for, as `on`; and the rows of `hears`."""
        rows: dict[str, list[TransitionData]] = {}
        hears: dict[str, list[TransitionData]] = {}
        for event, data in self._table(state, "on").items():
            where = (*state.where, "on", event)
            descriptor = descriptor_of(translated(event, self._named))
            if event == "":
                continue  # version 4's `always`
            if descriptor is None:
                self.parts.lost(where, f"`{event}` is no event", "write names with dots between")
                continue
            if descriptor.startswith("xstate."):
                self.parts.lost(where, f"nothing says `{event}` here", "the transition stays, and is never taken")
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

    def _named(self, id: str) -> str:
        """What the state of that id is called here; the id itself where there is none."""
        found = self.outline.resolve(self.outline.root, f"#{id}")
        return (found.name or self.outline.title) if found else invoke_id(id)

    def _always(self, state: XStateNode) -> list[TransitionData]:
        rows = self.transitions.rows(state, "always") if "always" in state.source else []
        table = state.source.get("on")
        if isinstance(table, dict) and "" in table:
            rows += self.transitions.under(state, (*state.where, "on", ""), table[""], eventless=True)
        return rows

    def _table(self, state: XStateNode, key: str) -> Mapping[str, Any]:
        table = state.source.get(key)
        if table is not None and not isinstance(table, dict):
            self.parts.lost((*state.where, key), f"`{key}` is no object", "write each event, or delay, as a key")
        return table if isinstance(table, dict) else {}

    def _after(self, state: XStateNode) -> dict[str, Any]:
        data: dict[str, Any] = {}
        for text, rows_data in self._table(state, "after").items():
            where = (*state.where, "after", text)
            delay = self.parts.delay(text, where)
            if delay is not None and (rows := self.transitions.under(state, where, rows_data)):
                data[delay] = single(rows)
        return data


def _lumen(state: XStateNode) -> Mapping[str, Any]:
    """What only Lumen has, in `meta`."""
    meta = state.source.get("meta")
    own = meta.get("lumen") if isinstance(meta, dict) else None
    return own if isinstance(own, dict) else {}
