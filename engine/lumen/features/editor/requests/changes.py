"""Changes to the project's files: renaming, and fixes of findings."""

import logging

from lsprotocol import types as lsp
from pygls.exceptions import JsonRpcContentModified, JsonRpcInvalidParams

from lumen.errors import LumenError
from lumen.features.editor import renaming
from lumen.features.editor.analysis import Analysis
from lumen.features.editor.language_server import LanguageServer
from lumen.lint.fixes import usable_fixes

RENAMING = lsp.RenameOptions(prepare_provider=True)
_log = logging.getLogger(__name__)
REPAIRS = lsp.CodeActionOptions(code_action_kinds=[lsp.CodeActionKind.QuickFix])


def prepare(server: LanguageServer, params: lsp.PrepareRenameParams) -> lsp.PrepareRenamePlaceholder | None:
    """Return the range and text of the name at a position if it can be renamed, else None."""

    def word(analysis: Analysis, file: str, line: int, column: int) -> lsp.PrepareRenamePlaceholder | None:
        found = renaming.renamable(analysis, file, line, column)
        if found is None:
            return None
        return lsp.PrepareRenamePlaceholder(server.encoder(analysis).ranges(file).range(found.place), found.text)

    return server.asked(params, word)


async def rename(server: LanguageServer, params: lsp.RenameParams) -> lsp.WorkspaceEdit | None:
    """Return the edits of a renaming; None if the file belongs to no project.

    Raises JsonRpcInvalidParams if the renaming is impossible or causes findings, and JsonRpcContentModified if a file
    changes meanwhile.
    """
    await server.settled(params.text_document.uri)
    if (found := server.at(params.text_document.uri, params.position)) is None:
        return None
    analysis, file, line, column = found
    if (word := renaming.renamable(analysis, file, line, column)) is None:
        raise JsonRpcInvalidParams("nothing here can be renamed")
    try:
        renamed = renaming.rename(analysis, word, params.new_name)
        after = await server.judge(analysis.root).judge(renaming.applied(analysis, renamed))
        if after is None:
            raise JsonRpcContentModified
        renaming.refuse_harm(analysis.diagnostics, after.diagnostics)
    except LumenError as error:
        raise JsonRpcInvalidParams(str(error)) from None
    return server.encoder(analysis).renaming(renamed)


async def repair(server: LanguageServer, params: lsp.CodeActionParams) -> list[lsp.CodeAction]:
    """Return the fixes for a document's findings in a range."""
    if (found := await server.settled(params.text_document.uri)) is None:
        return []
    analysis, file = found
    encoder, actions = server.encoder(analysis), []
    for diagnostic in analysis.diagnostics:
        here = encoder.ranges(file).range(diagnostic.place)
        if diagnostic.place.file != file or here.end < params.range.start or params.range.end < here.start:
            continue
        for fix in usable_fixes(diagnostic, analysis.files, _log.error):
            edit = lsp.WorkspaceEdit(document_changes=list(encoder.edits(fix.edits)))
            said = [encoder.diagnostic(diagnostic)]
            actions.append(
                lsp.CodeAction(fix.title, lsp.CodeActionKind.QuickFix, diagnostics=said, edit=edit, is_preferred=True)
            )
    return actions
