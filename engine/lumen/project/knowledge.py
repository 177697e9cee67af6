"""Build passages, `knowledge/NAME.yaml` or `NAME.md`, and the questions to try them with from plain data."""

from collections.abc import Mapping
from datetime import date
from typing import Any

from lumen.language.diagnostics import ERROR, Code
from lumen.language.knowledge import Passage, QuestionSet
from lumen.project.document_report import DocumentReport
from lumen.project.field_reader import read_fields

BAD_DATE = Code("bad-date", "knowledge", ERROR, "a date of a passage is not valid, or its dates are in the wrong order")


def build_passage(data: Any, report: DocumentReport, *, name: str) -> Passage | None:
    """Return the passage that the data describes; None if it is not a map or lacks its questions or its answer."""
    if not isinstance(data, Mapping) or not {"questions", "answer"} <= data.keys():
        return None
    as_of, until = (_day(data, key, report) for key in ("as-of", "until"))
    if as_of and until and until < as_of:
        message = f"`until: {until}` is before `as-of: {as_of}`"
        report(BAD_DATE, ("until",), message, "write a later date, or delete the passage")
    answer = {language: " ".join(text.split()) for language, text in data["answer"].items()}
    return read_fields(Passage, data, name=name, answer=answer, as_of=as_of, until=until, file=report.document.file)


def build_questions(data: Any, report: DocumentReport, *, name: str) -> QuestionSet | None:
    """Return the questions in the data; None if it is not a map."""
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
