"""Build a `MachineDefinition` from the plain data of a behaviour file, `behaviors/NAME.yaml`."""

import hashlib
import json
from collections.abc import Collection, Iterator, Mapping
from dataclasses import replace
from types import MappingProxyType
from typing import Any, NamedTuple

from lumen.expressions import unparse
from lumen.expressions.expression_findings import UNKNOWN_CONTEXT_KEY, UNKNOWN_STATE
from lumen.expressions.own_functions import KnownFunctions
from lumen.language.diagnostics import ERROR, Code, NodePath, did_you_mean
from lumen.language.machines import MachineDefinition, State, StateKind
from lumen.language.shared import SHARED, SharedKey, first_values, shared_schema
from lumen.project.actions import Actions
from lumen.project.added_verbs import NO_VERBS, OwnVerbs
from lumen.project.common_words import COMMON
from lumen.project.document_report import DocumentReport
from lumen.project.expressions import Expressions
from lumen.project.known_words import WordFiles, known_words
from lumen.project.outline import BehaviorOutline, OutlinedState
from lumen.project.rounds import NOTHING_YET, Rounds, unrolled
from lumen.project.shapes import check_shapes
from lumen.project.state_parts import build_properties, check_ids, invocations, read_buttons
from lumen.project.transitions import TransitionReader

NOT_WITHIN = Code("not-within", "statecharts", ERROR, "the state named in `initial` is not one of the inner states")


CONTEXT_PREFIX = "context"
"""The prefix of keys of the context under `renamed`, as in `context.name: context.visitor`."""


def build_machine(
    data: Any,
    report: DocumentReport,
    *,
    name: str,
    words: WordFiles = MappingProxyType({}),
    known: Collection[str] = (),
    shared: Mapping[str, SharedKey] = MappingProxyType({}),
    performed: Collection[str] = (),
    languages: Collection[str] = (),
    shipped: bool = False,
    verbs: OwnVerbs = NO_VERBS,
    functions: KnownFunctions = MappingProxyType({}),
) -> MachineDefinition | None:
    """Return the machine that the data of `behaviors/NAME.yaml` describes; None if it has no states.

    `data` has the shape of behavior.schema.json; any other fault is reported, and the faulty part left out.

    `words` are the words files that the behaviour may name, and `known` the names of all words files, including
    unreadable ones. `shared` are the keys that the robots have in common: the behaviours in `performed`, which robots
    perform, can read them. `languages` are the project's; `shipped` is true if the words file `common` comes with
    Lumen. `verbs` and `functions` are those that the project declares.
    """
    if not isinstance(data, Mapping) or not data.get("states"):
        return None
    common = shared if name in performed and SHARED not in (data.get("context") or {}) else {}
    around = _WordsAround(words, known or words.keys(), languages, shipped, functions)
    builder = _Builder(data, report, name, around, common, verbs)
    return MachineDefinition(**builder.fields())


def fingerprint(data: Any) -> str:
    """Return the SHA-256 of plain data, in hex digits.

    The order of keys counts, because the transitions of a state are tried in the order in which they are written.
    """
    text = json.dumps(data, ensure_ascii=False, separators=(",", ":"))
    return hashlib.sha256(text.encode("utf-8", "surrogatepass")).hexdigest()


class _WordsAround(NamedTuple):
    """The words files that a behaviour may name and the functions that it may call, as given to `build_machine`."""

    files: WordFiles
    known: Collection[str]
    languages: Collection[str]
    shipped: bool
    functions: KnownFunctions


class _Builder:
    """Reads one file: first the tree of its states, then the content of each state."""

    def __init__(
        self,
        data: Mapping[str, Any],
        report: DocumentReport,
        name: str,
        words: "_WordsAround",
        shared: Mapping[str, SharedKey],
        verbs: OwnVerbs,
    ) -> None:
        self.data, self.report, self.files, self.shared = data, report, words.files, shared
        self.outline = BehaviorOutline(data, name, report)
        hears = any("hears" in entry.data for entry in self.outline.entries.values())
        found = known_words(data, report, words.files, words.known, words.languages, shipped=words.shipped, hears=hears)
        self.words = found._replace(functions=words.functions)
        self.rounds = Rounds(self.outline, report, data.get("context") or {}, shared=bool(shared))
        names = {*self.outline.entries, *self.outline.aliases}
        self.expressions = Expressions(report, data, self.words, names, self.rounds)
        self.actions = Actions(report, self.expressions, data.get("units") or {}, verbs)
        self.transitions = TransitionReader(report, self.outline, self.actions, self.expressions)
        self.beginnings: dict[str, tuple[str, ...]] = {}

    def fields(self) -> dict[str, Any]:
        """Return the arguments for `MachineDefinition`, by field name."""
        data = self.data
        check_shapes(self.outline, self.report)
        check_ids(self.outline, self.report)
        return {
            "id": self.outline.root.alias,
            "states": {state.path: state for entry in self.outline.entries.values() for state in self.states(entry)},
            "context": {
                **(data.get("context") or {}),
                **dict.fromkeys(self.rounds.keys.values(), NOTHING_YET),
                **({SHARED: first_values(self.shared)} if self.shared else {}),
            },
            "types": {
                **{k: v for k, v in (data.get("types") or {}).items() if self.expressions.key(k, ("types", k))},
                **({SHARED: shared_schema(self.shared)} if self.shared else {}),
            },
            "events": dict(data.get("events") or {}),
            "properties": build_properties(data, self.report, self.expressions.expression),
            **self.words.tables,
            "words": self.words.files,
            "borrowed": self.words.borrowed,
            "renamed": {was: now for was in data.get("renamed") or {} if (now := self.renamed(was))},
            "hash": fingerprint([data, *borrowed] if (borrowed := list(self.borrowed())) else data),
            "shared": tuple(self.shared),
            "anyhow": self.words.anyhow,
        }

    def borrowed(self) -> Iterator[Any]:
        """Iterate over the data that this machine uses from other files, for its hash."""
        supplied = self.words.supplied
        yield from (
            self.files[name].data
            for name in self.words.files
            if name in self.files and not (name == COMMON and supplied is not None)
        )
        if supplied is not None:
            yield supplied
        yield from ([name, key.type, key.initial] for name, key in self.shared.items())
        for name in sorted(self.expressions.used):
            if function := self.expressions.functions[name]:
                yield [name, [*function.parameters], unparse(function.body)]

    def states(self, entry: OutlinedState) -> Iterator[State]:
        """Yield the state of an entry; if it has `for`, yield the states of the unrolled loop instead."""
        state = self.state(entry)
        loop = self.rounds.read(entry, self.expressions.whole)
        if loop is None:
            yield state
        else:
            yield from unrolled(replace(state, for_each=loop), state.initial)

    def state(self, entry: OutlinedState) -> State:
        data, where = entry.data, entry.where
        return State(
            path=entry.path,
            kind=entry.kind,
            parent=entry.parent.path if entry.parent else None,
            alias=entry.alias,
            children=tuple(child.path for child in entry.children.values()),
            initial=self.initial(entry),
            deep=data.get("history") == "deep",
            entry=self.actions.block(data.get("entry"), (*where, "entry")),
            do=self.actions.block(data.get("do"), (*where, "do"), do=True),
            exit=self.actions.block(data.get("exit"), (*where, "exit")),
            transitions=self.transitions.of(entry),
            invoke=invocations(entry, self.expressions),
            output=self.expressions.value(data.get("output"), (*where, "output")),
            on_reload=self.on_reload(entry),
            resume=data.get("resume", ""),
            life=data.get("life", ""),
            gestures=data.get("gestures", ""),
            buttons=tuple(row.button for row in read_buttons(data.get("buttons"), (*where, "buttons"), entry.name)),
            where=where,
        )

    def initial(self, entry: OutlinedState) -> tuple[str, ...]:
        """Return the paths that are entered by default: those under `initial` or `target`, else the first child."""
        if entry.path not in self.beginnings:
            self.beginnings[entry.path] = (
                self.remembered(entry) if entry.kind is StateKind.HISTORY else self.begin(entry)
            )
        return self.beginnings[entry.path]

    def begin(self, entry: OutlinedState) -> tuple[str, ...]:
        if entry.kind is not StateKind.COMPOUND:
            return ()
        where = (*entry.where, "initial")
        if "initial" in entry.data:
            rows = entry.data["initial"]
            body = [_child(text) for text in rows] if isinstance(rows, list) else _child(rows)
            if found := self.within(entry, entry, body, where, rows):
                return tuple(state.path for state in found)
        return _children(entry)[:1]

    def remembered(self, entry: OutlinedState) -> tuple[str, ...]:
        """Return the paths that a history state without a memory enters: its target, else its parent's default.

        A target that is a history state is reported, and the result is empty.
        """
        parent = entry.parent
        assert parent is not None  # the schema does not allow the root to be a history state
        if "target" in entry.data:
            where = (*entry.where, "target")
            found = self.within(parent, entry, entry.data["target"], where)
            if any(state.kind is StateKind.HISTORY for state in found):
                self.report(
                    NOT_WITHIN, where, "a history can't lead to a history", hint="name a state that is not a history"
                )
                return ()
            return tuple(state.path for state in found)
        begin = _children(parent) if parent.kind is StateKind.PARALLEL else self.initial(parent)
        return begin if entry.path not in begin else _children(parent)[:1]

    def within(
        self, home: OutlinedState, source: OutlinedState, body: Any, where: NodePath, written: Any = None
    ) -> list[OutlinedState]:
        """Return the named states, which must be below `home`; if one is not, report it and return an empty list."""
        found = self.transitions.targets(source, body, where, written) or []
        for state in found:
            if state is home or not state.lies_in(home):
                hint = did_you_mean(state.path, home.children, "it has")
                self.report(NOT_WITHIN, where, f"`{state.path}` is not inside {home.title}", hint=hint)
                return []
        return found

    def on_reload(self, entry: OutlinedState) -> str:
        if "onReload" not in entry.data:
            return ""
        found = self.outline.resolve(entry, entry.data["onReload"], (*entry.where, "onReload"))
        return found.path if found else ""

    def renamed(self, was: str) -> str:
        """Return the present name of an entry under `renamed`, after all renames.

        If no state or key has that name, report it and return an empty string.
        """
        table: Mapping[str, str] = self.data["renamed"]
        seen, now = {was}, table[was]
        while not (found := self.known(now)) and now in table and now not in seen:
            seen.add(now)
            now = table[now]
        if not found:
            self.unknown(table[was], ("renamed", was))
        return found

    def known(self, name: str) -> str:
        """Return the path of a state given by path or id, or `context.KEY` of a known key, else an empty string."""
        entry = self.outline.entries.get(name) or self.outline.aliases.get(name)
        key = name.removeprefix(f"{CONTEXT_PREFIX}.")
        return entry.path if entry else name if key != name and key in (self.data.get("context") or {}) else ""

    def unknown(self, name: str, where: NodePath) -> None:
        """Report a name under `renamed` that no state and no context key has."""
        head, _, key = name.partition(".")
        if head == CONTEXT_PREFIX:
            known = [f"{CONTEXT_PREFIX}.{other}" for other in self.data.get("context") or {}]
            self.report(UNKNOWN_CONTEXT_KEY, where, f"`context` has no `{key}`", hint=did_you_mean(name, known))
        else:
            hint = did_you_mean(name, filter(None, self.outline.entries))
            self.report(UNKNOWN_STATE, where, f"there is no state `{name}`", hint=hint)


def _children(entry: OutlinedState) -> tuple[str, ...]:
    return tuple(child.path for child in entry.children.values() if child.kind is not StateKind.HISTORY)


def _child(target: str) -> str:
    return target if target.startswith(("#", ".")) else f".{target}"
