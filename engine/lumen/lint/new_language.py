"""Adds a language to a project: an entry in every text and phrase."""

import json
from collections.abc import Mapping
from typing import Any

from lumen.language.diagnostics import NodePath, Place
from lumen.lint.fixes.edits import Edit, FileText, edited
from lumen.lint.translation import TO_DO, language_entries, plain_texts
from lumen.project.document_report import DocumentReport
from lumen.project.draft import ProjectDraft


def with_language(draft: ProjectDraft, files: Mapping[str, bytes], language: str, source: str) -> dict[str, bytes]:
    """Return the changed files, with an entry for `language` beside each entry for `source`: the same words after TODO.

    `languages` in lumen.yaml gets the language too. If `source` was the only language, a one-line `say` text without a
    language becomes a text in both. Everything else in these files, including comments, stays as it is.
    """
    assert draft.main is not None  # the caller must have checked the project
    edits: dict[str, list[Edit]] = {}
    for report, path, by_language in language_entries(draft):
        if source in by_language and language not in by_language:
            text = FileText(report.document.file, files[report.document.file])
            words = json.dumps(_to_do(by_language[source]), ensure_ascii=False)
            last = (*path, list(by_language)[-1])
            edits.setdefault(text.file, []).append(beside(report, text, path, last, f"{language}: {words}"))
    main = draft.main
    if list(main.document.find(("languages",))) == [source]:
        for report, path in plain_texts(draft):
            text, said = FileText(report.document.file, files[report.document.file]), report.document.find(path)
            both = ", ".join(
                f"{name}: {json.dumps(words, ensure_ascii=False)}"
                for name, words in ((source, said), (language, _to_do(said)))
            )
            edits.setdefault(text.file, []).append(Edit(report.document.place(path), f"{{{both}}}"))
    text = FileText(main.document.file, files[main.document.file])
    spoken = main.document.find(("languages",))
    last = ("languages", len(spoken) - 1)
    edits.setdefault(text.file, []).append(beside(main, text, ("languages",), last, language, dash="- "))
    return {file: edited(files[file], changes) for file, changes in edits.items()}


def _to_do(value: Any) -> Any:
    return [TO_DO + str(text) for text in value] if isinstance(value, list) else TO_DO + str(value)


def beside(
    report: DocumentReport, text: FileText, around: NodePath, last: NodePath, entry: str, dash: str = ""
) -> Edit:
    """Return the edit that writes an entry after `last`: on the same line if in brackets, else on a new line."""
    spans = report.document.spans
    whole, end = spans[around].value, spans[last].value
    if text.line(whole.line)[whole.column - 1 : whole.column] in ("{", "["):
        return Edit(Place(text.file, end.end_line, end.end_column, end.end_line, end.end_column), f", {entry}")
    line, nothing = end.end_line, ("", "#") if isinstance(report.document.find(last), list) else ("",)
    if not text.line(line)[: end.end_column - 1].strip():
        line -= 1  # the parser places its end where the next element begins
    while line > end.line and text.line(line).strip()[:1] in nothing:
        line -= 1
    column = len(text.line(line)) + 1
    return Edit(Place(text.file, line, column, line, column), f"\n{' ' * (whole.column - 1)}{dash}{entry}")
