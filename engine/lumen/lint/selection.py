"""Which codes are meant by the words that people write: a code, its first words, or a family."""

from collections.abc import Iterable

from lumen.errors import UsageError
from lumen.language.diagnostics import did_you_mean
from lumen.lint.codes import codes, families


def selected(words: Iterable[str]) -> frozenset[str]:
    """The codes that these words stand for; each may be several with commas between them.

    `unknown` is every code that begins with `unknown-`. Raises UsageError for a word that stands for nothing.
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
    """What to say of a word that is no code."""
    if not word:
        return "a code is missing: run `lumen explain` to list the codes"
    hint = did_you_mean(word, [*codes(), *families()])
    return f"there is no code `{word}`: {hint if hint.startswith('did') else 'run `lumen explain` to list the codes'}"
