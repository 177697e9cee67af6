"""Speech recognition: recordings that hold words, and what is no sound at all."""

import base64
from collections.abc import Callable
from typing import Any

import pytest

from lumen.modules.ears import Ears
from lumen.modules.ears.sphinx import resampled
from lumen.modules.sound import Sound
from lumen.modules.voice import espeak
from tests.modules.conftest import Stand

Make = Callable[..., Stand]
STREAM, RECORDING, HEARD = "lumen.audio.wav.stream", "avatar.NAO.data.recording", "lumen.audio.speech.recognition"


class Parrot:
    """A recogniser of one's own: says how long the sound was."""

    languages = ("en", "id")

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
        ("no base64 at all!", "is no base64"),
        (base64.b64encode(b"RIFF, but no wave").decode(), "is no WAV"),
        ("", "is no WAV"),
        (wav(_stereo), "has 2 channels, 16 bits, 16000 Hz"),
        (wav(_slow), "has 1 channel, 16 bits, 100 Hz"),
        (wav(_cut), "is no WAV"),
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


def test_a_language_that_nobody_understands(stand: Make) -> None:
    here = stand()
    listening(here)
    here.bus.publish(STREAM, {"content": Sound(16_000, b"\x01\x00" * 800).text(), "language": "jv"})
    here.settle()
    assert here.told == ["nobody understands the language `jv` here, only en, id: type what was said"]


def test_another_rate_lasts_as_long() -> None:
    sound = Sound(22_050, b"\x10\x00" * 22_050)
    assert resampled(sound, 16_000).duration == sound.duration
    assert set(resampled(sound, 16_000).samples) == {0x10, 0x00}


def test_words_that_were_spoken_are_recognised(stand: Make) -> None:
    """PocketSphinx, offline, by the model that comes in its package; a synthetic voice, said slowly."""
    here = stand()
    here.add(Ears(here.project, here.bus, here.told.append))
    heard = here.listen(HEARD)
    sound = espeak().speak("go forward ten meters", pace=100)
    here.bus.publish(STREAM, {"name": "s", "content": sound.text(), "language": "en"})
    assert "forward" in heard.wait(1)[0]["result"]
