"""Converts the language services' values to the types of the Language Server Protocol."""

from collections.abc import Iterable
from pathlib import Path

from lsprotocol import types as lsp
from pygls.workspace import PositionCodec

from lumen.features.editor.analysis import Analysis
from lumen.features.editor.completion import Item
from lumen.features.editor.names import NameKind
from lumen.features.editor.ranges import Ranges
from lumen.features.editor.renaming import Renaming
from lumen.features.editor.symbols import Symbol
from lumen.language.diagnostics import Diagnostic, Place, Severity
from lumen.lint.fixes import Edit, FileText

LSP_SEVERITIES = {
    Severity.ERROR: lsp.DiagnosticSeverity.Error,
    Severity.WARNING: lsp.DiagnosticSeverity.Warning,
    Severity.INFO: lsp.DiagnosticSeverity.Information,
}
_ICONS = {
    NameKind.STATE: lsp.SymbolKind.Class,
    NameKind.CONTEXT: lsp.SymbolKind.Variable,
    NameKind.EVENT: lsp.SymbolKind.Event,
    NameKind.ROUTE: lsp.SymbolKind.Interface,
    NameKind.POSE: lsp.SymbolKind.Struct,
    NameKind.POSTURE: lsp.SymbolKind.Struct,
    NameKind.JOINT: lsp.SymbolKind.Field,
    NameKind.PHRASE: lsp.SymbolKind.String,
    NameKind.ANSWERS: lsp.SymbolKind.Array,
}


def icon(kind: NameKind) -> lsp.SymbolKind:
    """Return the symbol kind by which an editor selects the icon for a name."""
    return _ICONS.get(kind, lsp.SymbolKind.Key)


class ProtocolEncoder:
    """Encodes a project's results for one client; `codec` converts columns to the client's units."""

    def __init__(self, analysis: Analysis, codec: PositionCodec) -> None:
        self.analysis, self._codec = analysis, codec
        self._ranges: dict[str, Ranges] = {}

    def ranges(self, file: str) -> Ranges:
        """Return the converter of places in a file."""
        if file not in self._ranges:
            self._ranges[file] = Ranges(FileText(file, self.analysis.files.get(file, b"")), self._codec)
        return self._ranges[file]

    def uri(self, file: str) -> str:
        """Return the absolute URI of one of the project's files."""
        return (Path(self.analysis.root) / file).absolute().as_uri()

    def location(self, place: Place) -> lsp.Location:
        """Return the protocol's location of a place."""
        return lsp.Location(self.uri(place.file), self.ranges(place.file).range(place))

    def diagnostic(self, found: Diagnostic) -> lsp.Diagnostic:
        """Return a finding as the protocol's diagnostic, with its hint, its rule's code, and related places."""
        related = [lsp.DiagnosticRelatedInformation(self.location(r.place), r.message) for r in found.related]
        return lsp.Diagnostic(
            self.ranges(found.place.file).range(found.place),
            f"{found.message}: {found.hint}" if found.hint else found.message,
            LSP_SEVERITIES[found.severity],
            code=found.code,
            source="lumen",
            related_information=related,
        )

    def item(self, item: Item, file: str, line: int, column: int, order: int) -> lsp.CompletionItem:
        """Return the completion item of a proposal at a line and column, from 1; `order` is its rank."""
        place = Place(file, line, column - item.replaces, line, column)
        icon = lsp.CompletionItemKind.Property if item.detail == "key" else lsp.CompletionItemKind.Reference
        return lsp.CompletionItem(
            item.text.rstrip(" :") or item.text,
            kind=icon,
            detail=item.detail,
            documentation=item.documentation or None,
            sort_text=f"{order:05}",
            filter_text=item.text,
            text_edit=lsp.TextEdit(self.ranges(file).range(place), item.text),
        )

    def symbol(self, symbol: Symbol) -> lsp.DocumentSymbol:
        """Return the protocol's symbol, with its children."""
        ranges = self.ranges(symbol.place.file)
        return lsp.DocumentSymbol(
            symbol.name,
            icon(symbol.kind),
            ranges.range(symbol.whole),
            ranges.range(symbol.place),
            detail=str(symbol.kind),
            children=[self.symbol(child) for child in symbol.children],
        )

    def edits(self, edits: Iterable[Edit]) -> list[lsp.TextDocumentEdit | lsp.RenameFile]:
        """Return the protocol's edits of documents, grouped by file."""
        gathered: dict[str, list[lsp.TextEdit | lsp.AnnotatedTextEdit | lsp.SnippetTextEdit]] = {}
        for edit in edits:
            change = lsp.TextEdit(self.ranges(edit.place.file).range(edit.place), edit.text)
            gathered.setdefault(edit.place.file, []).append(change)
        return [
            lsp.TextDocumentEdit(lsp.OptionalVersionedTextDocumentIdentifier(self.uri(file)), changes)
            for file, changes in gathered.items()
        ]

    def renaming(self, renaming: Renaming) -> lsp.WorkspaceEdit:
        """Return the protocol's edits: those of the files by their current names, then the file's renaming, if any."""
        changes = self.edits(renaming.edits)
        if renaming.moved:
            old, new = renaming.moved
            changes.append(lsp.RenameFile(self.uri(old), self.uri(new)))
        return lsp.WorkspaceEdit(document_changes=list(changes))
