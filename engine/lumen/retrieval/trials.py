"""An exhibition's own questions: what they say of when a passage answers, and what becomes of them."""

from collections.abc import Iterable, Mapping

from lumen.language.knowledge import QuestionSet
from lumen.retrieval.calibration import Sample, calibrate, held_out, judged, left_out, outcome
from lumen.retrieval.ranking import QuestionTrial, Weights, WrongAnswer
from lumen.retrieval.retriever import Retriever


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
