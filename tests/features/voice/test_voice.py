"""Speech as sound: by espeak-ng, on the bus and from the simulated robot."""

import wave
from array import array
from collections.abc import Callable
from pathlib import Path

import pytest

from lumen.cli.main import main
from lumen.clock.simulated import SimulatedClock
from lumen.errors import ModuleError, UsageError
from lumen.features.simulation.offers import SimulatedRobot
from lumen.features.voice.module import Espeak, Voice, espeak
from lumen.features.voice.speaker import Speaker
from lumen.language.commands import Say, Volume
from lumen.language.projects import Project
from lumen.robot.none import NoRobot
from lumen.run.setup import Setup
from lumen.run.sound import Sound, sound_of, wav
from lumen.run.voices import voiced
from tests import ROOT
from tests.copying import copied_project
from tests.features.conftest import Stand
from tests.tables import for_each

Make = Callable[..., Stand]
STREAM, SPOKEN = "lumen.audio.text.stream", "lumen.audio.text.to.speech"


def loud(sound: Sound, begin: float, end: float) -> bool:
    """Return True if the sound is not silent between these times [s]."""
    part = sound.samples[2 * round(begin * sound.rate) : 2 * round(end * sound.rate)]
    return any(part)


def peak(sound: Sound, begin: float, end: float) -> int:
    """Return the greatest sample between these times [s]."""
    part = sound.samples[2 * round(begin * sound.rate) : 2 * round(end * sound.rate)]
    return max(map(abs, array("h", part)), default=0)


def test_tells_when_each_word_is_heard() -> None:
    text = "Halo, Ärztin Budi: we have 27 robots! Follow me."
    sound, words = espeak().timed(text)
    begins = [text[word.character :].split()[0] for word in words]
    assert begins == ["Halo,", "Ärztin", "Budi:", "we", "have", "27", "7", "robots!", "Follow", "me."]
    times = [word.at for word in words]
    assert times == sorted(times)
    assert 0.0 <= times[0] < times[-1] < sound.duration
    follow = begins.index("Follow")
    assert not loud(sound, times[follow] - 0.1, times[follow] - 0.05)


def test_says_a_text_and_a_longer_one_for_longer() -> None:
    short, long = espeak().speak("Good morning!"), espeak().speak("Good morning! Welcome to the exhibition.")
    assert 0.4 < short.duration < long.duration < 6.0
    assert loud(short, 0.0, short.duration)
    assert wav(_file(short)) == short


def test_each_language_sounds_different() -> None:
    text = "1920, 1959, 2015"
    english, indonesian = espeak().speak(text, "en"), espeak().speak(text, "id")
    assert abs(english.duration - indonesian.duration) > 0.1
    with pytest.raises(ModuleError, match="espeak-ng has no voice for the language `xx`"):
        espeak().speak("Hello", "xx")
    assert espeak().speak(text, "id").duration == pytest.approx(indonesian.duration, abs=0.01)


@for_each("text", ["", " ", "\x00\x1b[2J", "[[h@l'oU]] <speak>", "é" * 3_000, "\ud800", "'; rm -rf /"])
def test_takes_any_text(text: str) -> None:
    assert espeak().speak(text).duration < 180.0


def test_no_espeak_is_one_line() -> None:
    with pytest.raises(ModuleError, match=r"espeak-ng cannot be loaded \(.*\): pip install 'lumen-robot\[voice\]'"):
        Espeak("libnowhere.so", None)


def test_answers_texts_on_the_bus(stand: Make) -> None:
    here = stand()
    here.add(Voice(here.project, here.bus, here.told.append))
    spoken = here.listen(SPOKEN)
    here.bus.publish(STREAM, {"name": "NAO", "text": "Selamat pagi", "date": "2015-05-20", "language": "id"})
    (body,) = spoken.wait(1)
    assert body["name"] == "NAO"
    length = espeak().speak("Selamat pagi", "id").duration
    assert sound_of(body["sound"]).duration == pytest.approx(length, abs=0.01)


def test_a_language_without_a_voice_is_told_once(stand: Make) -> None:
    here = stand()
    here.add(Voice(here.project, here.bus, here.told.append))
    spoken = here.listen(SPOKEN)
    for _ in range(3):
        here.bus.publish(STREAM, {"text": "hello", "language": "xx"})
    here.bus.publish(STREAM, {"text": "hello"})
    spoken.wait(1)
    assert here.told == ["espeak-ng has no voice for the language `xx`"]


@pytest.fixture
def robot(project: Project) -> SimulatedRobot:
    return SimulatedRobot(project.body, Path(project.root) / "models", project.hall)


def test_the_simulated_robot_takes_as_long_as_its_voice(robot: SimulatedRobot, tmp_path: Path) -> None:
    file = tmp_path / "said.wav"
    silence = voiced(Setup(robot, SimulatedClock(robot.advance, None), robot), "espeak", file, "en")
    robot.advance(1.0)
    robot.start("c1", Say("Good morning!", "en"))
    robot.advance(4.0)
    robot.start("c2", Say("A long sentence that nobody hears to its end, because it is cancelled before.", "en"))
    robot.advance(1.0)
    robot.cancel("c2")
    robot.advance(2.0)
    done, cancelled = (event for event in robot.poll() if ".command." in event.name)
    length = espeak().speak("Good morning!").duration
    assert (done.name, cancelled.name) == ("done.command.c1", "cancelled.command.c2")
    assert done.at == pytest.approx(1.0 + length, abs=0.03)
    silence()
    sound = wav(file.read_bytes())
    assert not loud(sound, 0.0, 0.9)
    assert loud(sound, 1.0, 1.0 + length)
    assert not loud(sound, 1.1 + length, 4.9)
    assert sound.duration == pytest.approx(6.0, abs=0.05)


def test_what_is_written_is_as_loud_as_the_robot_was_told(robot: SimulatedRobot, tmp_path: Path) -> None:
    file = tmp_path / "said.wav"
    end = voiced(Setup(robot, SimulatedClock(robot.advance, None), robot), "espeak", file, "en")
    for begin, level in ((0.0, 1.0), (3.0, 0.25), (6.0, 0.0)):
        robot.start("", Volume(level))
        robot.start("", Say("Good morning!", "en"))
        robot.advance(begin + 3.0 - robot.time)
    end()
    sound = wav(file.read_bytes())
    loudest, quieter, silent = (peak(sound, begin, begin + 2.9) for begin in (0.0, 3.0, 6.0))
    assert quieter == pytest.approx(0.25 * loudest, rel=0.1)  # it never speaks twice alike
    assert silent == 0


def test_a_language_that_espeak_lacks_is_spoken_in_the_first(tmp_path: Path) -> None:
    speaker = Speaker("id", tmp_path / "a.wav")
    length = espeak().speak("Selamat pagi", "id").duration
    assert speaker.begin("Selamat pagi", "xx", 1.0, 0.0) == pytest.approx(length, abs=0.01)


@pytest.mark.process
@pytest.mark.slow
@pytest.mark.parametrize(
    ("flags", "said"),
    [
        (["--sound", "a.wav"], "add --voice espeak"),
        (["--voice", "espeak", "--robot", "recording"], "leave out --robot"),
        (["--voice", "espeak", "--sound", "nowhere/a.wav"], "name a .wav file in an existing folder"),
        (["--voice", "espeak", "--sound", "a.mp3"], "name a .wav file"),
    ],
)
def test_flags_that_do_not_go_together(
    flags: list[str], said: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    folder = copied_project(ROOT / "examples/minimal", tmp_path / "minimal")
    assert main(["run", str(folder), *flags, "--for", "0.1s", "--speed", "max"]) == 2
    assert said in capsys.readouterr().err


def test_a_robot_without_a_voice_to_give(tmp_path: Path) -> None:
    chosen = Setup(NoRobot(), SimulatedClock(lambda _: None, None), None)
    with pytest.raises(UsageError, match="--voice needs the simulated robot"):
        voiced(chosen, "espeak", tmp_path / "a.wav", "en")


def _file(sound: Sound) -> bytes:
    import base64

    return base64.b64decode(sound.text())


def test_its_files_are_what_every_player_reads(tmp_path: Path) -> None:
    speaker = Speaker("en", tmp_path / "a.wav")
    speaker.begin("Good morning!", "en", 1.0, 0.5)
    speaker.close()
    with wave.open(str(tmp_path / "a.wav")) as file:
        assert (file.getnchannels(), file.getsampwidth(), file.getframerate()) == (1, 2, espeak().rate)
        assert file.getnframes() / file.getframerate() > 0.9
