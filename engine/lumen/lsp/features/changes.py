"""What an editor may write in our name: another name for a thing, and repairs."""

from lsprotocol import types as lsp
from pygls.exceptions import JsonRpcInvalidParams

from lumen.errors import LumenError
from lumen.lsp import renaming
from lumen.lsp.analysis import Analysis
from lumen.lsp.language_server import LanguageServer
from lumen.rules.fixes import fixes

RENAMING = lsp.RenameOptions(prepare_provider=True)
REPAIRS = lsp.CodeActionOptions(code_action_kinds=[lsp.CodeActionKind.QuickFix])


def prepare(server: LanguageServer, params: lsp.PrepareRenameParams) -> lsp.PrepareRenamePlaceholder | None:
    def word(analysis: Analysis, file: str, line: int, column: int) -> lsp.PrepareRenamePlaceholder | None:
        found = renaming.renamable(analysis, file, line, column)
        if found is None:
            return None
        return lsp.PrepareRenamePlaceholder(server.encoder(analysis).ranges(file).range(found.place), found.text)

    return server.asked(params, word)


def rename(server: LanguageServer, params: lsp.RenameParams) -> lsp.WorkspaceEdit | None:
    def edit(analysis: Analysis, file: str, line: int, column: int) -> lsp.WorkspaceEdit:
        word = renaming.renamable(analysis, file, line, column)
        if word is None:
            raise JsonRpcInvalidParams("there is nothing here that can be renamed")
        try:
            return server.encoder(analysis).renaming(renaming.rename(analysis, word, params.new_name))
        except LumenError as error:
            raise JsonRpcInvalidParams(str(error)) from None

    return server.asked(params, edit)


async def repair(server: LanguageServer, params: lsp.CodeActionParams) -> list[lsp.CodeAction]:
    """The fixes of the findings in a range."""
    if (found := await server.settled(params.text_document.uri)) is None:
        return []
    analysis, file = found
    encoder, actions = server.encoder(analysis), []
    for diagnostic in analysis.diagnostics:
        here = encoder.ranges(file).range(diagnostic.place)
        if diagnostic.place.file != file or here.end < params.range.start or params.range.end < here.start:
            continue
        for fix in fixes(diagnostic, analysis.files):
            edit = lsp.WorkspaceEdit(document_changes=list(encoder.edits(fix.edits)))
            said = [encoder.diagnostic(diagnostic)]
            actions.append(
                lsp.CodeAction(fix.title, lsp.CodeActionKind.QuickFix, diagnostics=said, edit=edit, is_preferred=True)
            )
    return actions
