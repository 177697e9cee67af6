"""Fits weights to an exhibition's own questions, and measures which of them find their passage."""

from collections.abc import Iterable, Mapping, Sequence
from math import floor
from typing import NamedTuple

from lumen.language.knowledge import QuestionSet
from lumen.retrieval.choice import fitted, probabilities, shares
from lumen.retrieval.features import Features
from lumen.retrieval.ranking import MAX_WRONG, NEVER, AnswerRates, QuestionTrial, Weights, WrongAnswer
from lumen.retrieval.retriever import Retriever

FOLDS = 10
"""The number of folds of cross-validation: each is judged by weights fitted to the others."""


class Sample(NamedTuple):
    """The features of each passage for a question; `wanted` is the row of the one that answers it, -1 for none."""

    wanted: int
    features: Features


class Judged(NamedTuple):
    """The most probable passage for a question."""

    probability: float
    """The probability of the passage."""
    is_right: bool
    """Whether the passage answers the question."""
    is_known: bool
    """Whether an answer exists."""


def judged(samples: Sequence[Sample], weights: Weights) -> list[Judged]:
    """Return the judgement of each sample by these weights."""
    found = []
    for sample in samples:
        of_each = probabilities(sample.features, weights.features, weights.none)
        row = int(of_each.argmax())
        found.append(Judged(float(of_each[row]), row == sample.wanted, sample.wanted >= 0))
    return found


def outcome(found: Sequence[Judged], least: float) -> AnswerRates:
    """Return the rates of right and wrong answers if an answer needs the probability `least`."""
    return _rates(found, [each.probability >= least for each in found])


def calibrate(samples: Sequence[Sample], max_wrong: float = MAX_WRONG) -> Weights:
    """Return weights fitted to these questions, with the threshold that gives the most right answers in held-out folds.

    At most `max_wrong` of the questions, a share, may be answered wrongly.
    """
    return Weights(*_fitted(samples), least_probability(held_out(samples), max_wrong))


def held_out(samples: Sequence[Sample]) -> list[Judged]:
    """Return the judgement of each sample by weights fitted to the other folds (cross-validation)."""
    found: dict[int, Judged] = {}
    folds = min(FOLDS, len(samples))
    for fold in range(folds):
        others = [sample for i, sample in enumerate(samples) if i % folds != fold]
        weights = Weights(*_fitted(others or samples), NEVER)
        found |= zip(range(fold, len(samples), folds), judged(samples[fold::folds], weights), strict=True)
    return [found[i] for i in range(len(samples))]


def left_out(found: Sequence[Judged], max_wrong: float = MAX_WRONG) -> AnswerRates:
    """Return the rates if each question is judged by the least probability that all other questions give."""
    others = ([*found[:i], *found[i + 1 :]] for i in range(len(found)))
    least = [least_probability(each, max_wrong) for each in others]
    return _rates(found, [one.probability >= enough for one, enough in zip(found, least, strict=True)])


def least_probability(found: Sequence[Judged], max_wrong: float = MAX_WRONG) -> float:
    """Return the least probability with the most right answers and at most `max_wrong` of all, a share, wrong.

    The highest of equals, rounded down to a thousandth; NEVER if even the first answer would be one too many.
    """
    right = most = 0
    wrong = 0.0
    least = NEVER
    counts = shares([one.is_known for one in found]).tolist()
    ordered = sorted(zip(found, counts, strict=True), key=lambda each: (-each[0].probability, each[0].is_right))
    for one, count in ordered:
        right, wrong = right + one.is_right, wrong + count * (not one.is_right)
        if wrong > max_wrong * len(found):
            break
        if right > most:
            most, least = right, floor(one.probability * 1000) / 1000
    return least


def _fitted(samples: Sequence[Sample]) -> tuple[tuple[float, ...], float]:
    return fitted([sample.features for sample in samples], [sample.wanted for sample in samples])


def _rates(found: Sequence[Judged], answered: Sequence[bool]) -> AnswerRates:
    counts = shares([one.is_known for one in found]).tolist()
    told = [
        (one.is_right, count) for one, count, is_answered in zip(found, counts, answered, strict=True) if is_answered
    ]
    known = sum(one.is_known for one in found)
    wrong = sum(count for is_right, count in told if not is_right)
    return AnswerRates(sum(is_right for is_right, _ in told) / max(known, 1), wrong / max(len(found), 1))


def samples_of(retriever: Retriever, sets: Iterable[QuestionSet]) -> dict[str, Sample]:
    """Return the questions in the retriever's language, each with its sample; empty if there are no passages."""
    if not retriever.names:
        return {}
    rows = {name: row for row, name in enumerate(retriever.names)}
    found: dict[str, Sample] = {}
    for each in sets:
        for wanted, texts in _texts(each, retriever.language):
            found |= {text: Sample(rows.get(wanted, -1), retriever.features(text)) for text in texts}
    return found


def weights_of(retriever: Retriever, sets: Iterable[QuestionSet]) -> Weights | None:
    """Return the weights fitted to the questions; None if there are no questions in the retriever's language."""
    samples = samples_of(retriever, sets)
    return calibrate([*samples.values()]) if samples else None


def tried(retriever: Retriever, sets: Iterable[QuestionSet]) -> QuestionTrial | None:
    """Return the results of the questions in the retriever's language; None if there are no such questions."""
    by_text = samples_of(retriever, sets)
    if not by_text:
        return None
    samples = [*by_text.values()]
    weights = calibrate(samples)
    found = judged(samples, weights)
    missed, wrong = [], []
    for (text, sample), one in zip(by_text.items(), found, strict=True):
        if not one.is_right:
            wanted = retriever.names[sample.wanted] if one.is_known else ""
            missed.append(WrongAnswer(text, wanted, retriever.rank(text, weights).passage))
            if one.probability >= weights.least:
                wrong.append(missed[-1])
    return QuestionTrial(
        retriever.language, len(samples), weights.least, outcome(found, weights.least), left_out(held_out(samples)),
        tuple(each for each in missed if each.wanted), tuple(wrong),
    )  # fmt: skip


def _texts(each: QuestionSet, language: str) -> Iterable[tuple[str, Iterable[str]]]:
    asked: Mapping[str, Mapping[str, tuple[str, ...]]] = {**each.asked, "": each.unanswered}
    return [(wanted, texts.get(language, ())) for wanted, texts in asked.items()]
