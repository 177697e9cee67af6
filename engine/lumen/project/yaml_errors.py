"""Describe the faults of a file that is not YAML so that a student understands them, and find their places."""

import re
from collections.abc import Callable, Sequence
from functools import partial
from typing import Any

import yaml

from lumen.language.diagnostics import ERROR, Code, Diagnostic, Place, mean, nearest
from lumen.language.text_lines import lines_of
from lumen.project.project_folders import kind_of
from lumen.project.yaml_composer import UnknownAliasError

MERGE_CONFLICT = Code("merge-conflict", "text", ERROR, "a merge conflict is not resolved: both sides are in the file")
NOT_UTF8 = Code("not-utf8", "text", ERROR, "a file is not UTF-8 text")
TAB = Code("tab", "text", ERROR, "a line is indented with a tab")
YAML_SYNTAX = Code("yaml-syntax", "text", ERROR, "a file is not YAML")


_LOOK = "check the indentation, and look for a missing colon, quote or bracket here or in the line above"
_HINTS = {
    "mapping values are not allowed": "put quotes around a text that contains a colon and a space",
    "cannot start any token": "put quotes around a text that begins with `@`, `%`, a backquote or a quote",
    "another document": "a file may contain only one document: delete the line `---`",
    "could not find expected ':'": (
        "if this line is a key, write `:` and a space after it;"
        " otherwise, indent the line under the key that it belongs to"
    ),
}
_CONFLICT = re.compile(r"(<{7}|={7}|>{7})(?= |$)")
_NOT_ALLOWED = yaml.reader.Reader.NON_PRINTABLE
TABBED = re.compile(r"[ \t]*\t[ \t]*")
"""The beginning of a line that is indented with a tab."""

TAB_WIDTHS = (2, 4, 8)
"""The numbers of spaces for which a tab may have been meant."""

_MOST_NULS = 0.2
"""The share of zero bytes above which a file counts as UTF-16 without a byte order mark."""


def merge_conflict(file: str, text: str) -> Diagnostic | None:
    """Return the finding about a file that holds both sides of a merge; None if the file does not."""
    begun = (_CONFLICT.match(line) for line in lines_of(text))
    line, found = next(((number, match) for number, match in enumerate(begun, 1) if match), (0, None))
    if found is None:
        return None
    place = Place(file, line, 1, line, len(found[0]) + 1)
    hint = "keep one of the two versions, and delete the lines with <<<<<<<, ======= and >>>>>>>"
    return MERGE_CONFLICT.at(place, "a merge conflict is not resolved: both sides are in the file", hint)


def not_utf8(file: str, content: bytes, at: int) -> Diagnostic:
    """Return the finding about a file whose first byte that is not UTF-8 is at offset `at`."""
    if _is_utf16(content):
        return _utf16(file)
    before = lines_of(content[:at].decode("utf-8-sig", "replace"))
    line, column = len(before), len(before[-1]) + 1
    sign = content[at : at + 1].decode("cp1252", "replace")
    message = f"the file is not UTF-8 text: `{sign}` may be encoded as Windows-1252 or Latin-1"
    return NOT_UTF8.at(Place(file, line, column, line, column + 1), message, "save it as UTF-8")


def _utf16(file: str) -> Diagnostic:
    return NOT_UTF8.at(Place(file, 1, 1, 1, 2), "the file is UTF-16 text, but it must be UTF-8", "save it as UTF-8")


def _is_utf16(content: bytes) -> bool:
    """Return True if the bytes begin with the byte order mark of UTF-16, or contain as many zeros as such a text."""
    return content[:2] in (b"\xff\xfe", b"\xfe\xff") or content.count(0) > _MOST_NULS * len(content)


def not_allowed(file: str, text: str) -> Diagnostic | None:
    """Return the finding for a character that YAML does not allow (5.1); None if there is no such character."""
    found = _NOT_ALLOWED.search(text)
    if found is None:
        return None
    if _is_utf16(text.encode("utf-8", "surrogatepass")):
        return _utf16(file)
    before, sign = lines_of(text[: found.start()]), found[0]
    line, column = len(before), len(before[-1]) + 1
    place = Place(file, line, column, line, column + 1)
    meant = bytes([ord(sign)]).decode("cp1252", "ignore") if "\x80" <= sign <= "\x9f" else ""
    which = f"U+{ord(sign):04X}, {f'`{meant}` of Windows-1252' if meant else 'a control character'}"
    hint = f"replace it with `{meant}`, or delete it" if meant else "delete it: an editor may not show it"
    return YAML_SYNTAX.at(place, f"YAML does not allow the character {which}", hint)


def syntax_error(file: str, text: str, error: Exception) -> Diagnostic:
    """Return the finding about the first syntax error of a file, with the probable mistake as its hint."""
    if found := not_allowed(file, text):  # libyaml counts its place in bytes
        return found
    if isinstance(error, UnknownAliasError):
        return _unknown_alias(file, error)
    if conflict := merge_conflict(file, text):
        return conflict
    context = getattr(error, "context", None) or ""
    mark: Any = getattr(error, "problem_mark", None) or getattr(error, "context_mark", None)
    lines, failed = lines_of(text), mark.line
    source = lines[failed] if failed < len(lines) else ""  # YAML also has other line ends
    if "\t" in (before := source[: mark.column + 1]) and not before.strip():
        column = before.index("\t") + 1
        place = Place(file, failed + 1, column, failed + 1, column + 1)
        return TAB.at(
            place, "this line is indented with a tab, but YAML allows only spaces", _spaces(file, lines, failed)
        )
    if "quoted scalar" in context or _begins_late(error, lines):
        mark = error.context_mark  # type: ignore[attr-defined]
    from lumen.project.mending import mistake  # imported only if there is a syntax error
    from lumen.project.slips import NOT_CLOSED

    if slipped := mistake(text, mark.line, failed, _misfits(file)):
        slip, _ = slipped
        place = Place(file, slip.line, slip.column, slip.line, slip.column + slip.length)
        return YAML_SYNTAX.at(place, slip.message, slip.hint)
    place = Place(file, mark.line + 1, mark.column + 1, mark.line + 1, mark.column + 2)
    if "quoted scalar" in context:
        return YAML_SYNTAX.at(place, *NOT_CLOSED)
    problem = " ".join(str(getattr(error, "problem", error)).split())
    detail = f"{problem} {context}" if context else problem
    hint = next((words for sign, words in _HINTS.items() if sign in problem), _LOOK)
    return YAML_SYNTAX.at(place, f"this is not YAML: {detail}", hint)


def _misfits(file: str) -> Callable[[str], int | None] | None:
    """Return a function that counts the faults which the file's schema finds in a text; None without a schema."""
    from lumen.project.schema import misfits  # late: it imports modules that import this one

    kind = kind_of(file)
    return partial(misfits, kind) if kind else None


def _spaces(file: str, lines: Sequence[str], row: int) -> str:
    """Return a hint with the spaces to write in place of the tabs in that line: as many as `lint --fix` writes."""
    misfits, before = _misfits(file), TABBED.match(lines[row])
    assert before
    for width in TAB_WIDTHS:
        starts = (found.end() if (found := TABBED.match(line)) else 0 for line in lines)
        mended = (line[:n].replace("\t", " " * width) + line[n:] for n, line in zip(starts, lines, strict=True))
        if misfits and misfits("\n".join(mended)) == 0:
            spaces = len(before[0].replace("\t", " " * width))
            return f"indent it with {spaces} spaces: `lumen lint --fix` writes {width} spaces for each tab"
    return "delete the tab, and indent with spaces as in the lines around it"


def _unknown_alias(file: str, error: UnknownAliasError) -> Diagnostic:
    """Return the finding for `*name` without `&name` above it: a misspelt name, or a text that begins with `*`."""
    mark, name = error.mark, error.name
    place = Place(file, mark.line + 1, mark.column + 1, mark.line + 1, mark.column + len(name) + 2)
    quotes = f'put quotes around it if it is a text: "*{name}"'
    hint = mean(f"*{name}", f"*{near}") if (near := nearest(name, error.known)) else quotes
    if error.known and not near:
        hint = f"{quotes}; the anchors above are {', '.join(f'`&{known}`' for known in error.known[:8])}"
    return YAML_SYNTAX.at(place, f"there is no anchor `&{name}` above `*{name}`", hint)


def _begins_late(error: Any, lines: Sequence[str]) -> bool:
    """Return True if the unfinished node is a key that began in an earlier line."""
    late = "simple key" in (getattr(error, "context", None) or "")
    return late and not "".join(lines[error.context_mark.line :][:1]).lstrip().startswith(("-", "?"))
