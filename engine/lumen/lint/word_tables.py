"""The phrases, answers and lists of all behaviours and words files, with their places."""

from collections.abc import Iterator, Mapping
from functools import lru_cache
from typing import Any, NamedTuple

from lumen.expressions.phrases import is_heard
from lumen.language.diagnostics import NodePath, Place
from lumen.language.machines import Answer
from lumen.project.document_report import DocumentReport
from lumen.project.draft import ProjectDraft
from lumen.project.expressions import place_within
from lumen.project.project_folders import WORDS_FOLDER
from lumen.project.words import ANYHOW
from lumen.talk.patterns import Slot, forms


class WordTables(NamedTuple):
    """The named tables of one file, with the file's report."""

    report: DocumentReport
    phrases: Mapping[str, Mapping[str, tuple[str, ...]]]
    """The phrases of each name by language; an empty language means every language."""
    answers: Mapping[str, tuple[Answer, ...]]
    """The rows of each table of answers."""
    lists: Mapping[str, tuple[Mapping[str, Any], ...]]
    """The entries of each list."""


class WrittenPhrase(NamedTuple):
    """A phrase in its file."""

    report: DocumentReport
    path: NodePath
    language: str
    """The phrase's language; empty if it is for every language."""
    text: str


def word_tables(draft: ProjectDraft) -> Iterator[WordTables]:
    """Yield the tables of each behaviour and each words file; a behaviour's borrowed tables are left out."""
    for name, machine in draft.behaviors.items():

        def own(key: str, table: Mapping[str, Any], borrowed: Any = machine.borrowed) -> dict[str, Any]:
            return {entry: content for entry, content in table.items() if (key, entry) not in borrowed}

        phrases, answers = own("phrases", machine.phrases), own("answers", machine.answers)
        yield WordTables(draft.report("behaviors", name), phrases, answers, own("lists", machine.lists))
    for name, words in draft.own_words.items():
        yield WordTables(draft.report(WORDS_FOLDER, name), words.phrases, words.answers, words.lists)


def written_phrases(report: DocumentReport, path: NodePath) -> Iterator[WrittenPhrase]:
    """Yield the phrases at a path: a text, a list of texts, or either for each language."""
    value = report.document.find(path)
    table = value if isinstance(value, Mapping) else {"": value}
    for language, rows in table.items():
        if language == ANYHOW:
            continue
        here = (*path, language) if isinstance(value, Mapping) else path
        several = (
            [(here, rows)] if isinstance(rows, str) else [((*here, i), text) for i, text in enumerate(_listed(rows))]
        )
        yield from (WrittenPhrase(report, at, language, text) for at, text in several if isinstance(text, str))


def is_taken(phrase: str, other: Mapping[str, tuple[str, ...]]) -> bool:
    """Return whether every form of a phrase contains one of the phrases in `other`; False if a form has a slot."""
    texts = _plain_texts(phrase)
    return texts is not None and all(is_heard(text, other) for text in texts)


@lru_cache(maxsize=8192)
def _plain_texts(phrase: str) -> tuple[str, ...] | None:
    """Return the words of each form of a phrase; None if a form has a slot. Phrases are compared with many tables."""
    every = forms(phrase)
    return tuple(" ".join(form.literals) for form in every) if all(form.plain for form in every) else None


def declaring_report(draft: ProjectDraft, behavior: str, key: str, name: str) -> DocumentReport | None:
    """Return the report of the file that declares these phrases or answers; None if they come with Lumen."""
    words = draft.behaviors[behavior].borrowed.get((key, name))
    if words is None:
        return draft.report("behaviors", behavior)
    return draft.report(WORDS_FOLDER, words) if words in draft.own_words else None


def _listed(value: Any) -> list[Any]:
    return value if isinstance(value, list) else []


def known_by(draft: ProjectDraft, report: DocumentReport) -> list[str]:
    """Return the behaviours that can use a file's names: its own behaviour, or all that name it under `words`."""
    folder, _, file = report.document.file.rpartition("/")
    name = file.removesuffix(".yaml")
    return [n for n, m in draft.behaviors.items() if (name in m.words if folder == WORDS_FOLDER else n == name)]


def slot_place(phrase: WrittenPhrase, slot: Slot) -> Place:
    """Return the place of a slot in a phrase, with its braces."""
    signs = (f"{{{slot.type}:{slot.name}}}", f"{{{slot.type}}}")
    sign = next(sign for sign in signs if sign in phrase.text)
    return place_within(phrase.report.document, phrase.path, phrase.text, phrase.text.index(sign), len(sign))
