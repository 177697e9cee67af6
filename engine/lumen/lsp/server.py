"""The language server: the protocol on one side, the language services on the other."""

import asyncio
import logging
from collections.abc import Callable
from pathlib import Path
from typing import Any, TypeVar

from lsprotocol import types as lsp
from pygls.exceptions import JsonRpcInvalidParams
from pygls.lsp.server import LanguageServer

import lumen
from lumen.errors import LumenError
from lumen.lsp import completion, definitions, hover, renaming, symbols
from lumen.lsp.analysis import Analysis
from lumen.lsp.answers import Answers
from lumen.lsp.desk import Desk, root_of
from lumen.lsp.ranges import path_of
from lumen.rules.fixes import fixes

QUIET = 0.2
"""How long nothing may be typed before the project is checked [s]."""

T = TypeVar("T")


class Server(LanguageServer):
    """Checks the projects of the files that are open, and answers what an editor asks about a position."""

    def __init__(self) -> None:
        super().__init__("lumen", lumen.__version__)
        self.desk = Desk()
        self._told: dict[Path, set[str]] = {}
        self._waiting: dict[Path, asyncio.Task[None]] = {}

    def answers(self, analysis: Analysis) -> Answers:
        return Answers(analysis, self.workspace.position_codec)

    def at(self, uri: str, position: lsp.Position) -> tuple[Analysis, str, int, int] | None:
        """Project, file, line and column of a position; None where the file belongs to no project."""
        try:
            analysis, file = self.desk.at(Path(path_of(uri)))
        except LumenError:
            return None
        line, column = self.answers(analysis).ranges(file).place(position)
        return analysis, file, line, column

    def written(self, uri: str, *, at_once: bool = False) -> None:
        """An open file has changed: take its text, and check its project when nothing has come for a while."""
        path = Path(path_of(uri))
        self.desk.write(path, self.workspace.get_text_document(uri).source)
        if root := root_of(path):
            self._told.setdefault(root, set()).add(path.relative_to(root).as_posix())
        self.check(path, at_once=at_once)

    def check(self, path: Path, *, at_once: bool = False) -> None:
        root = root_of(path)
        if root is None:
            return
        if root in self._waiting:
            self._waiting[root].cancel()
        self._waiting[root] = asyncio.ensure_future(self._check(root, 0 if at_once else QUIET))

    async def _check(self, root: Path, wait: float) -> None:
        await asyncio.sleep(wait)
        analysis = self.desk.analysis(root)
        await asyncio.get_running_loop().run_in_executor(None, lambda: analysis.diagnostics)
        self._tell(root, analysis)

    def _tell(self, root: Path, analysis: Analysis) -> None:
        """Publish what was found, file by file; of an open one also that nothing was, or nothing is any more."""
        answers, found = self.answers(analysis), dict[str, list[lsp.Diagnostic]]()
        for diagnostic in analysis.diagnostics:
            found.setdefault(diagnostic.place.file, []).append(answers.diagnostic(diagnostic))
        for file in sorted(self._told.get(root, set()) | found.keys()):
            self.text_document_publish_diagnostics(lsp.PublishDiagnosticsParams(answers.uri(file), found.get(file, [])))
        self._told[root] = set(found)


def server() -> Server:
    """A server that has not been started yet."""
    made = Server()
    _watch(made)
    _answer(made)
    return made


def _watch(made: Server) -> None:
    """What is written, saved and closed."""

    @made.feature(lsp.TEXT_DOCUMENT_DID_OPEN)
    def opened(server: Server, params: lsp.DidOpenTextDocumentParams) -> None:
        server.written(params.text_document.uri, at_once=True)

    @made.feature(lsp.TEXT_DOCUMENT_DID_CHANGE)
    def changed(server: Server, params: lsp.DidChangeTextDocumentParams) -> None:
        server.written(params.text_document.uri)

    @made.feature(lsp.TEXT_DOCUMENT_DID_SAVE)
    def saved(server: Server, params: lsp.DidSaveTextDocumentParams) -> None:
        server.written(params.text_document.uri, at_once=True)

    @made.feature(lsp.TEXT_DOCUMENT_DID_CLOSE)
    def closed(server: Server, params: lsp.DidCloseTextDocumentParams) -> None:
        path = Path(path_of(params.text_document.uri))
        server.desk.close(path)
        server.check(path)

    @made.feature(lsp.WORKSPACE_DID_CHANGE_WATCHED_FILES)
    def touched(server: Server, params: lsp.DidChangeWatchedFilesParams) -> None:
        for change in params.changes:
            path = Path(path_of(change.uri))
            server.desk.forget(path)
            server.check(path)


def _answer(made: Server) -> None:
    """What an editor asks."""

    @made.feature(
        lsp.TEXT_DOCUMENT_COMPLETION, lsp.CompletionOptions(trigger_characters=[".", "#", "'", "{", " ", ":"])
    )
    def complete(server: Server, params: lsp.CompletionParams) -> list[lsp.CompletionItem]:
        def items(analysis: Analysis, file: str, line: int, column: int) -> list[lsp.CompletionItem]:
            answers = server.answers(analysis)
            found = completion.complete(analysis, file, line, column)
            return [answers.item(item, file, line, column, order) for order, item in enumerate(found)]

        return _asked(server, params, items) or []

    @made.feature(lsp.TEXT_DOCUMENT_HOVER)
    def show(server: Server, params: lsp.HoverParams) -> lsp.Hover | None:
        text = _asked(server, params, hover.hover)
        return lsp.Hover(lsp.MarkupContent(lsp.MarkupKind.Markdown, text)) if text else None

    @made.feature(lsp.TEXT_DOCUMENT_DEFINITION)
    def define(server: Server, params: lsp.DefinitionParams) -> list[lsp.Location]:
        return _places(server, params, definitions.definitions)

    @made.feature(lsp.TEXT_DOCUMENT_REFERENCES)
    def refer(server: Server, params: lsp.ReferenceParams) -> list[lsp.Location]:
        return _places(server, params, definitions.uses)

    @made.feature(lsp.TEXT_DOCUMENT_PREPARE_RENAME)
    def prepare(server: Server, params: lsp.PrepareRenameParams) -> lsp.PrepareRenamePlaceholder | None:
        def word(analysis: Analysis, file: str, line: int, column: int) -> lsp.PrepareRenamePlaceholder | None:
            found = renaming.renamable(analysis, file, line, column)
            if found is None:
                return None
            return lsp.PrepareRenamePlaceholder(server.answers(analysis).ranges(file).range(found.place), found.text)

        return _asked(server, params, word)

    @made.feature(lsp.TEXT_DOCUMENT_RENAME, lsp.RenameOptions(prepare_provider=True))
    def rename(server: Server, params: lsp.RenameParams) -> lsp.WorkspaceEdit | None:
        def edit(analysis: Analysis, file: str, line: int, column: int) -> lsp.WorkspaceEdit:
            word = renaming.renamable(analysis, file, line, column)
            if word is None:
                raise JsonRpcInvalidParams("there is nothing here that can be renamed")
            try:
                return server.answers(analysis).renaming(renaming.rename(analysis, word, params.new_name))
            except LumenError as error:
                raise JsonRpcInvalidParams(str(error)) from None

        return _asked(server, params, edit)

    @made.feature(lsp.TEXT_DOCUMENT_DOCUMENT_SYMBOL)
    def outline(server: Server, params: lsp.DocumentSymbolParams) -> list[lsp.DocumentSymbol]:
        found = server.at(params.text_document.uri, lsp.Position(0, 0))
        if found is None:
            return []
        answers = server.answers(found[0])
        return [answers.symbol(symbol) for symbol in symbols.symbols(found[0], found[1])]

    @made.feature(lsp.TEXT_DOCUMENT_CODE_ACTION, lsp.CodeActionOptions(code_action_kinds=[lsp.CodeActionKind.QuickFix]))
    def act(server: Server, params: lsp.CodeActionParams) -> list[lsp.CodeAction]:
        found = server.at(params.text_document.uri, params.range.start)
        return _actions(server, found[0], found[1], params.range) if found else []


def _actions(server: Server, analysis: Analysis, file: str, asked: lsp.Range) -> list[lsp.CodeAction]:
    """The fixes of the findings in a range."""
    answers, actions = server.answers(analysis), []
    for diagnostic in analysis.diagnostics:
        here = answers.ranges(file).range(diagnostic.place)
        if diagnostic.place.file != file or here.end < asked.start or asked.end < here.start:
            continue
        for fix in fixes(diagnostic, analysis.files):
            edit = lsp.WorkspaceEdit(document_changes=list(answers.edits(fix.edits)))
            said = [answers.diagnostic(diagnostic)]
            actions.append(
                lsp.CodeAction(fix.title, lsp.CodeActionKind.QuickFix, diagnostics=said, edit=edit, is_preferred=True)
            )
    return actions


def _asked(server: Server, params: Any, answer: Callable[[Analysis, str, int, int], T]) -> T | None:
    """What a service answers about the position that is asked for."""
    found = server.at(params.text_document.uri, params.position)
    return answer(*found) if found else None


def _places(server: Server, params: Any, find: Callable[..., list[Any]]) -> list[lsp.Location]:
    found = server.at(params.text_document.uri, params.position)
    return [server.answers(found[0]).location(place) for place in find(*found)] if found else []


def serve() -> None:
    """Answer an editor on standard input and output until it says goodbye."""
    logging.getLogger("pygls").setLevel(logging.ERROR)
    server().start_io()
