"""The values of a ranking: probabilities, weights, and the results of an exhibition's own questions; needs no numpy."""

from typing import NamedTuple

MAX_WRONG = 0.02
"""The share of all questions that may be answered wrongly."""
UNANSWERABLE = 0.3
"""The assumed share of visitors' questions without an answer, however many of either kind the author wrote."""
NEVER = 2.0
"""A threshold above any probability: nothing is answered."""


class Ranked(NamedTuple):
    """The passage that most probably answers a question, and its probability; `""` and 0 if there are no passages."""

    passage: str
    probability: float


class Weights(NamedTuple):
    """The parameters by which passages are ranked and an answer is chosen."""

    features: tuple[float, ...]
    """The weight of each feature of a passage."""
    none: float
    """The utility of the answer “none”."""
    least: float
    """The least probability of an answer."""


class AnswerRates(NamedTuple):
    """How often questions are answered rightly and wrongly.

    All questions are weighted as visitors are assumed to ask them: the share UNANSWERABLE has no answer.
    """

    recall: float
    """The share of questions with an answer that get it."""
    wrong: float
    """The share of all questions that get a wrong answer."""


class WrongAnswer(NamedTuple):
    """A question for which another passage was found than `wanted`, which is empty if no passage has the answer."""

    question: str
    wanted: str
    passage: str


class QuestionTrial(NamedTuple):
    """The results of a language's questions by the weights fitted to them."""

    language: str
    asked: int
    """The number of questions."""
    least: float
    """The least probability of an answer."""
    rates: AnswerRates
    others: AnswerRates
    """The rates if each question is judged by the others: the better estimate of what visitors will see."""
    unfound: tuple[WrongAnswer, ...]
    """Questions whose passage is not even the most probable."""
    wrong: tuple[WrongAnswer, ...]
    """Questions that are answered wrongly."""
