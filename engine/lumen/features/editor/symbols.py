"""The symbols that a file defines, as a tree in which states contain their inner states."""

from collections.abc import Iterator
from typing import NamedTuple

from lumen.features.editor.analysis import Analysis
from lumen.features.editor.grammar import defines, key_kind
from lumen.features.editor.names import NameKind, NameUse
from lumen.language.diagnostics import Place
from lumen.project.document import Document
from lumen.project.project_folders import kind_of


class Symbol(NamedTuple):
    """A name that a file defines."""

    name: str
    kind: NameKind
    place: Place
    """The place of the name."""
    whole: Place
    """The place of the whole definition."""
    children: tuple["Symbol", ...] = ()


def symbols(analysis: Analysis, file: str) -> tuple[Symbol, ...]:
    """Return a file's symbols in their order; empty if the file is unreadable."""
    document = analysis.documents.get(file)
    return _below(document, kind_of(file), ()) if document else ()


def search(analysis: Analysis, query: str) -> Iterator[NameUse]:
    """Yield the definitions in the project's files whose names contain the query's letters in this order."""
    for use in analysis.index.uses:
        letters = iter(use.name.lower())
        if use.defines and use.place.file in analysis.files and all(letter in letters for letter in query.lower()):
            yield use


def _below(document: Document, kind: str, path: tuple[str | int, ...]) -> tuple[Symbol, ...]:
    node = document.value(path)
    found: list[Symbol] = []
    for key in node if isinstance(node, dict) else ():
        here = (*path, key)
        span, named = document.spans.get(here), key_kind(kind, here)
        if span is None or span.key is None:
            continue
        if named and defines(kind, here, named):
            whole = span.key._replace(end_line=span.value.end_line, end_column=span.value.end_column)
            found.append(Symbol(key, named, span.key, max(whole, span.key), _below(document, kind, here)))
        elif not path or key == "states":
            found += _below(document, kind, here)
    return tuple(found)
