"""Which passage a question is for, or none: a conditional logit (McFadden 1974), and how probable that choice is.

Each passage is an alternative whose worth is the weighted sum of its features, and “none of them” is one more, of a
worth of its own. A question that several passages fit equally well, or none better than “none”, is probably for none.
"""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from lumen.retrieval.features import Features

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


RIDGE = 1.0
"""How much weights are held back, in units of what one question tells of features of variance 1."""
NONE_RIDGE = 1e-3
"""How much the worth of “none” is."""
STEPS, ENOUGH = 60, 1e-6
"""Newton's steps at most, and how small a step is the last."""
LONGEST = 3.0
"""How far a step goes at most: far from the solution, Newton's goes too far."""


def probabilities(features: NDArray[np.float32], weights: tuple[float, ...], none: float) -> NDArray[np.float64]:
    """How probably each passage is the one, of features of shape (…, passages, features); what is left is for none."""
    worth = np.asarray(features, np.float64) @ np.array(weights)
    most = np.maximum(worth.max(axis=-1, keepdims=True, initial=-np.inf), none)
    share = np.exp(worth - most)
    found: NDArray[np.float64] = share / (share.sum(axis=-1, keepdims=True) + np.exp(none - most))
    return found


def shares(known: Sequence[bool]) -> NDArray[np.float64]:
    """How much each question counts, 1 on average, by whether it has an answer; together UNANSWERABLE have none."""
    has = np.array(known, bool)
    if has.all() or not has.any():
        return np.ones(len(has))
    counts: NDArray[np.float64] = np.where(has, (1 - UNANSWERABLE) / has.mean(), UNANSWERABLE / (~has).mean())
    return counts


def fitted(features: list[Features], wanted: list[int]) -> tuple[tuple[float, ...], float]:
    """Weights of the features, and the worth of “none”; `wanted` is a passage's row for each question, -1 for none."""
    told = np.array(features, np.float64)
    count, passages, kinds = told.shape
    middle = told.mean(axis=(0, 1))
    spread = np.maximum(told.std(axis=(0, 1)), 1e-9)
    offered = np.zeros((count, passages + 1, kinds + 1))
    offered[:, :passages, 1:] = (told - middle) / spread
    offered[:, passages, 0] = 1.0
    counts = shares([row >= 0 for row in wanted])
    chosen = offered[np.arange(count), np.where(np.array(wanted) < 0, passages, wanted)]
    ridge = np.diag([NONE_RIDGE, *[RIDGE] * kinds])
    solution = np.zeros(kinds + 1)
    for _ in range(STEPS):
        worth = offered @ solution
        share = np.exp(worth - worth.max(axis=1, keepdims=True))
        share /= share.sum(axis=1, keepdims=True)
        mean = (share[:, None, :] @ offered)[:, 0]
        slope = counts @ (chosen - mean) - ridge @ solution
        flat = offered.reshape(-1, kinds + 1)
        bend = (flat * (share * counts[:, None]).reshape(-1, 1)).T @ flat - (mean.T * counts) @ mean + ridge
        step = np.linalg.solve(bend, slope)
        longest = float(np.abs(step).max())
        solution += step * min(1.0, LONGEST / max(longest, 1e-12))
        if longest < ENOUGH:
            break
    weights = solution[1:] / spread
    return tuple(weights.tolist()), float(solution[0] + weights @ middle)
