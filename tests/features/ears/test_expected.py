"""The active states decide what the recogniser is told to expect, and what interrupts the robot."""

from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import Any

import pytest

import lumen
from lumen import statechart
from lumen.features.ears.ears import LOST_AFTER, ActiveStates
from lumen.features.ears.expected import MAX_SENTENCES, STORY_WEIGHT, HeardName, expected, heard_names
from lumen.features.ears.module import Ears
from lumen.features.ears.recogniser import Hypothesis
from lumen.language.events import Event
from lumen.language.machines import MachineDefinition, State
from lumen.language.projects import Project
from lumen.run.sound import Sound
from lumen.statechart.nesting import active_names
from lumen.talk.speech import TABLES, WORD_LISTS
from tests.features.conftest import Stand, with_options
from tests.features.ears.test_own_voice import SAY, Ear
from tests.tables import for_each

Make = Callable[..., Stand]
FILES = {
    "lumen.yaml": """
lumen: 1
name: Small
behavior: guide
languages: [en, id]
robot: {name: NAO, model: nao}
routes:
  heard: {key: lumen.audio.speech.recognition, direction: in, schema: speech.recognition, event: heard}
  go: {key: test.go, direction: in, schema: text.stream, event: go}
""",
    "behaviors/guide.yaml": """
phrases:
  dance: {en: ["(dance|boogie) [for me]", don't stand still], id: [menari]}
  tour_of: {en: ["show me [to] the {exhibits}", "exhibit {number:n}", "{number:n}"]}
  stop: {en: ["(stop|enough) [it].", "not the {exhibits}"], id: [berhenti]}
  hot: {en: [too hot]}
  cold: {en: [too cold]}
  never: {en: [nobody waits for this]}
answers:
  faq: [{phrases: {en: [how (tall|high)], id: [berapa tinggi]}, value: Small}]
lists:
  exhibits:
    - {name: engine, phrases: {en: ["[old] engine"]}}
    - {name: lamp, phrases: {en: lamp, id: lampu}}
states:
  open:
    hears: {hot|cold: {actions: {log: weather}}}
    states:
      idle:
        hears: {dance: busy, tour_of: ., not dance: .}
        on: {go: playing}
      busy:
        hears: {stop: idle}
        on:
          heard:
            guard: lookup(event.data.result, 'faq') != null && !heard(event.data.result, 'fillers')
            target: idle
      playing: {invoke: {id: game, behavior: quiz}, on: {done.invoke.game: idle}}
""",
    "behaviors/quiz.yaml": """
phrases:
  quit: {en: [quit]}
  stop: {en: [no more questions]}
lists:
  questions:
    - {ask: How many?, right: {en: [three, "[number] 3"]}}
    - {ask: How old?, right: [a hundred]}
on: {heard: {guard: "heard(event.data.result, 'quit')", target: .over}}
initial: round
states:
  round:
    for: {each: lists.questions, as: question}
    states:
      ask: {hears: {question.right: next, stop: "#over"}}
      next: {type: final}
    onDone: over
  over: {id: over, type: final}
""",
    "behaviors/stories/visitor.yaml": """
steps:
  - {says: I’d like a boogie}
  - {says: I’d like a boogie}
""",
}
IDLE, BUSY = ["open", "open.idle"], ["open", "open.busy"]
PLAYING = ["open", "open.playing", "game/round", "game/round.ask"]


@pytest.fixture(scope="module")
def small(tmp_path_factory: pytest.TempPathFactory) -> Project:
    folder = tmp_path_factory.mktemp("small")
    for name, text in FILES.items():
        file = folder / name
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text(text, "utf-8")
    return lumen.load(folder)


def names(project: Project, states: Sequence[str] | frozenset[str] | None) -> set[str]:
    return {one.name for one in heard_names(project, states)}


def sentences(project: Project, *states: str) -> list[str]:
    return [" ".join(words) for words in expected(project, heard_names(project, states))]


@for_each(
    ("states", "heard"),
    [
        (IDLE, {"hot", "cold", "dance", "tour_of"}),
        (BUSY, {"hot", "cold", "stop", "faq"}),
        (PLAYING[:3], {"hot", "cold", "quit"}),
        (PLAYING, {"hot", "cold", "quit", "stop", "context.question_in_round.entry.right"}),
        ([], set()),
    ],
)
def test_active_states_and_those_around_them_hear(small: Project, states: list[str], heard: set[str]) -> None:
    assert names(small, states) == heard


def test_the_names_are_those_of_messages(small: Project) -> None:
    first = statechart.initial(small.machine).snapshot
    then = statechart.step(small.machine, first, Event("go", None, 1.0)).snapshot
    assert names(small, active_names(first)) == names(small, IDLE)
    assert names(small, active_names(then)) == names(small, PLAYING)


def test_all_states_of_all_behaviours_hear_if_the_active_ones_are_unknown(small: Project) -> None:
    everything = {"hot", "cold", "dance", "tour_of", "stop", "faq", "quit", "context.question_in_round.entry.right"}
    assert names(small, None) == everything
    assert names(small, ["open", "a state of other files"]) == everything


def test_expects_the_forms_of_patterns_in_every_language(small: Project) -> None:
    assert sentences(small, *BUSY) == [
        "too hot", "too cold", "stop", "stop it", "enough", "enough it", "not the engine", "not the old engine",
        "not the lamp", "not the lampu", "berhenti", "how tall", "how high", "berapa tinggi",
        *["i'd like a boogie"] * STORY_WEIGHT,
    ]  # fmt: skip


def test_fills_slots_by_lists_and_leaves_others_out(small: Project) -> None:
    found = sentences(small, *IDLE)
    assert {"show me the old engine", "show me to the lampu", "exhibit", "don't stand still", "menari"} <= {*found}
    assert "" not in found
    assert {"three", "number 3", "3", "a hundred"} <= {*sentences(small, *PLAYING)}


def test_no_phrase_is_expected_in_more_ways_than_a_bound(small: Project) -> None:
    entries = tuple({"phrases": {"en": (f"thing {i}",)}} for i in range(100))
    phrase = "(a|b|c|d|e|f|g) (h|i|j|k|l|m|n) {things} and {things}"
    machine = MachineDefinition("m", {"": State("")}, phrases={"it": {"en": (phrase,)}}, lists={"things": entries})
    found = expected(replace(small, stories={}), [HeardName(machine, "it")])
    assert len(found) == MAX_SENTENCES
    assert {word for words in found for word in words} >= {"thing", "0", "99"}


def test_word_lists_and_tables_are_never_expected(small: Project) -> None:
    assert "heard(event.data.result, 'fillers')" in FILES["behaviors/guide.yaml"]
    assert small.machine.phrases["fillers"]
    assert not {*WORD_LISTS, *TABLES} & names(small, None)


def here(*parts: str, robot: str = "NAO", state: str = "here") -> dict[str, Any]:
    return {"robot": robot, "parts": list(parts), "session": "s", "state": state}


def test_active_states_are_known_from_the_first_message_until_the_brain_is_lost() -> None:
    active = ActiveStates("NAO")
    assert active.names(0.0) is None
    active.state({"robot": "NAO", "states": ["a", "b"]}, 1.0)
    active.state({"robot": "NAO", "command": SAY}, 2.0)
    active.state({"robot": "Ben", "states": ["c"]}, 2.0)
    assert active.names(1_000.0) == {"a", "b"}, "a brain on a bus within the process announces nothing"
    active.presence(here("brain", "motion"), 1_000.0)
    active.presence(here("robot"), 1_003.0)
    active.presence(here("brain", robot="Ben"), 1_003.0)
    active.presence(here("brain", state="leaves"), 1_003.0)
    assert active.names(1_000.0 + LOST_AFTER) == {"a", "b"}
    assert active.names(1_000.1 + LOST_AFTER) is None
    active.presence(here("brain"), 1_005.0)
    assert active.names(1_005.0) is None, "it may have moved on"
    active.state({"robot": "NAO", "states": ["c"]}, 1_020.0)
    assert active.names(1_021.0) == {"c"}


@for_each("body", [None, 3, {}, {"robot": "NAO"}, {"robot": "NAO", "states": 3}, {"robot": "NAO", "parts": 3}])
def test_what_tells_of_no_states_is_left_out(body: Any) -> None:
    active = ActiveStates("NAO")
    active.state(body, 1.0)
    active.presence(body, 1.0)
    assert active.names(100.0) is None


class Listener:
    """A recogniser that keeps what it was told to expect, each time."""

    languages = ("en", "id")

    def __init__(self, *texts: str) -> None:
        self.told: list[set[str]] = []
        self.texts, self.asked = texts, 0

    def expect(self, sentences: Sequence[Sequence[str]]) -> None:
        self.told.append({" ".join(words) for words in sentences})

    def recognise(self, sound: Sound) -> str:
        return ""

    def hypotheses(self, sound: Sound) -> Sequence[Hypothesis]:
        self.asked += 1
        return [Hypothesis(text) for text in self.texts]


def listening(stand: Make, project: Project, *texts: str) -> tuple[Ear, Listener]:
    listener = Listener(*texts)
    return Ear(stand(project), listener), listener


def test_the_recogniser_is_told_when_a_sound_comes_and_only_of_what_changed(stand: Make, small: Project) -> None:
    ear, listener = listening(stand, small)
    ear.state(100.0, states=IDLE)
    ear.state(101.0, states=BUSY)
    assert listener.told == []
    ear.record(102.0, 4)
    ear.record(103.0, 4)
    ear.state(104.0, states=BUSY)
    ear.record(105.0, 4)
    [busy] = listener.told
    assert "stop it" in busy
    assert "menari" not in busy
    ear.state(106.0, states=IDLE)
    ear.record(107.0, 4)
    assert "menari" in listener.told[1]
    ear.stand.modules[0].use(replace(small, stories={}))
    ear.record(108.0, 4)
    assert len(listener.told) == 3
    assert listener.told[1] - listener.told[2] == {"i'd like a boogie"}


def test_a_lost_brain_leaves_all_states(stand: Make, small: Project) -> None:
    ear, listener = listening(stand, small)
    ear.state(100.0, states=IDLE)
    ear.send(100.0, "lumen.NAO.presence", here("brain"))
    ear.record(101.0, 4)
    ear.record(101.0 + LOST_AFTER, 4)
    assert ["quit" in told for told in listener.told] == [False, True]


@for_each(
    ("states", "said", "heard"),
    [
        (BUSY, "uh enough it now", ["enough it"]),
        (BUSY, "Not the, please, old engine", ["Not the, please, old engine"]),
        (BUSY, "too hot", []),
        (IDLE, "enough", []),
        (None, "no more questions", ["no more questions"]),
        (PLAYING, "enough", []),
        (PLAYING, "no more questions", ["no more questions"]),
    ],
)
def test_phrases_that_an_active_state_hears_interrupt(
    stand: Make, small: Project, states: list[str] | None, said: str, heard: list[str]
) -> None:
    ear, listener = listening(stand, small, said)
    if states:
        ear.state(100.0, states=states)
    ear.state(100.0, command=SAY)
    assert ear.record(101.0, 1) == heard
    assert listener.asked == (states != IDLE), "if nothing interrupts, nothing is recognised"


def test_interrupts_names_answers_too(stand: Make, small: Project) -> None:
    ear, _ = listening(stand, with_options(small, "ears", interrupts=["faq"]), "well how high are you")
    ear.state(100.0, states=BUSY, command=SAY)
    assert ear.record(101.0, 1) == ["how high"]


def test_its_own_words_are_expected_while_it_speaks_and_only_the_likeliest_text_counts(
    stand: Make, small: Project
) -> None:
    ear, listener = listening(stand, small, "please stop at the organ", "please enough of the organ")
    ear.state(100.0, states=BUSY)
    ear.state(100.0, command=SAY)
    assert ear.record(101.0, 1) == []
    ear.state(101.0, answer={"id": "d1", "kind": "done"})
    ear.record(105.0, 4)
    assert ["please stop at the organ" in told for told in listener.told] == [True, False]


def test_each_robot_of_a_process_hears_by_its_own_states(stand: Make, small: Project) -> None:
    here, listeners = stand(small), {"NAO": Listener(), "Ben": Listener()}
    for robot, listener in listeners.items():
        here.add(Ears(replace(small, robot=robot), here.bus, here.told.append, listener))
    for robot, states in (("NAO", IDLE), ("Ben", BUSY)):
        here.bus.publish(f"lumen.{robot}.state", {"robot": robot, "time": 1.0, "states": states})
        sound = Sound(16_000, b"\x04\x00" * 1_000).text()
        here.bus.publish(f"avatar.{robot}.data.recording", {"name": "r", "content": sound})
    here.settle()
    assert {robot: "menari" in listener.told[0] for robot, listener in listeners.items()} == {"NAO": True, "Ben": False}
