"""Requests about a position: completion, hover, definitions, uses and highlights."""

from collections.abc import Callable
from typing import Any

from lsprotocol import types as lsp

from lumen.features.editor import completion, definitions, hover
from lumen.features.editor.analysis import Analysis
from lumen.features.editor.language_server import LanguageServer

TRIGGERS = lsp.CompletionOptions(trigger_characters=[".", "#", "'", "{", " ", ":", "|"])


def complete(server: LanguageServer, params: lsp.CompletionParams) -> list[lsp.CompletionItem]:
    """Return the proposals for a position, the best first."""

    def items(analysis: Analysis, file: str, line: int, column: int) -> list[lsp.CompletionItem]:
        encoder = server.encoder(analysis)
        found = completion.complete(analysis, file, line, column)
        return [encoder.item(item, file, line, column, order) for order, item in enumerate(found)]

    return server.asked(params, items) or []


async def show(server: LanguageServer, params: lsp.HoverParams) -> lsp.Hover | None:
    """Return the hover text at a position; None if there is none."""
    await server.settled(params.text_document.uri)
    text = server.asked(params, hover.hover)
    return lsp.Hover(lsp.MarkupContent(lsp.MarkupKind.Markdown, text)) if text else None


def define(server: LanguageServer, params: lsp.DefinitionParams) -> list[lsp.Location]:
    """Return the definitions of the name at a position."""
    return _places(server, params, definitions.definitions)


def refer(server: LanguageServer, params: lsp.ReferenceParams) -> list[lsp.Location]:
    """Return all uses of the name at a position, including its definitions."""
    return _places(server, params, definitions.uses)


def highlight(server: LanguageServer, params: lsp.DocumentHighlightParams) -> list[lsp.DocumentHighlight]:
    """Return the document's uses of the name at a position, marked as written for definitions and else as read."""

    def marks(analysis: Analysis, file: str, line: int, column: int) -> list[lsp.DocumentHighlight]:
        use, ranges = analysis.index.at(file, line, column), server.encoder(analysis).ranges(file)
        kinds = (lsp.DocumentHighlightKind.Read, lsp.DocumentHighlightKind.Write)
        return [
            lsp.DocumentHighlight(ranges.range(other.place), kinds[other.defines])
            for other in (analysis.index.of(use) if use else ())
            if other.text and other.place.file == file
        ]

    return server.asked(params, marks) or []


def _places(server: LanguageServer, params: Any, find: Callable[..., list[Any]]) -> list[lsp.Location]:
    found = server.at(params.text_document.uri, params.position)
    return [server.encoder(found[0]).location(place) for place in find(*found)] if found else []
