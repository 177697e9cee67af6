"""YAML 1.2 with a place for every node.

PyYAML reads YAML 1.1 (`on:` is true there, `12:30` is 750); here only its parser is used, and scalars are resolved by
the YAML 1.2 core schema. A `Document` keeps plain data beside a table of places, so that every later message can point
at the author's text by the path of the node.
"""

import re
from collections.abc import Callable, Hashable, Iterable, Iterator, Mapping
from dataclasses import dataclass, field
from itertools import chain
from math import inf, nan
from typing import Any, NamedTuple, TypeVar

import yaml

from lumen.language.diagnostics import Diagnostic, NodePath, Place, Related, Severity
from lumen.loading.memoization import memoize

T = TypeVar("T")

MAX_NODE_DEPTH = 100
MAX_NODES = 200_000

_NULL = frozenset(("", "~", "null", "Null", "NULL"))
_BOOL = {"true": True, "True": True, "TRUE": True, "false": False, "False": False, "FALSE": False}
_INT = re.compile(r"[-+]?[0-9]+")
_OCT = re.compile(r"0o[0-7]+")
_HEX = re.compile(r"0x[0-9a-fA-F]+")
_FLOAT = re.compile(r"[-+]?(\.[0-9]+|[0-9]+(\.[0-9]*)?)([eE][-+]?[0-9]+)?")
_INF = re.compile(r"([-+]?)\.(inf|Inf|INF)")
_WHOLE, _DECIMALS = re.compile(r"[-+]?[0-9]+"), re.compile(r"[0-9]+(ms|s|min|h)?")
_QUOTED = re.compile(r"(?<=[`.#])[^`.#]+(?=[`.])")
_LOOK = "look at the indentation, a missing colon, quote or bracket here or in the line above"
_HINTS = {
    "mapping values are not allowed": "put quotes around a text that holds a colon and a blank",
    "cannot start any token": "put quotes around a text that begins with `@`, `%`, a backquote or a quote",
    "another document": "a file holds one document: delete the line `---`",
    "undefined alias": "put quotes around a text that begins with `*`; nothing here has that anchor `&`",
    "could not find expected ':'": "write `:` and a blank behind it if it is a key; else indent it below its key",
    "duplicate anchor": "give each anchor `&` a name of its own",
}
_TAGS = {"!include": "write here what stands in that file: one file can't include another"}
_PLAIN = frozenset(("tag:yaml.org,2002:str", "tag:yaml.org,2002:seq", "tag:yaml.org,2002:map"))
_CONFLICT = re.compile(r"^(<{7}|={7}|>{7})(?= |$)", re.MULTILINE)
_KEYED = re.compile(r" *[A-Za-z_][\w.]*:( |$)")
_NAN = frozenset((".nan", ".NaN", ".NAN"))


class _Loader(yaml.CSafeLoader):
    """Parses and composes; resolves nothing."""


_Loader.yaml_implicit_resolvers = {}


class NodeSpan(NamedTuple):
    """Where a node stands: its key (None in a list and at the root) and its value."""

    key: Place | None
    value: Place


@dataclass(frozen=True)
class Document:
    """One file: its path relative to the project, its text, the plain data in it, and where each node stands.

    `dropped` are the words under keys that stand a second time, and that are not read.
    """

    file: str
    data: Any
    spans: Mapping[NodePath, NodeSpan] = field(default_factory=dict, repr=False, compare=False)
    text: str = field(default="", repr=False, compare=False)
    dropped: frozenset[str] = field(default=frozenset(), repr=False, compare=False)

    def place(self, path: NodePath, *, key: bool = False) -> Place:
        """The place of the node at `path`, or of its key; of the nearest node above it where there is none.

        Where the node itself is missing, that is the key of its parent: what to look at when something is absent.
        """
        if path in self.spans:
            span = self.spans[path]
            return span.key if key and span.key else span.value
        while path:
            path = path[:-1]
            if path in self.spans:
                span = self.spans[path]
                return span.key or span.value._replace(end_line=span.value.line, end_column=span.value.column + 1)
        return Place(self.file)


class DocumentReport:
    """Collects the diagnostics of one document; whoever finds something calls it with the path of the node.

    `pruned` are the paths of nodes that were taken out because they are broken, and `lost` the names that stood in
    them: that such a name is unknown (`unknown-…`) follows from what has been said, and is not said. A key that was
    misspelt counts as pruned under the name that was meant. `missed` are names that stand for nothing: something of
    a like name may have been meant, and looks unused. `whole` is whether everything that the file says was built:
    what is absent in another was perhaps meant by what is broken.
    """

    def __init__(self, document: Document) -> None:
        self.document = document
        self.diagnostics: list[Diagnostic] = []
        self.pruned: set[NodePath] = set()
        self.lost: set[str] = {*document.dropped}
        self.missed: set[str] = set()
        self.whole = True

    def __call__(
        self,
        code: str,
        path: NodePath,
        message: str,
        *,
        hint: str = "",
        key: bool = False,
        severity: Severity = Severity.ERROR,
        related: Iterable[tuple[NodePath, str]] = (),
        cause: str = "",
        root: str = "",
    ) -> None:
        """Report what is wrong with the node at `path`; `related` are nodes of the same document.

        Findings of the same `cause` become one: see `gathered`.
        """
        if not self.follows(code, message):
            place = self.document.place(path, key=key)
            others = tuple(Related(self.document.place(where, key=True), what) for where, what in related)
            self.diagnostics.append(Diagnostic(code, message, place, hint, severity, others, cause, root))

    def copy(self) -> "DocumentReport":
        """Another report that says the same, and to which more can be said."""
        other = DocumentReport(self.document)
        other.take(self)
        return other

    def take(self, other: "DocumentReport") -> None:
        """Say what the other says, and nothing else."""
        self.document = other.document
        self.diagnostics = [*other.diagnostics]
        self.pruned, self.lost, self.missed = {*other.pruned}, {*other.lost}, {*other.missed}

    def memoize(self, slot: Hashable, given: Any, make: Callable[[], T]) -> T:
        """What `make` made and said here when last given the same of the same file, else what it makes and says now."""
        before = (self.document.text, [*self.diagnostics], {*self.pruned}, {*self.lost}, {*self.missed})
        made, after = memoize(slot, (before, given), lambda: (make(), self.copy()))
        self.take(after)
        return made

    def broken(self, path: NodePath) -> bool:
        """Whether the node at `path`, one above it or one in it, was pruned."""
        return any(lost[: len(path)] == path[: len(lost)] for lost in self.pruned)

    def follows(self, code: str, message: str) -> bool:
        """Whether a finding only follows from what was pruned: a name is unknown that stood there."""
        named = code.startswith("unknown-") and code != "unknown-key" and self.lost
        return bool(named) and not self.lost.isdisjoint(_QUOTED.findall(message))


def parse(file: str, content: bytes) -> tuple[Document | None, list[Diagnostic]]:
    """The document in `content`, or None, and what is wrong with it; never raises for what the file holds.

    It depends on nothing else, so that a file that did not change is not read again.
    """
    document, found = memoize(("parse", file), content, lambda: _read(file, content))
    return document, [*found]


def _read(file: str, content: bytes) -> tuple[Document | None, list[Diagnostic]]:
    try:
        text = content.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        return None, [_not_utf8(file, content, error.start)]
    loader = _Loader(text)
    try:
        node = loader.get_single_node()
    except (yaml.MarkedYAMLError, yaml.reader.ReaderError, RecursionError) as error:
        return None, [_syntax_error(file, text, error)]
    finally:
        loader.dispose()
    if node is None:
        return None, [Diagnostic("empty-file", "the file is empty", Place(file), "write its content, or delete it")]
    reader = _Reader(file)
    data = reader.read(node, (), None, 0)
    if "<<<<<<< " in text and (conflict := merge_conflict(file, text)):
        reader.diagnostics.append(conflict)
    return Document(file, data, reader.spans, text, frozenset(reader.dropped)), reader.diagnostics


def resolve(text: str) -> Any:
    """What a plain scalar stands for by the YAML 1.2 core schema (10.3.2)."""
    if text in _NULL:
        return None
    if text in _BOOL:
        return _BOOL[text]
    if text[0] not in "+-.0123456789":
        return text
    if _INT.fullmatch(text):
        return int(text) if len(text) < 300 else float(text)
    if _OCT.fullmatch(text):
        return int(text[2:], 8)
    if _HEX.fullmatch(text):
        return int(text[2:], 16)
    if _FLOAT.fullmatch(text):
        return float(text)
    if match := _INF.fullmatch(text):
        return -inf if match[1] == "-" else inf
    return nan if text in _NAN else text


class _Reader:
    """Turns composed nodes into plain data, remembering where each stood."""

    def __init__(self, file: str) -> None:
        self.file = file
        self.spans: dict[NodePath, NodeSpan] = {}
        self.diagnostics: list[Diagnostic] = []
        self.full = False
        self.dropped: set[str] = set()

    def read(self, node: yaml.Node, path: NodePath, key: yaml.Node | None, depth: int) -> Any:
        self.spans[path] = NodeSpan(self.place(key) if key else None, self.place(node))
        if depth > MAX_NODE_DEPTH or len(self.spans) > MAX_NODES:
            self.overflow(node, depth)
            return None
        if node.tag not in _PLAIN:
            self.say(
                "yaml-tag",
                node,
                "a tag (a word that begins with `!`) means nothing here",
                _TAGS.get(node.tag, "delete the tag"),
            )
        if isinstance(node, yaml.ScalarNode):
            return node.value if node.style else resolve(node.value)
        if isinstance(node, yaml.SequenceNode):
            return [self.read(child, (*path, i), None, depth + 1) for i, child in enumerate(node.value)]
        return self.mapping(node, path, depth)

    def mapping(self, node: yaml.Node, path: NodePath, depth: int) -> dict[str, Any]:
        data: dict[str, Any] = {}
        last: yaml.Node | None = None
        for key, value in node.value:
            before, last = last, value
            if before is not None and data and (number := _decimal(before, key, value)):
                self.comma(before, key, number)
                data[next(reversed(data))] = resolve(number)
            elif not isinstance(key, yaml.ScalarNode):
                hint = "put quotes around a text that begins with `{`"
                self.say("complex-key", key, "a key has to be a single word or text", hint)
            elif key.value in data:
                self.duplicate(key, path)
                if data[key.value] is None:  # the line was doubled, and the second one goes on
                    data[key.value] = self.read(value, (*path, key.value), key, depth + 1)
                else:
                    self.dropped.update(_words(value))
            else:
                data[key.value] = self.read(value, (*path, key.value), key, depth + 1)
        return data

    def comma(self, before: yaml.Node, key: yaml.Node, number: str) -> None:
        """Report a number that was written with a comma."""
        start, end = before.start_mark, key.end_mark
        place = Place(self.file, start.line + 1, start.column + 1, end.line + 1, end.column + 1)
        message = f"a comma ends the number {before.value}, and `{key.value}` would be a key"
        self.diagnostics.append(Diagnostic("decimal-comma", message, place, f"write a point: {number}"))

    def duplicate(self, key: yaml.Node, path: NodePath) -> None:
        """Report a key that stands a second time; those of one map are one finding."""
        first = self.spans[(*path, key.value)].key
        hint = f"the first one stands in line {first.line}" if first else ""
        related = (Related(first, "the first one stands here"),) if first else ()
        message, cause = f"`{key.value}` stands twice in the same place", f"{self.file} twice in {path}"
        self.diagnostics.append(
            Diagnostic("duplicate-key", message, self.place(key), hint, related=related, cause=cause)
        )

    def overflow(self, node: yaml.Node, depth: int) -> None:
        if not self.full:
            self.full = True
            what = (
                f"nested deeper than {MAX_NODE_DEPTH} levels"
                if depth > MAX_NODE_DEPTH
                else f"more than {MAX_NODES:,} values"
            )
            self.say("too-large", node, f"the file is too large to be read: {what}", "split it, or use fewer aliases")

    def say(self, code: str, node: yaml.Node, message: str, hint: str) -> None:
        self.diagnostics.append(Diagnostic(code, message, self.place(node), hint))

    def place(self, node: yaml.Node) -> Place:
        start, end = node.start_mark, node.end_mark
        return Place(self.file, start.line + 1, start.column + 1, end.line + 1, end.column + 1)


def _decimal(before: yaml.Node, key: yaml.Node, value: yaml.Node) -> str:
    """The number that a value and an empty key behind its comma were meant to be; empty where they are none."""
    near = key.start_mark.index == before.end_mark.index + 1 and value.start_mark.index == value.end_mark.index
    plain = near and all(isinstance(node, yaml.ScalarNode) and not node.style for node in (before, key, value))
    if plain and _WHOLE.fullmatch(before.value) and _DECIMALS.fullmatch(key.value):
        return f"{before.value}.{key.value}"
    return ""


def _words(node: yaml.Node) -> Iterator[str]:
    """Every key and text below a node, each part of the file once."""
    waiting, seen = [node], set[int]()
    while waiting:
        item = waiting.pop()
        if isinstance(item, yaml.ScalarNode):
            yield item.value
        elif id(item) not in seen:
            seen.add(id(item))
            waiting += chain.from_iterable(item.value) if isinstance(item, yaml.MappingNode) else item.value


def merge_conflict(file: str, text: str) -> Diagnostic | None:
    """What to say of a file that holds both sides of a merge, None where it does not."""
    found = _CONFLICT.search(text)
    if found is None:
        return None
    line = text.count("\n", 0, found.start()) + 1
    place = Place(file, line, 1, line, len(found[0]) + 1)
    hint = "keep one of the two versions, and delete the lines with <<<<<<<, ======= and >>>>>>>"
    return Diagnostic("merge-conflict", "both sides of a merge stand in the file", place, hint)


def _too_deep(lines: list[str], index: int) -> bool:
    """Whether a line that is a key stands further in than the key with a value above it."""
    above = next((line for line in reversed(lines[:index]) if line.strip()), "")
    here = lines[index] if index < len(lines) else ""
    deeper = len(here) - len(here.lstrip()) > len(above) - len(above.lstrip())
    return deeper and bool(_KEYED.match(here)) and bool(_KEYED.match(above))


def _not_utf8(file: str, content: bytes, at: int) -> Diagnostic:
    """What to say of bytes that are no UTF-8 from there on."""
    line = content.count(b"\n", 0, at) + 1
    column = len(content[content.rfind(b"\n", 0, at) + 1 : at].decode("utf-8", "replace")) + 1
    if content[:2] in (b"\xff\xfe", b"\xfe\xff"):
        message = "the file is UTF-16 text, and should be UTF-8"
    else:
        message = (
            f"the file is not UTF-8 text: `{content[at : at + 1].decode('latin-1')}` may be from Windows or Latin-1"
        )
    return Diagnostic("not-utf8", message, Place(file, line, column, line, column + 1), "save it as UTF-8")


def _syntax_error(file: str, text: str, error: Exception) -> Diagnostic:
    if isinstance(error, yaml.reader.ReaderError):
        line = text.count("\n", 0, error.position) + 1
        place = Place(file, line, 1, line, 2)
        return Diagnostic("yaml-syntax", "the file holds a character that YAML does not allow", place, "delete it")
    if conflict := merge_conflict(file, text):
        return conflict
    context = getattr(error, "context", None) or ""
    if "quoted scalar" in context:
        start = error.context_mark  # type: ignore[attr-defined]
        place = Place(file, start.line + 1, start.column + 1, start.line + 1, start.column + 2)
        hint = "close it with the same sign; a quote inside the text needs the other kind of quotes around it"
        return Diagnostic("yaml-syntax", "a quoted text begins here and is not closed where it should be", place, hint)
    mark = getattr(error, "problem_mark", None) or getattr(error, "context_mark", None)
    if "simple key" in context and not text.splitlines()[error.context_mark.line].lstrip().startswith(("-", "?")):  # type: ignore[attr-defined]
        mark = error.context_mark  # type: ignore[attr-defined]
    if mark is None:
        return Diagnostic("too-large", "the file is nested too deeply to be read", Place(file), "use fewer levels")
    place = Place(file, mark.line + 1, mark.column + 1, mark.line + 1, mark.column + 2)
    lines = text.splitlines()
    source = lines[mark.line] if mark.line < len(lines) else ""
    if "\t" in source[: mark.column + 1] and not source[: mark.column].strip():
        column = source.index("\t") + 1
        place = Place(file, mark.line + 1, column, mark.line + 1, column + 1)
        return Diagnostic("tab", "a tab stands in the indentation", place, "YAML is indented with spaces: use two")
    from lumen.loading.slips import slip_near  # only where something slipped

    if slip := slip_near(lines, mark.line):
        row, column, length, message, hint = slip
        return Diagnostic("yaml-syntax", message, Place(file, row, column, row, column + length), hint)
    problem = " ".join(str(getattr(error, "problem", error)).split())
    detail = f"{problem} {context}" if context else problem
    hint = next((words for sign, words in _HINTS.items() if sign in problem), _LOOK)
    if "mapping values" in problem and _too_deep(lines, mark.line):
        hint = "this line stands further in than the one above, which has its value already: align the two"
    return Diagnostic("yaml-syntax", f"this is not YAML: {detail}", place, hint)
