"""Where a thing is made known, and everywhere it is named."""

from lumen.features.editor.analysis import Analysis
from lumen.language.diagnostics import Place


def definitions(analysis: Analysis, file: str, line: int, column: int) -> list[Place]:
    """Where what stands at a line and column, from 1, is made known; a state by its key rather than its id.

    What comes with Lumen is made known in none of the project's files.
    """
    use = analysis.index.at(file, line, column)
    places = [other.place for other in analysis.index.of(use) if other.defines] if use else []
    return [place for place in places if place.file in analysis.files]


def uses(analysis: Analysis, file: str, line: int, column: int) -> list[Place]:
    """Every place that names what stands at a line and column, from 1."""
    use = analysis.index.at(file, line, column)
    return [other.place for other in analysis.index.of(use) if other.text] if use else []
