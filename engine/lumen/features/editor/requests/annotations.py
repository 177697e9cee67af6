"""Lenses, inlay hints, and the signatures of functions."""

from lsprotocol import types as lsp

from lumen.features.editor import hints, lenses, signatures
from lumen.features.editor.language_server import LanguageServer

CALLS = lsp.SignatureHelpOptions(trigger_characters=["(", ","])


async def lens(server: LanguageServer, params: lsp.CodeLensParams) -> list[lsp.CodeLens]:
    """Return a document's lenses with their commands.

    A command's arguments are the project's folder and a name or, for lenses with places, the document, the lens's
    position and the places.
    """
    uri = params.text_document.uri
    if (found := await server.settled(uri)) is None:
        return []
    analysis, file = found
    encoder, shown = server.encoder(analysis), list[lsp.CodeLens]()
    for each in lenses.lenses(analysis, file, server.active(analysis.root)):
        here = encoder.ranges(file).range(each.place)
        arguments: list[object] = [analysis.root.absolute().as_uri(), each.name]
        if each.places:
            arguments = [uri, here.start, [encoder.location(place) for place in each.places]]
        shown.append(lsp.CodeLens(here, lsp.Command(each.title, each.command, arguments=arguments)))
    return shown


async def hint(server: LanguageServer, params: lsp.InlayHintParams) -> list[lsp.InlayHint]:
    """Return the inlay hints in the requested lines of a document."""
    if (found := await server.settled(params.text_document.uri)) is None:
        return []
    ranges = server.encoder(found[0]).ranges(found[1])
    first, last = params.range.start.line + 1, params.range.end.line + 1
    return [
        lsp.InlayHint(ranges.range(each.place).end, each.text, tooltip=each.more, padding_left=True)
        for each in hints.hints(*found)
        if first <= each.place.line <= last
    ]


def call(server: LanguageServer, params: lsp.SignatureHelpParams) -> lsp.SignatureHelp | None:
    """Return the signature of the function whose call contains a position; None if there is none."""
    if (found := server.asked(params, signatures.signature)) is None:
        return None
    shown = lsp.SignatureInformation(
        found.label,
        documentation=found.documentation,
        parameters=[lsp.ParameterInformation(each) for each in found.parameters],
    )
    return lsp.SignatureHelp([shown], active_signature=0, active_parameter=found.active)
