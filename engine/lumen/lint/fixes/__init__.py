"""Repairs that need no decision: from findings to edits of the text that leave comments and layout alone.

A fix is a proposal: the caller lints the edited files, and keeps the fix only if the finding has disappeared and no
other has appeared (`lint.repairs`).
"""

from collections.abc import Callable, Mapping
from typing import Any

from lumen.errors import LumenError
from lumen.feature import owner, resolve, table
from lumen.language.diagnostics import Diagnostic
from lumen.lint.codes import codes
from lumen.lint.fixes.edits import Edit, FileText, Fix, edited
from lumen.lint.fixes.misspellings import outnumbered, slip
from lumen.project.broken_features import blaming, faulty, shown

__all__ = ["Edit", "FileText", "Fix", "edited", "fixes", "usable_fixes"]

SLIP = "lumen.lint.fixes.misspellings:slip"
"""The repair of codes that begin with `unknown-` or `wrong-` and have no repair of their own."""


def fixes(diagnostic: Diagnostic, files: Mapping[str, bytes]) -> list[Fix]:
    """Return the fixes for this finding, the most likely first; empty if only the author can decide.

    Raises LumenError if the repair belongs to another installed package and raises an exception, or returns anything
    but a list of `Fix`.
    """
    content = files.get(diagnostic.place.file)
    where = table("fixes").get(diagnostic.code, SLIP if diagnostic.code.startswith(("unknown-", "wrong-")) else "")
    if content is None or not where:
        return []
    source = FileText(diagnostic.place.file, content)
    proposed = slip(diagnostic, source) if where == SLIP else _proposed(where, diagnostic, source)
    if where != SLIP or codes()[diagnostic.code].family == "shape":
        return proposed
    return [fix for fix in proposed for edit in fix.edits if not outnumbered(source.at(edit.place), edit.text, files)]


def usable_fixes(
    diagnostic: Diagnostic, files: Mapping[str, bytes], failed: Callable[[LumenError], object]
) -> list[Fix]:
    """Return the fixes for this finding; none if its repair is faulty, which is told to `failed`."""
    try:
        return fixes(diagnostic, files)
    except LumenError as error:
        failed(error)
        return []


def _proposed(where: str, diagnostic: Diagnostic, source: FileText) -> list[Fix]:
    feature = owner("fixes", diagnostic.code)
    with blaming(feature, where):
        proposed: Any = resolve(where)(diagnostic, source)
    match proposed:
        case [*fixes] if all(map(_is_fix, fixes)):
            return fixes
    raise faulty(feature, f"`{where}` returned {shown(proposed)} instead of a list of `Fix`")


def _is_fix(value: object) -> bool:
    match value:
        case Fix(str(), [*edits]):
            return all(isinstance(edit, Edit) for edit in edits)
    return False
