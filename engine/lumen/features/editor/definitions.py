"""Finds the definitions and uses of a name."""

from lumen.features.editor.analysis import Analysis
from lumen.language.diagnostics import Place


def definitions(analysis: Analysis, file: str, line: int, column: int) -> list[Place]:
    """Return the definitions of the name at a line and column, from 1; for a state its key, not its id.

    The list is empty if the name is unknown or comes with Lumen.
    """
    use = analysis.index.at(file, line, column)
    places = [other.place for other in analysis.index.of(use) if other.defines] if use else []
    return [place for place in places if place.file in analysis.files]


def uses(analysis: Analysis, file: str, line: int, column: int) -> list[Place]:
    """Return all uses of the name at a line and column, from 1; an empty list if there is no name."""
    use = analysis.index.at(file, line, column)
    return [other.place for other in analysis.index.of(use) if other.text] if use else []
