"""Compose the nodes of a YAML file from libyaml's events.

libyaml's own composer is recursive: 60,000 brackets crash the process. Here the depth and the number of nodes are
counted with each event, and reading stops at a limit. An alias counts as all nodes of the node that it refers to.
"""

from collections.abc import Callable, Mapping
from typing import Any

import yaml
from yaml.composer import ComposerError

from lumen.project.document import MAX_NODE_DEPTH, MAX_NODES

MAX_TAG_DIRECTIVES = 100
"""The maximum number of tag directives; libyaml compares each directive with all before it."""

_TEXT, _LIST, _MAP = "tag:yaml.org,2002:str", "tag:yaml.org,2002:seq", "tag:yaml.org,2002:map"
PLAIN_TAGS = frozenset((_TEXT, _LIST, _MAP))
"""The tags of nodes that have no tag in the file."""


class TooLargeError(Exception):
    """Raised if the file exceeds a limit, which the message names; `mark` is the place of the excess, or None."""

    def __init__(self, what: str, mark: Any) -> None:
        super().__init__(what)
        self.mark = mark


class UnknownAliasError(ComposerError):
    """Raised if an alias names an anchor that is not above it."""

    def __init__(self, name: str, known: tuple[str, ...], mark: Any) -> None:
        super().__init__(None, None, "found undefined alias", mark)
        self.name, self.known, self.mark = name, known, mark


_OLD_BREAKS = "\x85\u2028\u2029"
"""Characters that end a line for libyaml, as in YAML 1.1; in YAML 1.2 they are part of a text."""


def shielded(text: str) -> tuple[str, Mapping[int, str]]:
    """Replace the characters that only YAML 1.1 reads as line breaks; return the text and the map to undo it.

    Each becomes one character of the private use area that is not in the text, so all places stay the same. The map is
    in the form of `str.translate`.
    """
    old = [sign for sign in _OLD_BREAKS if sign in text]
    if not old:
        return text, {}
    free = (code for code in range(0xE000, 0xF900) if chr(code) not in text)
    meant = dict(zip(free, old, strict=False))
    return text.translate({ord(sign): code for code, sign in meant.items()}), meant


def compose(text: str) -> yaml.Node | None:
    """Return the root of the file's only document; None if it is empty. Tags of plain scalars are not resolved.

    Raises TooLargeError, UnknownAliasError, or another YAMLError if the text is not YAML.
    """
    if text.count("%TAG") > MAX_TAG_DIRECTIVES:
        raise TooLargeError(f"more than {MAX_TAG_DIRECTIVES} tag directives", None)
    readable, meant = shielded(text)
    loader = yaml.CSafeLoader(readable)
    try:
        return _Composer(loader, meant).document()
    finally:
        loader.dispose()


class _Composer:
    def __init__(self, loader: yaml.CSafeLoader, meant: Mapping[int, str]) -> None:
        self._meant = meant
        self._next: Callable[[], Any] = loader.get_event
        self._anchors: dict[str, yaml.Node] = {}
        self._sizes: dict[str, int] = {}
        self._count = 0

    def document(self) -> yaml.Node | None:
        self._next()  # the stream begins
        if isinstance(start := self._next(), yaml.StreamEndEvent):
            return None
        root = self._node(self._next(), 0)
        self._next()  # the document ends
        if not isinstance(another := self._next(), yaml.StreamEndEvent):
            expected, problem = "expected a single document in the stream", "but found another document"
            raise ComposerError(expected, start.start_mark, problem, another.start_mark)
        return root

    def _node(self, event: Any, depth: int) -> yaml.Node:
        if depth > MAX_NODE_DEPTH:
            raise TooLargeError(f"nested deeper than {MAX_NODE_DEPTH} levels", event.start_mark)
        kind, before = type(event), self._count
        self._count = before + 1
        if before >= MAX_NODES:
            raise _too_many(event)
        node: yaml.Node
        if kind is yaml.ScalarEvent:  # like most events, which thus need no further call
            value = event.value.translate(self._meant) if self._meant else event.value
            node = yaml.ScalarNode(event.tag or _TEXT, value, event.start_mark, event.end_mark, event.style)
            if event.anchor is None:
                return node
            self._named(event, node)
        elif kind is yaml.AliasEvent:
            return self._named_before(event)
        else:
            node = self._list(event, depth + 1) if kind is yaml.SequenceStartEvent else self._map(event, depth + 1)
        if event.anchor is not None:
            self._sizes[event.anchor] = self._count - before
        return node

    def _list(self, event: Any, depth: int) -> yaml.Node:
        node = self._named(event, yaml.SequenceNode(event.tag or _LIST, [], event.start_mark, None, event.flow_style))
        while type(inner := self._next()) is not yaml.SequenceEndEvent:
            node.value.append(self._node(inner, depth))
        node.end_mark = inner.end_mark
        return node

    def _map(self, event: Any, depth: int) -> yaml.Node:
        node = self._named(event, yaml.MappingNode(event.tag or _MAP, [], event.start_mark, None, event.flow_style))
        while type(inner := self._next()) is not yaml.MappingEndEvent:
            key = self._node(inner, depth)
            node.value.append((key, self._node(self._next(), depth)))
        node.end_mark = inner.end_mark
        return node

    def _named(self, event: Any, node: yaml.Node) -> yaml.Node:
        """Store the node under its anchor, if any, and return it. Anchors may be reused (YAML 1.2, 3.2.2.2)."""
        if event.anchor is not None:
            self._anchors[event.anchor] = node
            self._sizes.pop(event.anchor, None)
        return node

    def _named_before(self, event: Any) -> yaml.Node:
        """Return the node that an alias refers to.

        Raises UnknownAliasError, or TooLargeError if the alias is within that node or there are too many nodes.
        """
        if event.anchor not in self._anchors:
            raise UnknownAliasError(event.anchor, tuple(self._anchors), event.start_mark)
        if event.anchor not in self._sizes:
            raise TooLargeError("an alias refers to the node that contains it", event.start_mark)
        self._count += self._sizes[event.anchor] - 1
        if self._count > MAX_NODES:
            raise _too_many(event)
        return self._anchors[event.anchor]


def _too_many(event: Any) -> TooLargeError:
    return TooLargeError(f"more than {MAX_NODES:,} values", event.start_mark)
