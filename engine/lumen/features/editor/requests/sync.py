"""Notifications of a session's beginning and end, and of opened, changed, saved and closed documents."""

from pathlib import Path

from lsprotocol import types as lsp

from lumen.features.editor.language_server import LanguageServer
from lumen.features.editor.ranges import path_of


def begun(server: LanguageServer, params: lsp.InitializedParams) -> None:
    """Start to follow running exhibitions."""
    server.follow()


def ended(server: LanguageServer, params: None) -> None:
    """End the thread that follows exhibitions, and the checking processes."""
    server.close()


def opened(server: LanguageServer, params: lsp.DidOpenTextDocumentParams) -> None:
    """Store the document's text, and check its project immediately."""
    server.written(params.text_document.uri, at_once=True)


def changed(server: LanguageServer, params: lsp.DidChangeTextDocumentParams) -> None:
    """Store the document's text, and check its project after a pause in typing."""
    server.written(params.text_document.uri)


def saved(server: LanguageServer, params: lsp.DidSaveTextDocumentParams) -> None:
    """Check the document's project immediately."""
    server.written(params.text_document.uri, at_once=True)


def closed(server: LanguageServer, params: lsp.DidCloseTextDocumentParams) -> None:
    """Discard the document's unsaved text, and check its project after a pause in typing."""
    path = Path(path_of(params.text_document.uri))
    server.projects.close(path)
    server.check(path)


def touched(server: LanguageServer, params: lsp.DidChangeWatchedFilesParams) -> None:
    """Check the projects of files that have changed on disk."""
    for change in params.changes:
        path = Path(path_of(change.uri))
        server.projects.forget(path)
        server.check(path)
