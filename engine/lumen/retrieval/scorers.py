"""The similarity of a question to each known wording: stems, letter n-grams, and the methods that compare them."""

from collections import Counter
from collections.abc import Callable, Sequence
from functools import cache
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from lumen.talk.folding import unbroken

STEMMERS = {"en": "english", "id": "indonesian", "de": "german", "fr": "french", "es": "spanish", "it": "italian",
            "nl": "dutch", "pt": "portuguese"}  # fmt: skip
"""Snowball's name of each language with stemming; words of other languages stay as they are."""

SHORTEST, LONGEST = 2, 4
"""The range of the lengths of letter n-grams."""

MAX_QUESTION = 300
"""The number of characters of a question that are compared."""


def stems(text: str, language: str) -> list[str]:
    """Return the stems of the words of a text, in order."""
    stem = _stemmer(language)
    return [stem(word) for word in words(text)]


def letter_runs(text: str, language: str) -> list[str]:
    """Return the letter n-grams of each word, with its ends marked; misspelt and inflected words share most of them."""
    found = []
    for word in words(text):
        marked = f" {word} "
        for length in range(SHORTEST, LONGEST + 1):
            found += [marked[i : i + length] for i in range(len(marked) - length + 1)]
    return found


def words(text: str) -> list[str]:
    """Return the words of a text, folded as phrases are; only its first MAX_QUESTION characters count."""
    return unbroken(text[:MAX_QUESTION])


@cache
def _stemmer(language: str) -> Callable[[str], str]:
    if (name := STEMMERS.get(language)) is None:
        return str
    import snowballstemmer  # it has a module for each of 30 languages

    return cache(snowballstemmer.stemmer(name).stemWord)


Scores = NDArray[np.float32]
"""Shape (known wordings,)."""

K1, B = 1.2, 0.5
"""The parameters of BM25: how soon repeated words stop counting, and how much length is penalised."""


class Scorer(Protocol):
    """Compares a question with known wordings."""

    def __call__(self, question: str) -> Scores:
        """Return the similarity of a question to each known wording, in the order of the wordings."""


WordingMethod = Callable[[Sequence[str], str], Scorer]
"""A function that makes a scorer for known wordings of a language."""


class _Table:
    """Known wordings split into parts: `counts` has a row for each wording, and a column for each part."""

    def __init__(self, known: Sequence[str], split: Callable[[str], list[str]]) -> None:
        self.split = split
        rows = [Counter(split(text)) for text in known]
        self.columns = {part: i for i, part in enumerate(sorted({part for row in rows for part in row}))}
        self.counts = np.zeros((len(rows), len(self.columns)), np.float32)
        for i, row in enumerate(rows):
            for part, count in row.items():
                self.counts[i, self.columns[part]] = count
        held = (self.counts > 0).sum(axis=0)
        self.rarity = np.log1p((len(rows) - held + 0.5) / (held + 0.5)).astype(np.float32)
        self.rarest = float(np.log1p(len(rows) + 0.5) + np.log(2.0)) if len(rows) else 1.0


def ngrams(known: Sequence[str], language: str) -> Scorer:
    """Return a scorer by the cosine of TF-IDF vectors of letter n-grams."""
    table = _Table(known, lambda text: letter_runs(text, language))
    vectors = np.sqrt(table.counts) * table.rarity
    vectors /= np.maximum(np.linalg.norm(vectors, axis=1, keepdims=True), 1e-9)

    def score(question: str) -> Scores:
        weights: dict[int, float] = {}
        beyond = 0.0
        for part, count in Counter(table.split(question)).items():
            column = table.columns.get(part)
            if column is None:
                beyond += count * table.rarest**2
            else:
                weights[column] = count**0.5 * float(table.rarity[column])
        length = (sum(weight**2 for weight in weights.values()) + beyond) ** 0.5
        columns = list(weights)
        values = np.fromiter(weights.values(), np.float32, len(weights))
        return np.asarray(vectors[:, columns] @ values / max(length, 1e-9), np.float32)

    return score


def bm25(known: Sequence[str], language: str) -> Scorer:
    """Return a scorer by Okapi BM25 of stems, as a share of the highest possible; unknown words count as the rarest."""
    table = _Table(known, lambda text: stems(text, language))
    lengths = table.counts.sum(axis=1, keepdims=True)
    held_back = K1 * (1 - B + B * lengths / max(float(lengths.mean()) if len(known) else 1.0, 1e-9))
    worth = table.rarity * table.counts * (K1 + 1) / (table.counts + held_back + 1e-9)

    def score(question: str) -> Scores:
        words = set(table.split(question))
        columns = [table.columns[word] for word in words if word in table.columns]
        most = sum(float(table.rarity[column]) for column in columns) * (K1 + 1) / (1 + K1)
        most += (len(words) - len(columns)) * table.rarest
        return np.asarray(np.minimum(worth[:, columns].sum(axis=1) / max(most, 1e-9), 1.0), np.float32)

    return score


def combined(known: Sequence[str], language: str) -> Scorer:
    """Return a scorer by the mean of `ngrams` and `bm25`: letters tolerate misheard words, stems match the meaning."""
    one, other = ngrams(known, language), bm25(known, language)

    def score(question: str) -> Scores:
        return np.asarray((one(question) + other(question)) / 2, np.float32)

    return score
