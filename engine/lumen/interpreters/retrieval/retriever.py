"""Finds the passage that answers a question, or none: pure, without a network, the same for the same files."""

from collections.abc import Iterable, Mapping, Sequence
from datetime import date
from typing import NamedTuple

from lumen.interpreters.retrieval.calibration import Sample
from lumen.interpreters.retrieval.ranking import Ranked, Thresholds
from lumen.interpreters.retrieval.scorers import Method, combined
from lumen.interpreters.retrieval.words import words
from lumen.language.knowledge import Passage

NEAREST = 15
"""Samples by which it is told how sure an answer is."""


class FoundAnswer(NamedTuple):
    """A passage for a question: its `score` in 0..1, and the share of questions with such a score that it answers."""

    passage: Passage
    language: str
    score: float
    confidence: float

    @property
    def text(self) -> str:
        """What is to be said."""
        return self.passage.answer[self.language]


class Retriever:
    """Knows the passages that one robot may say in one language on one day."""

    def __init__(
        self,
        passages: Iterable[Passage],
        language: str,
        *,
        robot: str = "",
        today: date | None = None,
        method: Method = combined,
    ) -> None:
        self.language = language
        self._passages = {
            passage.name: passage
            for passage in passages
            if {*passage.questions} & {language} and language in passage.answer
            if not (robot and not passage.is_said_by(robot)) and not (today and passage.is_past(today))
        }
        known = [(name, text) for name, passage in self._passages.items() for text in passage.questions[language]]
        self._owners = [name for name, _ in known]
        self._whose = {" ".join(words(text)): name for name, text in reversed(known)}
        self._score = method([text for _, text in known], language)

    def rank(self, question: str) -> Ranked:
        """What is most like the question; an empty passage where nothing is known."""
        best: dict[str, float] = {}
        for name, score in zip(self._owners, self._score(question).tolist() if self._owners else (), strict=True):
            best[name] = max(best.get(name, 0.0), score)
        first, second = sorted([*best.items(), ("", 0.0), ("", 0.0)], key=lambda each: -each[1])[:2]
        return Ranked(first[0], first[1], first[1] - second[1])

    def nearest(self, question: str, count: int) -> list[str]:
        """The answers of the passages that are most like the question, whether or not they answer it."""
        best: dict[str, float] = {}
        for name, score in zip(self._owners, self._score(question).tolist() if self._owners else (), strict=True):
            best[name] = max(best.get(name, 0.0), score)
        names = sorted(best, key=lambda name: -best[name])[:count]
        return [self._passages[name].answer[self.language] for name in names if best[name] > 0.0]

    def samples(self, asked: Mapping[str, Sequence[str]], unanswered: Sequence[str]) -> list[Sample]:
        """What is most like each of these questions: by the passage that has its answer, and those without one."""
        found = [Sample(name, self.rank(text)) for name, texts in asked.items() for text in texts]
        return found + [Sample("", self.rank(text)) for text in unanswered]

    def answer(self, question: str, thresholds: Thresholds, samples: Sequence[Sample] = ()) -> FoundAnswer | None:
        """The passage that answers the question, None where none surely does; `samples` tell how sure that is.

        A question that stands in a passage, whatever its signs, is that passage's.
        """
        ranked = self.rank(question)
        if own := self._whose.get(" ".join(words(question))):
            return FoundAnswer(self._passages[own], self.language, 1.0, 1.0)
        if not ranked.passage or not thresholds.allow(ranked):
            return None
        near = sorted(samples, key=lambda sample: abs(sample.ranked.score - ranked.score))[:NEAREST]
        sure = sum(sample.is_right for sample in near) / len(near) if near else 0.0
        return FoundAnswer(self._passages[ranked.passage], self.language, ranked.score, sure)
