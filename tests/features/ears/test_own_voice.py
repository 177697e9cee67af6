"""While the robot speaks, its ears take only what interrupts it."""

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
import pytest

from lumen.features.ears.module import Ears, Recogniser
from lumen.features.ears.own_voice import ECHO, LONGEST, OwnVoice
from lumen.features.ears.voice_activity import VoiceActivity
from lumen.features.voice.module import espeak
from lumen.run.sound import Sound
from tests.features.conftest import Stand, with_options
from tests.tables import for_each

Make = Callable[..., Stand]
RATE = 16_000
STATE, REPORT, RECORDING = "lumen.NAO.state", "avatar.NAO.event.command", "avatar.NAO.data.recording"
HEARD = "lumen.audio.speech.recognition"
SAY = {"verb": "say", "id": "d1", "text": "Please stop at the organ."}


class Writer:
    """A recogniser that tells speakers apart by loudness: 1 is the robot, and from 2 on the words of a visitor."""

    languages = ("en", "id")
    words = ("", "the robot's own words", "wait a moment", "stop", "can you dance")

    def expect(self, sentences: Sequence[Sequence[str]]) -> None: ...

    def recognise(self, sound: Sound) -> str:
        levels = dict.fromkeys(np.frombuffer(sound.samples, "<i2").tolist())
        return " ".join(self.words[level] for level in levels if level)


class Ear:
    """Ears with a clock that the test sets, and the texts that they recognised."""

    def __init__(self, stand: Stand, recogniser: Recogniser | None = None) -> None:
        self.stand, self.now = stand, 100.0
        stand.add(Ears(stand.project, stand.bus, stand.told.append, recogniser or Writer(), clock=lambda: self.now))
        self.collector = stand.listen(HEARD)

    def send(self, at: float, key: str, body: Any) -> None:
        self.now = at
        self.stand.bus.publish(key, body)
        self.stand.settle()

    def state(self, at: float, **body: Any) -> None:
        self.send(at, STATE, {"robot": "NAO", "time": at, **body})

    def record(self, at: float, *levels: int) -> list[str]:
        """Send a sound with half a second of each level, which ends at `at` [s]; return the texts recognised in it."""
        before = len(self.collector.bodies)
        samples = np.repeat(np.array(levels, "<i2"), RATE // 2).tobytes()
        self.send(at, RECORDING, {"name": "r", "content": Sound(RATE, samples).text()})
        return [body["result"] for body in self.collector.bodies[before:]]


@pytest.fixture
def ear(stand: Make) -> Ear:
    return Ear(stand())


def test_does_not_hear_itself(ear: Ear) -> None:
    ear.state(100.0, command=SAY)
    assert ear.record(101.0, 1, 1) == []
    ear.state(102.0, answer={"id": "d1", "kind": "done"})
    assert ear.record(102.2, 1) == []
    assert ear.record(102.9, 4) == ["can you dance"]


def test_hears_what_a_visitor_says_before_and_after_it_spoke(ear: Ear) -> None:
    ear.state(100.0, command=SAY)
    ear.state(101.0, answer={"id": "d1", "kind": "cancelled"})
    assert ear.record(102.5, 1, 1, 0, 0, 4) == ["can you dance"]


def test_is_told_to_wait_while_it_speaks_but_takes_no_word_of_its_own_for_that(ear: Ear) -> None:
    ear.state(100.0, command=SAY)
    assert ear.record(101.0, 1, 4) == []
    assert ear.record(102.0, 1, 3) == [], "its text has the word `stop`"
    assert ear.record(103.0, 1, 2) == ["wait a moment"]


def test_a_command_of_somebody_else_is_its_voice_too(ear: Ear) -> None:
    ear.send(100.0, REPORT, {"id": "7", "state": "started", "method": "say"})
    assert ear.record(101.0, 1, 1) == []
    assert ear.record(102.0, 1, 3) == ["stop"]
    ear.send(102.0, REPORT, {"id": "7", "state": "failed", "method": "say"})
    ear.send(102.0, REPORT, {"id": "8", "state": "started", "method": "dance"})
    assert ear.record(103.0, 4) == ["can you dance"]


def test_which_words_interrupt_is_written(stand: Make, ear: Ear) -> None:
    other = Ear(stand(with_options(ear.stand.project, "ears", interrupts=["dance"])))
    other.state(100.0, command=SAY)
    assert other.record(101.0, 1, 2) == []
    assert other.record(102.0, 1, 4) == ["dance"]


def test_phrases_that_no_state_hears_are_told(stand: Make, ear: Ear) -> None:
    other = Ear(stand(with_options(ear.stand.project, "ears", interrupts=["stop", "stpo"])))
    assert other.stand.told == ["`interrupts` has `stpo`, which no state hears (did you mean `stop`?)"]
    assert ear.stand.project.machine.phrases["german"]
    unheard = Ear(stand(with_options(ear.stand.project, "ears", interrupts=["german"])))
    assert "`german`, which no state hears" in unheard.stand.told[0]
    assert ear.stand.told == []


def test_an_end_that_nobody_tells_leaves_it_deaf_for_a_minute_at_most() -> None:
    voice = OwnVoice()
    voice.state({"command": {"verb": "say", "id": "d1", "text": "Hello"}}, 10.0)
    assert [u.end for u in voice.during(60.0, 65.0)] == [65.0 + ECHO]
    assert voice.during(10.0 + LONGEST + ECHO, 100.0) == []


@for_each("body", [None, 3, {}, {"command": {"verb": "say"}}, {"answer": 3}, {"answer": {"id": "x"}}])
def test_what_is_no_speech_is_none(body: Any) -> None:
    voice = OwnVoice()
    voice.state(body, 1.0)
    voice.report(body, 1.0)
    assert voice.during(0.0, 100.0) == []


def test_finds_where_somebody_speaks_and_nothing_in_noise() -> None:
    spoken = np.frombuffer(espeak().speak("can you sing a song please", "en-us", pace=150).samples, "<i2").astype(float)
    rate = espeak().rate
    noise = np.random.default_rng(1).normal(0.0, 100.0, rate * 2 + len(spoken))
    noisy = noise.copy()
    noisy[rate : rate + len(spoken)] += spoken
    activity = VoiceActivity()
    spans = activity.spans(Sound(rate, noisy.astype("<i2").tobytes()))
    assert spans[0][0] == pytest.approx(1.0, abs=0.2)
    assert spans[-1][1] == pytest.approx(1.0 + len(spoken) / rate, abs=0.3)
    assert activity.spans(Sound(rate, noise.astype("<i2").tobytes())) == []


def test_who_finds_nobody_speaking_wakes_no_recogniser(stand: Make) -> None:
    here = stand()
    here.add(Ears(here.project, here.bus, here.told.append, Writer(), VoiceActivity()))
    heard = here.listen(HEARD)
    here.bus.publish(RECORDING, {"name": "r", "content": Sound(RATE, b"\x04\x00" * RATE).text()})
    here.settle()
    assert (heard.bodies, here.told) == ([], [])
