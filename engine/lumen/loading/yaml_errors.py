"""What to say of a file that is not YAML: where it went wrong, in a student's words."""

import re
from typing import Any

import yaml

from lumen.language.diagnostics import ERROR, Code, Diagnostic, Place
from lumen.loading.document import TOO_LARGE
from lumen.loading.yaml_composer import TooLargeError

MERGE_CONFLICT = Code("merge-conflict", "text", ERROR, "both sides of a merge stand in the file")
NOT_UTF8 = Code("not-utf8", "text", ERROR, "a file is not UTF-8 text")
TAB = Code("tab", "text", ERROR, "a tab stands in the indentation")
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
_KEYED = re.compile(r" *[A-Za-z_][\w.]*:( |$)")


def merge_conflict(file: str, text: str) -> Diagnostic | None:
    """What to say of a file that holds both sides of a merge, None where it does not."""
    found = _CONFLICT.search(text)
    if found is None:
        return None
    line = text.count("\n", 0, found.start()) + 1
    place = Place(file, line, 1, line, len(found[0]) + 1)
    hint = "keep one of the two versions, and delete the lines with <<<<<<<, ======= and >>>>>>>"
    return MERGE_CONFLICT.at(place, "both sides of a merge stand in the file", hint)


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
    if "quoted scalar" in context:
        start = error.context_mark  # type: ignore[attr-defined]
        place = Place(file, start.line + 1, start.column + 1, start.line + 1, start.column + 2)
        hint = "close it with the same sign; a quote inside the text needs the other kind of quotes around it"
        return YAML_SYNTAX.at(place, "a quoted text begins here and is not closed where it should be", hint)
    mark: Any = getattr(error, "problem_mark", None) or getattr(error, "context_mark", None)
    if "simple key" in context and not text.splitlines()[error.context_mark.line].lstrip().startswith(("-", "?")):  # type: ignore[attr-defined]
        mark = error.context_mark  # type: ignore[attr-defined]
    place = Place(file, mark.line + 1, mark.column + 1, mark.line + 1, mark.column + 2)
    lines = text.splitlines()
    source = lines[mark.line] if mark.line < len(lines) else ""
    if "\t" in source[: mark.column + 1] and not source[: mark.column].strip():
        column = source.index("\t") + 1
        place = Place(file, mark.line + 1, column, mark.line + 1, column + 1)
        return TAB.at(place, "a tab stands in the indentation", "YAML is indented with spaces: use two")
    from lumen.loading.slips import slip_near  # only where something slipped

    if slip := slip_near(lines, mark.line):
        row, column, length, message, hint = slip
        return YAML_SYNTAX.at(Place(file, row, column, row, column + length), message, hint)
    problem = " ".join(str(getattr(error, "problem", error)).split())
    detail = f"{problem} {context}" if context else problem
    hint = next((words for sign, words in _HINTS.items() if sign in problem), _LOOK)
    if "mapping values" in problem and _too_deep(lines, mark.line):
        hint = "this line stands further in than the one above, which has its value already: align the two"
    return YAML_SYNTAX.at(place, f"this is not YAML: {detail}", hint)


def _too_deep(lines: list[str], index: int) -> bool:
    """Whether a line that is a key stands further in than the key with a value above it."""
    above = next((line for line in reversed(lines[:index]) if line.strip()), "")
    here = lines[index] if index < len(lines) else ""
    deeper = len(here) - len(here.lstrip()) > len(above) - len(above.lstrip())
    return deeper and bool(_KEYED.match(here)) and bool(_KEYED.match(above))
