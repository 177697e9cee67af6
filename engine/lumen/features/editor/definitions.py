"""Finds the places that define a thing, and those that use its name."""

from lumen.features.editor.analysis import Analysis
from lumen.language.diagnostics import Place


def definitions(analysis: Analysis, file: str, line: int, column: int) -> list[Place]:
    """Return the places that define the thing at a line and column, from 1; for a state its key, not its id.

    Things that come with Lumen are not defined in the project's files.
    """
    use = analysis.index.at(file, line, column)
    places = [other.place for other in analysis.index.of(use) if other.defines] if use else []
    return [place for place in places if place.file in analysis.files]


def uses(analysis: Analysis, file: str, line: int, column: int) -> list[Place]:
    """Return all places that name the thing at a line and column, from 1."""
    use = analysis.index.at(file, line, column)
    return [other.place for other in analysis.index.of(use) if other.text] if use else []
