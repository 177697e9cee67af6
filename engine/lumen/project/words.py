"""Build `Words` from the plain data of a words file, `behaviors/words/NAME.yaml`."""

from collections.abc import Mapping
from typing import Any

from lumen.language.machines import Answer
from lumen.language.words import Words
from lumen.project.document_report import DocumentReport

ANYHOW = "anyhow"


def build_words(data: Any, report: DocumentReport, *, name: str) -> Words | None:
    """Return the content of `behaviors/words/NAME.yaml`; None if the data is not a map."""
    return Words(name, **tables(data), anyhow=anyhow(data)) if isinstance(data, Mapping) else None


def tables(data: Mapping[str, Any]) -> dict[str, Any]:
    """Return the tables that both a words file and a behaviour may have: `phrases`, `answers` and `lists`."""
    return {
        "phrases": {key: _phrases(body) for key, body in (data.get("phrases") or {}).items()},
        "answers": {key: _answers(rows) for key, rows in (data.get("answers") or {}).items()},
        "lists": {key: tuple(rows or ()) for key, rows in (data.get("lists") or {}).items()},
    }


def anyhow(data: Mapping[str, Any]) -> frozenset[str]:
    """Return the names of phrases that match even if they are negated."""
    phrases = data.get("phrases") or {}
    return frozenset(name for name, body in phrases.items() if isinstance(body, Mapping) and body.get(ANYHOW) is True)


def _phrases(body: Any) -> dict[str, tuple[str, ...]]:
    table = body if isinstance(body, Mapping) else {"": body}
    return {
        language: (rows,) if isinstance(rows, str) else tuple(rows)
        for language, rows in table.items()
        if language != ANYHOW
    }


def _answers(rows: Any) -> tuple[Answer, ...]:
    return tuple(Answer(_phrases(row["phrases"]), row["value"]) for row in rows)
