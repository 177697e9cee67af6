"""What a project says and hears in its languages: what is missing in one, and places for a new one."""

import json
from collections.abc import Iterator, Mapping, Sequence
from typing import Any, NamedTuple

from lumen.language.actions import SayText
from lumen.language.diagnostics import NodePath, Place
from lumen.loading.document_report import DocumentReport
from lumen.loading.draft import ProjectDraft
from lumen.rules.fixes.edits import Edit, FileText, edited
from lumen.rules.lists import listed_texts
from lumen.rules.lookups import value_at
from lumen.rules.walk import action_sites
from lumen.rules.word_tables import word_tables

TO_DO = "TODO "
"""What a text begins with that is to be translated yet."""


class LanguageEntry(NamedTuple):
    """Where something stands once for each language: a text, alternatives of one, or phrases to be heard."""

    report: DocumentReport
    path: NodePath
    by_language: Mapping[str, Any]


class Untranslated(NamedTuple):
    """A place where a language is missing, or not translated yet, and what stands there in another."""

    place: Place
    text: str


def language_entries(draft: ProjectDraft) -> list[LanguageEntry]:
    """All of a project, file by file, each once; what is the same in every language is none of them."""
    found = {(report.document.file, path): report for report, path in _places(draft)}
    entries = []
    for (_, path), report in found.items():
        value = value_at(report, path)
        if isinstance(value, Mapping) and value and value.keys().isdisjoint(("", "any")):
            entries.append(LanguageEntry(report, path, value))
    return entries


def untranslated(entries: Sequence[LanguageEntry], language: str) -> Iterator[Untranslated]:
    """Where something is missing in that language."""
    for report, path, by_language in entries:
        there = by_language.get(language)
        if there is not None and not any(text.startswith(TO_DO) for text in _texts(there)):
            continue
        at = (*path, language) if there is not None else path
        other = next((value for name, value in by_language.items() if name != language), there)
        yield Untranslated(report.document.place(at, key=True), "; ".join(_texts(other)))


def with_language(draft: ProjectDraft, files: Mapping[str, bytes], language: str, source: str) -> dict[str, bytes]:
    """The files with a place for the language wherever there is one for `source`, whose words stand there to be read.

    Everything else in them stays as it is, comments included.
    """
    assert draft.main is not None  # the caller has checked the project
    edits: dict[str, list[Edit]] = {}
    for report, path, by_language in language_entries(draft):
        if source in by_language and language not in by_language:
            text = FileText(report.document.file, files[report.document.file])
            words = json.dumps(_to_do(by_language[source]), ensure_ascii=False)
            last = (*path, list(by_language)[-1])
            edits.setdefault(text.file, []).append(_beside(report, text, path, last, f"{language}: {words}"))
    main = draft.main
    text = FileText(main.document.file, files[main.document.file])
    spoken = value_at(main, ("languages",))
    last = ("languages", len(spoken) - 1)
    edits.setdefault(text.file, []).append(_beside(main, text, ("languages",), last, language, dash="- "))
    return {file: edited(files[file], changes) for file, changes in edits.items()}


def _places(draft: ProjectDraft) -> Iterator[tuple[DocumentReport, NodePath]]:
    for name, machine in draft.behaviors.items():
        said = (site.step.where for site in action_sites(machine) if isinstance(site.step.action, SayText))
        yield from ((draft.report("behaviors", name), (*where, "say")) for where in said)
    for tables in word_tables(draft):
        yield from ((tables.report, ("phrases", name)) for name in tables.phrases)
        for table, rows in tables.answers.items():
            for number in range(len(rows)):
                yield tables.report, ("answers", table, number, "phrases")
                yield tables.report, ("answers", table, number, "value")
    languages = draft.settings.languages if draft.settings else ()
    yield from ((report, path) for report, path, _ in listed_texts(word_tables(draft), languages))
    for name, motion in draft.motions.items():
        yield from ((draft.report("motions", name), cue.where) for cue in motion.cues if cue.kind == "say")


def _texts(value: Any) -> list[str]:
    return [text for text in (value if isinstance(value, list) else [value]) if isinstance(text, str)]


def _to_do(value: Any) -> Any:
    return [TO_DO + str(text) for text in value] if isinstance(value, list) else TO_DO + str(value)


def _beside(
    report: DocumentReport, text: FileText, around: NodePath, last: NodePath, entry: str, dash: str = ""
) -> Edit:
    """The entry behind the last one: on its line between brackets, else on a line of its own at the same depth."""
    spans = report.document.spans
    whole, end = spans[around].value, spans[last].value
    if text.line(whole.line)[whole.column - 1 : whole.column] in ("{", "["):
        return Edit(Place(text.file, end.end_line, end.end_column, end.end_line, end.end_column), f", {entry}")
    line, nothing = end.end_line, ("", "#") if isinstance(value_at(report, last), list) else ("",)
    if not text.line(line)[: end.end_column - 1].strip():
        line -= 1  # the parser sees its end where the next thing begins
    while line > end.line and text.line(line).strip()[:1] in nothing:
        line -= 1
    column = len(text.line(line)) + 1
    return Edit(Place(text.file, line, column, line, column), f"\n{' ' * (whole.column - 1)}{dash}{entry}")
