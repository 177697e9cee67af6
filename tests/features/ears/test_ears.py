"""Speech recognition: recordings that hold words, and bodies that are not sounds."""

import base64
import ctypes
import shutil
from collections.abc import Callable, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import espeakng_loader
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from lumen.errors import ModuleError
from lumen.features.ears.expected import expected, heard_names
from lumen.features.ears.module import Ears, Hypothesis
from lumen.features.ears.resampling import resampled
from lumen.features.ears.sphinx import MAX_MODELS, Sphinx, arpa, pronounced
from lumen.features.voice.module import Espeak
from lumen.insight.explaining.sentences import explained, first_context
from lumen.language.machines import path_of
from lumen.language.projects import Project
from lumen.run.sound import Sound, sound_of
from tests.features.conftest import Stand
from tests.tables import for_each

Make = Callable[..., Stand]
Speak = Callable[[str, str], Sound]
STREAM, RECORDING, HEARD = "lumen.audio.wav.stream", "avatar.NAO.data.recording", "lumen.audio.speech.recognition"
SONG = "can you sing a song please"


class Parrot:
    """A custom recogniser that returns the duration of the sound as its text."""

    languages = ("en", "id")

    def expect(self, sentences: Sequence[Sequence[str]]) -> None:
        self.expected = sentences

    def recognise(self, sound: Sound) -> str:
        return f"{sound.duration:.2f} seconds" if any(sound.samples) else ""


def listening(stand: Stand, recogniser: Any = None) -> Ears:
    ears = Ears(stand.project, stand.bus, stand.told.append, recogniser or Parrot())
    stand.add(ears)
    return ears


def test_recordings_and_sounds_become_what_was_said(stand: Make) -> None:
    here = stand()
    listening(here)
    heard = here.listen(HEARD)
    sound = Sound(16_000, b"\x01\x00" * 8_000)
    here.bus.publish(RECORDING, {"name": "r1", "content": sound.text()})
    here.bus.publish(STREAM, {"name": "r2", "content": sound.text(), "language": "id"})
    first, second = heard.wait(2)
    assert (first["name"], first["result"], first["language"]) == ("r1", "0.50 seconds", "en")
    assert (second["name"], second["result"], second["language"]) == ("r2", "0.50 seconds", "id")


def test_silence_says_nothing(stand: Make) -> None:
    here = stand()
    listening(here)
    heard = here.listen(HEARD)
    here.bus.publish(RECORDING, {"name": "r1", "content": Sound(16_000, bytes(32_000)).text()})
    here.settle()
    assert (heard.bodies, here.told) == ([], [])


def wav(change: Callable[[bytearray], None]) -> str:
    data = bytearray(base64.b64decode(Sound(16_000, b"\x01\x00" * 8_000).text()))
    change(data)
    return base64.b64encode(data).decode()


def _stereo(data: bytearray) -> None:
    data[22:24] = (2).to_bytes(2, "little")


def _slow(data: bytearray) -> None:
    data[24:28] = (100).to_bytes(4, "little")


def _cut(data: bytearray) -> None:
    del data[10:]


def _bare(data: bytearray) -> None:
    del data[44:]
    data[40:44] = bytes(4)


@pytest.mark.parametrize(
    ("content", "said"),
    [
        ("no base64 at all!", "is not base64"),
        (base64.b64encode(b"RIFF, but no wave").decode(), "is not a WAV"),
        ("", "is not a WAV"),
        (wav(_stereo), "has 2 channels, 16 bits, 16000 Hz"),
        (wav(_slow), "has 1 channel, 16 bits, 100 Hz"),
        (wav(_cut), "is not a WAV"),
        (wav(_bare), "is empty"),
        (Sound(8_000, bytes(2 * 8_000 * 121)).text(), "is longer than 120 s"),
    ],
)
def test_a_sound_that_is_none_is_one_line(stand: Make, content: str, said: str) -> None:
    here = stand()
    listening(here)
    heard = here.listen(HEARD)
    for _ in range(3):
        here.bus.publish(RECORDING, {"name": "r1", "content": content})
    here.settle()
    assert len(here.told) == 1
    assert said in here.told[0]
    here.bus.publish(RECORDING, {"name": "r2", "content": Sound(16_000, b"\x01\x00" * 8_000).text()})
    assert heard.wait(1)[0]["name"] == "r2"


@for_each("content", [None, 5, ["UklGRg=="]])
def test_a_sound_that_is_no_text_is_a_module_error(content: object) -> None:
    """The schema of the message refuses it first, unless the project has its own."""
    with pytest.raises(ModuleError, match="a sound must be a string"):
        sound_of(content)


def test_a_language_that_nobody_understands(stand: Make) -> None:
    here = stand()
    listening(here)
    here.bus.publish(STREAM, {"content": Sound(16_000, b"\x01\x00" * 800).text(), "language": "jv"})
    here.settle()
    assert here.told == ["the ears understand only en, id, not `jv`: type what was said"]


def test_another_rate_lasts_as_long() -> None:
    sound = Sound(22_050, b"\x10\x00" * 22_050)
    assert resampled(sound, 16_000).duration == sound.duration
    assert set(resampled(sound, 16_000).samples) == {0x10, 0x00}


def active(project: Project, name: str) -> list[str]:
    """Return the names of the active states that the brain publishes while the tour's guide is in that state."""
    state = next(state for state in project.machine.states.values() if state.name == name)
    names = ["safety", "watching", "touch", "touch.free", "face", "unwatched", "language"]
    while state.path:
        names.append(state.name)
        state = project.machine.states[state.parent or ""]
    return names


@pytest.fixture(scope="module")
def recogniser() -> Sphinx:
    """PocketSphinx, offline, with the model of its package."""
    return Sphinx()


@pytest.fixture
def sphinx(recogniser: Sphinx, project: Project) -> Sphinx:
    """The recogniser, which expects what the tour does in `offer`."""
    recogniser.expect(expected(project, heard_names(project, active(project, "offer"))))
    return recogniser


@pytest.fixture
def speak(tmp_path: Path) -> Speak:
    """Return a function that speaks its first text always alike.

    espeak-ng varies a text after it spoke others. This function has a copy of the library that has spoken nothing.
    """
    library = str(shutil.copy(espeakng_loader.get_library_path(), tmp_path))
    ctypes.CDLL(library).espeak_ng_SetRandSeed(1)
    voice = Espeak(library, espeakng_loader.get_data_path())
    return lambda text, language: voice.speak(text, language, pace=150)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("text", "voice", "state"),
    [
        (SONG, "en-us", "offer"),
        ("how many joints do you have", "en-us", "any_question"),
        ("nama saya budi", "id", "ask_name"),
    ],
)
def test_what_visitors_may_say_is_understood(
    project: Project, sphinx: Sphinx, speak: Speak, text: str, voice: str, state: str
) -> None:
    sphinx.expect(expected(project, heard_names(project, active(project, state))))
    assert meaning(project, state, sphinx.recognise(speak(text, voice))) == meaning(project, state, text)


@pytest.mark.slow
def test_a_sound_is_recognised_alike_after_any_others(sphinx: Sphinx, speak: Speak) -> None:
    sounds = [speak(text, "en-us") for text in (SONG, "how many joints do you have")]
    first = [sphinx.hypotheses(sound) for sound in sounds]
    assert [sphinx.hypotheses(sound) for sound in (*reversed(sounds), *sounds)] == [*reversed(first), *first]


def meaning(project: Project, state: str, text: str) -> tuple[str, dict[str, Any]]:
    """Return the row of `hears` that a sentence takes in a state of the tour, and the words in its slots."""
    machine = project.machine
    taken = explained(machine, path_of(machine, state), text, first_context(machine)).taken
    assert taken
    return taken.key, taken.slots


def test_silence_is_nothing_also_to_who_expects_something(sphinx: Sphinx) -> None:
    assert sphinx.recognise(Sound(16_000, bytes(32_000))) == ""
    assert sphinx.recognise(Sound(16_000, b"")) == ""


@pytest.mark.slow
def test_words_that_were_spoken_are_recognised_on_the_bus(stand: Make, sphinx: Sphinx, speak: Speak) -> None:
    here = stand()
    listening(here, sphinx)
    here.bus.publish("lumen.NAO.state", {"robot": "NAO", "time": 0.0, "states": active(here.project, "offer")})
    heard = here.listen(HEARD)
    here.bus.publish(STREAM, {"name": "s", "content": speak(SONG, "en-us").text(), "language": "en"})
    [said] = heard.wait(1)
    assert meaning(here.project, "offer", said["result"]) == meaning(here.project, "offer", SONG)
    assert said["language"] == "en"
    assert 0.3 < said["confidence"] <= 1.0
    others = [row["result"] for row in said["alternatives"]]
    assert len({said["result"], *others}) == len(others) + 1 == 5


class Doubter(Parrot):
    """A recogniser that also reports other texts that may have been said."""

    def hypotheses(self, sound: Sound) -> Sequence[Hypothesis]:
        return [Hypothesis("can you thing", 0.41234), Hypothesis("can you sing"), Hypothesis("can you ring", 0.1)]


def test_what_else_may_have_been_said_is_on_the_bus(stand: Make) -> None:
    here = stand()
    listening(here, Doubter())
    heard = here.listen(HEARD)
    here.bus.publish(RECORDING, {"name": "r", "content": Sound(16_000, bytes(32_000)).text()})
    [said] = heard.wait(1)
    assert (said["result"], said["confidence"]) == ("can you thing", 0.412)
    assert said["alternatives"] == [{"result": "can you sing"}, {"result": "can you ring", "confidence": 0.1}]


def test_expects_what_the_active_states_hear_and_what_visitors_say_in_stories(stand: Make, project: Project) -> None:
    here, parrot = stand(), Parrot()
    ears = listening(here, parrot)
    heard = here.listen(HEARD)
    sound = Sound(16_000, b"\x01\x00" * 8_000).text()

    def expected_at(count: int) -> Sequence[Sequence[str]]:
        here.bus.publish(RECORDING, {"name": "r", "content": sound})
        heard.wait(count)
        return parrot.expected

    everywhere = expected_at(1)
    assert ["speak", "english"] in everywhere
    assert ["how", "many", "joints"] in everywhere
    assert ["my", "name", "is", "budi"] in everywhere
    states = active(project, "dance")
    here.bus.publish("lumen.NAO.state", {"robot": "NAO", "time": 0.0, "states": states})
    dancing = expected_at(2)
    assert ["stop"] in dancing
    assert ["how", "many", "joints"] not in dancing
    assert ["my", "name", "is", "budi"] in dancing
    ears.use(replace(project, stories={}))
    assert ["my", "name", "is", "budi"] not in expected_at(3)


@pytest.mark.slow
def test_another_language_model_for_another_tour(sphinx: Sphinx, speak: Speak) -> None:
    sound = speak("kucing", "id")
    assert sphinx.recognise(sound) != "kucing"
    sphinx.expect([["kucing"], ["anjing"]])
    assert sphinx.recognise(sound) == "kucing"


def test_the_language_models_used_last_are_kept(sphinx: Sphinx, monkeypatch: pytest.MonkeyPatch) -> None:
    made: list[str] = []
    make = sphinx._make

    def counted(name: str, sentences: Sequence[Sequence[str]]) -> None:
        made.append(sentences[0][0])
        make(name, sentences)

    monkeypatch.setattr(sphinx, "_make", counted)
    words = ["one", "two", "three", "four", "five"][: MAX_MODELS + 1]
    for word in (*words[:-1], *words[:-1], words[-1], words[1], words[0]):
        sphinx._prepare([[word], ["größe"], ["7"], []])
    assert made == [*words, words[0]], "the oldest gave way"
    assert sphinx._decoder.get_lm(sphinx._decoder.current_search()).prob(["one"]) > sphinx._english.prob(["one"])
    sphinx._prepare([["7"], []])
    assert sphinx._decoder.current_search() == sphinx._freely, "nothing that it could say is expected"


def chances(model: str) -> tuple[dict[str, float], dict[str, float], dict[tuple[str, str], float]]:
    """Return the probabilities of words, the backoff weights of words, and the probabilities of pairs of words."""
    first, _, second = model.partition("\\2-grams:")
    ones = [line.split() for line in first.partition("\\1-grams:")[2].split("\n") if line]
    twos = [line.split() for line in second.partition("\\end")[0].split("\n") if line]
    words = {word: 10 ** float(chance) for chance, word, _ in ones}
    return words, {word: 10 ** float(left) for _, word, left in ones}, {(a, b): 10 ** float(p) for p, a, b in twos}


@settings(max_examples=30)
@given(
    st.lists(st.lists(st.sampled_from("abcde"), min_size=1, max_size=4), min_size=1, max_size=6),
    st.dictionaries(st.sampled_from("defgh"), st.floats(0.01, 1.0)),
)
def test_what_follows_a_word_has_a_chance_of_one_in_all(sentences: list[list[str]], common: dict[str, float]) -> None:
    words, left, pairs = chances(arpa(sentences, common))
    for word in left:
        after = sum(pairs.get((word, b), left[word] * chance) for b, chance in words.items() if b != "<s>")
        assert after == pytest.approx(1.0, abs=0.01), word


@for_each(
    ("word", "sounds"),
    [("dewi", "D AH W IY"), ("nyanyi", "N Y AA N Y IY"), ("bunga", "B UW NG AA"), ("pantai", "P AA N T AY"), ("'", "")],
)
def test_indonesian_is_written_as_it_is_spoken(word: str, sounds: str) -> None:
    assert pronounced(word) == sounds
