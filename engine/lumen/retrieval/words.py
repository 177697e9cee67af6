"""What a question is compared by: stems of its words, and runs of its letters."""

from collections.abc import Callable
from functools import cache

from lumen.talk.folding import unbroken

STEMMERS = {"en": "english", "id": "indonesian", "de": "german", "fr": "french", "es": "spanish", "it": "italian",
            "nl": "dutch", "pt": "portuguese"}  # fmt: skip
"""Snowball's name of each language whose words are stemmed; those of others are taken as they are."""

SHORTEST, LONGEST = 2, 4
"""How many letters a run has."""

MAX_QUESTION = 300
"""Characters of a question that are looked at."""


def stems(text: str, language: str) -> list[str]:
    """The stems of its words, in their order."""
    stem = _stemmer(language)
    return [stem(word) for word in words(text)]


def letter_runs(text: str, language: str) -> list[str]:
    """Runs of letters within each word, with its ends marked; they are alike where words are misspelt or inflected."""
    found = []
    for word in words(text):
        marked = f" {word} "
        for length in range(SHORTEST, LONGEST + 1):
            found += [marked[i : i + length] for i in range(len(marked) - length + 1)]
    return found


def words(text: str) -> list[str]:
    """Its words, folded as phrases are."""
    return unbroken(text[:MAX_QUESTION])


@cache
def _stemmer(language: str) -> Callable[[str], str]:
    if (name := STEMMERS.get(language)) is None:
        return str
    import snowballstemmer  # it has a module for each of 30 languages

    return cache(snowballstemmer.stemmer(name).stemWord)
