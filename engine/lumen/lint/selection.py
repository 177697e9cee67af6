"""Selection of codes on the command line: by a code, its first words, or a family."""

from collections.abc import Iterable

from lumen.errors import UsageError
from lumen.language.diagnostics import did_you_mean
from lumen.lint.codes import codes, families


def selected(words: Iterable[str]) -> frozenset[str]:
    """Return the codes that these words select; a word can contain several codes, separated by commas.

    `unknown` selects every code that begins with `unknown-`. Raises UsageError for a word that selects no code.
    """
    return frozenset(code for text in words for word in text.split(",") for code in _codes(word.strip()))


def _codes(word: str) -> Iterable[str]:
    if word in codes():
        return (word,)
    if word in families():
        return families()[word]
    if found := [code for code in codes() if code.startswith(f"{word.rstrip('-')}-")]:
        return found
    raise UsageError(unknown_code(word))


def unknown_code(word: str) -> str:
    """Return the error message for a word that is not a code."""
    if not word:
        return "a code is missing: run `lumen explain` to list the codes"
    hint = did_you_mean(word, [*codes(), *families()])
    return f"there is no code `{word}`: {hint if hint.startswith('did') else 'run `lumen explain` to list the codes'}"
