"""Texts that YAML reads in an unintended way: cut off by a comment, split at a comma, or made a map by a colon."""

import re
from collections.abc import Iterator
from functools import partial

from lumen.language.diagnostics import WARNING, Code, NodePath
from lumen.language.text_lines import lines_of
from lumen.project.document_report import DocumentReport
from lumen.project.draft import ProjectDraft

CUT_TEXT = Code("cut-text", "speech", WARNING, "a text is cut off by ` #`, which begins a comment")
TORN_TEXT = Code("torn-text", "speech", WARNING, "a text in a list is split by a comma or a colon")

_CUT = re.compile(r" +#(?=[^\s#!:-])")
_HAS_CUT = re.compile(r"[^\s#] +#[^\s#!:-]")
_NUMBERS = {2: "two", 3: "three", 4: "four"}
_ENDED = (".", "!", "?", "…", ":", '"', "'", ")")


def check(draft: ProjectDraft) -> None:
    """Report texts that YAML cuts off at a ` #`, and texts in lists that it splits at a comma or a colon."""
    for file, report in draft.reports.items():
        if file.startswith("behaviors/"):
            report.memoize(("torn texts", file), None, partial(_texts, report))


def _texts(report: DocumentReport) -> None:
    _cut(report)
    _torn(report)
    _mapped(report)


def _cut(report: DocumentReport) -> None:
    text = report.document.text
    if not _HAS_CUT.search(text):
        return
    lines = lines_of(text)
    for path, span in list(report.document.spans.items()):
        place = span.value
        line = lines[place.end_line - 1] if place.end_line <= len(lines) else ""
        value = report.document.find(path)
        if not isinstance(value, str) or " " not in value or lines[place.line - 1][place.column - 1] in "\"'|>":
            continue
        if found := _CUT.match(line, place.end_column - 1):
            shown = line[found.end() - 1 :].rstrip()
            message = f"` #` begins a comment here: `{shown[:40]}` is not part of the text"
            report(CUT_TEXT, path, message, "put quotes around the text, or a space after the `#` of a comment")


def _torn(report: DocumentReport) -> None:
    """Report lists of sentences in which a text has no final mark and the next begins with a lowercase letter."""
    lines = lines_of(report.document.text)
    lists: dict[NodePath, list[str]] = {}
    for path in report.document.spans:
        if path and isinstance(path[-1], int) and isinstance(value := report.document.find(path), str):
            lists.setdefault(path[:-1], []).append(value)
    for path, texts in lists.items():
        if "phrases" in path:  # a full stop there means that a phrase must be a whole clause
            continue
        if len(texts) > 1 and any(text.endswith((".", "!", "?")) for text in texts):
            places = [report.document.place((*path, i)) for i in range(len(texts))]
            # the line of each plain text; quoted texts can't be split, so each gets a different negative number
            plain = [p.line if lines[p.line - 1][p.column - 1] not in "\"'" else -i for i, p in enumerate(places)]
            for first, last in _parts(texts, plain):
                *before, end = [f"`{text}`" for text in texts[first:last]]
                number = _NUMBERS.get(last - first, f"{last - first}")
                message = f"these are {number} texts: {', '.join(before)} and {end}"
                whole = ", ".join(texts[first:last])
                shown = whole if len(whole) <= 60 else f"{whole[:59]}…"
                report(TORN_TEXT, (*path, first), message, f'put quotes around a text with a comma in it: "{shown}"')
                break


def _mapped(report: DocumentReport) -> None:
    """Report texts in a list of answers that became maps because of a colon; a map in braces is intended."""
    lines = report.document.text.split("\n")
    for path in report.document.spans:
        if "answers" not in path or "value" not in path[:-1] or not isinstance(path[-1], int):
            continue
        value, place = report.document.find(path), report.document.place(path)
        if isinstance(value, dict) and len(value) == 1 and lines[place.line - 1][place.column - 1] != "{":
            ((key, rest),) = value.items()
            if isinstance(rest, str) and " " in f"{key}{rest}":
                message = f"this is not a text but a map with the key `{key}`, because a colon ends a key"
                report(TORN_TEXT, path, message, f'put quotes around a text with a colon in it: "{key}: {rest}"')


def _parts(texts: list[str], lines: list[int]) -> Iterator[tuple[int, int]]:
    """Yield the first index and the end index of each text that a comma has split; `lines` are the texts' lines.

    Every part except the last lacks a final mark; every part except the first begins with a lowercase letter on the
    same line.
    """
    first = 0
    for i in range(1, len(texts) + 1):
        if i < len(texts) and lines[i - 1] == lines[i] and texts[i][:1].islower() and not texts[i - 1].endswith(_ENDED):
            continue
        if i - first > 1 and texts[first][:1].isupper():
            yield first, i
        first = i
