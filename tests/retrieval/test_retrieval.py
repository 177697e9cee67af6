"""Questions find their passage, thresholds keep wrong answers few, and the written questions are apart from both."""

import re
from datetime import date

import answers
import pytest

from lumen.interpreters.retrieval.calibration import NEVER, Sample, calibrate, left_out, outcome
from lumen.interpreters.retrieval.ranking import Ranked, Thresholds
from lumen.interpreters.retrieval.retriever import Retriever
from lumen.interpreters.retrieval.scorers import METHODS
from lumen.interpreters.retrieval.trials import thresholds_of, tried
from lumen.interpreters.retrieval.words import stems
from lumen.language.knowledge import Passage, QuestionSet

PASSAGES = (
    Passage("height", {"en": ("how tall are you",)}, {"en": "Small."}, who=("NAO",)),
    Passage("dance", {"en": ("which dances do you know",)}, {"en": "One."}, until=date(2015, 11, 21)),
    Passage("campus", {"en": ("where is the campus",), "id": ("di mana kampusnya",)}, {"en": "There.", "id": "Sana."}),
)
ANY = Thresholds(0.1, 0.0)


@pytest.mark.parametrize("method", METHODS)
def test_a_question_in_other_words_finds_its_passage(method: str) -> None:
    retriever = Retriever(PASSAGES, "en", method=METHODS[method])
    assert retriever.rank("which dance do you dance").passage == "dance"
    assert retriever.rank("how tall are you").score == pytest.approx(1.0, abs=0.2)
    assert retriever.rank("kereta").score < 0.2


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("question", ["", "?!", "x" * 10_000, "\u0000", "quux"])
def test_whatever_is_said_has_a_score(method: str, question: str) -> None:
    for passages in (PASSAGES, ()):
        assert 0.0 <= Retriever(passages, "en", method=METHODS[method]).rank(question).score <= 1.0


def test_only_what_may_be_said_is_found() -> None:
    late = Retriever(PASSAGES, "en", robot="OTHER", today=date(2015, 11, 22))
    assert late.answer("how tall are you", ANY) is None
    assert late.rank("which dances do you know").passage != "dance"
    found = Retriever(PASSAGES, "id").answer("kampusnya di mana", ANY)
    assert found
    assert (found.passage.name, found.text) == ("campus", "Sana.")


def test_words_are_stemmed_in_both_languages() -> None:
    assert stems("dancing dances", "en") == ["danc", "danc"]
    assert stems("menarikan tarian", "id")[1] == "tari"
    assert stems("Tanzen!", "xx") == ["tanzen"]


def samples(*rows: tuple[str, str, float]) -> list[Sample]:
    return [Sample(wanted, Ranked(got, score, score)) for wanted, got, score in rows]


def test_thresholds_answer_most_with_few_wrong() -> None:
    told = samples(("a", "a", 0.9), ("b", "b", 0.8), ("", "a", 0.7), ("c", "c", 0.6))
    assert outcome(told, calibrate(told)) == (2 / 3, 0.0)
    assert outcome(told, calibrate(told, max_wrong=0.25)) == (1.0, 0.25)
    assert calibrate([]) == NEVER
    assert outcome(told[2:3], calibrate(told[2:3])).wrong == 0.0


def test_each_question_is_judged_by_the_others() -> None:
    told = samples(("a", "a", 0.9), ("", "b", 0.8), ("c", "c", 0.7))
    assert outcome(told, calibrate(told)).wrong == 0.0
    assert left_out(told).wrong == pytest.approx(1 / 3)


def test_the_questions_are_many_and_in_words_of_their_own() -> None:
    known = answers.shipped().knowledge
    seen: set[str] = {
        " ".join(re.findall(r"\w+", q)) for p in known.values() for qs in p.questions.values() for q in qs
    }
    counts = {"en": 0, "id": 0, "none": 0}
    for half in ("dev", "test"):
        questions = answers.asked(half)
        assert questions["asked"].keys() == known.keys()
        for language in answers.LANGUAGES:
            asked = [text for texts in questions["asked"].values() for text in texts[language]]
            counts[language] += len(asked)
            counts["none"] += len(questions["unanswered"][language])
            for text in (*asked, *questions["unanswered"][language]):
                assert text not in seen
                seen.add(text)
    assert counts["en"] >= 100
    assert counts["id"] >= 100
    assert counts["none"] >= 100


SETS = (
    QuestionSet("a", {"height": {"en": ("how tall exactly", "so how tall")}}, {"en": ("how tall is a tree",)}),
    QuestionSet("b", {"campus": {"en": ("where is that campus",), "id": ("kampusnya di mana",)}}, {}),
)


def test_an_exhibitions_questions_set_when_a_passage_answers() -> None:
    english, french = Retriever(PASSAGES, "en"), Retriever(PASSAGES, "fr")
    trial = tried(english, SETS)
    assert trial
    assert (trial.asked, trial.thresholds) == (4, thresholds_of(english, SETS))
    assert trial.rates.recall > 0
    assert not trial.wrong
    assert tried(french, SETS) is None
    assert thresholds_of(french, SETS) is None


def test_what_is_answered_wrongly_is_named() -> None:
    sets = [
        QuestionSet("a", {"campus": {"en": ("how tall are you",) * 2}, "height": {"en": ("and how tall are you",)}}, {})
    ]
    trial = tried(Retriever(PASSAGES, "en"), sets)
    assert trial
    assert trial.unfound == (("how tall are you", "campus", "height"),)
