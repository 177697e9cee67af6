"""An exhibition's own questions: what they say of when a passage answers, and what becomes of them."""

from collections.abc import Iterable, Mapping

from lumen.interpreters.retrieval.calibration import Sample, calibrate, left_out, outcome
from lumen.interpreters.retrieval.ranking import QuestionTrial, Thresholds, WrongAnswer
from lumen.interpreters.retrieval.retriever import Retriever
from lumen.language.knowledge import QuestionSet


def samples_of(retriever: Retriever, sets: Iterable[QuestionSet]) -> dict[str, Sample]:
    """The questions of the retriever's language, each with what is most like it."""
    found: dict[str, Sample] = {}
    for each in sets:
        for wanted, texts in _texts(each, retriever.language):
            found |= {text: Sample(wanted, retriever.rank(text)) for text in texts}
    return found


def thresholds_of(retriever: Retriever, sets: Iterable[QuestionSet]) -> Thresholds | None:
    """Those that the questions set, None where there is none in this language."""
    samples = samples_of(retriever, sets)
    return calibrate([*samples.values()]) if samples else None


def tried(retriever: Retriever, sets: Iterable[QuestionSet]) -> QuestionTrial | None:
    """What becomes of the questions in the retriever's language, None where there are none."""
    by_text = samples_of(retriever, sets)
    if not by_text:
        return None
    samples = [*by_text.values()]
    thresholds = calibrate(samples)
    missed = [WrongAnswer(text, s.wanted, s.ranked.passage) for text, s in by_text.items() if not s.is_right]
    wrong = [each for each in missed if thresholds.allow(by_text[each.question].ranked)]
    return QuestionTrial(
        retriever.language, len(samples), thresholds, outcome(samples, thresholds), left_out(samples),
        tuple(each for each in missed if each.wanted), tuple(wrong),
    )  # fmt: skip


def _texts(each: QuestionSet, language: str) -> Iterable[tuple[str, Iterable[str]]]:
    asked: Mapping[str, Mapping[str, tuple[str, ...]]] = {**each.asked, "": each.unanswered}
    return [(wanted, texts.get(language, ())) for wanted, texts in asked.items()]
