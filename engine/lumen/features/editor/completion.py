"""Proposals at a cursor: names of the expected kind, or the keys and values of the schema."""

import re
from collections.abc import Iterable, Iterator, Mapping
from typing import Any, NamedTuple

from lumen.expressions.function_table import functions
from lumen.features.editor.analysis import Analysis
from lumen.features.editor.cursor import Cursor, cursor
from lumen.features.editor.grammar import key_kind, value_kind
from lumen.features.editor.heard_rows import ELSE, is_phrase, names_in, row_around, texts_in
from lumen.features.editor.index import WORD_KINDS, NameIndex, stem
from lumen.features.editor.names import NameKind
from lumen.features.editor.schemas import keys_at, values_at
from lumen.language.built_in_routes import BUILT_IN_ROUTES
from lumen.language.diagnostics import NodePath
from lumen.language.events import robot_events
from lumen.language.modules import own_module_events
from lumen.language.routes import Route
from lumen.lint.events import BUILT_IN_FAMILIES, hears
from lumen.project.lending import shipped_message
from lumen.project.outline import THIS
from lumen.project.project_folders import kind_of
from lumen.talk.patterns import TYPES, slots_of
from lumen.talk.speech import TABLES, WORD_LISTS

_CALL = re.compile(r"\b(heard|lookup|In)\([^()]*?(?:\([^()]*\)[^()]*?)*['\"](\w*)$")
_NAMED = {"heard": NameKind.PHRASE, "lookup": NameKind.ANSWERS, "In": NameKind.STATE}
_FIELD = re.compile(r"\b(context|event\.data|event|state|heard)\.(\w*)$")
_SLOT = re.compile(r"\{([\w?]*)$")
_PART = re.compile(r"[^\s|]*$")


_WAYS = {"not": "refused, as in “don't dance”", "asked": "part of a who, why or when question"}
_SLOTS = {
    "name": "one to four words, exactly as spoken",
    "name?": "a name, unless it can be something else",
    "number": "a number, in digits or words",
    "text": "everything that follows",
}


class Item(NamedTuple):
    """A proposal that the editor shows."""

    text: str
    """The text that is inserted."""
    detail: str
    """The kind of the proposed name, or a short remark."""
    replaces: int
    """The number of characters before the cursor that the text replaces."""
    documentation: str = ""
    """A longer description; empty if there is none."""


def complete(analysis: Analysis, file: str, line: int, column: int) -> list[Item]:
    """Return the proposals for a line and column, from 1, the best first; none if the cursor's node is unknown."""
    here = cursor(analysis.text(file), line, column, lambda: analysis.readable_text(file))
    kind = kind_of(file)
    if here is None or not kind:
        return []
    return _fitting(_Completion(analysis, kind, file, here, (line, column)).items(), here.before)


def _fitting(items: Iterable[Item], before: str) -> list[Item]:
    """Return the items that contain the typed letters in order.

    The items that begin with these letters come first, then those that contain them without gaps, then all others.
    """
    ranked = [(rank, item) for item in items if (rank := _rank(item, before)) is not None]
    return [item for _, item in sorted(ranked, key=lambda each: each[0])]


def _rank(item: Item, before: str) -> int | None:
    typed = before[len(before) - item.replaces :].lower() if item.replaces else ""
    text = item.text.lower()
    plain = text.lstrip("\"'#.")
    if text.startswith(typed) or plain.startswith(typed.lstrip("\"'#.")):
        return 0
    if typed in text:
        return 1
    letters = iter(text)
    return 2 if all(letter in letters for letter in typed) else None


class _Completion:
    def __init__(self, analysis: Analysis, kind: str, file: str, here: Cursor, at: tuple[int, int]) -> None:
        self.analysis, self.kind, self.file, self.here, self.at = analysis, kind, file, here, at
        self.index: NameIndex = analysis.names(file)
        self.verbs = analysis.draft.verbs
        self.scope = str(here.path[0]) if kind == "sayings" and here.path else self.index.behavior(file)

    def items(self) -> Iterator[Item]:
        """Yield the proposals for the cursor's key or value."""
        path, here = self.here.path, self.here
        if here.key:
            named = key_kind(self.kind, path)
            if named is NameKind.ROW:
                yield from self.rows(path)
                return
            yield from self.names(named, path, key=True) if named else ()
            yield from self.keys(path[:-1]) if named is None or path[:1] == ("phrases",) else ()
            return
        if is_phrase(self.kind, path) and (slot := _SLOT.search(here.before)):
            names = dict.fromkeys((*TYPES, *self.lists()))
            yield from (Item(f"{name}}}", self.slot_detail(name), len(slot[1])) for name in names)
            return
        named = value_kind(self.kind, path)
        match named:
            case NameKind.EXPRESSION:
                yield from self.expression(here.before, path)
            case NameKind.TEMPLATE:
                opened = here.before.rpartition("{{")[2] if "{{" in here.before else "}}"
                if "}}" not in opened:
                    yield from self.expression(opened, path)
            case NameKind.FIELD:
                yield from self.field(here.before)
            case None:
                pass
            case _:
                yield from self.names(named, path)
        yield from (Item(value, "value", len(here.word)) for value in values_at(self.kind, path, self.verbs))
        if not here.before and named is None:
            yield from self.keys(path)

    def keys(self, path: NodePath) -> Iterator[Item]:
        """Yield the schema's keys that the map at a path does not have yet."""
        there = self.here.document.value(path)
        taken = there if isinstance(there, dict) else {}
        for key, schema in keys_at(self.kind, path, self.verbs).items():
            if key not in taken:
                yield Item(f"{key}: ", "key", len(self.here.word), str(schema.get("description", "")))

    def rows(self, path: NodePath) -> Iterator[Item]:
        """Yield names of phrases and answers for a key of `hears`, and the words that can begin the key."""
        before, there = self.here.before, self.here.document.value(path[:-1])
        part = _PART.search(before)
        wide = len(part[0]) if part else 0
        for kind in (NameKind.PHRASE, NameKind.ANSWERS):
            for name in self.index.known(kind, self.scope):
                if name not in (*WORD_LISTS, *TABLES):
                    yield Item(f"{name}: ", str(kind), wide)
        yield from (Item(f"{name}: ", "of the list's entry", wide) for name in self.entry_fields(path))
        if not before[: len(before) - wide].strip():
            yield from (Item(f"{way} ", detail, wide) for way, detail in _WAYS.items())
            if ELSE not in there:
                yield Item(f"{ELSE}: ", "every sentence that no other row matches", wide)

    def entry_fields(self, path: NodePath) -> Iterator[str]:
        """Yield the fields of the entries of each `for` around a node, such as `question.right`."""
        around = self.index.data(self.scope)
        steps = [*_steps(path), ""]
        for step in steps:
            loop = around.get("for") if isinstance(around, dict) else None
            states = around.get("states") if isinstance(around, dict) else None
            around = states.get(step) if isinstance(states, dict) else None
            if isinstance(loop, dict) and isinstance(loop.get("as"), str):
                found = re.fullmatch(r"\s*lists\.(\w+)\s*", str(loop.get("each", "")))
                entries = self.lists().get(found[1]) if found else ()
                keys = dict.fromkeys(key for entry in entries or () if isinstance(entry, dict) for key in entry)
                yield from (f"{loop['as']}.{key}" for key in keys)

    def lists(self) -> Mapping[str, Any]:
        """Return the file's lists by name, with those of its words files, or for a words file those of its users."""
        found: dict[str, Any] = {}
        users = [name for name, words in self.index.words.items() if self.scope in (name, *words)]
        for scope in dict.fromkeys((self.scope, *(s for name in users for s in (name, *self.index.words[name])))):
            data = self.index.data(scope)
            own = data.get("lists") if isinstance(data, dict) else None
            found = {**(own if isinstance(own, dict) else {}), **found}
        return found

    def slot_detail(self, name: str) -> str:
        """Return the description of a phrase's slot by the name of its type or list."""
        return _SLOTS.get(name, "an entry of the list, by its `phrases`")

    def caught(self, path: NodePath) -> list[str]:
        """Return the members of `heard` in the row of `hears` around a node; an empty list outside such a row."""
        key = row_around(path)
        if not key:
            return []
        found = ["text", "phrase"]
        for name, _ in names_in(key):
            kind = self.index.row_kind(name, self.scope)
            found += ["answer"] if kind is NameKind.ANSWERS else []
            data = self.index.data(self.index.home(kind, name, self.scope))
            table = data.get(WORD_KINDS[kind]) if isinstance(data, dict) else None
            phrases = texts_in(table.get(name) if isinstance(table, dict) else None)
            found += [slot.name for phrase in phrases for slot in slots_of(phrase)]
        return list(dict.fromkeys(found))

    def names(self, kind: NameKind, path: NodePath, *, key: bool = False) -> Iterator[Item]:
        """Yield a proposal for each possible name of a kind at a path."""
        wide, end = len(self.here.word), ": " if key else ""
        for name, detail in self.candidates(kind, path, key=key):
            written = f'"{name}"' if name.startswith("#") and not self.quoted() else name
            yield Item(written + end, detail or str(kind), wide)

    def quoted(self) -> bool:
        """Return True if the cursor is in quotes, where `#` does not begin a comment."""
        return self.here.quote != ""

    def candidates(self, kind: NameKind, path: NodePath, *, key: bool) -> Iterator[tuple[str, str]]:
        """Yield the possible names of a kind at a path, each with its description, which may be empty."""
        match kind:
            case NameKind.STATE:
                yield from self.states(path) if not key or self.kind == "sayings" else ()
            case NameKind.EVENT:
                yield from self.events(waits=key)
            case NameKind.FIELD:
                yield from self.body(path)
            case NameKind.ROUTE:
                yield from ((n, "comes with Lumen" if r.built_in else "") for n, r in self.routes().items())
            case NameKind.LANGUAGE if key and path[-2:-1] == ("say",):
                yield from ((name, "") for name in [*self.index.names(kind), "any"])
            case _:
                scope = self.scope if kind in (NameKind.CONTEXT, NameKind.PHRASE, NameKind.ANSWERS) else ""
                scope = stem(self.file) if kind is NameKind.POSE else scope
                yield from ((name, "") for name in self.index.known(kind, scope))

    def states(self, path: NodePath) -> Iterator[tuple[str, str]]:
        """Yield the possible names of states at a path, each with the state's path.

        In a behaviour these are the state itself, its siblings, its children, and all others by their ids.
        """
        tree = self.index.outlines.get(self.scope)
        if tree is None:
            return
        if self.kind in ("story", "sayings"):
            yield from ((entry.name, entry.path) for entry in tree.entries.values() if entry.path)
            return
        entry = tree.entries.get(".".join(str(step) for step in _steps(path)))
        if entry is None:
            return
        if path[-1] == "initial" or (len(path) > 1 and path[-2] == "initial"):
            yield from ((key, child.path) for key, child in entry.children.items())
            return
        if path[-1] != "onReload":
            yield THIS, "this state again"
        if entry.parent:
            yield from ((key, other.path) for key, other in entry.parent.children.items())
        yield from ((f".{key}", child.path) for key, child in entry.children.items())
        yield from ((f"#{other.name}", other.path) for other in tree.entries.values() if other.parent)

    def events(self, *, waits: bool) -> Iterator[tuple[str, str]]:
        """Yield names of events, each with its origin, which is empty for events of the project's files.

        For an awaited event (`waits`), these are the events that something raises and those in this file, but not those
        that only other files await; otherwise all events in the project's files.
        """
        written = self.index.at(self.file, *self.at)
        uses = [w for w in self.index.uses if w.kind is NameKind.EVENT and w is not written]
        names = dict.fromkeys(w.name for w in uses if w.defines or not waits or w.place.file == self.file)
        yield from ((name, "") for name in names)
        if waits:
            yield from ((name, "the robot's") for name in robot_events() if name not in names)
            yield from ((name, "of a module") for name in self.module_events())
            routed = (route for route in self.routes().values() if route.event and route.event not in names)
            yield from ((route.event, f"from the route `{route.name}`") for route in routed)
            yield from ((f.removesuffix(".") + ".*", "the engine's") for f in BUILT_IN_FAMILIES)

    def field(self, before: str) -> Iterator[Item]:
        """Yield the routes or, after a dot, the fields of the route's message."""
        route, dot, part = before.partition(".")
        if dot:
            yield from (Item(name, "field", len(part)) for name in self.fields(self.schema(route)))
        else:
            yield from (Item(name, "route", len(route)) for name in self.routes())

    def body(self, path: NodePath) -> Iterator[tuple[str, str]]:
        """Yield the fields of the message that the action around a node publishes."""
        around = self.here.document.value(path[:-2])
        route = around.get("route") if isinstance(around, dict) else None
        yield from ((name, "field") for name in self.fields(self.schema(str(route))))

    def expression(self, before: str, path: NodePath) -> Iterator[Item]:
        """Yield the names that continue an expression after the text `before`."""
        if call := _CALL.search(before):
            kind = _NAMED[call[1]]
            names = self.index.known(kind, self.scope)
            if kind is NameKind.STATE and (tree := self.index.outlines.get(self.scope)):
                names = [entry.name for entry in tree.entries.values() if entry.parent]
            yield from (Item(name, str(kind), len(call[2])) for name in names)
        elif found := _FIELD.search(before):
            named = {
                "context": self.index.names(NameKind.CONTEXT, self.scope),
                "event": ["name", "data"],
                "event.data": self.event_fields(path),
                "state": ["path", "language", "place"],
                "heard": self.caught(path),
            }
            yield from (Item(name, f"of {found[1]}", len(found[2])) for name in named[found[1]])
        else:
            part = re.search(r"\w*$", before)
            wide = len(part[0]) if part else 0
            yield from (Item(name, "", wide) for name in self.beginnings(path))
            yield from (Item(f"{name}(", what, wide) for name, what in self.functions())

    def beginnings(self, path: NodePath) -> list[str]:
        """Return the names that can begin an expression; in a function of the project, only its arguments."""
        if self.kind == "function":
            data = self.here.document.data
            arguments = data.get("args") if isinstance(data, dict) else None
            return [*map(str, arguments)] if isinstance(arguments, dict) else []
        return ["context", "event", "state", *(["heard"] if row_around(path) else [])]

    def functions(self) -> Iterator[tuple[str, str]]:
        """Yield the functions that can be called here, with their descriptions, the project's first."""
        own = [name for name in self.index.names(NameKind.FUNCTION) if name not in functions()]
        yield from ((name, "the project's function") for name in own if not self.is_own(name))
        yield from (
            (name, "function") for name, each in functions().items() if self.kind != "function" or not each.scoped
        )

    def is_own(self, function: str) -> bool:
        """Return True if this is the file of that function, which can't call itself."""
        return self.kind == "function" and stem(self.file) == function

    def event_fields(self, path: NodePath) -> list[str]:
        """Return the data fields of the events under whose `on` an expression is; an empty list outside `on`."""
        event = next((str(path[i + 1]) for i in range(len(path) - 2, -1, -1) if path[i] == "on"), "")
        found = (schema for name, schema in self.declared() if event and hears(event, name))
        return list(dict.fromkeys(name for schema in found for name in self.fields(schema)))

    def declared(self) -> Iterator[tuple[str, Any]]:
        """Yield the events of routes, the robot, modules and the file, each with its data's schema."""
        own = self.index.documents.get(self.file)
        yield from ((route.event, self.schema(name)) for name, route in self.routes().items())
        yield from robot_events().items()
        yield from self.module_events().items()
        events = own.data.get("events") if own and isinstance(own.data, dict) else None
        yield from events.items() if isinstance(events, dict) else ()

    def module_events(self) -> Mapping[str, Any]:
        """Return the events of the project's own modules, each with its data's schema."""
        settings = self.analysis.settings.settings
        return own_module_events(settings.modules) if settings else {}

    def routes(self) -> Mapping[str, Route]:
        """Return the project's routes, and Lumen's routes that the project does not replace or remove."""
        settings = self.analysis.settings.settings
        own, removed = (settings.routes, settings.removed_routes) if settings else ({}, frozenset[str]())
        return {**own, **{n: r for n, r in BUILT_IN_ROUTES.items() if n not in own and n not in removed}}

    def schema(self, route: str) -> Any:
        """Return the schema of a route's message, None if the route or its schema is unknown."""
        known = self.routes().get(route)
        return known and (self.analysis.settings.messages.get(known.schema) or shipped_message(known.schema))

    def fields(self, schema: Any) -> list[str]:
        """Return the names of a schema's properties; an empty list if it has none."""
        properties = schema.get("properties") if isinstance(schema, Mapping) else None
        return list(properties) if isinstance(properties, Mapping) else []


def _steps(path: NodePath) -> Iterator[str]:
    """Yield the keys of the states that contain a node, the outermost first."""
    for i in range(0, len(path) - 1, 2):
        if path[i] != "states":
            return
        yield str(path[i + 1])
