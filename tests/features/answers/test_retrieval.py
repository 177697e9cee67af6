"""Questions find their passage, what is learned keeps wrong answers few, and written questions are apart from both."""

import re
from datetime import date

import answers
import numpy as np
import pytest
from answers import METHODS
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra import numpy as hnp

from lumen.language.knowledge import Passage, QuestionSet
from lumen.retrieval.choice import RIDGE, fitted, probabilities, shares
from lumen.retrieval.features import coverage
from lumen.retrieval.ranking import NEVER, UNANSWERABLE, Weights
from lumen.retrieval.retriever import Retriever
from lumen.retrieval.scorers import stems
from lumen.retrieval.trials import Judged, least_probability, left_out, outcome, tried, weights_of
from tests.tables import for_each

PASSAGES = (
    Passage("height", {"en": ("how tall are you",)}, {"en": "Small."}, who=("NAO",)),
    Passage("dance", {"en": ("which dances do you know",)}, {"en": "One."}, until=date(2015, 11, 21)),
    Passage("campus", {"en": ("where is the campus",), "id": ("di mana kampusnya",)}, {"en": "There.", "id": "Sana."}),
)
ANY = Weights((1.0, 1.0, 1.0), none=-9.0, least=0.1)


@pytest.mark.parametrize("method", METHODS)
def test_a_question_in_other_words_finds_its_passage(method: str) -> None:
    retriever = Retriever(PASSAGES, "en", method=METHODS[method])
    assert retriever.features("which dance do you dance")[:, 0].argmax() == retriever.names.index("dance")
    assert retriever.features("how tall are you")[0, 0] == pytest.approx(1.0, abs=0.2)
    assert retriever.features("kereta")[:, 0].max() < 0.2


@for_each("method", METHODS)
@for_each("question", ["", "?!", "x" * 10_000, "\u0000", "quux"])
def test_whatever_is_said_has_features(method: str, question: str) -> None:
    retriever = Retriever(PASSAGES, "en", method=METHODS[method])
    features = retriever.features(question)
    assert features.shape[0] == len(retriever.names)
    assert np.isfinite(features).all()
    assert Retriever((), "en", method=METHODS[method]).rank(question, ANY) == ("", 0.0)


def test_several_alike_wordings_count_besides_the_nearest() -> None:
    many = Passage("many", {"en": ("aa bb", "aa cc", "aa dd", "xx yy")}, {"en": "."})
    one = Passage("one", {"en": ("aa ee",)}, {"en": "."})
    nearest, three = Retriever((many, one), "en", method=METHODS["bm25"]).features("aa bb").T
    assert nearest[0] > three[0] > 0
    assert nearest[1] == three[1]


def test_words_that_no_passage_has_are_not_covered() -> None:
    retriever = Retriever(PASSAGES, "en", method=coverage)
    told = [float(retriever.features(text)[0, 0]) for text in ("how tall are you", "how tall is mount everest", "quux")]
    assert told[0] == 1.0
    assert 0.0 < told[1] < 0.5
    assert told[2] == 0.0


def test_only_what_may_be_said_is_found() -> None:
    late = Retriever(PASSAGES, "en", robot="OTHER", today=date(2015, 11, 22))
    assert late.names == ["campus"]
    assert late.answer("how tall are you", ANY._replace(none=1.0, least=0.5)) is None
    found = Retriever(PASSAGES, "id").answer("kampusnya di mana", ANY)
    assert found
    assert (found.passage.name, found.text) == ("campus", "Sana.")


def test_words_are_stemmed_in_both_languages() -> None:
    assert stems("dancing dances", "en") == ["danc", "danc"]
    assert stems("menarikan tarian", "id")[1] == "tari"
    assert stems("Tanzen!", "xx") == ["tanzen"]


TOLD = [Judged(0.9, True, True), Judged(0.8, True, True), Judged(0.7, False, False), Judged(0.6, True, True)]


def test_the_least_probability_answers_most_with_few_wrong() -> None:
    assert least_probability(TOLD) == 0.8
    assert outcome(TOLD, 0.8) == (2 / 3, 0.0)
    assert outcome(TOLD, least_probability(TOLD, max_wrong=UNANSWERABLE)) == (1.0, pytest.approx(UNANSWERABLE))
    assert least_probability([]) == least_probability(TOLD[2:3]) == NEVER
    assert least_probability([Judged(0.8, True, True), Judged(0.8, False, False)]) == NEVER


def test_each_question_is_judged_by_the_others() -> None:
    told = [Judged(0.9, True, True), Judged(0.8, False, False), Judged(0.7, True, True)]
    assert outcome(told, least_probability(told)).wrong == 0.0
    assert left_out(told).wrong == pytest.approx(UNANSWERABLE)


def test_how_many_questions_without_an_answer_are_written_changes_no_share() -> None:
    one, other = Judged(0.9, True, True), Judged(0.8, False, False)
    assert outcome([one, other], 0.0).wrong == pytest.approx(outcome([one] + 9 * [other], 0.0).wrong)
    assert shares([True, True, False, True]).tolist() == pytest.approx([2.8 / 3] * 2 + [1.2, 2.8 / 3])
    assert shares([True]).tolist() == shares([False]).tolist() == [1.0]


def test_a_choice_is_learned_as_statistics_say() -> None:
    """At the learned weights, the slope of the penalised likelihood is zero, by finite differences on made-up
    questions.
    """
    draw = np.random.default_rng(3)
    features = [draw.normal(size=(4, 2)).astype(np.float32) for _ in range(30)]
    wanted = [int(each[:, 0].argmax()) if i % 3 else -1 for i, each in enumerate(features)]
    weights, none = fitted(features, wanted)
    assert weights[0] > abs(weights[1])
    spread = np.array(features).std(axis=(0, 1))

    def likelihood(weights: np.ndarray, none: float) -> float:
        found = 0.0
        for each, row in zip(features, wanted, strict=True):
            of_each = probabilities(each, tuple(weights), none)
            told = np.log(of_each[row] if row >= 0 else 1.0 - of_each.sum())
            found += told * (UNANSWERABLE * 3 if row < 0 else (1 - UNANSWERABLE) * 3 / 2)
        return found - RIDGE / 2 * float(((weights * spread) ** 2).sum())

    at = np.array(weights)
    for step in (np.array([1e-4, 0.0]), np.array([0.0, 1e-4])):
        slope = (likelihood(at + step, none) - likelihood(at - step, none)) / 2e-4
        assert slope == pytest.approx(0.0, abs=0.05)


@given(hnp.arrays(np.float32, (5, 3), elements=st.floats(-1, 1, width=32)), st.floats(-200, 200))
def test_probabilities_are_shares(features: np.ndarray, none: float) -> None:
    of_each = probabilities(features, (150.0, -2.0, 0.0), none)
    assert (of_each >= 0).all()
    assert of_each.sum() <= 1.0 + 1e-9


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
    weights = weights_of(english, SETS)
    assert weights
    assert (trial.asked, trial.least) == (4, weights.least)
    assert trial.rates.recall > 0
    assert not trial.wrong
    assert tried(french, SETS) is None
    assert weights_of(french, SETS) is None


def test_what_is_answered_wrongly_is_named() -> None:
    sets = [
        QuestionSet("a", {"campus": {"en": ("how tall are you",) * 2}, "height": {"en": ("and how tall are you",)}}, {})
    ]
    trial = tried(Retriever(PASSAGES, "en"), sets)
    assert trial
    assert trial.unfound == (("how tall are you", "campus", "height"),)
