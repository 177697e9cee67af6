"""What to say of a file that is not YAML: where it went wrong, in a student's words."""

import re
from collections.abc import Sequence
from typing import Any

import yaml

from lumen.language.diagnostics import ERROR, Code, Diagnostic, Place
from lumen.loading.document import TOO_LARGE
from lumen.loading.yaml_composer import TooLargeError

MERGE_CONFLICT = Code("merge-conflict", "text", ERROR, "a merge conflict is not resolved: both sides are in the file")
NOT_UTF8 = Code("not-utf8", "text", ERROR, "a file is not UTF-8 text")
TAB = Code("tab", "text", ERROR, "a line is indented with a tab")
YAML_SYNTAX = Code("yaml-syntax", "text", ERROR, "a file is not YAML")


_LOOK = "look at the indentation, a missing colon, quote or bracket here or in the line above"
_HINTS = {
    "mapping values are not allowed": "put quotes around a text that holds a colon and a blank",
    "cannot start any token": "put quotes around a text that begins with `@`, `%`, a backquote or a quote",
    "another document": "a file holds one document: delete the line `---`",
    "undefined alias": "put quotes around a text that begins with `*`; nothing here has that anchor `&`",
    "could not find expected ':'": "write `:` and a blank behind it if it is a key; else indent it below its key",
    "duplicate anchor": "give each anchor `&` a name of its own",
}
_SMALLER = "split it, or use fewer levels and aliases"
_CONFLICT = re.compile(r"^(<{7}|={7}|>{7})(?= |$)", re.MULTILINE)


def merge_conflict(file: str, text: str) -> Diagnostic | None:
    """What to say of a file that holds both sides of a merge, None where it does not."""
    found = _CONFLICT.search(text)
    if found is None:
        return None
    line = text.count("\n", 0, found.start()) + 1
    place = Place(file, line, 1, line, len(found[0]) + 1)
    hint = "keep one of the two versions, and delete the lines with <<<<<<<, ======= and >>>>>>>"
    return MERGE_CONFLICT.at(place, "a merge conflict is not resolved: both sides are in the file", hint)


def not_utf8(file: str, content: bytes, at: int) -> Diagnostic:
    """What to say of bytes that are no UTF-8 from there on."""
    line = content.count(b"\n", 0, at) + 1
    column = len(content[content.rfind(b"\n", 0, at) + 1 : at].decode("utf-8", "replace")) + 1
    if content[:2] in (b"\xff\xfe", b"\xfe\xff"):
        message = "the file is UTF-16 text, and should be UTF-8"
    else:
        message = (
            f"the file is not UTF-8 text: `{content[at : at + 1].decode('latin-1')}` may be from Windows or Latin-1"
        )
    return NOT_UTF8.at(Place(file, line, column, line, column + 1), message, "save it as UTF-8")


def too_large(file: str, error: TooLargeError) -> Diagnostic:
    """What to say of a file that holds too much."""
    mark = error.mark
    place = Place(file, mark.line + 1, mark.column + 1, mark.line + 1, mark.column + 2) if mark else Place(file)
    return TOO_LARGE.at(place, f"the file is too large to be read: {error}", _SMALLER)


def syntax_error(file: str, text: str, error: Exception) -> Diagnostic:
    if isinstance(error, yaml.reader.ReaderError):
        line = text.count("\n", 0, error.position) + 1
        place = Place(file, line, 1, line, 2)
        return YAML_SYNTAX.at(place, "the file holds a character that YAML does not allow", "delete it")
    if conflict := merge_conflict(file, text):
        return conflict
    context = getattr(error, "context", None) or ""
    mark: Any = getattr(error, "problem_mark", None) or getattr(error, "context_mark", None)
    lines, failed = text.split("\n"), mark.line
    source = lines[failed] if failed < len(lines) else ""  # YAML knows other ends of lines as well
    if "\t" in (before := source[: mark.column + 1]) and not before.strip():
        column = before.index("\t") + 1
        place = Place(file, failed + 1, column, failed + 1, column + 1)
        return TAB.at(place, "a line is indented with a tab", "YAML is indented with spaces: use two")
    if "quoted scalar" in context or _begins_late(error, lines):
        mark = error.context_mark  # type: ignore[attr-defined]
    from lumen.loading.mending import mistake  # only where something slipped
    from lumen.loading.slips import NOT_CLOSED

    if found := mistake(text, mark.line, failed):
        slip, _ = found
        place = Place(file, slip.line, slip.column, slip.line, slip.column + slip.length)
        return YAML_SYNTAX.at(place, slip.message, slip.hint)
    place = Place(file, mark.line + 1, mark.column + 1, mark.line + 1, mark.column + 2)
    if "quoted scalar" in context:
        return YAML_SYNTAX.at(place, *NOT_CLOSED)
    problem = " ".join(str(getattr(error, "problem", error)).split())
    detail = f"{problem} {context}" if context else problem
    hint = next((words for sign, words in _HINTS.items() if sign in problem), _LOOK)
    return YAML_SYNTAX.at(place, f"this is not YAML: {detail}", hint)


def _begins_late(error: Any, lines: Sequence[str]) -> bool:
    """Whether what could not be ended is a key that began in an earlier line."""
    late = "simple key" in (getattr(error, "context", None) or "")
    return late and not "".join(lines[error.context_mark.line :][:1]).lstrip().startswith(("-", "?"))
