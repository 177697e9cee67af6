"""Find the quotes and brackets that are open at the end of one line of YAML, without the lines around it."""

from typing import NamedTuple

_PAIRS = {"[": "]", "{": "}"}


class Mark(NamedTuple):
    """A sign and its column, from 0."""

    sign: str
    column: int


class LineMarks(NamedTuple):
    """The unbalanced quotes and brackets of a line; columns count from 0."""

    quote: Mark | None
    """A quote that opens and is not closed; None if there is none."""
    ended: tuple[Mark, Mark] | None
    """The opening and closing quote of a text that is followed by anything but a comma, a colon or a bracket."""
    open: tuple[Mark, ...]
    """Brackets that are not closed, the outer ones first."""
    surplus: tuple[Mark, ...]
    """Closing brackets that match no open one."""
    stop: int
    """The end of the line without trailing blanks and comment."""
    braces: tuple[int, ...]
    """The columns of `{{` at the beginning of an unquoted text."""


def marks_of(line: str) -> LineMarks:
    """Return the marks of a line that does not begin within a quoted text."""
    opened, surplus, braces, bracketed = list[Mark](), list[Mark](), list[int](), False
    ended: tuple[Mark, Mark] | None = None
    i, token, stop = 0, True, 0  # `token`: a text may begin here, so a quote would open it
    while i < len(line):
        sign = line[i]
        if sign == "#" and (i == 0 or line[i - 1] in " \t"):
            break
        if sign in "'\"" and token:
            close = _closing(line, i)
            if close < 0:
                return LineMarks(Mark(sign, i), ended, (*opened,), (*surplus,), len(line.rstrip()), (*braces,))
            if ended is None and not _well_ended(line, close, bool(opened)):
                ended = Mark(sign, i), Mark(sign, close)
            i, token = close, False
        elif sign in _PAIRS and (token or opened):
            if line.startswith("{{", i) and token:
                braces.append(i)
            opened.append(Mark(sign, i))
            token = bracketed = True
        elif sign in _PAIRS.values() and (bracketed or token):
            if opened and _PAIRS[opened[-1].sign] == sign:
                opened.pop()
            else:
                surplus.append(Mark(sign, i))
            token = False
        elif not sign.isspace():
            blank = line[i + 1 : i + 2] in ("", " ")
            token = (sign == "," and bool(opened)) or (sign == ":" and blank) or (sign == "-" and blank and token)
        if not line[i].isspace():
            stop = i + 1
        i += 1
    return LineMarks(None, ended, (*opened,), (*surplus,), stop, (*braces,))


def closers(brackets: tuple[Mark, ...]) -> str:
    """Return the signs that close these brackets, the inner ones first."""
    return "".join(_PAIRS[mark.sign] for mark in reversed(brackets))


def _closing(line: str, start: int) -> int:
    """Return the index of the quote that closes the text which begins there; -1 if none does."""
    quote, i = line[start], start + 1
    while i < len(line):
        if quote == '"' and line[i] == "\\":
            i += 1
        elif line[i] == quote:
            if quote == "'" and line.startswith("''", i):
                i += 1
            else:
                return i
        i += 1
    return -1


def _well_ended(line: str, close: int, within: bool) -> bool:
    """Return True if the characters after a quoted text are allowed there."""
    rest = line[close + 1 :]
    text = rest.lstrip()
    if not text or (text[0] == "#" and rest != text):
        return True
    return text[0] == ":" or (within and text[0] in ",]}")
