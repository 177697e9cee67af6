"""The states of an XState machine before their content is read, and the resolution of targets."""

from collections.abc import Mapping
from typing import Any

from lumen.features.formats_charts.foreign_states import MAX_STATE_LEVELS, ForeignState, clean_id, free_id, free_key
from lumen.features.formats_charts.xstate.json_source import JsonSource
from lumen.language.diagnostics import NodePath
from lumen.project.formats.conversion_findings import ConversionFindings


class XStateNode(ForeignState):
    """A state of an XState machine; `source` is its JSON."""

    __slots__ = ("named", "original", "regular", "where")

    original: str
    """The state's key in the file."""
    where: NodePath
    """The state's path in the file."""
    named: "dict[str, XStateNode]"
    """The children, by their keys in the file."""
    regular: "list[XStateNode]"
    """The children that can be active: all except histories."""

    @property
    def kind(self) -> str:
        """The state's kind, from its declared type and its children."""
        kind = declared_kind(self.source)
        if kind in ("final", "history") or (kind == "parallel" and self.regular):
            return kind
        return "compound" if self.regular else "atomic"

    @property
    def foreign_id(self) -> str:
        """The state's id in XState: its own, else its parent's id and its key, joined by a dot.

        It is `(machine)` for a root without an id.
        """
        if isinstance(self.source.get("id"), str) and self.source["id"]:
            return str(self.source["id"])
        below = self.parent.foreign_id if isinstance(self.parent, XStateNode) else ""
        return f"{below}.{self.original}" if below else "(machine)"

    def child(self, key: str) -> "XStateNode | None":
        """Return the child with this key in the file, or None."""
        return self.named.get(key)


def declared_kind(data: Mapping[str, Any]) -> str:
    """Return the kind that a state declares, or empty; `history` needs no `type`, and version 4 has `parallel`."""
    if data.get("type"):
        return str(data["type"])
    if data.get("parallel") is True:
        return "parallel"
    return "history" if data.get("history") and not data.get("states") else ""


class XStateStateTree:
    """The tree of states under `root`; `by_id` has the states with an id."""

    def __init__(self, source: JsonSource, title: str, findings: ConversionFindings) -> None:
        self.source, self.findings = source, findings
        own = source.data.get("id") or source.data.get("key")  # version 4's name for `id`
        self.machine_id = own if isinstance(own, str) and own else "(machine)"
        self.title = clean_id(own) if isinstance(own, str) and own else title
        self.ids = set(_ids(source.data))
        self.by_id: dict[str, XStateNode] = {}
        self.given: set[str] = set()
        self.root = self._state(source.data, None, "", "", ())
        self._fill(self.root, 1)

    def _state(
        self, data: Mapping[str, Any], parent: ForeignState | None, key: str, original: str, where: NodePath
    ) -> XStateNode:
        id = data.get("id") if parent is not None else None
        named = free_id(id, self.ids, self.given) if isinstance(id, str) else ""
        if isinstance(id, str) and id != named:
            message = f"the state `{id}` is renamed to `{named}` in the whole behaviour"
            self.findings.changed(self.source.place((*where, "id")), message, "an id can't contain spaces, `#` or `*`")
        self.given.add(named)
        path = parent.below(key) if parent else ""
        state = XStateNode(data, parent, key, "" if named == path else named, path)
        state.original, state.where, state.named, state.regular = original, where, {}, []
        return state

    def _fill(self, parent: XStateNode, level: int) -> None:
        for original, data in self._states(parent, level).items():
            where = (*parent.where, "states", original)
            if data is None:
                data = {}
            id = data.get("id") if isinstance(data, dict) else None
            if not isinstance(data, dict):
                self.findings.lost(
                    self.source.place(where), f"`{original}` is not a state", "write a state as an object"
                )
            elif isinstance(id, str) and id in self.by_id:
                self.findings.lost(
                    self.source.place(where), f"a second state has the id `{id}`", "give each state its own id"
                )
            else:
                key = free_key(parent, original, clean_id(id) if isinstance(id, str) else "", self.ids)
                state = self._state(data, parent, key, original, where)
                parent.add(state)
                parent.named[original] = state
                if declared_kind(data) != "history":
                    parent.regular.append(state)
                if isinstance(id, str):
                    self.by_id[id] = state
                self._fill(state, level + 1)
        if parent.children and not parent.regular:
            self.findings.lost(
                self.source.place(parent.where),
                "the history is left out: its state has no other inner states",
                "delete it",
            )
            for child in parent.named.values():
                self.by_id.pop(child.source.get("id", ""), None)
            parent.children.clear()
            parent.named.clear()

    def _states(self, parent: XStateNode, level: int) -> Mapping[str, Any]:
        states = parent.source.get("states") or {}
        if level > MAX_STATE_LEVELS or not isinstance(states, dict):
            what = (
                f"states are nested more than {MAX_STATE_LEVELS} levels deep"
                if level > MAX_STATE_LEVELS
                else "`states` is not an object"
            )
            if states:
                self.findings.lost(self.source.place((*parent.where, "states")), what)
            return {}
        if declared_kind(parent.source) in ("final", "history") and states:
            kind = declared_kind(parent.source)
            self.findings.lost(self.source.place((*parent.where, "states")), f"a {kind} state has no inner states")
            return {}
        return states

    def resolve(self, state: XStateNode, target: str) -> XStateNode | None:
        """Return the state that `target` names in a transition of `state`; None if it does not exist."""
        if target.startswith("#"):
            return self._by_id(target[1:])
        if target.startswith("."):
            return _descend(state, target[1:])
        parent = state.parent
        return _descend(parent, target) if isinstance(parent, XStateNode) else None

    def _by_id(self, id: str) -> XStateNode | None:
        if id in self.by_id:
            return self.by_id[id]
        heads: dict[str, XStateNode] = {**self.by_id, self.machine_id: self.root}
        for head in sorted(heads, key=len, reverse=True):
            if id == head:
                return heads[head]
            if id.startswith(f"{head}."):
                return _descend(heads[head], id[len(head) + 1 :])
        return None


def _descend(state: XStateNode | None, path: str) -> XStateNode | None:
    """Return the state at a path of keys, the last of which can contain dots; None if it does not exist."""
    if state is None:
        return None
    if (found := state.child(path)) is not None:
        return found
    head, _, rest = path.partition(".")
    below = state.child(head)
    return _descend(below, rest) if rest else below


def _ids(data: Any) -> list[str]:
    found, states = [], [data]
    while states:
        state = states.pop()
        if not isinstance(state, dict):
            continue
        if isinstance(state.get("id"), str):
            found.append(state["id"])
        children = state.get("states")
        states += children.values() if isinstance(children, dict) else ()
    return found
