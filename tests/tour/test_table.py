"""Contents of the tour's tables: both languages everywhere, and for each question an answer of its own."""

from collections.abc import Iterator
from pathlib import Path

import pytest
import yaml

import lumen
from lumen.expressions import Scope, compile_expression
from lumen.insight.explaining.sayings import tried
from lumen.insight.explaining.sentences import explained, first_context
from lumen.language.actions import If, Parallel, PlacedAction, SayText
from lumen.language.machines import MachineDefinition, State, StateKind
from lumen.language.projects import Project
from lumen.project.common_words import common_words
from lumen.talk.speech import NEGATIONS_AFTER, TABLES
from tests.tables import for_each
from tests.tour.names import GUIDE, SAFETY

LANGUAGES = {"en", "id"}
QUESTIONS = 18


@pytest.fixture(scope="module")
def tour(project: Project) -> MachineDefinition:
    return project.behaviors["tour"]


def lookup(tour: MachineDefinition, text: str, table: str, language: str) -> object:
    scope = Scope(event={"name": "heard", "data": {"result": text}}, language=language, answers=tour.answers)
    return compile_expression(f"lookup(event.data.result, '{table}')")(scope)


def heard(tour: MachineDefinition, text: str, name: str) -> object:
    scope = Scope(event={"name": "heard", "data": {"result": text}}, phrases=tour.phrases)
    return compile_expression(f"heard(event.data.result, '{name}')")(scope)


def flattened(steps: tuple[PlacedAction, ...]) -> Iterator[object]:
    for step in steps:
        match step.action:
            case If(_, then, otherwise):
                yield from flattened(then + otherwise)
            case Parallel(branches):
                yield from flattened(branches)
            case action:
                yield action


def actions(state: State) -> Iterator[object]:
    blocks = [state.entry, state.do, state.exit, *(t.actions for t in state.transitions)]
    return (action for block in blocks for action in flattened(block))


def leaves(tour: MachineDefinition, around: str) -> Iterator[State]:
    """Yield the states that are active alone within another one; groups of states are not."""
    groups = {state.parent for state in tour.states.values()}
    for state in tour.states.values():
        if state.path.startswith(f"{around}.") and state.path not in groups and state.kind != StateKind.HISTORY:
            yield state


def test_the_guide_has_the_papers_fifteen_states(tour: MachineDefinition) -> None:
    talking = {state.name for state in leaves(tour, "guide.talking")}
    assert len(GUIDE) == 15
    assert talking | {"idle"} == {*GUIDE, "check_name", "quiet"}


def test_safety_has_a_state_for_everything_that_can_happen(tour: MachineDefinition) -> None:
    assert {state.name for state in leaves(tour, "safety")} == {"watching", *SAFETY}


def test_every_phrase_table_has_both_languages(tour: MachineDefinition) -> None:
    shared = yaml.safe_load(common_words())["phrases"]
    assert tour.phrases.keys() > shared.keys()
    for name, phrases in tour.phrases.items():
        if name != NEGATIONS_AFTER:  # in both languages a negation comes before what it negates
            assert set(phrases) >= LANGUAGES if name in shared else set(phrases) == LANGUAGES, name
            assert all(phrases.values()), name


def test_every_answer_has_phrases_and_a_text_in_both_languages(tour: MachineDefinition) -> None:
    assert tour.answers.keys() == {"explanations", "faq", *TABLES}
    for table in ("explanations", "faq"):
        for row in tour.answers[table]:
            assert set(row.phrases) == set(row.value) == LANGUAGES, (table, row)
            assert all(row.phrases.values()), (table, row)
            assert all(row.value.values()), (table, row)


def test_every_sentence_is_there_in_both_languages(tour: MachineDefinition) -> None:
    for state in tour.states.values():
        for action in actions(state):
            if isinstance(action, SayText) and "" not in action.texts:
                assert set(action.texts) == LANGUAGES, (state.path, action)


def test_only_looked_up_texts_stand_without_a_language(tour: MachineDefinition) -> None:
    bare = {
        (state.name, template.text)
        for state in tour.states.values()
        for action in actions(state)
        if isinstance(action, SayText)
        for template in action.texts.get("", ())
    }
    assert bare == {("explain", "{{ context.reply }}"), ("answer", "{{ context.reply }}")}


def test_it_explains_three_things_and_answers_eighteen_questions(tour: MachineDefinition) -> None:
    assert len(tour.answers["explanations"]) == 3
    assert len(tour.answers["faq"]) == QUESTIONS


@for_each("language", sorted(LANGUAGES))
@for_each("number", range(QUESTIONS))
def test_every_phrase_of_a_question_leads_to_its_answer(tour: MachineDefinition, number: int, language: str) -> None:
    row = tour.answers["faq"][number]
    for phrase in row.phrases[language]:
        text = f"Lumen, {phrase.capitalize()}?"
        assert lookup(tour, text, "faq", language) == row.value[language]
        assert lookup(tour, text, "explanations", language) is None, "an explanation comes before a question"
        for state in ("offer", "any_question"):
            path = next(s.path for s in tour.states.values() if s.name == state)
            taken = explained(tour, path, text, tour.context, language).taken
            assert taken is not None
            assert (taken.key, taken.caught["answer"]) == ("faq", row.value[language]), "a wish comes before a question"
        assert explained(tour, "language", text, tour.context, language).taken is None, "a language, and no question"


@pytest.mark.parametrize(
    ("text", "name"),
    [
        ("I know", "no"),
        ("This is a notable hall", "no"),
        ("A lovely guidance", "dance"),
        ("I am unwell", "fine"),
        ("What a sad gambler", "photo"),
    ],
)
def test_a_part_of_a_word_is_not_a_phrase(tour: MachineDefinition, text: str, name: str) -> None:
    assert not heard(tour, text, name)


def test_every_state_of_a_conversation_ends_by_itself(tour: MachineDefinition) -> None:
    """After a long silence, or a motion that never ends, the next visitor can still be greeted."""
    for state in leaves(tour, "guide.talking"):
        around = [s for s in tour.states.values() if f"{state.path}.".startswith(f"{s.path}.")]
        assert any(t.delay for s in around for t in s.transitions), state.name


@for_each(
    ("text", "language", "row"),
    [
        ("Do you have a battery?", "en", "else"),
        ("What is electrical engineering?", "en", "else"),
        ("how much do you cost", "en", "else"),
        ("Kamu terbuat dari apa?", "id", "else"),
        ("Siapa yang bikin kamu?", "id", "else"),
        ("Umur kamu berapa?", "id", "else"),
        ("Lumen artinya apa?", "id", "else"),
        ("Toilet di mana ya?", "id", "else"),
        ("Who taught you to dance?", "en", "asked dance|sing|photo"),
        ("How do you take photos?", "en", "asked dance|sing|photo"),
        ("Siapa yang ngajarin kamu nari?", "id", "asked dance|sing|photo"),
        ("When does the exhibition close?", "en", "explanations"),
        ("Acara ini sampai jam berapa?", "id", "explanations"),
    ],
)
def test_questions_that_staff_may_answer_one_day(tour: MachineDefinition, text: str, language: str, row: str) -> None:
    """They are no sayings of the shipped project: those would forbid the answer."""
    state = next(state.path for state in tour.states.values() if state.alias == "offer")
    found = explained(tour, state, text, first_context(tour), language)
    assert found.taken
    assert found.taken.key == row


TOILET = """
    - phrases:
        en: [toilet, toilets, restroom]
        id: [toilet, wc, kamar kecil]
      value:
        en: ["The toilets are beside the entrance."]
        id: ["Toilet ada di samping pintu masuk."]
    - phrases:
        en: [when does the exhibition close, opening hours, battery, how much do you cost, who taught you to dance]
        id: [sampai jam berapa, terbuat dari apa, siapa yang bikin kamu, umur kamu berapa, lumen artinya apa]
      value:
        en: ["At five."]
        id: ["Jam lima."]
"""


def test_an_answer_that_staff_add_contradicts_no_saying(copy: Path) -> None:
    words = copy / "behaviors" / "words" / "faq.yaml"
    words.write_text(words.read_text("utf-8") + TOILET, "utf-8")
    project = lumen.load(copy)
    assert [one.wrong for one in tried(project.sayings.values(), project.behaviors) if one.wrong] == []
