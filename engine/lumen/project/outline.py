"""The tree of a behaviour's states, made before their contents are read, so that every target can be resolved."""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from typing import Any

from lumen.expressions.expression_findings import UNKNOWN_STATE
from lumen.language.diagnostics import ERROR, MAX_COMPARED_NAMES, Code, NodePath, did_you_mean, nearest
from lumen.language.machines import StateKind
from lumen.project.document_report import DocumentReport

THIS = "."
"""The target for the state itself, which the transition leaves and enters again."""

DUPLICATE_ID = Code(
    "duplicate-id", "statecharts", ERROR, "two states, or two behaviours that are invoked at once, have the same id"
)


@dataclass(slots=True)
class OutlinedState:
    """A state's place in the tree, and its data in the file."""

    path: str
    parent: "OutlinedState | None"
    data: Mapping[str, Any]
    where: NodePath
    kind: StateKind
    alias: str = ""
    children: "dict[str, OutlinedState]" = field(default_factory=dict)

    def lies_in(self, other: "OutlinedState") -> bool:
        """Return True if this is the other state or lies anywhere below it."""
        entry: OutlinedState | None = self
        while entry is not None and entry is not other:
            entry = entry.parent
        return entry is other

    @property
    def name(self) -> str:
        return self.alias or self.path

    @property
    def title(self) -> str:
        """The name of the state in messages."""
        return f"`{self.path}`" if self.path else "the behaviour itself"


class BehaviorOutline:
    """All states by path, in document order, and by alias."""

    def __init__(self, data: Mapping[str, Any], name: str, report: DocumentReport) -> None:
        self.report = report
        self.entries: dict[str, OutlinedState] = {}
        self.aliases: dict[str, OutlinedState] = {}
        self.root = self._enter("", None, data, ())
        self.root.alias = data.get("id", name)
        for entry in self.entries.values():
            self._alias(entry)

    def resolve(self, source: OutlinedState, target: str, where: NodePath, written: str = "") -> OutlinedState | None:
        """Return the state to which `target` refers in a transition of `source`; None if none, which is reported.

        `written` is the target as the file has it, if that differs. The name of a state that was removed as broken is
        not reported.
        """
        if target == THIS:
            found: OutlinedState | None = source
        elif target.startswith("#"):
            found = self._by_id(target[1:])
        elif target.startswith("."):
            found = _descend(source, target[1:])
        else:
            found = _descend(source.parent, target) if source.parent else None
        if found is None and target.rpartition(".")[2].lstrip("#") not in self.report.lost:
            self._unknown(source, target, where, written or target)
        return found

    def _unknown(self, source: OutlinedState, target: str, where: NodePath, written: str) -> None:
        self.report.missed.add(target.rpartition(".")[2].lstrip("#"))
        message = f"there is no state `{written}` to go to from {source.title}"
        if len(self.report.missed) > MAX_COMPARED_NAMES:  # a search for suggestions would take too long
            self.report(UNKNOWN_STATE, where, message, hint="write the name of a state in this file")
            return
        known = self._known(source, target)
        hint = self._hint(source, target, known)
        if written != target:
            message = f"{source.title} has no state `{written}` to begin in"
            hint = hint.replace("`.", "`")
        meant = self._meant(source, nearest(target, known))
        related = [(meant.where, f"`{meant.name}` is here")] if meant and "mean" in hint else []
        file = self.report.document.file
        cause, root = f"{file} state {target.lstrip('#.')}", f"the states of {file}"
        self.report(UNKNOWN_STATE, where, message, hint=hint, related=related, cause=cause, root=root)

    def _known(self, source: OutlinedState, target: str) -> list[str]:
        """Return the targets that could have been written in place of `target`."""
        if target.startswith("#"):
            return [f"#{e.name}" for e in self.entries.values() if e.name]
        children = [f".{key}" for key in source.children]
        if target.startswith("."):
            return children
        aliases = [f"#{e.alias}" for e in self.entries.values() if e.parent and e.alias]
        return [*(source.parent.children if source.parent else ()), *children, *aliases]

    def _meant(self, source: OutlinedState, target: str) -> OutlinedState | None:
        if target.startswith("#"):
            return self._by_id(target[1:])
        return _descend(source, target[1:]) if target.startswith(".") else _descend(source.parent, target)

    def _hint(self, source: OutlinedState, target: str, known: Iterable[str]) -> str:
        key = target.lstrip("#.")
        if key in source.children:
            return f"`{key}` is a child state: write `.{key}`"
        if loop := self._loop(source, key):
            name = loop.path.rpartition(".")[2]
            return f"it is inside the `for` of `{name}`: go to `#{loop.name}`, which begins with the first entry"
        if self._by_id(key):
            return f"`{key}` is elsewhere in the tree: write `#{key}`"
        if deeper := [e for e in self.entries.values() if e.path.rpartition(".")[2] == key]:
            return f"`{key}` is elsewhere in the tree: write `#{deeper[0].name}`"
        return did_you_mean(target, known)

    def _loop(self, source: OutlinedState, key: str) -> OutlinedState | None:
        """Return the outermost state with a `for` that contains the state `key` but not `source`; None without one."""
        inner = [e for e in self.entries.values() if e.path.rpartition(".")[2] == key]
        state, found = (inner[0].parent if inner else None), None
        while state is not None:
            inside = source.path == state.path or source.path.startswith(f"{state.path}.")
            found = state if "for" in state.data and not inside else found
            state = state.parent
        return found

    def _by_id(self, name: str) -> OutlinedState | None:
        if found := self.aliases.get(name) or (self.entries.get(name) if name else None):
            return found
        head, _, rest = name.partition(".")
        return _descend(self.aliases[head], rest) if rest and head in self.aliases else None

    def _enter(
        self, path: str, parent: OutlinedState | None, data: Mapping[str, Any], where: NodePath
    ) -> OutlinedState:
        entry = OutlinedState(path, parent, data, where, _kind(data), "" if parent is None else data.get("id", ""))
        self.entries[path] = entry
        for key, child in (data.get("states") or {}).items():
            below = f"{path}.{key}" if path else key
            entry.children[key] = self._enter(below, entry, child or {}, (*where, "states", key))
        return entry

    def _alias(self, entry: OutlinedState) -> None:
        alias = entry.alias
        if not alias:
            return
        first = self.aliases.get(alias) or self.entries.get(alias)
        if first is None or first is entry or entry.parent is None:
            self.aliases.setdefault(alias, entry)
        elif first.parent is None and first is self.aliases.get(alias):
            self.aliases[alias] = entry  # a state's id has priority over the behaviour's own name
        else:
            message = f"the id `{alias}` of `{entry.path}` already belongs to {first.title}"
            hint = "give each state its own id"
            if first.alias == alias and entry.path.rpartition(".")[2] == alias != first.path.rpartition(".")[2]:
                self.aliases[alias] = entry  # this state has that name: the other one's id is the fault
                first, entry = entry, first
                message = f"the id `{alias}` of `{entry.path}` belongs to {first.title}"
            before = [((*first.where, "id") if first.alias == alias else first.where, "it belongs to this one")]
            self.report(DUPLICATE_ID, (*entry.where, "id"), message, hint=hint, related=before)
            self.report.lost |= {alias, *entry.path.split(".")}
            entry.alias = ""


def _kind(data: Mapping[str, Any]) -> StateKind:
    if kind := data.get("type"):
        return StateKind(kind)
    return StateKind.COMPOUND if data.get("states") else StateKind.ATOMIC


def _descend(entry: OutlinedState | None, path: str) -> OutlinedState | None:
    for key in path.split("."):
        entry = entry.children.get(key) if entry else None
    return entry
