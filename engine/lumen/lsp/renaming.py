"""Another name for a thing, wherever it stands in the project."""

import re
from typing import NamedTuple

from lumen.errors import UsageError
from lumen.language.routes import MEANINGS
from lumen.lsp.analysis import Analysis
from lumen.lsp.words import FOLDERS, SCOPED, Kind, Word
from lumen.rules.fixes import Edit, edited

_NAMES = {
    Kind.STATE: (r"[^\s.#*,\[\]{}:'\"]+", "without spaces, dots, `#` or `*`"),
    Kind.CONTEXT: (r"[A-Za-z_][A-Za-z0-9_]*", "made of letters, digits and `_`"),
    Kind.PHRASE: (r"[A-Za-z_][A-Za-z0-9_]*", "made of letters, digits and `_`"),
    Kind.ANSWERS: (r"[A-Za-z_][A-Za-z0-9_]*", "made of letters, digits and `_`"),
    Kind.ROUTE: (r"[A-Za-z_][A-Za-z0-9_-]*", "made of letters, digits, `_` and `-`"),
    Kind.EVENT: (r"[A-Za-z_][\w-]*(\.[\w-]+)*", "made of words with dots between them"),
    Kind.POSE: (r"[A-Za-z_][\w-]*", "made of letters, digits, `_` and `-`"),
    Kind.MOTION: (r"[A-Za-z_][\w-]*", "made of letters, digits, `_` and `-`"),
    Kind.CONTROLLER: (r"[A-Za-z_][\w-]*", "made of letters, digits, `_` and `-`"),
    Kind.BEHAVIOR: (r"[A-Za-z_][\w-]*", "made of letters, digits, `_` and `-`"),
    Kind.STORY: (r"[A-Za-z_][\w-]*", "made of letters, digits, `_` and `-`"),
}
"""The kinds that can be renamed, and what their names look like."""
_RESERVED = re.compile(r"(?i:null|true|false|yes|no|on|off|y|n|~|any)|[\d.+-].*")


class Renaming(NamedTuple):
    """The edits of all files, and the file that is called otherwise afterwards, before and after."""

    edits: tuple[Edit, ...]
    moved: tuple[str, str] | None = None


def renamable(analysis: Analysis, file: str, line: int, column: int) -> Word | None:
    """The word at a line and column, from 1, where it can be renamed."""
    word = analysis.index.at(file, line, column)
    defined = word is not None and any(other.defines for other in analysis.index.of(word))
    return word if word and word.kind in _NAMES and defined else None


def rename(analysis: Analysis, word: Word, name: str) -> Renaming:
    """What gives a word's thing another name. Raises UsageError where it can't have that one.

    A state keeps its `id` where that is another word than its key.
    """
    pattern, look = _NAMES[word.kind]
    if not re.fullmatch(pattern, name) or _RESERVED.fullmatch(name):
        raise UsageError(f"`{name}` can't be the name of a {word.kind}: it has to be {look}")
    if word.kind is Kind.ROUTE and word.name in MEANINGS:
        raise UsageError(f"the route `{word.name}` means something to Lumen itself: {MEANINGS[word.name]}")
    if _taken(analysis, word, name):
        raise UsageError(f"there is a {word.kind} `{name}` already")
    words = [w for w in analysis.index.of(word) if w.text == word.text]
    edits = tuple(Edit(w.place, name) for w in words)
    return _sound(analysis, Renaming(edits, _moved(analysis, word, name)))


def applied(analysis: Analysis, renaming: Renaming) -> Analysis:
    """The project after a renaming."""
    files = dict(analysis.files)
    for file in {edit.place.file for edit in renaming.edits}:
        files[file] = edited(files[file], [edit for edit in renaming.edits if edit.place.file == file])
    if renaming.moved:
        old, new = renaming.moved
        files[new] = files.pop(old)
    return Analysis(analysis.root, files)


def _sound(analysis: Analysis, renaming: Renaming) -> Renaming:
    """The renaming, where it leaves no more errors than there were."""
    before, after = len(analysis.diagnostics), applied(analysis, renaming).diagnostics
    if len(after) > before:
        known = {(d.code, d.message) for d in analysis.diagnostics}
        new = next((d for d in after if (d.code, d.message) not in known), after[0])
        raise UsageError(f"that would break the project: {new}")
    return renaming


def _taken(analysis: Analysis, word: Word, name: str) -> bool:
    scope = word.scope if word.kind in SCOPED else ""
    if word.kind is Kind.STATE:
        tree = analysis.index.outlines.get(scope)
        beside = f"{word.name.rpartition('.')[0]}.{name}".lstrip(".")
        return tree is not None and (beside in tree.entries or name in tree.aliases)
    return name in analysis.index.names(word.kind, scope)


def _moved(analysis: Analysis, word: Word, name: str) -> tuple[str, str] | None:
    if word.kind not in FOLDERS:
        return None
    old = f"{FOLDERS[word.kind]}/{word.name}.yaml"
    return (old, f"{FOLDERS[word.kind]}/{name}.yaml") if old in analysis.files else None
