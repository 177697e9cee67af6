"""The phrases, answers and lists of every file, behaviours and words files alike, where they stand."""

from collections.abc import Iterator, Mapping
from typing import Any, NamedTuple

from lumen.language.machines import Answer
from lumen.loading.common_words import is_shipped
from lumen.loading.document_report import DocumentReport
from lumen.loading.draft import ProjectDraft
from lumen.loading.words import WORDS_FOLDER


class WordTables(NamedTuple):
    """What one file gives names to, with the file's report."""

    report: DocumentReport
    phrases: Mapping[str, Mapping[str, tuple[str, ...]]]
    answers: Mapping[str, tuple[Answer, ...]]
    lists: Mapping[str, tuple[Mapping[str, Any], ...]]


def word_tables(draft: ProjectDraft) -> Iterator[WordTables]:
    """Those of each file of the project; a behaviour's without what it has from words files."""
    for name, machine in draft.behaviors.items():

        def own(key: str, table: Mapping[str, Any], borrowed: Any = machine.borrowed) -> dict[str, Any]:
            return {entry: content for entry, content in table.items() if (key, entry) not in borrowed}

        phrases, answers = own("phrases", machine.phrases), own("answers", machine.answers)
        yield WordTables(draft.report("behaviors", name), phrases, answers, own("lists", machine.lists))
    for name, words in draft.words.items():
        if is_shipped(draft.files, name):
            continue
        yield WordTables(draft.report(WORDS_FOLDER, name), words.phrases, words.answers, words.lists)
