"""The stranger's answer to an editor: the colours in a file."""

from lsprotocol import types as lsp

from lumen.features.editor.language_server import LanguageServer

OPTIONS = lsp.DocumentColorOptions(work_done_progress=False)


def colours(server: LanguageServer, params: lsp.DocumentColorParams) -> list[lsp.ColorInformation]:
    """Return one colour for each line with the word `red`."""
    lines = server.workspace.get_text_document(params.text_document.uri).lines
    return [
        lsp.ColorInformation(lsp.Range(lsp.Position(number, 0), lsp.Position(number, 3)), lsp.Color(1.0, 0.0, 0.0, 1.0))
        for number, line in enumerate(lines)
        if "red" in line
    ]


def count(server: LanguageServer, text: str) -> int:
    """Return how often a text names the colour."""
    return text.count("red")
