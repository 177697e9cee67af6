"""Build passages, `knowledge/NAME.yaml` or `NAME.md`, and sets of test questions for them.

A passage in Markdown becomes the same document as in YAML, but its places point at lines of the Markdown file.
"""

import re
from collections.abc import Mapping
from dataclasses import replace
from datetime import date
from typing import Any

from lumen.language.diagnostics import ERROR, Code, Diagnostic, NodePath, Place
from lumen.language.knowledge import Passage, QuestionSet
from lumen.language.text_lines import lines_of
from lumen.project.document import Document, NodeSpan
from lumen.project.document_report import DocumentReport
from lumen.project.sections import read_fields
from lumen.project.yaml_reader import parse

NO_FRONT_MATTER = Code("no-front-matter", "knowledge", ERROR, "a Markdown passage does not begin with its YAML data")
STRAY_TEXT = Code(
    "stray-text", "knowledge", ERROR, "text of a Markdown passage is not under a heading with its language"
)

MARKDOWN_SUFFIX = ".md"
FENCE = "---"

_HEADING = re.compile(r"#+\s+(\S+)\s*")


def parse_markdown(file: str, content: bytes) -> tuple[Document | None, list[Diagnostic]]:
    """Return the document of a Markdown file and its faults; None if it does not begin with valid YAML data.

    No content of the file raises an error.
    """
    lines = lines_of(content.decode("utf-8-sig", "replace"))
    text = "\n".join(lines)
    end = next((i for i, line in enumerate(lines) if i and line.rstrip() == FENCE), 0)
    if lines[0].rstrip() != FENCE or not end:
        hint = f"begin with a line `{FENCE}`, then `questions:` as in YAML, then a line `{FENCE}`"
        return None, [NO_FRONT_MATTER.at(Place(file, 1, 1), "the passage does not begin with its YAML data", hint)]
    front = "\n".join(["", *lines[1:end], ""])
    document, found = parse(file, content if "\ufffd" in text else front.encode())
    if document is None or not isinstance(document.data, dict):
        return document, found
    answer, spans, strays = _answers(file, lines, end + 1)
    if "answer" in document.data:
        message = "the answer of a Markdown passage belongs below its YAML data"
        found.append(_stray(document.place(("answer",), key=True), message))
    found += strays
    data = {**document.data, **({"answer": answer} if answer else {})}
    return replace(document, data=data, spans={**document.spans, **spans}, text=text), found


def _answers(
    file: str, lines: list[str], begin: int
) -> tuple[dict[str, str], dict[NodePath, NodeSpan], list[Diagnostic]]:
    """Return the text below each heading by language, its places, and the faults; `begin` is an index of `lines`."""
    answer: dict[str, str] = {}
    spans: dict[NodePath, NodeSpan] = {}
    found: list[Diagnostic] = []
    language = ""
    for number, line in enumerate(lines[begin:], begin + 1):
        place = Place(file, number, 1, number, len(line) + 1)
        if heading := _HEADING.fullmatch(line):
            language = heading[1]
            if language in answer:
                message = f"there is already a heading `{language}`"
                found.append(_stray(place, message, "write both texts under one heading, or correct the language"))
            answer.setdefault(language, "")
            spans.setdefault(("answer",), NodeSpan(place, place))
            spans["answer", language] = NodeSpan(place, place)
        elif line.strip() and not language:
            found.append(_stray(place, "this text is not under a heading with its language"))
            language = " "
        elif line.strip() and language != " ":
            answer[language] = f"{answer[language]} {line.strip()}".strip()
            spans["answer", language] = NodeSpan(spans["answer", language].key, place)
    return answer, spans, found


_HEAD = "write a heading with the language, such as `# en`, above the answer"


def _stray(place: Place, message: str, hint: str = _HEAD) -> Diagnostic:
    return STRAY_TEXT.at(place, message, hint)


BAD_DATE = Code("bad-date", "knowledge", ERROR, "a date of a passage is not valid, or its dates are in the wrong order")


def build_passage(data: Any, report: DocumentReport, *, name: str) -> Passage | None:
    """Return the passage that the data describes; None if the data is not a map, or lacks questions or an answer."""
    if not isinstance(data, Mapping) or not {"questions", "answer"} <= data.keys():
        return None
    as_of, until = (_day(data, key, report) for key in ("as-of", "until"))
    if as_of and until and until < as_of:
        message = f"`until: {until}` is before `as-of: {as_of}`"
        report(BAD_DATE, ("until",), message, "write a later date, or delete the passage")
    answer = {language: " ".join(text.split()) for language, text in data["answer"].items()}
    return read_fields(Passage, data, name=name, answer=answer, as_of=as_of, until=until, file=report.document.file)


def build_questions(data: Any, report: DocumentReport, *, name: str) -> QuestionSet | None:
    """Return the questions in the data; None if the data is not a map."""
    if not isinstance(data, Mapping):
        return None
    return read_fields(QuestionSet, data, name=name)


def _day(data: Mapping[str, Any], key: str, report: DocumentReport) -> date | None:
    text = data.get(key)
    try:
        return date.fromisoformat(text) if text else None
    except ValueError:
        report(BAD_DATE, (key,), f"`{text}` is not a date", "write year, month and day: 2015-11-21")
        return None
