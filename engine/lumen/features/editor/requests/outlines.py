"""Requests for a file's outline, the projects' symbols, folding ranges, and links to files."""

from lsprotocol import types as lsp

from lumen.features.editor import folding, links, symbols
from lumen.features.editor.language_server import LanguageServer
from lumen.features.editor.protocol import icon

MAX_FOUND_SYMBOLS = 300


async def outline(server: LanguageServer, params: lsp.DocumentSymbolParams) -> list[lsp.DocumentSymbol]:
    """Return the symbols of a document as a tree."""
    if (found := await server.settled(params.text_document.uri)) is None:
        return []
    encoder = server.encoder(found[0])
    return [encoder.symbol(symbol) for symbol in symbols.symbols(*found)]


def search(server: LanguageServer, params: lsp.WorkspaceSymbolParams) -> list[lsp.WorkspaceSymbol]:
    """Return up to MAX_FOUND_SYMBOLS symbols of open projects whose names contain the query's letters in this order."""
    found: list[lsp.WorkspaceSymbol] = []
    for analysis in server.analyses():
        encoder = server.encoder(analysis)
        for use in symbols.search(analysis, params.query):
            location = encoder.location(use.place)
            found.append(lsp.WorkspaceSymbol(location, use.name, icon(use.kind), container_name=str(use.kind)))
            if len(found) == MAX_FOUND_SYMBOLS:
                return found
    return found


async def fold(server: LanguageServer, params: lsp.FoldingRangeParams) -> list[lsp.FoldingRange]:
    """Return the folding ranges of a document."""
    found = await server.settled(params.text_document.uri)
    document = found[0].documents.get(found[1]) if found else None
    kinds = (None, lsp.FoldingRangeKind.Comment)
    return [
        lsp.FoldingRange(each.first - 1, each.last - 1, kind=kinds[each.comment])
        for each in (folding.folds(document) if document else ())
    ]


async def link(server: LanguageServer, params: lsp.DocumentLinkParams) -> list[lsp.DocumentLink]:
    """Return a document's links to files."""
    if (found := await server.settled(params.text_document.uri)) is None:
        return []
    encoder = server.encoder(found[0])
    ranges = encoder.ranges(found[1])
    return [
        lsp.DocumentLink(ranges.range(each.place), target=encoder.uri(each.target), tooltip=each.target)
        for each in links.links(*found)
    ]
