"""An exhibition's own questions: the weights of features that they lead to, and what becomes of them."""

from collections.abc import Iterable, Mapping, Sequence
from math import floor
from typing import NamedTuple

from lumen.language.knowledge import QuestionSet
from lumen.retrieval.choice import fitted, probabilities, shares
from lumen.retrieval.features import Features
from lumen.retrieval.ranking import MAX_WRONG, NEVER, AnswerRates, QuestionTrial, Weights, WrongAnswer
from lumen.retrieval.retriever import Retriever

FOLDS = 10
"""Parts into which questions are dealt: each part is judged by what the others tell."""


class Sample(NamedTuple):
    """What is told of each passage for a question; `wanted` is the row of the one that answers it, -1 for none."""

    wanted: int
    features: Features


class Judged(NamedTuple):
    """What would be answered to a question: how probably, whether that is right, and whether there is an answer."""

    probability: float
    is_right: bool
    is_known: bool


def judged(samples: Sequence[Sample], weights: Weights) -> list[Judged]:
    """What these weights would answer to each."""
    found = []
    for sample in samples:
        of_each = probabilities(sample.features, weights.features, weights.none)
        row = int(of_each.argmax())
        found.append(Judged(float(of_each[row]), row == sample.wanted, sample.wanted >= 0))
    return found


def outcome(found: Sequence[Judged], least: float) -> AnswerRates:
    """What becomes of these questions where an answer has to be that probable."""
    return _rates(found, [each.probability >= least for each in found])


def calibrate(samples: Sequence[Sample], max_wrong: float = MAX_WRONG) -> Weights:
    """Weights of these questions, which answer most of them rightly and at most so many wrongly, each by the others."""
    return Weights(*_fitted(samples), least_probability(held_out(samples), max_wrong))


def held_out(samples: Sequence[Sample]) -> list[Judged]:
    """What would be answered to each, by the weights that questions of the other parts set."""
    found: dict[int, Judged] = {}
    folds = min(FOLDS, len(samples))
    for fold in range(folds):
        others = [sample for i, sample in enumerate(samples) if i % folds != fold]
        weights = Weights(*_fitted(others or samples), NEVER)
        found |= zip(range(fold, len(samples), folds), judged(samples[fold::folds], weights), strict=True)
    return [found[i] for i in range(len(samples))]


def left_out(found: Sequence[Judged], max_wrong: float = MAX_WRONG) -> AnswerRates:
    """What becomes of each of these questions by the least probability that all others set."""
    others = ([*found[:i], *found[i + 1 :]] for i in range(len(found)))
    least = [least_probability(each, max_wrong) for each in others]
    return _rates(found, [one.probability >= enough for one, enough in zip(found, least, strict=True)])


def least_probability(found: Sequence[Judged], max_wrong: float = MAX_WRONG) -> float:
    """The one that answers most of these rightly, at most so many wrongly; the highest of equals, to a thousandth."""
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
    """The questions of the retriever's language, each with what is told of the passages; none where it knows none."""
    if not retriever.names:
        return {}
    rows = {name: row for row, name in enumerate(retriever.names)}
    found: dict[str, Sample] = {}
    for each in sets:
        for wanted, texts in _texts(each, retriever.language):
            found |= {text: Sample(rows.get(wanted, -1), retriever.features(text)) for text in texts}
    return found


def weights_of(retriever: Retriever, sets: Iterable[QuestionSet]) -> Weights | None:
    """Those that the questions set, None where there is none in this language."""
    samples = samples_of(retriever, sets)
    return calibrate([*samples.values()]) if samples else None


def tried(retriever: Retriever, sets: Iterable[QuestionSet]) -> QuestionTrial | None:
    """What becomes of the questions in the retriever's language, None where there are none."""
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
