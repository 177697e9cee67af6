"""The texts and phrases of a project by language, and those that are missing in a language."""

import re
from collections.abc import Iterator, Mapping, Sequence
from typing import Any, NamedTuple

from lumen.language.actions import SayText
from lumen.language.commands import Language
from lumen.language.diagnostics import NodePath, Place
from lumen.language.folders import KNOWLEDGE_FOLDER
from lumen.lint.lists import listed_texts
from lumen.lint.walk import action_sites
from lumen.lint.word_tables import word_tables
from lumen.project.document_report import DocumentReport
from lumen.project.draft import ProjectDraft
from lumen.project.words import ANYHOW

_HOLE = re.compile(r"\{\{.*?\}\}")
TO_DO = "TODO "
"""The mark at the beginning of a text that is not translated yet."""


class LanguageEntry(NamedTuple):
    """A value given once for each language: a text, alternative texts, or phrases."""

    report: DocumentReport
    path: NodePath
    by_language: Mapping[str, Any]


class Untranslated(NamedTuple):
    """A text that is missing in a language, or not translated yet."""

    place: Place
    """The place of the text, or of the value that lacks the language."""
    text: str
    """The text in another language; alternatives are joined by `; `."""


def language_entries(draft: ProjectDraft) -> list[LanguageEntry]:
    """Return a project's values by language, each once; values that apply to every language are left out."""
    found = {(report.document.file, path): report for report, path in _places(draft)}
    entries = []
    for (_, path), report in found.items():
        value = report.document.find(path)
        if isinstance(value, Mapping) and value and value.keys().isdisjoint(("", "any")):
            texts = {language: text for language, text in value.items() if language not in ("gestures", ANYHOW)}
            entries.append(LanguageEntry(report, path, texts))
    return entries


def plain_texts(draft: ProjectDraft) -> Iterator[tuple[DocumentReport, NodePath]]:
    """Yield the place of each one-line `say` without languages that has words outside its expressions."""
    for name, machine in draft.behaviors.items():
        report = draft.report("behaviors", name)
        for site in action_sites(machine):
            path = (*site.step.where, "say")
            said = report.document.find(path) if isinstance(site.step.action, SayText) else None
            place = report.document.place(path)
            if isinstance(said, str) and place.line == place.end_line and _HOLE.sub("", said).strip(" .,!?"):
                yield report, path


def spoken_places(draft: ProjectDraft) -> Iterator[tuple[DocumentReport, NodePath]]:
    """Yield the place of each text that a robot says; labels of buttons and phrases of visitors are left out."""
    for report, path in _places(draft):
        if path[0] == "lists" or (path[0] not in ("phrases", "questions") and path[-1] not in ("label", "phrases")):
            yield report, path


def switched_to(draft: ProjectDraft) -> set[str]:
    """Return the languages to which an action of some behaviour switches the robot."""
    actions = (site.step.action for machine in draft.behaviors.values() for site in action_sites(machine))
    return {action.language for action in actions if isinstance(action, Language)}


def untranslated(entries: Sequence[LanguageEntry], language: str) -> Iterator[Untranslated]:
    """Yield the entries that are missing in that language, or not translated yet."""
    for report, path, by_language in entries:
        there = by_language.get(language)
        if not is_empty(there) and not _is_begun(there):
            continue
        at = (*path, language) if language in by_language else path
        other = next((value for name, value in by_language.items() if name != language), there)
        yield Untranslated(report.document.place(at, key=True), "; ".join(_texts(other)))


def begun(entries: Sequence[LanguageEntry], language: str) -> Iterator[tuple[DocumentReport, NodePath]]:
    """Yield the path of each text that has a copy marked with TODO in place of a translation into that language."""
    for report, path, by_language in entries:
        if _is_begun(by_language.get(language)):
            yield report, (*path, language)


def is_empty(value: Any) -> bool:
    """Return whether a translation has no text, or a text without words."""
    texts = value if isinstance(value, list) else [value]
    return not texts or any(text is None or (isinstance(text, str) and not text.strip()) for text in texts)


def _places(draft: ProjectDraft) -> Iterator[tuple[DocumentReport, NodePath]]:
    for name, machine in draft.behaviors.items():
        said = (site.step.where for site in action_sites(machine) if isinstance(site.step.action, SayText))
        yield from ((draft.report("behaviors", name), (*where, "say")) for where in said)
        for state in machine.states.values():
            yield from ((draft.report("behaviors", name), (*button.where, "label")) for button in state.buttons)
    for tables in word_tables(draft):
        yield from ((tables.report, ("phrases", name)) for name in tables.phrases)
        for table, rows in tables.answers.items():
            for number in range(len(rows)):
                yield tables.report, ("answers", table, number, "phrases")
                yield tables.report, ("answers", table, number, "value")
    for name in draft.knowledge:
        yield from ((draft.report(KNOWLEDGE_FOLDER, name), (key,)) for key in ("questions", "answer"))
    languages = draft.settings.languages if draft.settings else ()
    yield from ((report, path) for report, path, _ in listed_texts(word_tables(draft), languages))
    for name, motion in draft.motions.items():
        yield from ((draft.report("motions", name), cue.where) for cue in motion.cues if cue.kind == "say")


def _texts(value: Any) -> list[str]:
    return [text for text in (value if isinstance(value, list) else [value]) if isinstance(text, str)]


def _is_begun(value: Any) -> bool:
    return any(text.startswith(TO_DO) for text in _texts(value))
