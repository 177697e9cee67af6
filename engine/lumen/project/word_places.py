"""Find the place of a single word within a text of a document."""

from dataclasses import replace

from lumen.language.diagnostics import Code, NodePath, Place
from lumen.language.text_lines import lines_of
from lumen.project.document import Document
from lumen.project.document_report import DocumentReport


def report_word(
    report: DocumentReport, code: Code, path: NodePath, text: str, offset: int, length: int, message: str, hint: str
) -> None:
    """Report a finding about `text[offset : offset + length]`, where `text` is the scalar at `path`."""
    before = len(report.diagnostics)
    word = text[offset : offset + length]
    report(code, path, message, hint=hint, cause=f"{report.document.file} {code} {word}" if "unknown" in code else "")
    if len(report.diagnostics) > before:
        place = place_of(report.document, path, text, offset, length)
        report.diagnostics[-1] = replace(report.diagnostics[-1], place=place)


def place_of(document: Document, path: NodePath, text: str, offset: int, length: int) -> Place:
    """Return the place of `text[offset : offset + length]`, where `text` is the scalar at `path`.

    Its visible characters are found one after the other, through quotes, folded lines and blocks. If a character is not
    found, as at an escape, or if the document has no source, the place is that of the whole text. If no visible
    character is left at `offset`, the place is that of the character after the text.
    """
    whole = document.place(path)
    columns = _columns(document, whole, text)
    if not columns:
        return whole
    shown = [i for i, c in enumerate(text) if not c.isspace()]
    inside = [columns[i] for i in shown if offset <= i < offset + max(length, 1)]
    if not inside:
        line, column = columns[shown[-1]]
        return Place(whole.file, line, column + 1, line, column + 2)
    (line, column), (end_line, end_column) = inside[0], inside[-1]
    return Place(whole.file, line, column, end_line, end_column + 1)


def _columns(document: Document, whole: Place, text: str) -> dict[int, tuple[int, int]]:
    """Return the line and column of each visible character of the text, by its index; empty if any is not found."""
    lines = lines_of(document.text)
    first = lines[whole.line - 1] if document.text and whole.line <= len(lines) else ""
    line, column = whole.line, whole.column
    if first[column - 1 : column] in ("|", ">"):
        line, column = line + 1, 1
    found: dict[int, tuple[int, int]] = {}
    for i, character in enumerate(text):
        if character.isspace():
            continue
        while line <= whole.end_line and line <= len(lines):
            at = lines[line - 1].find(character, column - 1)
            limit = whole.end_column - 1 if line == whole.end_line else len(lines[line - 1])
            if 0 <= at < limit and _skippable(lines[line - 1][column - 1 : at]):
                found[i] = (line, at + 1)
                column = at + 2
                break
            line, column = line + 1, 1
        else:
            return {}
    return found


def _skippable(between: str) -> bool:
    """Return True if there are only spaces and quotes between two characters of a text."""
    return not between.strip(" \t'\"")
