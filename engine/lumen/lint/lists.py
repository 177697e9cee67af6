"""Checks that the entries of a list have the same keys, and describes lists by JSON Schemas."""

from collections import Counter
from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from typing import Any

from lumen.expressions.lists import by_language, is_text_by_language
from lumen.expressions.value_types import schema_of
from lumen.language.diagnostics import ERROR, Code, NodePath, did_you_mean
from lumen.language.language_tags import is_language_tag
from lumen.lint.word_tables import WordTables, word_tables
from lumen.project.document_report import DocumentReport
from lumen.project.draft import ProjectDraft
from lumen.project.torn_texts import whole_text

UNEVEN_LIST = Code("uneven-list", "references", ERROR, "an entry of a list has different keys from the others")

Entries = Sequence[Mapping[str, Any]]


def check(draft: ProjectDraft) -> None:
    """Report entries that lack a key that most entries have, or have a key that most entries lack."""
    for tables in word_tables(draft):
        for name, entries in tables.lists.items():
            _even(tables.report, name, entries)


def listed_texts(
    tables: Iterable[WordTables], languages: Collection[str]
) -> Iterator[tuple[DocumentReport, NodePath, Mapping[str, Any]]]:
    """Yield each text or list of phrases in an entry that is given by language, in any of these languages."""
    for table in tables:
        for name, entries in table.lists.items():
            for i, entry in enumerate(entries):
                for key, value in entry.items():
                    path = ("lists", name, i, key)
                    if not isinstance(value, Mapping) or value.keys().isdisjoint(languages):
                        continue
                    if by_language(value) or is_torn(table.report, path, value, entries):
                        yield table.report, path, value


def is_torn(report: DocumentReport, path: NodePath, value: Mapping[str, Any], entries: Entries) -> bool:
    """Return whether a map in a list is a text by language that YAML has split at a colon or comma.

    Then the map has parts of the text as keys beside the languages. Such a key without a value is certain. A key with a
    value counts if it can't be a name, or if other entries have a text by language in this place and none has a map
    with the same key.
    """
    name = str(path[-1])
    others = [entry[name] for entry in entries if name in entry and entry[name] is not value]
    alike = any(by_language(other) and len(other) > 1 for other in others)
    known = {key for other in others if isinstance(other, Mapping) for key in other}
    for key in (key for key in value if not is_language_tag(key)):
        certain = whole_text(report.document, (*path, key))
        likely = key not in known and (alike or not str(key).isidentifier())
        if not certain and not (likely and whole_text(report.document, (*path, key), by_language=True)):
            return False
    return True


def entry_schema(entries: Entries) -> dict[str, Any]:
    """Return the JSON Schema of an entry of a list, in which every key is required.

    Entries that lack a key are reported by `check`.
    """
    fields = {key: _field([e[key] for e in entries if key in e]) for entry in entries for key in entry}
    return {"type": "object", "properties": fields, "required": sorted(fields)}


def list_schema(entries: Entries) -> dict[str, Any]:
    """Return the JSON Schema of a whole list."""
    return {"type": "array", "items": entry_schema(entries) if entries else {}}


def _field(values: list[Any]) -> dict[str, Any]:
    """Return the schema of the values under a key as expressions see them: a text by language is a string."""
    kinds = {"string" if is_text_by_language(value) else schema_of(value)["type"] for value in values}
    return {"type": sorted(kinds)}


def _even(report: DocumentReport, name: str, entries: Entries) -> None:
    have = Counter(key for entry in entries for key in entry)
    usual = [key for key, count in have.items() if 2 * count > len(entries)]
    for i, entry in enumerate(entries):
        where = ("lists", name, i)
        missing = [key for key in usual if key not in entry and (*where, key) not in report.pruned]
        odd = [key for key in entry if key not in usual and len(entries) > 1]
        for key in odd:
            hint = did_you_mean(key, missing or usual, "the other entries have")
            report(UNEVEN_LIST, (*where, key), f"no other entry of `{name}` has `{key}`", hint, key=True)
        for key in missing if not odd else ():
            message = f"this entry of `{name}` has no `{key}`"
            report(UNEVEN_LIST, where, message, f"add `{key}`: expressions read it from every entry")
