"""What can be repaired without asking: findings to edits of the text, comments and layout untouched.

A fix is a proposal: whoever applies one lints again and keeps it only where the finding is gone and no other has come
(`rules.repairs`).
"""

from collections.abc import Mapping

from lumen.feature import resolve, table
from lumen.language.diagnostics import Diagnostic
from lumen.rules.codes import codes
from lumen.rules.fixes.edits import Edit, FileText, Fix, edited
from lumen.rules.fixes.misspellings import outnumbered, slip

__all__ = ["Edit", "FileText", "Fix", "edited", "fixes"]


def fixes(diagnostic: Diagnostic, files: Mapping[str, bytes]) -> list[Fix]:
    """What may repair this finding, the likeliest first; nothing where only its author can know."""
    content = files.get(diagnostic.place.file)
    where = table("fixes").get(diagnostic.code)
    fixer = resolve(where) if where else slip if diagnostic.code.startswith(("unknown-", "wrong-")) else None
    if content is None or fixer is None:
        return []
    source = FileText(diagnostic.place.file, content)
    proposed: list[Fix] = fixer(diagnostic, source)
    if fixer is not slip or codes()[diagnostic.code].family == "shape":
        return proposed
    return [fix for fix in proposed for edit in fix.edits if not outnumbered(source.at(edit.place), edit.text, files)]
