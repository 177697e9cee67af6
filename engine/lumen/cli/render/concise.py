"""One line for each finding, in a form that editors can parse and `grep` can filter."""

from collections.abc import Sequence

from lumen.cli.render.terminal_text import SEVERITY_COLOURS, clean, summary
from lumen.cli.terminal import paint
from lumen.language.diagnostics import Diagnostic
from lumen.run.linting.findings import Findings


def render(found: Sequence[Findings], *, coloured: bool = False) -> str:
    """Return lines `file:line:column: severity[code] message (hint)`, and a line with the counts."""
    lines = [_line(each, diagnostic, coloured) for each in found for diagnostic in each.diagnostics]
    return "\n".join([*lines, summary(found, coloured)])


def _line(found: Findings, diagnostic: Diagnostic, coloured: bool) -> str:
    place = diagnostic.place
    where = paint(f"{clean(found.name(place.file))}:{place.line}:{place.column}:", "bold", on=coloured)
    what = paint(f"{diagnostic.severity}[{diagnostic.code}]", SEVERITY_COLOURS[diagnostic.severity], on=coloured)
    hint = f" ({clean(diagnostic.hint)})" if diagnostic.hint else ""
    return f"{where} {what} {clean(diagnostic.message)}{hint}"
