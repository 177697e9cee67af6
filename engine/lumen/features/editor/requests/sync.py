"""The beginning and end of a session, and changed, saved and closed documents."""

from pathlib import Path

from lsprotocol import types as lsp

from lumen.features.editor.language_server import LanguageServer
from lumen.features.editor.ranges import path_of


def begun(server: LanguageServer, params: lsp.InitializedParams) -> None:
    """Start to follow running exhibitions."""
    server.follow()


def ended(server: LanguageServer, params: None) -> None:
    """End the server's thread and processes."""
    server.close()


def opened(server: LanguageServer, params: lsp.DidOpenTextDocumentParams) -> None:
    """Check the document's project at once."""
    server.written(params.text_document.uri, at_once=True)


def changed(server: LanguageServer, params: lsp.DidChangeTextDocumentParams) -> None:
    """Check the document's project once typing pauses."""
    server.written(params.text_document.uri)


def saved(server: LanguageServer, params: lsp.DidSaveTextDocumentParams) -> None:
    """Check the document's project at once."""
    server.written(params.text_document.uri, at_once=True)


def closed(server: LanguageServer, params: lsp.DidCloseTextDocumentParams) -> None:
    """Forget the document's unsaved text, and check its project."""
    path = Path(path_of(params.text_document.uri))
    server.projects.close(path)
    server.check(path)


def touched(server: LanguageServer, params: lsp.DidChangeWatchedFilesParams) -> None:
    """Check the projects of files that changed on disk."""
    for change in params.changes:
        path = Path(path_of(change.uri))
        server.projects.forget(path)
        server.check(path)
