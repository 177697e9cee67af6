"""Parse a changed document again, but only the block around the lines that have changed.

All other lines become empty, except the keys around the block and the key after it, which keep the indentation. The
usual parser reads the block, with its places, and the result is inserted into the previous document. If the result
might differ from that of a complete parse, the whole file is parsed instead.
"""

import re
from collections.abc import Callable
from typing import Any

import yaml

from lumen.language.diagnostics import NodePath
from lumen.language.json_paths import with_value
from lumen.language.text_lines import lines_of
from lumen.project.document import MAX_NODES, Document, NodeSpan
from lumen.project.yaml_composer import TooLargeError, compose

Spans = dict[NodePath, NodeSpan]
Read = Callable[[str, yaml.Node, NodePath, yaml.Node], tuple[Any, Spans] | None]
"""A function that returns the data and the places of the node at a path; None if it has a fault.

Its arguments are the text that holds the node, the node, its path, and the node of its key.
"""

_OUTER, _NEXT = "outer", "next"
_FAR_REACHING = re.compile(r"[\r\ufeff]|(?m:^%|^<<<<<<< )|(?<![^\s\[{,:-])&[\w-]")
"""Syntax that changes how other lines are read or separated: line ends, directives, conflicts, anchors."""


def reread(before: Document, text: str, read: Read) -> Document | None:
    """Return the document of `text`, some lines of which differ from `before`; None if it must be parsed as a whole.

    `read` converts the changed block.
    """
    old, new = lines_of(before.text), lines_of(text)
    if len(old) != len(new) or new[-1] or before.dropped or _FAR_REACHING.search(text):
        return None
    changed = [i for i, (one, other) in enumerate(zip(old, new, strict=True)) if one != other]
    path = _block(before, new, changed[0] + 1, changed[-1] + 1) if changed else ()
    if not path or 2 * len(before.spans) > MAX_NODES:
        return None
    fragment = _fragment(before, new, path)
    try:
        found = _found(compose(fragment), len(path) - 1, before.spans[path])
    except (yaml.YAMLError, TooLargeError):
        return None
    made = read(fragment, found[1], path, found[0]) if found and found[0].value == path[-1] else None
    return _with(before, text, path, *made) if made else None


def _block(before: Document, lines: list[str], first: int, last: int) -> NodePath:
    """Return the path of the innermost key alone on a line whose block holds those lines; empty if no key does."""
    path: NodePath = ()
    node = before.data
    while isinstance(node, dict):
        spans = ((key, before.spans.get((*path, key))) for key in node)
        inner = next((key for key, span in spans if span and _holds(span, lines, first, last)), None)
        if inner is None:
            break
        path, node = (*path, inner), node[inner]
    return path


def _holds(span: NodeSpan, lines: list[str], first: int, last: int) -> bool:
    key, value = span
    if key is None or not (key.line < first and last < value.end_line and key.line < value.line):
        return False
    begins_line = not lines[key.line - 1][: key.column - 1].strip(" ")
    return begins_line and key.end_line == key.line and value.end_column <= key.column


def _fragment(before: Document, lines: list[str], path: NodePath) -> str:
    """Return the text with only the block at a path, under keys that are indented like those around it."""
    key, value = before.spans[path]
    assert key
    kept = [""] * len(lines)
    for depth in range(1, len(path)):
        outer = before.spans[path[:depth]].key
        assert outer
        kept[outer.line - 1] = f"{' ' * (outer.column - 1)}{_OUTER}:"
    kept[key.line - 1 : value.end_line - 1] = lines[key.line - 1 : value.end_line - 1]
    if value.end_line < len(lines):
        kept[value.end_line - 1] = f"{' ' * (value.end_column - 1)}{_NEXT}:"
    return "\n".join(kept)


def _found(node: yaml.Node | None, depth: int, span: NodeSpan) -> tuple[yaml.Node, yaml.Node] | None:
    """Return the key and the value of the block; None if its lines contain anything else."""
    for inner in range(depth, -1, -1):
        if not isinstance(node, yaml.MappingNode) or node.flow_style or not node.value:
            return None
        (key, value), *others = node.value
        if any(other.value != _NEXT or other.start_mark.line + 1 != span.value.end_line for other, _ in others):
            return None
        if inner and key.value != _OUTER:
            return None
        node = value
    assert span.key
    here = key.start_mark.line + 1, key.start_mark.column + 1
    return (key, value) if here == (span.key.line, span.key.column) else None


def _with(before: Document, text: str, path: NodePath, made: Any, spans: Spans) -> Document:
    """Return the document with another value at a path; everything else is shared with the previous document."""
    depth, together = len(path), Spans()
    for where, span in before.spans.items():
        if where[:depth] != path:
            together[where] = span
        elif where == path:
            together.update(spans)
    return Document(before.file, with_value(before.data, path, made), together, text)
