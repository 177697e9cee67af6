"""Finds the passage that answers a question, if any: without a network, and deterministic for the same files."""

from collections.abc import Iterable
from datetime import date
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from lumen.language.knowledge import Passage
from lumen.retrieval.choice import probabilities
from lumen.retrieval.features import Features, Method
from lumen.retrieval.features import words as by_words
from lumen.retrieval.ranking import Ranked, Weights
from lumen.retrieval.scorers import words


class FoundAnswer(NamedTuple):
    """A passage, and the probability that it answers a question."""

    passage: Passage
    language: str
    probability: float

    @property
    def text(self) -> str:
        """The answer in the language of the question."""
        return self.passage.answer[self.language]


class Retriever:
    """The passages that one robot (by default: any) may say in one language on one day (by default: any).

    `names` lists them in the order of the features' rows.
    """

    def __init__(
        self,
        passages: Iterable[Passage],
        language: str,
        *,
        robot: str = "",
        today: date | None = None,
        method: Method = by_words,
    ) -> None:
        self.language = language
        self._passages = [
            passage
            for passage in passages
            if passage.questions.get(language) and language in passage.answer
            if not (robot and not passage.is_said_by(robot)) and not (today and passage.is_past(today))
        ]
        self.names = [passage.name for passage in self._passages]
        wordings = [(passage, text) for passage in self._passages for text in passage.questions[language]]
        self._whose = {" ".join(words(text)): passage for passage, text in reversed(wordings)}
        self._extract = method(self._passages, language) if self._passages else None

    def features(self, question: str) -> Features:
        """Return the features of each passage, shape (passages, features); shape (0, 1) if there are no passages."""
        return self._extract(question) if self._extract else np.zeros((0, 1), np.float32)

    def rank(self, question: str, weights: Weights) -> Ranked:
        """Return the passage that most probably answers the question, even if that is improbable.

        Its name is empty if there are no passages.
        """
        of_each = self._probabilities(self.features(question), weights)
        row = int(of_each.argmax()) if self.names else -1
        return Ranked(self.names[row], float(of_each[row])) if row >= 0 else Ranked("", 0.0)

    def nearest(self, question: str, count: int, weights: Weights) -> list[str]:
        """Return up to `count` answers, the most probable first, of passages with any feature that is not 0."""
        features = self.features(question)
        of_each = self._probabilities(features, weights)
        rows = [row for row in np.argsort(-of_each, kind="stable") if features[row].any()]
        return [self._passages[row].answer[self.language] for row in rows[:count]]

    def answer(self, question: str, weights: Weights) -> FoundAnswer | None:
        """Return the passage that answers the question; None if the most probable one is below `weights.least`.

        A question that a passage contains, whatever its punctuation, gets that passage with probability 1.
        """
        if own := self._whose.get(" ".join(words(question))):
            return FoundAnswer(own, self.language, 1.0)
        ranked = self.rank(question, weights)
        if not ranked.passage or ranked.probability < weights.least:
            return None
        return FoundAnswer(self._passages[self.names.index(ranked.passage)], self.language, ranked.probability)

    def _probabilities(self, features: Features, weights: Weights) -> NDArray[np.float64]:
        return probabilities(features, weights.features, weights.none) if self.names else np.zeros(0)
