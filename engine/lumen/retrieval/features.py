"""Features: a few numbers that measure how well each passage fits a question, by several methods."""

from collections.abc import Callable, Sequence
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from lumen.language.knowledge import Passage
from lumen.retrieval.scorers import WordingMethod, combined, stems

NEAREST = 3
"""The number of nearest wordings of a passage for the mean: one may be similar by chance, three are not."""

Features = NDArray[np.float32]
"""Shape (passages, features): the higher, the better the fit."""


class FeatureExtractor(Protocol):
    """Compares a question with the passages that it was made for."""

    def __call__(self, question: str) -> Features:
        """Return the features of each passage, in the order of the passages."""


Method = Callable[[Sequence[Passage], str], FeatureExtractor]
"""Makes an extractor for passages in a language; each of them has questions and an answer in it."""


def by_wordings(method: WordingMethod) -> Method:
    """Return a method with two features: the score of the nearest wording of a passage, and the mean of the NEAREST."""

    def make(passages: Sequence[Passage], language: str) -> FeatureExtractor:
        wordings = [passage.questions[language] for passage in passages]
        score = method([text for texts in wordings for text in texts], language)
        counts = np.array([len(texts) for texts in wordings], np.intp)
        place = np.arange(counts.max())[None, :]
        held = place < counts[:, None]
        rows = np.where(held, np.cumsum(counts)[:, None] - counts[:, None] + place, 0)
        several = np.minimum(counts, NEAREST)

        def extract(question: str) -> Features:
            nearest = np.sort(np.where(held, score(question)[rows], -np.inf), axis=1)[:, ::-1][:, :NEAREST]
            total = np.where(np.isfinite(nearest), nearest, 0.0).sum(axis=1)
            return np.stack([nearest[:, 0], total / several], axis=1).astype(np.float32)

        return extract

    return make


def coverage(passages: Sequence[Passage], language: str) -> FeatureExtractor:
    """Make an extractor of the share of a question's words that are in a passage; rare words count more.

    A word that no passage has counts most: “how tall is Mount Everest” is not covered by the passage on how tall the
    robot is, although the two are similar.
    """
    held = [
        {stem for text in (*passage.questions[language], passage.answer[language]) for stem in stems(text, language)}
        for passage in passages
    ]
    columns = {stem: i for i, stem in enumerate(sorted(set[str]().union(*held)))}
    has = np.zeros((len(passages), len(columns) + 1), np.float32)  # the last column: words of no passage
    for row, words in zip(has, held, strict=True):
        row[[columns[word] for word in words]] = 1.0
    rarity = np.log((len(passages) + 1) / (has.sum(axis=0) + 0.5)).astype(np.float32)

    def extract(question: str) -> Features:
        asked = [columns.get(word, -1) for word in sorted(set(stems(question, language)))]
        worth = rarity[asked]
        return np.asarray(has[:, asked] @ worth / max(float(worth.sum()), 1e-9), np.float32)[:, None]

    return extract


def joined(*methods: Method) -> Method:
    """Return a method that concatenates the features of several methods."""

    def make(passages: Sequence[Passage], language: str) -> FeatureExtractor:
        extractors = [method(passages, language) for method in methods]
        return lambda question: np.concatenate([extract(question) for extract in extractors], axis=1)

    return make


words = joined(by_wordings(combined), coverage)
"""The default method: letters tolerate misheard words, stems match the meaning, and coverage finds unknown topics."""
