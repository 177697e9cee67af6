"""Finds the text in a project's files behind a robot's sentence, with its placeholders and in all languages."""

import hashlib
import re
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any, NamedTuple

from lumen.language.diagnostics import NodePath
from lumen.lint.translation import spoken_places
from lumen.lint.word_tables import word_tables
from lumen.project.building import draft
from lumen.project.document_report import DocumentReport
from lumen.project.draft import ProjectDraft
from lumen.project.files import read_files

MAX_PLACES = 5
"""The maximum number of places that are shown for a sentence."""
ANY_LANGUAGE = ("", "any")
NO_LANGUAGE = "gestures"
"""The key of a `say` that is not a language."""
MARKDOWN = ".md"
_HOLE = re.compile(r"\{\{.*?\}\}", re.DOTALL)


class SaidSentence(NamedTuple):
    """A sentence that the robot said."""

    text: str
    language: str = ""
    file: str = ""
    """The file of the action that says it; empty if unknown."""
    line: int = 0
    """The line of that action; 0 if unknown."""
    passage: str = ""
    """The name of the passage that contains it; empty if there is none."""


class WrittenSentence(NamedTuple):
    """A text in a file that a robot can say."""

    report: DocumentReport
    around: NodePath
    """The path of the text, of its alternatives, or of its map by language."""
    path: NodePath
    """The path of this text itself."""
    language: str
    """The text's language; empty if the text is for all languages."""
    alternative: int | None
    """The text's index among its alternatives, from 0; None if they are not a list."""
    text: str

    @property
    def file(self) -> str:
        return self.report.document.file

    def to_json(self, languages: tuple[str, ...], content: bytes) -> dict[str, Any]:
        """Return the place with the text in each of the project's languages; a text is empty if it is missing."""
        return {
            "file": self.file,
            "line": self.report.document.place(self.path).line,
            "around": list(self.around),
            "alternative": self.alternative,
            "texts": texts_of(self, languages),
            "version": version_of(content),
            "editable": not self.file.endswith(MARKDOWN),
        }


def version_of(content: bytes) -> str:
    """Return a hash of a file's content, which detects later changes."""
    return hashlib.sha256(content).hexdigest()


def places(root: Path, robot: str, said: SaidSentence) -> list[dict[str, Any]]:
    """Return the most probable places of a sentence in the saved files; an empty list if no file has it."""
    files = read_files(root, robot)
    found = draft(files)
    languages = tuple(found.settings.languages) if found.settings else ()
    return [one.to_json(languages, files[one.file]) for one in places_in(found, said) if one.file in files]


def places_in(found: ProjectDraft, said: SaidSentence) -> list[WrittenSentence]:
    """Return up to MAX_PLACES equally probable texts of a draft that can yield this sentence.

    A text must have words outside its placeholders. A text of the sentence's action or passage is most probable, then
    the text with the most letters outside its placeholders, then one in a table, a list or a passage.
    """
    fitting = [(one, own) for one in written(found) if (own := own_letters(one.text, said.text))]
    same = [row for row in fitting if not said.language or row[0].language in ("", said.language)]
    passage = found.knowledge.get(said.passage)

    def rank(row: tuple[WrittenSentence, int]) -> tuple[bool, int, bool]:
        one, own = row
        of_passage = passage is not None and one.file == passage.file
        return of_passage or _is_of(one, said), own, "say" not in one.around

    ranked = sorted(same or fitting, key=rank, reverse=True)
    best = [one for one, own in ranked if rank((one, own)) == rank(ranked[0])]
    return best[:MAX_PLACES]


def _is_of(one: WrittenSentence, said: SaidSentence) -> bool:
    """Return True if a text belongs to the action that said the sentence."""
    if one.file != said.file or not said.line:
        return False
    document = one.report.document
    return said.line in (document.place(one.around[:-1]).line, document.place(one.around).line)


def own_letters(template: str, said: str) -> int:
    """Return the number of letters and digits outside a text's placeholders if it can yield the sentence, else 0."""
    literals = [" ".join(literal.split()) for literal in _HOLE.split(template)]
    own = sum(sign.isalnum() for literal in literals for sign in literal)
    pattern = r"\s*(?:.*?)\s*".join(re.escape(literal) for literal in literals)
    return own if own and re.fullmatch(pattern, " ".join(said.split()), re.DOTALL) else 0


def written(found: ProjectDraft) -> Iterator[WrittenSentence]:
    """Yield all texts of the project that a robot may say, each once."""
    known = set[tuple[str, NodePath]]()
    for report, around in (*spoken_places(found), *_plain_entries(found)):
        for one in _texts(report, around):
            if (one.file, one.path) not in known:
                known.add((one.file, one.path))
                yield one


def _plain_entries(found: ProjectDraft) -> Iterator[tuple[DocumentReport, NodePath]]:
    """Yield the place of each list text without a language, because an expression may use it."""
    for tables in word_tables(found):
        for name, entries in tables.lists.items():
            for number, entry in enumerate(entries):
                yield from ((tables.report, ("lists", name, number, key)) for key in entry)


def _texts(report: DocumentReport, around: NodePath) -> Iterator[WrittenSentence]:
    value = report.document.find(around)
    if not isinstance(value, Mapping):
        yield from _alternatives(report, around, around, "", value)
        return
    for key, texts in value.items():
        if key != NO_LANGUAGE:
            language = "" if key in ANY_LANGUAGE else str(key)
            yield from _alternatives(report, around, (*around, key), language, texts)


def _alternatives(
    report: DocumentReport, around: NodePath, path: NodePath, language: str, value: Any
) -> Iterator[WrittenSentence]:
    if isinstance(value, str):
        yield WrittenSentence(report, around, path, language, None, value)
    elif isinstance(value, list):
        for number, text in enumerate(value):
            if isinstance(text, str):
                yield WrittenSentence(report, around, (*path, number), language, number, text)


def texts_of(one: WrittenSentence, languages: tuple[str, ...]) -> dict[str, str]:
    """Return the same text by language; it is empty in the project's languages that lack it.

    An alternative corresponds to the one with the same index; a language with fewer alternatives is left out.
    """
    value = one.report.document.find(one.around)
    if not isinstance(value, Mapping):
        return {one.language: one.text}
    found = {}
    for key in (*languages, *(key for key in value if key not in languages and key != NO_LANGUAGE)):
        if (path := path_in(one, key)) is not None:
            found[key] = str(one.report.document.find(path))
        elif key not in value and one.alternative is None and one.language:
            found[key] = ""
    return found


def path_in(one: WrittenSentence, language: str) -> NodePath | None:
    """Return the path of the same text in another language; None if it is missing there."""
    if not isinstance(one.report.document.find(one.around), Mapping):
        return one.path if language == one.language else None
    path = (*one.around, language) if one.alternative is None else (*one.around, language, one.alternative)
    return path if isinstance(one.report.document.find(path), str) else None
