"""The beginning and the end; what is written, saved and closed."""

from pathlib import Path

from lsprotocol import types as lsp

from lumen.features.editor.language_server import LanguageServer
from lumen.features.editor.ranges import path_of


def begun(server: LanguageServer, params: lsp.InitializedParams) -> None:
    server.follow()


def ended(server: LanguageServer, params: None) -> None:
    server.close()


def opened(server: LanguageServer, params: lsp.DidOpenTextDocumentParams) -> None:
    server.written(params.text_document.uri, at_once=True)


def changed(server: LanguageServer, params: lsp.DidChangeTextDocumentParams) -> None:
    server.written(params.text_document.uri)


def saved(server: LanguageServer, params: lsp.DidSaveTextDocumentParams) -> None:
    server.written(params.text_document.uri, at_once=True)


def closed(server: LanguageServer, params: lsp.DidCloseTextDocumentParams) -> None:
    path = Path(path_of(params.text_document.uri))
    server.projects.close(path)
    server.check(path)


def touched(server: LanguageServer, params: lsp.DidChangeWatchedFilesParams) -> None:
    for change in params.changes:
        path = Path(path_of(change.uri))
        server.projects.forget(path)
        server.check(path)
