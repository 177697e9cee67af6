"""The index of the names in a project's files, with their meanings."""

from collections.abc import Iterator, Mapping
from functools import cached_property
from pathlib import PurePosixPath
from typing import Any

from lumen.features.editor.grammar import defines, key_kind, names_verb, value_kind
from lumen.features.editor.heard_rows import names_in
from lumen.features.editor.locating import DocumentText, NameInText, in_expression, in_template
from lumen.features.editor.names import BODY_KINDS, KIND_FOLDERS, SCOPED_KINDS, NameKind, NameUse, covers
from lumen.language.actions import context_key
from lumen.language.diagnostics import NodePath, Place
from lumen.project.document import Document
from lumen.project.document_report import DocumentReport
from lumen.project.memoization import memoize
from lumen.project.messages import SCHEMA_SUFFIX
from lumen.project.outline import BehaviorOutline, OutlinedState
from lumen.project.project_folders import kind_of

WORDS_SCOPE = "words/"
"""The prefix of a words file's scope, before the file's name."""

WORD_KINDS: Mapping[NameKind, str] = {NameKind.PHRASE: "phrases", NameKind.ANSWERS: "answers"}
"""The kinds of names that words files define, each with the key above its definitions."""


class NameIndex:
    """All uses of names in a project, from its readable documents by file.

    `files` are the names of all files, including unreadable ones. Documents without a file come with Lumen; their names
    have no place in the project. `main` is the behaviour that the project runs.
    """

    def __init__(self, documents: Mapping[str, Document], files: frozenset[str], main: str) -> None:
        self.documents, self.files, self._main = documents, files, main
        self.outlines = {stem(file): tree for file, d in documents.items() if (tree := _outline(file, d))}

    @cached_property
    def uses(self) -> tuple[NameUse, ...]:
        """All uses in the order of the documents, followed by the names of the files."""
        found = list[NameUse]()
        for file, document in self.documents.items():
            uses = self._within(document)
            found += uses if file in self.files else [use._replace(text="") for use in uses if use.defines]
        for file in sorted(filter(kind_of, {*self.files, *self.documents})):
            folder = str(PurePosixPath(file).parent)
            found += [
                NameUse(kind, "", stem(file), "", Place(file), True) for kind, f in KIND_FOLDERS.items() if f == folder
            ]
        return tuple(found)

    def _within(self, document: Document) -> tuple[NameUse, ...]:
        """Return the uses in one document.

        They are computed again only after the document or the possible meanings of its names have changed.
        """
        scopes = tuple(self.scopes(document))
        states = [
            (tuple(tree.entries), tuple((name, s.path) for name, s in tree.aliases.items())) if tree else None
            for tree in map(self.outlines.get, scopes)
        ]
        known = [
            (w, kind, tuple(_entries(self.data(w), kind)))
            for scope in scopes
            for w in (scope, *self.words.get(scope, ()))
            for kind in WORD_KINDS
        ]
        given = document.text, scopes, states, known, self.other_body(document.file), self.skills
        return memoize(("uses", document.file), given, lambda: tuple(_Reader(self, document).uses()))

    @cached_property
    def skills(self) -> frozenset[str]:
        """The names of the project's skills."""
        folder = KIND_FOLDERS[NameKind.SKILL]
        return frozenset(stem(file) for file in self.files if file.startswith(f"{folder}/") and file.endswith(".yaml"))

    def at(self, file: str, line: int, column: int) -> NameUse | None:
        """Return the use at a line and column, from 1: the shortest if there are several, None if there is none."""
        here = [use for use in self.uses if use.place.file == file and use.text and covers(use.place, line, column)]
        return min(here, key=lambda use: len(use.text), default=None)

    def of(self, use: NameUse) -> list[NameUse]:
        """Return all uses with the same meaning as this use, including itself."""
        return [other for other in self.uses if other.thing == use.thing]

    def names(self, kind: NameKind, scope: str = "") -> list[str]:
        """Return the names of a kind that a scope defines, in the order of the files."""
        return list(
            dict.fromkeys(use.name for use in self.uses if use.kind is kind and use.scope == scope and use.defines)
        )

    def known(self, kind: NameKind, scope: str) -> list[str]:
        """Return the names known in a scope: its own, and for phrases and answers those of the words files it uses."""
        scopes = (scope, *self.words.get(scope, ())) if kind in WORD_KINDS else (scope,)
        return list(dict.fromkeys(name for each in scopes for name in self.names(kind, each)))

    def home(self, kind: NameKind, name: str, scope: str) -> str:
        """Return the scope that defines a name in a behaviour: its own, or that of a words file it uses.

        An undefined name belongs to the behaviour's own scope.
        """
        if kind not in WORD_KINDS or name in _entries(self.data(scope), kind):
            return scope
        return next((w for w in self.words.get(scope, ()) if name in _entries(self.data(w), kind)), scope)

    def row_kind(self, name: str, scope: str) -> NameKind:
        """Return the kind of a name in a key of `hears`: phrases or answers; phrases if the name is undefined."""
        found = (
            k for k in WORD_KINDS for s in (scope, *self.words.get(scope, ())) if name in _entries(self.data(s), k)
        )
        return next(found, NameKind.PHRASE)

    def data(self, scope: str) -> Any:
        """Return the data of the behaviour or words file with that scope; None if there is none."""
        document = self.documents.get(f"behaviors/{scope}.yaml")
        return document.data if document else None

    @cached_property
    def words(self) -> Mapping[str, tuple[str, ...]]:
        """The scopes of the words files that each behaviour uses.

        The words file that comes with Lumen is last, so all others take precedence over it.
        """
        shipped = {WORDS_SCOPE + stem(file) for file in self.documents.keys() - self.files}
        return {
            stem(file): tuple(sorted(_words(d.data), key=lambda scope: scope in shipped))
            for file, d in self.documents.items()
            if kind_of(file) == "behavior"
        }

    @cached_property
    def own_bodies(self) -> frozenset[str]:
        """The names of the robot model in lumen.yaml and of its base model."""
        robot = self._data("lumen.yaml").get("robot")
        model = str(robot.get("model", "")) if isinstance(robot, dict) else ""
        return frozenset((model, str(self._data(f"models/{model}.yaml").get("like", model))))

    def other_body(self, file: str) -> str:
        """Return the model whose joints and postures a file names; empty for the project's own robot."""
        kind, folder = kind_of(file), PurePosixPath(file).parent.name
        model = stem(file) if kind == "body" else folder if kind == "motion" and file.count("/") > 1 else ""
        return "" if model in self.own_bodies else model

    def _data(self, file: str) -> Mapping[str, Any]:
        document = self.documents.get(file)
        return document.data if document and isinstance(document.data, dict) else {}

    def scopes(self, document: Document) -> Iterator[str]:
        """Yield the scopes of the names in a document: all behaviours of a sayings file, one scope for other files."""
        if kind_of(document.file) == "sayings":
            yield from map(str, document.data if isinstance(document.data, dict) else ())
        else:
            yield self.behavior(document.file)

    def behavior(self, file: str) -> str:
        """Return the scope of the names in a file.

        A story has the scope of its behaviour. One robot's version of a motion has the file's path as its scope.
        """
        if kind_of(file) == "words":
            return WORDS_SCOPE + stem(file)
        if kind_of(file) == "motion" and file.count("/") > 1:
            return file  # one robot's version; a shared motion can have the same name
        if kind_of(file) != "story":
            return stem(file)
        document = self.documents.get(file)
        named = document.data.get("behavior") if document and isinstance(document.data, dict) else None
        return named if isinstance(named, str) else self._main


class _Reader:
    """Finds the uses of names in one document."""

    def __init__(self, index: NameIndex, document: Document) -> None:
        self.index, self.document, self.kind = index, document, kind_of(document.file)
        self.lines = DocumentText(document)
        self.scope = index.behavior(document.file)
        self.outline = index.outlines.get(self.scope)

    def uses(self) -> Iterator[NameUse]:
        """Yield the uses of names in the document."""
        for path, span in self.document.spans.items():
            if self.kind == "sayings" and path:
                self.scope = str(path[0])
                self.outline = self.index.outlines.get(self.scope)
            if span.key and isinstance(path[-1], str) and (kind := key_kind(self.kind, path)):
                yield from self.keyed(kind, path)
            elif span.key and path[-1] in self.index.skills and names_verb(self.kind, path):
                yield from self.named(NameKind.SKILL, path, key=True)
            if span.key and path[-2:-1] == ("after",):
                yield from self.parts(path, str(path[-1]), in_template(str(path[-1])), key=True)
            value = self.document.value(path)
            if isinstance(value, str) and value and (kind := value_kind(self.kind, path)):
                yield from self.valued(kind, path, value)
            elif (
                path[-1:] == ("did",) and self.kind == "story" and isinstance(value, str) and value in self.index.skills
            ):
                yield from self.named(NameKind.SKILL, path)
            elif isinstance(value, str) and path[-1:] == ("id",) and path[-3:-2] == ("states",):
                yield from self.alias(path, value)

    def keyed(self, kind: NameKind, path: NodePath) -> Iterator[NameUse]:
        """Yield the uses of names in the key at `path`, which is of the kind `kind`."""
        key = str(path[-1])
        if kind is NameKind.ROW:
            yield from self.row(path)
        elif kind is NameKind.STATE and self.kind == "sayings":
            yield from self.segments(path, key, key, 0, self._named_state, key=True)
        else:
            yield from self.named(kind, path, key=True)

    def named(self, kind: NameKind, path: NodePath, *, key: bool = False) -> Iterator[NameUse]:
        """Yield the use of the name that is a whole key or value; none for a field or a name in another form."""
        whole = str(path[-1]) if key else str(self.document.value(path))
        text = context_key(whole) if kind is NameKind.CONTEXT else whole
        place = self.lines.part(self.document.place(path, key=key), whole, 0, len(text))
        if place is None or kind is NameKind.FIELD:
            return
        name = _state_at(path) if kind is NameKind.STATE else text
        yield self.use(kind, name, text, place, defining=defines(self.kind, path, kind))

    def row(self, path: NodePath) -> Iterator[NameUse]:
        """Yield the uses of phrases and answers in a key of `hears`."""
        key = str(path[-1])
        names = (NameInText(self.index.row_kind(name, self.scope), name, offset) for name, offset in names_in(key))
        yield from self.parts(path, key, names, key=True)

    def valued(self, kind: NameKind, path: NodePath, value: str) -> Iterator[NameUse]:
        """Yield the uses of names in the value at `path`, which is of the kind `kind`."""
        match kind:
            case NameKind.EXPRESSION:
                yield from self.parts(path, value, in_expression(value))
            case NameKind.TEMPLATE:
                yield from self.parts(path, value, in_template(value))
            case NameKind.STATE:
                yield from self.target(path, value)
            case NameKind.FIELD:
                route = value.partition(".")[0]
                yield from self.parts(path, value, iter([NameInText(NameKind.ROUTE, route, 0)]))
            case _:
                yield from self.named(kind, path)

    def parts(self, path: NodePath, value: str, parts: Iterator[NameInText], *, key: bool = False) -> Iterator[NameUse]:
        """Yield the uses of names in `parts` of the text `value` at a path."""
        place = self.document.place(path, key=key)
        for part in parts:
            if part.kind is NameKind.STATE and not key:
                yield from self.segments(path, value, part.text, part.offset, self._named_state)
            elif here := self.lines.part(place, value, part.offset, len(part.text)):
                yield self.use(part.kind, part.text, part.text, here)

    def target(self, path: NodePath, value: str) -> Iterator[NameUse]:
        """Yield the uses of states in a target, or in a state's name in a story: one for each step of a dotted name."""
        if self.kind == "story":
            yield from self.segments(path, value, value, 0, self._named_state)
        elif self.outline:
            source = self.outline.entries.get(_state_at(path))
            written = f".{value}" if path[-1] == "initial" and value[:1] not in "#." else value
            shift = len(value) - len(written)
            begin = 1 if written[:1] in "#." else 0
            outline = self.outline
            if source:
                found = lambda text: outline.resolve(source, written[:begin] + text, path)  # noqa: E731
                yield from self.segments(path, value, written[begin:], begin + shift, found)

    def segments(
        self, path: NodePath, value: str, dotted: str, offset: int, find: Any, *, key: bool = False
    ) -> Iterator[NameUse]:
        """Yield a use for each step of a dotted name that leads to a state; an id can contain dots itself.

        `dotted` begins at `offset` in `value`; `find` returns a name's state or None.
        """
        place, done = self.document.place(path, key=key), 0
        steps = dotted.split(".")
        for i in range(1, len(steps) + 1):
            entry: OutlinedState | None = find(".".join(steps[:i]))
            if entry is None or not entry.path or not dotted:
                continue
            text = ".".join(steps[done:i])
            at = offset + len(".".join(steps[:done])) + (done > 0)
            done = i
            if here := self.lines.part(place, value, at, len(text)):
                yield self.use(NameKind.STATE, entry.path, text, here)

    def _named_state(self, name: str) -> OutlinedState | None:
        if self.outline is None:
            return None
        return self.outline.entries.get(name) or self.outline.aliases.get(name)

    def alias(self, path: NodePath, value: str) -> Iterator[NameUse]:
        """Yield the use of a state's name that its `id` defines."""
        if place := self.lines.scalar(path):
            yield self.use(NameKind.STATE, _state_at(path), value, place)

    def use(self, kind: NameKind, name: str, text: str, place: Place, *, defining: bool = False) -> NameUse:
        """Return a use of a name, with the scope in which the name is valid."""
        if kind in BODY_KINDS:
            scope = self.index.other_body(self.document.file)
        else:
            scope = self.index.home(kind, name, self.scope) if kind in SCOPED_KINDS else ""
        return NameUse(kind, scope, name, text, place, defining)


def stem(file: str) -> str:
    """Return the name that a file defines: its own without the suffix."""
    name = PurePosixPath(file).name
    return name.removesuffix(SCHEMA_SUFFIX) if name.endswith(SCHEMA_SUFFIX) else PurePosixPath(file).stem


def _entries(data: Any, kind: NameKind) -> Any:
    """Return the names of phrases or answers that a file's data defines, by `kind`; empty if there are none."""
    table = data.get(WORD_KINDS[kind]) if isinstance(data, dict) else None
    return table if isinstance(table, dict) else ()


def _words(data: Any) -> tuple[str, ...]:
    """Return the scopes of the words files that a behaviour's data names."""
    written = data.get("words") if isinstance(data, dict) else None
    rows = [written] if isinstance(written, str) else written if isinstance(written, list) else []
    return tuple(f"{WORDS_SCOPE}{name}" for name in rows)


def _state_at(path: NodePath) -> str:
    """Return the path of the innermost state that contains a node, or whose key the node is; empty if there is none."""
    steps, at = [], 0
    while at + 1 < len(path) and path[at] == "states":
        steps.append(str(path[at + 1]))
        at += 2
    return ".".join(steps)


def _outline(file: str, document: Document) -> BehaviorOutline | None:
    """Return the outline of a behaviour file, which may have errors.

    Return None for other files, or if the states can't be determined.
    """
    if kind_of(file) != "behavior":
        return None
    try:
        return BehaviorOutline(_states(document.data), stem(file), DocumentReport(document))
    except (AttributeError, TypeError, ValueError, RecursionError):
        return None


def _states(data: Any) -> dict[str, Any]:
    """Return the fields of a state's data that the outline reads, without malformed ones."""
    known = data if isinstance(data, dict) else {}
    children, name, kind = known.get("states"), known.get("id"), known.get("type")
    state: dict[str, Any] = {}
    if isinstance(children, dict):
        state["states"] = {key: _states(child) for key, child in children.items()}
    if isinstance(name, str):
        state["id"] = name
    if kind in ("atomic", "compound", "parallel", "final", "history"):
        state["type"] = kind
    return state
