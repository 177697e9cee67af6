"""Find typing mistakes, and characters that word processors change, in one line; each with the corrected line.

The public functions get the text of a line and its index in the file, from 0.
"""

import json
import re
from collections.abc import Iterator, Mapping
from typing import NamedTuple

from lumen.project.line_marks import LineMarks, Mark, closers, marks_of

KEY = r"[A-Za-z_][\w.]*"


class Slip(NamedTuple):
    """A typing mistake, with its correction. Its line and column count from 1."""

    line: int
    column: int
    length: int
    message: str
    hint: str
    meant: Mapping[int, str]
    """The corrected lines, by index from 0."""
    only_whole: bool = False
    """True if the slip counts only if its correction makes the whole file valid YAML, not merely more of the file."""


NOT_CLOSED = (
    "a quoted text begins here and is not closed",
    "close it with the same quote; if the text contains that quote, use the other kind of quote around the text",
)
NO_COMMA = "a comma is missing between two entries in brackets", "write `,` here"
COLON_IN_TEXT = "a text that contains a colon and a space needs quotes"
BARE_BRACES = "without quotes, `{{` begins a map here"
QUOTE_BRACES = 'put quotes around the text: "{{ … }}"'

_SIGNS: tuple[tuple[re.Pattern[str], str, str, str], ...] = (
    (
        re.compile("^ *(?P<slip>[\u00ad\u200b-\u200f\u2060\ufeff]+)"),
        "",
        "there is an invisible character here",
        "delete it: it may come from copied text",
    ),
    (
        re.compile("^[ ]*(?P<slip>[\u00a0\u2007\u202f\u3000]+)"),
        " ",
        "this character in the indentation looks like a space, but it is not",
        "replace it with spaces",
    ),
    (
        re.compile(f"^ *(?:- )?{KEY}(?P<slip>： ?)"),
        ": ",
        "this is a full-width colon, as in Chinese or Japanese text",
        "write `:` and a space",
    ),
    (
        re.compile(f"^ *(?:- )?{KEY}:(?P<slip>[\u00a0\u2007\u202f\u3000\u200b]+)"),
        " ",
        "this character looks like a space, but it is not",
        "replace it with a space",
    ),
    (
        re.compile("^ *(?P<slip>[–—•*]) +\\w"),
        "-",
        "this list item does not begin with a hyphen",
        "write `- `",
    ),
    (
        re.compile(f"^ *(?P<slip>-)(?={KEY}:(?: |$))"),
        "- ",
        "a space is missing after the hyphen",
        "write `- `",
    ),
    (
        re.compile(f"^ *(?:- )?{KEY}(?P<slip>:)(?=[A-Za-z\"'\\[{{][^ ]*$)(?!//)"),
        ": ",
        "a space is missing after the colon",
        "write `: `",
    ),
    (
        re.compile(f"^ *(?:- )?{KEY}(?P<slip> ?=) ?(?=[^=>])"),
        ": ",
        "a colon is missing between the key and its value",
        "write `: `",
    ),
    (
        re.compile(f"^ *(?:- )?{KEY}(?P<slip> *;)(?: |$)"),
        ":",
        "this is a semicolon, but a key needs a colon",
        "write `: `",
    ),
    (
        re.compile(f"^ *(?:- )?{KEY}(?P<slip>::)(?: |$)"),
        ":",
        "there are two colons after the key",
        "write only one: `: `",
    ),
)


class _Line(NamedTuple):
    """A line that may contain a slip, and its index in the file."""

    text: str
    row: int

    def slip(self, column: int, length: int, words: tuple[str, str], start: int, end: int, meant: str) -> Slip:
        """Return a slip of that length at that column; `meant` should replace `start` to `end` (all from 0)."""
        right = self.text[:start] + meant + self.text[end:]
        return Slip(self.row + 1, column + 1, length, *words, {self.row: right})

    def quoted(self, start: int, end: int, message: str, hint: str = "") -> Slip:
        """Return the slip that the text from `start` to `end` lacks quotes."""
        value = self.text[start:end]
        plain = '"' not in value and "\\" not in value
        meant = f'"{value}"' if plain else "'" + value.replace("'", "''") + "'"
        words = message, hint or f"put quotes around it: {short(meant)}"
        return self.slip(start, end - start, words, start, end, meant)


def signs(text: str, index: int) -> Iterator[Slip]:
    """Yield slips about mistaken signs and missing spaces."""
    line = _Line(text, index)
    for pattern, meant, message, hint in _SIGNS:
        if found := pattern.search(text):
            start, end = found.span("slip")
            right = meant * (end - start) if meant == " " else meant
            yield line.slip(start, end - start, (message, hint), start, end, right)
    if found := re.search("[“”„«»‘’]", text):
        straight = re.sub("[“”„«»]", '"', re.sub("[‘’]", "'", text))
        words = f"{found[0]} is not a quote in YAML: only straight quotes are allowed", "write straight quotes: \" or '"
        yield line.slip(found.start(), 1, words, 0, len(text), straight)


def quotes(text: str, index: int) -> Iterator[Slip]:
    """Yield slips about a quoted text that is not closed, or closed too early."""
    line, marks = _Line(text, index), marks_of(text)
    if marks.quote:
        sign, column = marks.quote
        for end in _ends(text, column):
            yield line.slip(column, 1, NOT_CLOSED, end, end, sign)
    if found := re.search(
        rf"(?:{KEY}: +|- +)(?P<text>[^\s\"'\[{{|>&*!][^\"']*)(?P<sign>[\"'])(?= *(?:[,\]}}]|$))", text
    ):
        start, sign = found.start("text"), found["sign"]
        words = (
            f"the quote in column {found.start('sign') + 1} closes a text that has no opening quote",
            f"write `{sign}` before it",
        )
        yield line.slip(start, 1, words, start, start, sign)
    if marks.ended:
        yield from _early(line, marks, *marks.ended)


def _early(line: _Line, marks: LineMarks, first: Mark, last: Mark) -> Iterator[Slip]:
    """Yield slips about a quoted text that is followed by more text; `first` and `last` are its quotes."""
    (sign, start), text = first, line.text
    rest = text[last.column + 1 :]
    if found := re.search(rf"(?P<end>,) *(?:{KEY}: +)?$", text[start : last.column]):  # the quote opens the next text
        yield line.slip(start, 1, NOT_CLOSED, start + found.start(), start + found.start(), sign)
    if re.match(rf" +(?:{KEY}|['\"\[{{])", rest):
        yield line.slip(last.column + 1, 1, NO_COMMA, last.column + 1, last.column + 1, ",")
    again = text.rfind(sign, last.column + 1)
    end = again + 1 if again > 0 else marks.stop
    inner = text[start + 1 : again] if again > 0 else text[start + 1 : end].replace(sign, "")
    if sign == "'" and rest[:1].isalpha():
        message = "this apostrophe ends the quoted text"
        words = message, "put double quotes around a text that contains an apostrophe"
    elif again > 0:
        message = "this quote ends the quoted text"
        words = message, "put single quotes around a text that contains double quotes"
    else:
        words = "there is more text after a quoted text", "put the quotes around the whole text"
    yield line.slip(last.column, 1, words, start, end, json.dumps(inner, ensure_ascii=False))


def _ends(text: str, start: int) -> Iterator[int]:
    """Yield the offsets at which a text may have been meant to end: before a key, bracket or comment, or at the end."""
    stop = len(text.rstrip())
    if found := re.search(rf", *{KEY}:(?= )", text[start:]):
        yield start + found.start()
    bare = len(text[:stop].rstrip("]} "))
    yield from (end for end in range(bare, stop) if end > start)
    yield stop
    if comment := re.search(r" +#", text[start:]):
        yield start + comment.start()


def brackets(text: str, index: int) -> Iterator[Slip]:
    """Yield slips about a bracket that its line does not close, or that closes nothing."""
    line, marks = _Line(text, index), marks_of(text)
    if marks.quote:
        return
    if marks.open and re.match(r" +#", text[marks.stop :]):
        yield from _cut(line, marks)
    if marks.braces:
        yield from _braces(line, marks)
    if marks.open:
        sign, column = marks.open[-1]
        close = closers(marks.open)
        yield line.slip(column, 1, not_closed(sign, close), marks.stop, marks.stop, close)
    for mark in marks.surplus[:1]:
        at = mark.column
        if marks.open and marks.open[-1].column < at:
            sign, column = marks.open[-1]
            close = closers(marks.open[-1:])
            words = f"the bracket `{sign}` is not closed by `{mark.sign}`", f"write `{close}`"
            yield from (line.slip(column, 1, words, at, end, close) for end in (at, at + 1))
        words = f"`{mark.sign}` has no opening bracket", "delete it, or add the opening bracket before it"
        yield line.slip(at, 1, words, at, at + 1, "")


def _cut(line: _Line, marks: LineMarks) -> Iterator[Slip]:
    """Yield slips about a text in brackets that a comment cuts off."""
    text, at = line.text, line.text.index("#", marks.stop)
    start = next(
        (i + 2 for i in range(marks.stop - 1, 0, -1) if text[i : i + 2] in (": ", ", ")), marks.open[-1].column + 1
    )
    words = "` #` begins a comment, which cuts this text off", "put quotes around the text"
    for end in _ends(text, start):
        if end > at:
            yield line.slip(at, 1, words, start, end, json.dumps(text[start:end], ensure_ascii=False))


def not_closed(sign: str, close: str) -> tuple[str, str]:
    """Return the message and the hint about a bracket that is not closed."""
    return f"the bracket `{sign}` is not closed", f"write `{close}` after its last entry"


def _braces(line: _Line, marks: LineMarks) -> Iterator[Slip]:
    """Yield slips about `{{` without quotes, which YAML reads as a map in a map."""
    start = marks.braces[0]
    words = BARE_BRACES, QUOTE_BRACES
    ends = [found.end() for found in re.finditer(r"\}\}", line.text) if found.end() > start]
    for end in (marks.stop, *reversed(ends)):
        if end > start:
            yield line.slip(start, 2, words, start, end, json.dumps(line.text[start:end], ensure_ascii=False))


def colons(text: str, index: int) -> Iterator[Slip]:
    """Yield slips about a key without its colon, or a value whose colon YAML misreads."""
    line, item = _Line(text, index), r"^ *(?:- +)*"
    if found := re.search(rf"{item}(?:\{{ *)?(?P<key>{KEY})(?P<rest> +[^ :#].*| *)$", text):
        start, end, rest = *found.span("key"), found["rest"].strip()
        shown = f"write `{found['key']}: {rest}"[:40].rstrip() + "`"
        alone = (
            f"if this line is a key, write `{found['key']}:`;"
            " otherwise, indent the line under the key that it belongs to"
        )
        yield line.slip(start, end - start, (_no_colon(found["key"]), shown if rest else alone), end, end, ":")
    if found := re.search(rf"{item}{KEY}:(?P<slip> +- +)\S", text):
        words = (
            "the first item of a list is on the same line as its key",
            "put the first item on a new line under the key, and begin that line with `- `",
        )
        yield line.slip(found.start("slip") + 1, 1, words, *found.span("slip"), " ")
    if found := re.search(rf"{item}(?P<all>{KEY}: [^,]+(?:, *{KEY}: [^,]+)+) *$", text):
        (start, end), meant = found.span("all"), f"{{{found['all']}}}"
        words = "several keys on one line need braces", f"write `{short(meant)}`"
        yield line.slip(start, end - start, words, start, end, meant)
    found = re.search(rf"{item}(?P<key>{KEY}): +(?P<value>(?P<inner>#?[a-z][\w.]*): .*?) *$", text)
    if found and (
        len(found["key"]) > 2 or found["key"] in ("on", "do", "at", "if")
    ):  # a two-letter key is a language, followed by a text
        message = f"two keys are on one line: `{found['key']}` and `{found['inner']}`"
        hint = f"write `{found['inner']}:` on the next line, indented further, or put quotes around it if it is a text"
        yield line.quoted(*found.span("value"), message, hint)
    if found := re.search(rf"{item}{KEY}: +(?P<value>(?!- )[^\"'\[{{|>#].*?: ?.*?) *$", text):
        yield line.quoted(*found.span("value"), COLON_IN_TEXT)
    if found := re.search(rf"{item}{KEY}: +(?P<value>[@%`!&*|>,\]}}].*?) *$", text):
        yield line.quoted(*found.span("value"), _odd_beginning(found["value"]))


_TRANSLATION = re.compile(
    r"""(?<=[{,])\s*(?:[a-z]{2}|any): +"""
    r"""(?P<value>[^"'\[\]{},: ][^"'\[\]{},:]*(?<! [a-z]{2})(?<! any): [^"'\[\]{},]*[^"'\[\]{}, ])"""
)
"""A text with a colon in it under a language, after a word that is not a language itself."""


def flows(text: str, index: int) -> Iterator[Slip]:
    """Yield slips inside brackets: missing commas and colons, and missing quotes around texts with a colon."""
    line = _Line(text, index)
    for found in re.finditer(_TRANSLATION, text):  # before the missing commas, because these words are no keys
        yield line.quoted(*found.span("value"), COLON_IN_TEXT)
    for found in re.finditer(rf"(?<=[\w\"'\]}}.])(?P<slip> +)(?={KEY}: )", text):
        yield line.slip(found.start(), 1, NO_COMMA, found.start(), found.start(), ",")
    for found in re.finditer(rf"{KEY}: +(?P<value>[^\"'\[\]{{}},:]+: [^\"'\[\]{{}},]*[^\"'\[\]{{}}, ])", text):
        yield line.quoted(*found.span("value"), COLON_IN_TEXT)
    for found in re.finditer(rf"(?:{KEY}: +|[\[,] *)(?P<value>[@%`!&*|>][^\"'\[\]{{}},]*)", text):
        yield line.quoted(*found.span("value"), _odd_beginning(found["value"]))
    for found in re.finditer(rf"(?<=[{{,] ){KEY}(?= +[\w\"'])|(?<=[{{,]){KEY}(?= +[\w\"'])", text):
        words = _no_colon(found[0]), f"write `{found[0]}: `"
        yield line.slip(found.start(), len(found[0]), words, found.end(), found.end(), ":")


def _no_colon(key: str) -> str:
    return f"`{key}` needs a colon after it"


def _odd_beginning(value: str) -> str:
    return f"a text that begins with `{value[0]}` needs quotes"


def short(text: str) -> str:
    return text if len(text) <= 60 else f"{text[:40]}…{text[-1]}"
