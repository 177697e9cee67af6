"""How alike a question and a passage are, and whether that is enough."""

from typing import NamedTuple

MAX_WRONG = 0.02
"""The share of all questions that may be answered wrongly."""


class Ranked(NamedTuple):
    """The passage that is most like a question, how much, and by how much more than the next one."""

    passage: str
    score: float
    margin: float


class Thresholds(NamedTuple):
    """A question is answered if its score is at least `least`, and so much better than the next one."""

    least: float
    margin: float

    def allow(self, ranked: Ranked) -> bool:
        """Whether it is answered."""
        return ranked.score >= self.least and ranked.margin >= self.margin


class AnswerRates(NamedTuple):
    """What becomes of questions: the share of those with an answer that get it, and of all that get a wrong one."""

    recall: float
    wrong: float


class WrongAnswer(NamedTuple):
    """A question that gets the answer of another passage than it should, which is empty where none has it."""

    question: str
    wanted: str
    passage: str


class QuestionTrial(NamedTuple):
    """What becomes of the questions of a language by the `thresholds` that they set.

    `others` is what becomes of each by those that all others set: the better guess of what visitors will meet.
    `unfound` are those whose passage is not even the most alike, `wrong` those that are answered wrongly.
    """

    language: str
    asked: int
    thresholds: Thresholds
    rates: AnswerRates
    others: AnswerRates
    unfound: tuple[WrongAnswer, ...]
    wrong: tuple[WrongAnswer, ...]
