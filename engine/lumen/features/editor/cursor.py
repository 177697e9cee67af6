"""The node at the cursor while its line is still being written."""

import re
from collections.abc import Callable
from typing import NamedTuple

from lumen.features.editor.fragments import fragment
from lumen.language.diagnostics import NodePath
from lumen.language.text_lines import lines_of
from lumen.project.document import Document
from lumen.project.yaml_reader import parse

CURSOR_MARK = "Here0Stands1The2Cursor"
_BEFORE = re.compile(r"[^\s,\[\]{}:'\"()]*$")
_PAIRS = {"[": "]", "{": "}"}


class Cursor(NamedTuple):
    """The node that is being written at the cursor."""

    path: NodePath
    key: bool
    """True if the cursor is in the node's key, False if it is in the value."""
    before: str
    """The node's text before the cursor."""
    word: str
    """The word before the cursor, which a completion replaces."""
    quote: str
    """The quote before the word, empty if there is none."""
    document: Document
    """The parsed lines around the cursor, in which `CURSOR_MARK` is inserted."""


def cursor(text: str, line: int, column: int, readable: Callable[[], str]) -> Cursor | None:
    """Return the node at a line and column, from 1, of a text that may be incomplete; None if it can't be determined.

    `readable` returns the repaired text; it is called only if the lines near the cursor are not sufficient.
    """
    lines = lines_of(text)
    if line > len(lines):
        return None
    near, at = fragment(lines, line - 1, column)
    found = _cursor(near, at + 1, column)
    if found:
        return found
    others = lines_of(readable())
    if len(others) != len(lines):
        return None
    return _cursor([*others[: line - 1], lines[line - 1], *others[line:]], line, column)


def _cursor(lines: list[str], line: int, column: int) -> Cursor | None:
    head, tail = lines[line - 1][: column - 1], lines[line - 1][column - 1 :]
    found = _BEFORE.search(head)
    word = found[0] if found else ""
    begun = head[: -len(word)] if word.startswith(("#", "*", "&", "@", "`", "%")) else head  # these begin YAML syntax
    for middle in [*_attempts(head, tail), *(_attempts(begun, tail) if begun != head else ())]:
        content = "\n".join([*lines[: line - 1], middle, *lines[line:]])
        document, _ = parse("cursor", content.encode("utf-8", "surrogatepass"))
        if document and (node := _marked(document)):
            path, key, value = node
            quote = head[: len(head) - len(word)][-1:]
            return Cursor(path, key, value.partition(CURSOR_MARK)[0], word, quote if quote in "'\"" else "", document)
    return None


def _attempts(head: str, tail: str) -> list[str]:
    """Return versions of the line with the mark that can be valid YAML, the most likely first."""
    rest = head.rstrip("\r")
    closed = _closed(rest)
    whole = [f"{head}{CURSOR_MARK}{tail}"]
    if not tail.strip():
        fresh = not rest.strip(" -") or re.fullmatch(r"[\s-]*[\w.*]*", rest)
        tries = [f"{head}{CURSOR_MARK}{closed}", f"{head}{CURSOR_MARK}: {closed}"]
        return tries[::-1] + whole if fresh else [*tries, *whole]
    return [*whole, f"{head}{CURSOR_MARK}{closed}", f"{head}{CURSOR_MARK}: {closed}", f"{head}{CURSOR_MARK}: x, {tail}"]


def _closed(head: str) -> str:
    """Return the closing quotes and brackets that a line lacks."""
    stack, quote = [], ""
    for character in head:
        if quote:
            quote = "" if character == quote else quote
        elif character in "'\"":
            quote = character
        elif character in _PAIRS:
            stack.append(_PAIRS[character])
        elif stack and character == stack[-1]:
            stack.pop()
    return quote + "".join(reversed(stack))


def _marked(document: Document) -> tuple[NodePath, bool, str] | None:
    """Return the path of the key or text with the mark, True if it is a key, and its text; None without the mark."""
    for path in document.spans:
        if path and isinstance(path[-1], str) and CURSOR_MARK in path[-1]:
            return path, True, path[-1]
        value = document.value(path)
        if isinstance(value, str) and CURSOR_MARK in value:
            return path, False, value
    return None
