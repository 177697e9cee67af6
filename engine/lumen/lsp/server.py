"""The language server: the protocol on one side, the language services on the other."""

import asyncio
import logging
from collections.abc import Callable
from pathlib import Path
from typing import Any, TypeVar

from lsprotocol import types as lsp
from pygls.exceptions import JsonRpcInvalidParams
from pygls.lsp import server as pygls_server

import lumen
from lumen.errors import LumenError
from lumen.lsp import completion, definitions, hover, renaming, symbols
from lumen.lsp.analysis import Analysis
from lumen.lsp.open_projects import OpenProjects, root_of
from lumen.lsp.protocol import ProtocolEncoder
from lumen.lsp.ranges import path_of
from lumen.rules.fixes import fixes

CHECK_DELAY = 0.2
"""How long nothing may be typed before the project is checked [s]."""

T = TypeVar("T")


class LanguageServer(pygls_server.LanguageServer):
    """Checks the projects of the files that are open, and answers what an editor asks about a position."""

    def __init__(self) -> None:
        super().__init__("lumen", lumen.__version__)
        self.projects = OpenProjects()
        self._told: dict[Path, set[str]] = {}
        self._waiting: dict[Path, asyncio.Task[None]] = {}

    def encoder(self, analysis: Analysis) -> ProtocolEncoder:
        return ProtocolEncoder(analysis, self.workspace.position_codec)

    def at(self, uri: str, position: lsp.Position) -> tuple[Analysis, str, int, int] | None:
        """Project, file, line and column of a position; None where the file belongs to no project."""
        try:
            analysis, file = self.projects.at(Path(path_of(uri)))
        except LumenError:
            return None
        line, column = self.encoder(analysis).ranges(file).place(position)
        return analysis, file, line, column

    def written(self, uri: str, *, at_once: bool = False) -> None:
        """An open file has changed: take its text, and check its project when nothing has come for a while."""
        path = Path(path_of(uri))
        self.projects.write(path, self.workspace.get_text_document(uri).source)
        if root := root_of(path):
            self._told.setdefault(root, set()).add(path.relative_to(root).as_posix())
        self.check(path, at_once=at_once)

    def check(self, path: Path, *, at_once: bool = False) -> None:
        root = root_of(path)
        if root is None:
            return
        if root in self._waiting:
            self._waiting[root].cancel()
        self._waiting[root] = asyncio.ensure_future(self._check(root, 0 if at_once else CHECK_DELAY))

    async def _check(self, root: Path, wait: float) -> None:
        await asyncio.sleep(wait)
        analysis = self.projects.analysis(root)
        await asyncio.get_running_loop().run_in_executor(None, lambda: analysis.diagnostics)
        self._tell(root, analysis)

    def _tell(self, root: Path, analysis: Analysis) -> None:
        """Publish what was found, file by file; of an open one also that nothing was, or nothing is any more."""
        encoder, found = self.encoder(analysis), dict[str, list[lsp.Diagnostic]]()
        for diagnostic in analysis.diagnostics:
            found.setdefault(diagnostic.place.file, []).append(encoder.diagnostic(diagnostic))
        for file in sorted(self._told.get(root, set()) | found.keys()):
            self.text_document_publish_diagnostics(lsp.PublishDiagnosticsParams(encoder.uri(file), found.get(file, [])))
        self._told[root] = set(found)


def server() -> LanguageServer:
    """A server that has not been started yet."""
    made = LanguageServer()
    _watch(made)
    _answer(made)
    return made


def _watch(made: LanguageServer) -> None:
    """What is written, saved and closed."""

    @made.feature(lsp.TEXT_DOCUMENT_DID_OPEN)
    def opened(server: LanguageServer, params: lsp.DidOpenTextDocumentParams) -> None:
        server.written(params.text_document.uri, at_once=True)

    @made.feature(lsp.TEXT_DOCUMENT_DID_CHANGE)
    def changed(server: LanguageServer, params: lsp.DidChangeTextDocumentParams) -> None:
        server.written(params.text_document.uri)

    @made.feature(lsp.TEXT_DOCUMENT_DID_SAVE)
    def saved(server: LanguageServer, params: lsp.DidSaveTextDocumentParams) -> None:
        server.written(params.text_document.uri, at_once=True)

    @made.feature(lsp.TEXT_DOCUMENT_DID_CLOSE)
    def closed(server: LanguageServer, params: lsp.DidCloseTextDocumentParams) -> None:
        path = Path(path_of(params.text_document.uri))
        server.projects.close(path)
        server.check(path)

    @made.feature(lsp.WORKSPACE_DID_CHANGE_WATCHED_FILES)
    def touched(server: LanguageServer, params: lsp.DidChangeWatchedFilesParams) -> None:
        for change in params.changes:
            path = Path(path_of(change.uri))
            server.projects.forget(path)
            server.check(path)


def _answer(made: LanguageServer) -> None:
    """What an editor asks."""

    @made.feature(
        lsp.TEXT_DOCUMENT_COMPLETION, lsp.CompletionOptions(trigger_characters=[".", "#", "'", "{", " ", ":"])
    )
    def complete(server: LanguageServer, params: lsp.CompletionParams) -> list[lsp.CompletionItem]:
        def items(analysis: Analysis, file: str, line: int, column: int) -> list[lsp.CompletionItem]:
            encoder = server.encoder(analysis)
            found = completion.complete(analysis, file, line, column)
            return [encoder.item(item, file, line, column, order) for order, item in enumerate(found)]

        return _asked(server, params, items) or []

    @made.feature(lsp.TEXT_DOCUMENT_HOVER)
    def show(server: LanguageServer, params: lsp.HoverParams) -> lsp.Hover | None:
        text = _asked(server, params, hover.hover)
        return lsp.Hover(lsp.MarkupContent(lsp.MarkupKind.Markdown, text)) if text else None

    @made.feature(lsp.TEXT_DOCUMENT_DEFINITION)
    def define(server: LanguageServer, params: lsp.DefinitionParams) -> list[lsp.Location]:
        return _places(server, params, definitions.definitions)

    @made.feature(lsp.TEXT_DOCUMENT_REFERENCES)
    def refer(server: LanguageServer, params: lsp.ReferenceParams) -> list[lsp.Location]:
        return _places(server, params, definitions.uses)

    @made.feature(lsp.TEXT_DOCUMENT_PREPARE_RENAME)
    def prepare(server: LanguageServer, params: lsp.PrepareRenameParams) -> lsp.PrepareRenamePlaceholder | None:
        def word(analysis: Analysis, file: str, line: int, column: int) -> lsp.PrepareRenamePlaceholder | None:
            found = renaming.renamable(analysis, file, line, column)
            if found is None:
                return None
            return lsp.PrepareRenamePlaceholder(server.encoder(analysis).ranges(file).range(found.place), found.text)

        return _asked(server, params, word)

    @made.feature(lsp.TEXT_DOCUMENT_RENAME, lsp.RenameOptions(prepare_provider=True))
    def rename(server: LanguageServer, params: lsp.RenameParams) -> lsp.WorkspaceEdit | None:
        def edit(analysis: Analysis, file: str, line: int, column: int) -> lsp.WorkspaceEdit:
            word = renaming.renamable(analysis, file, line, column)
            if word is None:
                raise JsonRpcInvalidParams("there is nothing here that can be renamed")
            try:
                return server.encoder(analysis).renaming(renaming.rename(analysis, word, params.new_name))
            except LumenError as error:
                raise JsonRpcInvalidParams(str(error)) from None

        return _asked(server, params, edit)

    @made.feature(lsp.TEXT_DOCUMENT_DOCUMENT_SYMBOL)
    def outline(server: LanguageServer, params: lsp.DocumentSymbolParams) -> list[lsp.DocumentSymbol]:
        found = server.at(params.text_document.uri, lsp.Position(0, 0))
        if found is None:
            return []
        encoder = server.encoder(found[0])
        return [encoder.symbol(symbol) for symbol in symbols.symbols(found[0], found[1])]

    @made.feature(lsp.TEXT_DOCUMENT_CODE_ACTION, lsp.CodeActionOptions(code_action_kinds=[lsp.CodeActionKind.QuickFix]))
    def act(server: LanguageServer, params: lsp.CodeActionParams) -> list[lsp.CodeAction]:
        found = server.at(params.text_document.uri, params.range.start)
        return _actions(server, found[0], found[1], params.range) if found else []


def _actions(server: LanguageServer, analysis: Analysis, file: str, asked: lsp.Range) -> list[lsp.CodeAction]:
    """The fixes of the findings in a range."""
    encoder, actions = server.encoder(analysis), []
    for diagnostic in analysis.diagnostics:
        here = encoder.ranges(file).range(diagnostic.place)
        if diagnostic.place.file != file or here.end < asked.start or asked.end < here.start:
            continue
        for fix in fixes(diagnostic, analysis.files):
            edit = lsp.WorkspaceEdit(document_changes=list(encoder.edits(fix.edits)))
            said = [encoder.diagnostic(diagnostic)]
            actions.append(
                lsp.CodeAction(fix.title, lsp.CodeActionKind.QuickFix, diagnostics=said, edit=edit, is_preferred=True)
            )
    return actions


def _asked(server: LanguageServer, params: Any, answer: Callable[[Analysis, str, int, int], T]) -> T | None:
    """What a service answers about the position that is asked for."""
    found = server.at(params.text_document.uri, params.position)
    return answer(*found) if found else None


def _places(server: LanguageServer, params: Any, find: Callable[..., list[Any]]) -> list[lsp.Location]:
    found = server.at(params.text_document.uri, params.position)
    return [server.encoder(found[0]).location(place) for place in find(*found)] if found else []


def serve() -> None:
    """Answer an editor on standard input and output until it says goodbye."""
    logging.getLogger("pygls").setLevel(logging.ERROR)
    server().start_io()
