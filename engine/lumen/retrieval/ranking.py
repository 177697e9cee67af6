"""How probable it is that a passage answers a question, and whether that is enough; imported without numpy."""

from typing import NamedTuple

MAX_WRONG = 0.02
"""The share of all questions that may be answered wrongly."""
UNANSWERABLE = 0.3
"""The share of visitors' questions that no passage answers: assumed, however many of either kind are written."""
NEVER = 2.0
"""More than any probability: what is to be answered never."""


class Ranked(NamedTuple):
    """The passage that most probably answers a question, and how probably; empty where nothing is known."""

    passage: str
    probability: float


class Weights(NamedTuple):
    """How much each feature of a passage counts, how much speaks for none, and how probable an answer has to be."""

    features: tuple[float, ...]
    none: float
    least: float


class AnswerRates(NamedTuple):
    """What becomes of questions: the share of those with an answer that get it, and of all that get a wrong one.

    Of all as visitors are taken to ask them, so that UNANSWERABLE of them have none.
    """

    recall: float
    wrong: float


class WrongAnswer(NamedTuple):
    """A question that gets the answer of another passage than it should, which is empty where none has it."""

    question: str
    wanted: str
    passage: str


class QuestionTrial(NamedTuple):
    """What becomes of the questions of a language by the weights that they set, with the `least` probability.

    `others` is what becomes of each by what all others set: the better guess of what visitors will meet. `unfound` are
    those whose passage is not even the most probable, `wrong` those that are answered wrongly.
    """

    language: str
    asked: int
    least: float
    rates: AnswerRates
    others: AnswerRates
    unfound: tuple[WrongAnswer, ...]
    wrong: tuple[WrongAnswer, ...]
