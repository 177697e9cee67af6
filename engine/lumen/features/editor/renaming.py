"""Renames a name everywhere in the project."""

import re
from collections.abc import Sequence
from typing import NamedTuple

from lumen.errors import UsageError
from lumen.expressions.function_table import functions
from lumen.features.editor.analysis import Analysis
from lumen.features.editor.heard_rows import ELSE, WAYS
from lumen.features.editor.index import WORD_KINDS
from lumen.features.editor.names import KIND_FOLDERS, NameKind, NameUse
from lumen.language.diagnostics import Diagnostic, Severity
from lumen.language.routes import route_meanings
from lumen.lint.fixes import Edit, edited
from lumen.talk.speech import TABLES, WORD_LISTS

_NAMES = {
    NameKind.STATE: (r"[^\s.#*,\[\]{}:'\"]+", "without spaces, dots, `#` or `*`"),
    NameKind.CONTEXT: (r"[A-Za-z_][A-Za-z0-9_]*", "made of letters, digits and `_`, and begin with a letter or `_`"),
    NameKind.PHRASE: (r"[A-Za-z_][A-Za-z0-9_]*", "made of letters, digits and `_`, and begin with a letter or `_`"),
    NameKind.ANSWERS: (r"[A-Za-z_][A-Za-z0-9_]*", "made of letters, digits and `_`, and begin with a letter or `_`"),
    NameKind.ROUTE: (
        r"[A-Za-z_][A-Za-z0-9_-]*",
        "made of letters, digits, `_` and `-`, and begin with a letter or `_`",
    ),
    NameKind.EVENT: (
        r"[A-Za-z_][\w-]*(\.[\w-]+)*",
        "made of words with dots in between, and begin with a letter or `_`",
    ),
    NameKind.POSE: (r"[A-Za-z_][\w-]*", "made of letters, digits, `_` and `-`, and begin with a letter or `_`"),
    NameKind.MOTION: (r"[A-Za-z_][\w-]*", "made of letters, digits, `_` and `-`, and begin with a letter or `_`"),
    NameKind.CONTROLLER: (r"[A-Za-z_][\w-]*", "made of letters, digits, `_` and `-`, and begin with a letter or `_`"),
    NameKind.BEHAVIOR: (r"[A-Za-z_][\w-]*", "made of letters, digits, `_` and `-`, and begin with a letter or `_`"),
    NameKind.WORDS: (r"[A-Za-z_][\w-]*", "made of letters, digits, `_` and `-`, and begin with a letter or `_`"),
    NameKind.FUNCTION: (
        r"[A-Za-z_][A-Za-z0-9_]*",
        "made of letters, digits and `_`, and begin with a letter or `_`",
    ),
    NameKind.PLACE: (r"[A-Za-z_][\w-]*", "made of letters, digits, `_` and `-`, and begin with a letter or `_`"),
    NameKind.SKILL: (r"[a-z][a-z0-9_]*", "made of small letters, digits and `_`, and begin with a letter"),
    NameKind.STORY: (r"[A-Za-z_][\w-]*", "made of letters, digits, `_` and `-`, and begin with a letter or `_`"),
}
"""The kinds of names that can be renamed, with the pattern of a new name and its description."""
_RESERVED = re.compile(r"(?i:null|true|false|yes|no|on|off|y|n|~|any)|[\d.+-].*")


class Renaming(NamedTuple):
    """The edits of all files, and the renaming of a file (its old and new name), if any."""

    edits: tuple[Edit, ...]
    moved: tuple[str, str] | None = None


def renamable(analysis: Analysis, file: str, line: int, column: int) -> NameUse | None:
    """Return the use of a name at a line and column, from 1, if it can be renamed; else None."""
    use = analysis.index.at(file, line, column)
    defined = use is not None and any(o.defines and o.place.file in analysis.files for o in analysis.index.of(use))
    return use if use and use.kind in _NAMES and defined else None


def rename(analysis: Analysis, use: NameUse, name: str) -> Renaming:
    """Return the renaming of all uses that are written like `use` and have its meaning.

    A state keeps an `id` that differs from its key. Raises UsageError if the new name is invalid or taken, if the old
    name is fixed, or if a file is invalid YAML. `refuse_harm` checks for errors that the renaming causes.
    """
    if analysis.broken:
        said = next(d for each in analysis.broken.values() for d in each.diagnostics)
        raise UsageError(f"can't rename while a file can't be read, because the name may be in it; first fix: {said}")
    pattern, look = _NAMES[use.kind]
    if not re.fullmatch(pattern, name):
        raise UsageError(f"`{name}` can't be the name of a {use.kind}: the name must be {look}")
    if _RESERVED.fullmatch(name):
        raise UsageError(f"`{name}` can't be the name of a {use.kind}: it looks like a number or a keyword of YAML")
    if use.kind in WORD_KINDS and name in (*WAYS, ELSE):
        raise UsageError(f"`{name}` can't be the name of a {use.kind}: it has a meaning in the keys of `hears`")
    if use.kind in WORD_KINDS and name in (*WORD_LISTS, *TABLES):
        raise UsageError(
            f"`{name}` can't be the name of a {use.kind}: it is a word list that `hears` uses to read sentences"
        )
    if use.kind is NameKind.ROUTE and use.name in route_meanings():
        raise UsageError(f"the route `{use.name}` has a fixed meaning in Lumen: {route_meanings()[use.name]}")
    if use.kind is NameKind.FUNCTION and name in functions():
        raise UsageError(f"`{name}` can't be the name of a {use.kind}: a function of this name comes with Lumen")
    if _taken(analysis, use, name):
        raise UsageError(f"there is already a {use.kind} `{name}`")
    uses = [other for other in analysis.index.of(use) if other.text == use.text]
    return Renaming(tuple(Edit(other.place, name) for other in uses), _moved(analysis, use, name))


def applied(analysis: Analysis, renaming: Renaming) -> Analysis:
    """Return the analysis of the project after a renaming."""
    files = dict(analysis.files)
    for file in {edit.place.file for edit in renaming.edits}:
        files[file] = edited(files[file], [edit for edit in renaming.edits if edit.place.file == file])
    if renaming.moved:
        old, new = renaming.moved
        files[new] = files.pop(old)
    return Analysis(analysis.root, files)


def refuse_harm(before: Sequence[Diagnostic], after: Sequence[Diagnostic]) -> None:
    """Raise UsageError if the project has more findings or errors after a renaming than before; ignore Python files."""
    # A skill's function still has the old name. Lint reports that, but the editor does not change Python.
    after = [each for each in after if not each.place.file.endswith(".py")]
    # An error hides other findings, such as unused names, so the number of findings may fall despite a new error.
    if len(after) > len(before) or _errors(after) > _errors(before):
        known = {(d.code, d.message) for d in before}
        new = next((d for d in after if (d.code, d.message) not in known), after[0])
        raise UsageError(f"this new name would break the project: {new}")


def _errors(found: Sequence[Diagnostic]) -> int:
    return sum(d.severity is Severity.ERROR for d in found)


def _taken(analysis: Analysis, use: NameUse, name: str) -> bool:
    if use.kind is NameKind.STATE:
        tree = analysis.index.outlines.get(use.scope)
        beside = f"{use.name.rpartition('.')[0]}.{name}".lstrip(".")
        return tree is not None and (beside in tree.entries or name in tree.aliases)
    return name in analysis.index.names(use.kind, use.scope)


def _moved(analysis: Analysis, use: NameUse, name: str) -> tuple[str, str] | None:
    if use.kind not in KIND_FOLDERS:
        return None
    old = f"{KIND_FOLDERS[use.kind]}/{use.name}.yaml"
    return (old, f"{KIND_FOLDERS[use.kind]}/{name}.yaml") if old in analysis.files else None
