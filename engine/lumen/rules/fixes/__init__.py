"""What can be repaired without asking: findings to edits of the text, comments and layout untouched.

A fix is a proposal: whoever applies one lints again and keeps it only where the finding is gone and no other has come
(`rules.repairs`).
"""

from collections.abc import Callable, Mapping

from lumen.language.diagnostics import Diagnostic
from lumen.loading.rulebook import RULE_SYNTAX
from lumen.loading.yaml_errors import TAB
from lumen.loading.yaml_nodes import DECIMAL_COMMA, DUPLICATE_KEY
from lumen.rules.codes import CODES
from lumen.rules.fixes.edits import Edit, FileText, Fix, edited
from lumen.rules.fixes.lines import fewer_ignores, once, spaces
from lumen.rules.fixes.misspellings import filled_in, outnumbered, point, slip, straight_quotes
from lumen.rules.ignores import UNUSED_IGNORE
from lumen.rules.traps import CURLY_QUOTES, NOT_FILLED_IN

__all__ = ["Edit", "FileText", "Fix", "edited", "fixes"]

_FIXERS: Mapping[str, Callable[[Diagnostic, FileText], list[Fix]]] = {
    CURLY_QUOTES: straight_quotes,
    DECIMAL_COMMA: point,
    DUPLICATE_KEY: once,
    NOT_FILLED_IN: filled_in,
    RULE_SYNTAX: slip,
    TAB: spaces,
    UNUSED_IGNORE: fewer_ignores,
}
"""How to repair what; a word that is unknown or wrong may be a slip."""


def fixes(diagnostic: Diagnostic, files: Mapping[str, bytes]) -> list[Fix]:
    """What may repair this finding, the likeliest first; nothing where only its author can know."""
    content = files.get(diagnostic.place.file)
    fixer = _FIXERS.get(diagnostic.code) or (slip if diagnostic.code.startswith(("unknown-", "wrong-")) else None)
    if content is None or fixer is None:
        return []
    source = FileText(diagnostic.place.file, content)
    proposed = fixer(diagnostic, source)
    if fixer is not slip or CODES[diagnostic.code].family == "shape":
        return proposed
    return [fix for fix in proposed for edit in fix.edits if not outnumbered(source.at(edit.place), edit.text, files)]
