"""Texts that need quotes because they contain brackets, such as phrase patterns: "[please] dance", "call me {name}"."""

import json
import re
from collections.abc import Iterator

from lumen.project.line_marks import marks_of
from lumen.project.slips import KEY, Slip, short
from lumen.talk.patterns import TYPES

_BRACKETED_TEXT = re.compile(r"^(?!\{\w+: )(?=.*[\[{])(?:[\[{][^\[\]{}]*[\]}]|[^\[{(\w])*[\w(]")
"""A text with brackets and other text outside them, unless it begins with a map."""


def bracketed(text: str, index: int) -> Iterator[Slip]:
    """Yield slips about texts with brackets that YAML reads as lists or maps; the corrected line has quotes.

    `text` is line `index`, counted from 0, of a file that is not valid YAML. There are at most two slips: one in
    case the line is the text of a key, and one in case it is within a list or a map.
    """
    key = re.match(rf" *(?:- +)*(?:{KEY}: +)?", text)
    begin, end = key.end() if key else 0, marks_of(text).stop
    stop = next((at for at in range(begin, end) if text[at] in "]}" and _depth(text[begin : at + 1]) < 0), end)
    items = _items(text, begin, stop)
    within = [span for low, high in items for span in _bracketed(text, low, high, flow=True)]
    for spans in (list(_bracketed(text, begin, end, flow=False)), within):
        if not spans:
            continue
        right = text
        for low, high in reversed(spans):
            right = right[:low] + _quoted(text[low:high]) + right[high:]
        low, high = spans[0]
        sign = next(sign for sign in text[low:high] if sign in "[{")
        message = f"here `{sign}` begins a {'list' if sign == '[' else 'map'}, even inside a text"
        hint = f"put quotes around the text: {short(_quoted(slot_signs(text[low:high])))}"
        hint += ", and around the others on this line" if len(spans) > 1 else ""
        yield Slip(index + 1, low + 1, high - low, message, hint, {index: right})


def slot_signs(text: str) -> str:
    """Return a text with its slots in normal form: without blanks, and with the name before the type."""

    def slot(found: re.Match[str]) -> str:
        one, other = found.groups()
        return f"{{{other}:{one}}}" if other in TYPES else f"{{{one}:{other}}}"

    return re.sub(r"\{(\w+\??): +(\w+\??)\}", slot, text)


def _depth(text: str) -> int:
    """Return the number of brackets that are left open; negative if more are closed than opened."""
    return sum(text.count(sign) for sign in "[{") - sum(text.count(sign) for sign in "]}")


def _bracketed(text: str, start: int, end: int, *, flow: bool) -> Iterator[tuple[int, int]]:
    """Yield the spans of texts that need quotes. If `flow`, the text is inside brackets, and a comma ends each item."""
    while start < end and text[start] == " ":
        start += 1
    if start >= end or text[start] in "\"'":
        return
    close = _closing_bracket(text, start, end) if text[start] in "[{" else -1
    if close >= 0 and not text[close + 1 : end].strip():
        if text[start] == "{" and re.fullmatch(r"\{\w+\??(:\w+)?\}", text[start : close + 1]):
            yield start, close + 1
            return
        for low, high in _items(text, start + 1, close):
            key = re.match(rf" *{KEY}: +", text[low:high])
            yield from _bracketed(text, low + (key.end() if key else 0), high, flow=True)
    elif _BRACKETED_TEXT.search(text[start:end]) and (flow or close >= 0):
        yield start, start + len(text[start:end].rstrip())


def _items(text: str, start: int, end: int) -> Iterator[tuple[int, int]]:
    """Yield the spans of the items between commas, ignoring commas within brackets or quotes."""
    low, at = start, start
    while at < end:
        if text[at] in "\"'" and not text[low:at].strip():
            at = max(text.find(text[at], at + 1), at)
        elif text[at] in "[{(":
            at = max(_closing_bracket(text, at, end), at)
        elif text[at] == ",":
            yield low, at
            low = at + 1
        at += 1
    yield low, end


_BRACKETS = {"[": "]", "{": "}", "(": ")"}


def _closing_bracket(text: str, start: int, end: int) -> int:
    """Return the index of the bracket that closes the first one at or after `start`; -1 if none closes it."""
    waiting: list[str] = []
    for at in range(start, end):
        if text[at] in _BRACKETS:
            waiting.append(_BRACKETS[text[at]])
        elif text[at] in _BRACKETS.values():
            if waiting.pop() != text[at]:
                return -1
            if not waiting:
                return at
    return -1


def _quoted(text: str) -> str:
    return json.dumps(text, ensure_ascii=False)
