"""Findings that the author has reviewed and does not want to see again: `# lumen: ignore[CODE] reason` in the YAML.

A comment at the end of a line applies to that line; a comment on its own line applies to the next line with content.
Errors can't be ignored: they prevent the start in any case.
"""

import re
from collections.abc import Callable, Iterable, Iterator, Mapping
from typing import NamedTuple

from lumen.language.diagnostics import WARNING, Code, Diagnostic, Place, Severity, did_you_mean, has_errors
from lumen.language.text_lines import lines_of
from lumen.project.document import Document

IGNORE_WITHOUT_REASON = Code("ignore-without-reason", "comments", WARNING, "an ignore comment gives no reason")
IGNORED_ERROR = Code("ignored-error", "comments", WARNING, "an ignore comment names the code of an error")
UNKNOWN_CODE = Code("unknown-code", "comments", WARNING, "an ignore comment names no code, or one that does not exist")
UNUSED_IGNORE = Code("unused-ignore", "comments", WARNING, "an ignore comment hides nothing")


_COMMENT = re.compile(r"(?<!\S)#[ \t]*lumen:[ \t]*ignore\b[ \t]*(?:\[(?P<codes>[^\]]*)\])?[ \t]*(?P<reason>.*)")
_WORD = re.compile(r"[^,\s]+")


class Ignore(NamedTuple):
    """A comment that ignores findings in one line."""

    place: Place
    """The place of the comment."""
    line: int
    """The number of the line to which it applies."""
    codes: tuple[tuple[str, Place], ...]
    """The codes that the comment names, each with its place."""
    reason: str
    """The reason; empty if the comment gives none."""


def obey(
    diagnostics: Iterable[Diagnostic], documents: Mapping[str, Document], codes: Callable[[], Mapping[str, Code]]
) -> tuple[Diagnostic, ...]:
    """Return the findings that are not ignored, and the faults of ignore comments, by file and line.

    `codes` returns all codes. It imports all modules that declare some, so it is called only for a comment.
    """
    found = list(diagnostics)
    comments = [c for d in documents.values() if "ignore" in d.text for c in comments_of(d)]
    if not comments:
        return tuple(found)
    by_line = {(c.place.file, c.line, code) for c in comments for code, _ in c.codes}
    hidden = [d for d in found if d.severity is not Severity.ERROR and _spot(d) in by_line]
    gone = {_spot(d) for d in hidden}
    said = [*(d for d in found if d not in hidden)]
    said += [f for c in comments for f in _faults(c, gone, codes(), whole=not has_errors(found))]
    return tuple(sorted(said, key=lambda d: (d.place, d.code, d.message)))


def comments_of(document: Document) -> Iterator[Ignore]:
    """Yield the ignore comments of a document; similar text inside a value is not a comment."""
    lines = lines_of(document.text)
    for number, line in enumerate(lines, 1):
        if (match := _COMMENT.search(line)) and not _in_text(document, number, match.start() + 1):
            place = Place(document.file, number, match.start() + 1, number, len(line.rstrip()) + 1)
            yield Ignore(place, _about(lines, number, match.start()), _codes(place, match), match["reason"].strip())


def _about(lines: list[str], number: int, column: int) -> int:
    if lines[number - 1][:column].strip():
        return number
    rest = enumerate(lines[number:], number + 1)
    return next((n for n, line in rest if line.strip() and not line.lstrip().startswith("#")), number)


def _codes(place: Place, match: re.Match[str]) -> tuple[tuple[str, Place], ...]:
    start = match.start("codes") + 1
    return tuple(
        (word[0], place._replace(column=start + word.start(), end_column=start + word.end()))
        for word in _WORD.finditer(match["codes"] or "")
    )


def _in_text(document: Document, line: int, column: int) -> bool:
    """Return whether a place is inside a key or a text value; comments between the keys of a map are not."""
    here = (line, column)
    return any(
        _holds(span.key, here) or (_holds(span.value, here) and isinstance(document.find(path), str))
        for path, span in document.spans.items()
    )


def _holds(place: Place | None, here: tuple[int, int]) -> bool:
    return place is not None and (place.line, place.column) < here < (place.end_line, place.end_column)


def _spot(diagnostic: Diagnostic) -> tuple[str, int, str]:
    return diagnostic.place.file, diagnostic.place.line, diagnostic.code


def _faults(
    comment: Ignore, gone: set[tuple[str, int, str]], codes: Mapping[str, Code], *, whole: bool
) -> Iterator[Diagnostic]:
    """Yield the faults of a comment.

    A comment that hides nothing is a fault only if the `whole` project was checked.
    """
    if not comment.codes:
        yield _fault(UNKNOWN_CODE, comment.place, "this comment names no code", "write `ignore[CODE] reason`")
    elif not comment.reason:
        hint = "write the reason after the bracket"
        yield _fault(IGNORE_WITHOUT_REASON, comment.place, "this comment gives no reason", hint)
    for code, place in comment.codes:
        if code not in codes:
            hint = did_you_mean(code, codes)
            hint = hint if hint.startswith("did") else "run `lumen explain` to list the codes"
            yield _fault(UNKNOWN_CODE, place, f"there is no code `{code}`", hint)
        elif (comment.place.file, comment.line, code) in gone:
            continue
        elif codes[code].severity is Severity.ERROR:
            hint = "fix the error, and delete this comment"
            yield _fault(IGNORED_ERROR, place, f"`{code}` is an error, which can't be ignored", hint)
        elif whole:
            yield _fault(UNUSED_IGNORE, place, f"there is no `{code}` here to ignore", "delete this comment")


def _fault(code: Code, place: Place, message: str, hint: str) -> Diagnostic:
    return code.at(place, message, hint)
